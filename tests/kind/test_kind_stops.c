/* A task is stopped whenever the poll says so, also while its row is filled. */
#include "kind/fill.h"
#include "study/study_cases.h"

#include "witness/countdown.h"

static void large_memory_is_filled_in_pieces(void **state) {
  (void)state;
  enum { NUMBERS = 5 << 20 }; /* 40 MB: 3 pieces */
  double *numbers = malloc(NUMBERS * sizeof *numbers);
  assert_non_null(numbers);
  for (int limit = 1; limit <= 4; limit++) {
    countdown c = {.limit = limit}, d = {.limit = limit};
    numbers[0] = numbers[NUMBERS - 1] = 7;
    assert_int_equal(fill_nan(numbers, NUMBERS, (ric_poll){count, &c}), limit > 3);
    assert_int_equal(isnan(numbers[0]), limit > 1);
    assert_int_equal(isnan(numbers[NUMBERS - 1]), limit > 3);
    numbers[0] = numbers[NUMBERS - 1] = 7;
    assert_int_equal(fill_zero(numbers, NUMBERS * sizeof *numbers, (ric_poll){count, &d}), limit > 3);
    assert_true((numbers[0] == 0) == (limit > 1));
    assert_true((numbers[NUMBERS - 1] == 0) == (limit > 3));
  }
  assert_true(fill_nan(NULL, NUMBERS, (ric_poll){0}));
  free(numbers);
}

/* A study with one task, opened with a poll. */
typedef struct one_task {
  study *study;
  const kind *kind;
  kind_plan plan;
  worker *worker;
  countdown countdown;
  unsigned char *row;
  records tails[KIND_MOST_TAILS];
} one_task;

static void open_task(one_task *t, const char *text) {
  message why;
  *t = (one_task){.study = parsed(text, NULL, 0), .countdown = {.limit = INT32_MAX}};
  t->kind = kind_of(t->study);
  assert_int_equal(t->kind->plan(t->study, &t->plan, &why), 0);
  assert_int_equal(t->kind->open(t->study, (ric_poll){count, &t->countdown}, &t->worker, &why), 0);
  t->row = malloc(t->plan.rows.row_bytes);
  assert_non_null(t->row);
  for (size_t k = 0; k < t->plan.tail_count; k++)
    t->tails[k].record_bytes = t->plan.tails[k].records.row_bytes;
}

static int evaluate(one_task *t, int limit) {
  t->countdown = (countdown){.limit = limit};
  for (size_t k = 0; k < t->plan.tail_count; k++)
    records_cut(&t->tails[k], 0);
  return t->kind->evaluate(t->worker, &t->plan, (task_range){0, 1}, t->row, t->tails);
}

static void close_task(one_task *t) {
  t->kind->close(&t->worker);
  for (size_t k = 0; k < t->plan.tail_count; k++)
    records_clear(&t->tails[k]);
  free(t->row);
  study_destroy(&t->study);
}

static void stops_at_calls(const char *text, int least_calls) {
  one_task t;
  open_task(&t, text);
  assert_int_equal(evaluate(&t, INT32_MAX), 0);
  const int calls = t.countdown.calls;
  if (calls < least_calls)
    fail_msg("asked %d times, expected at least %d:\n%s", calls, least_calls, text);
  for (int i = 0; i < 20; i++) {
    const int limit = 1 + (int)((double)(calls - 1) * i / 19);
    assert_int_equal(evaluate(&t, limit), -1);
    assert_int_equal(t.countdown.calls, limit);
  }
  assert_int_equal(evaluate(&t, INT32_MAX), 0);
  assert_int_equal(t.countdown.calls, calls);
  close_task(&t);
}

static void a_task_of_any_kind_stops_at_any_call(void **state) {
  (void)state;
  stops_at_calls("kind: orbits\nmodel: {type: chain, particles: 30, gamma: 0.1}\n"
                 "orbit: {period: 1.5 pi, at_start: [0], verify: true, stable: true}\n",
                 10);
  stops_at_calls("kind: trajectory\nmodel: {type: chain, particles: 3, gamma: 0.1}\nstart: {v: 2}\n"
                 "time: {duration: 5, samples: 9, lyapunov: true}\n",
                 10);
  stops_at_calls("kind: branch\nmodel: {type: duffing_chain, particles: 2, cubic: 0.1, wall: 1}\norbit: {mode: 0}\n"
                 "branch: {parameter: orbit.energy, from: 0.05, to: 1}\n",
                 100);
  stops_at_calls("kind: diagram\nmodel: {type: grazing_map, lambda: 0.5, omega: 0.3, d: 0.01}\n"
                 "iterate: {start: [0, 0, 0], keep: 60000, lyapunov: true}\n", /* asked thrice by any variant of SIMD */
                 3);
}

/* Before anything is computed, and what a row has room for is never touched after a stop. */
static void filling_a_huge_row_stops(void **state) {
  (void)state;
  static const char *const studies_with_rows[] = {
      "kind: diagram\nmodel: {type: grazing_map, lambda: 0.5, omega: 0.3, d: 0.01}\n"
      "iterate: {start: [0, 0, 0], transient: 0, keep: 6000000}\n",
      "kind: trajectory\nmodel: {type: chain, particles: 3, gamma: 0}\nstart: {v: 2}\n"
      "time: {duration: 1, samples: 1000000}\n"};
  for (size_t i = 0; i < 2; i++) {
    one_task t;
    open_task(&t, studies_with_rows[i]);
    const size_t last = t.plan.rows.row_bytes - 1;
    for (int limit = 1; limit <= 3; limit++) {
      t.row[last] = 0x77;
      assert_int_equal(evaluate(&t, limit), -1);
      assert_int_equal(t.row[last], 0x77);
      assert_int_equal(t.countdown.calls, limit);
    }
    close_task(&t);
  }
}

/* A map that diverges at once: nothing but the filling of its values takes long. */
static void filling_the_values_of_a_map_that_diverged_stops(void **state) {
  (void)state;
  stops_at_calls("kind: diagram\nmodel: {type: grazing_map, L: [9], eta: [1], xi: [1], kappa: [3], d: 0.01}\n"
                 "iterate: {start: 1, transient: 0, keep: 12000000}\n",
                 6 + 12);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(large_memory_is_filled_in_pieces),
      cmocka_unit_test(a_task_of_any_kind_stops_at_any_call),
      cmocka_unit_test(filling_a_huge_row_stops),
      cmocka_unit_test(filling_the_values_of_a_map_that_diverged_stops),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
