/* The scheduler of a process without MPI: the same promises as between ranks. */
#include "support.h"

#include "run/ranks.h"
#include "run/scheduler.h"

static scheduler *create(uint64_t items) {
  scheduler *s;
  message why;
  assert_int_equal(scheduler_create(items, &s, &why), 0);
  return s;
}

static void one_process_is_one_rank(void **state) {
  (void)state;
  message why = {"as it was"};
  uint64_t sum = 7, shared = 5;
  assert_false(ranks_parallel());
  assert_int_equal(ranks_rank(), 0);
  assert_int_equal(ranks_count(), 1);
  ranks_barrier();
  ranks_sum(&sum, 1);
  ranks_share(&shared, sizeof shared);
  assert_int_equal(sum, 7);
  assert_int_equal(shared, 5);
  assert_true(ranks_max(-2) == -2);
  assert_int_equal(ranks_agree(0, &why), 0);
  assert_int_equal(ranks_agree(EXIT_FILES, &why), EXIT_FILES);
  assert_string_equal(why.text, "as it was");
  ranks_finish();
}

static void every_item_is_handed_out_once_in_order(void **state) {
  (void)state;
  scheduler *s = create(1000);
  uint64_t first, count, next = 0;
  for (uint64_t want = 0; (count = scheduler_take(s, want % 17, &first)); want++) {
    assert_int_equal(first, next);
    assert_true(count <= (want % 17 ? want % 17 : 1));
    next += count;
    assert_int_equal(scheduler_taken(s), next);
    assert_false(scheduler_poll(s));
  }
  assert_int_equal(next, 1000);
  assert_int_equal(scheduler_take(s, 1, &first), 0);
  assert_false(scheduler_stopped(s));
  scheduler_destroy(&s);
  assert_null(s);
}

static void after_a_stop_nothing_is_handed_out(void **state) {
  (void)state;
  scheduler *s = create(1000);
  uint64_t first;
  message why;
  assert_int_equal(scheduler_take(s, 10, &first), 10);
  scheduler_stop(s);
  scheduler_stop(s);
  assert_true(scheduler_poll(s) && scheduler_stopped(s));
  assert_int_equal(scheduler_take(s, 10, &first), 0);
  assert_int_equal(scheduler_taken(s), 10);
  assert_int_equal(scheduler_failure(s, &why), 0);
  scheduler_destroy(&s);
}

static void no_items_and_too_many_are_told_apart(void **state) {
  (void)state;
  scheduler *s = create(0);
  uint64_t first;
  message why;
  assert_int_equal(scheduler_take(s, 1, &first), 0);
  scheduler_destroy(&s);
  assert_int_equal(scheduler_create(UINT64_MAX, &s, &why), EXIT_RUN);
  assert_null(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_process_is_one_rank),
      cmocka_unit_test(every_item_is_handed_out_once_in_order),
      cmocka_unit_test(after_a_stop_nothing_is_handed_out),
      cmocka_unit_test(no_items_and_too_many_are_told_apart),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
