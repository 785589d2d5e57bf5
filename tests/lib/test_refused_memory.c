/* Whatever allocation is refused, functions that make lists say so and leave nothing behind. Not what solves by
 * SUNDIALS, which does not survive it. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "scenario/scenario.h"
#include "witness/allocation_counter.h"

#ifdef ALLOCATIONS_ARE_COUNTED

/* Heads of workspaces that GSL keeps when there is no memory for the rest. */
enum { GSL_LEAVES_BEHIND = 256, MOST_REFUSALS = 20000 };

typedef ric_status work(void *user);

/* Refuses the first allocation of the work, then the second, until it has all of them. */
static void refuse_each(work *run, void *user, const char *what) {
  ric_status status = RIC_ENOMEM;
  size_t k = 1;
  for (; status != RIC_OK; k++) {
    const size_t before = live;
    until_refusal = k;
    status = run(user);
    const bool refused = until_refusal == 0;
    until_refusal = 0;
    if (status != (refused ? RIC_ENOMEM : RIC_OK))
      fail_msg("%s, allocation %zu: status %d", what, k, (int)status);
    if (live > before + GSL_LEAVES_BEHIND)
      fail_msg("%s, allocation %zu: %zu bytes are left", what, k, live - before);
    assert_true(k < MOST_REFUSALS);
  }
  print_message("[ %s: %zu allocations ]\n", what, k - 2);
  assert_true(k > 2);
}

/* --- basins and windows ------------------------------------------------------------------------------------------- */

static ric_status fill_basin(void *user) {
  ric_basin *basin = NULL;
  ric_status status = ric_basin_create(2, NULL, &basin, NULL);
  (void)user;
  for (size_t period = 1; period < 30 && status == RIC_OK; period++) {
    double lowest[2] = {1, 2};
    const ric_attractor run = {.kind = RIC_ATTRACTOR_PERIODIC, .period = period, .lowest = lowest};
    int64_t label;
    status = ric_basin_add(basin, &run, &label, NULL);
  }
  ric_basin_destroy(&basin);
  return status;
}

static size_t period_at(double p) {
  return (size_t)floor(p) % 2 ? (size_t)floor(p) : 0;
}

static ric_status run_window(double p, const double *start, ric_attractor *a, void *user, ric_error *error) {
  (void)start, (void)user, (void)error;
  a->period = period_at(p);
  a->kind = a->period > 0 ? RIC_ATTRACTOR_PERIODIC : RIC_ATTRACTOR_APERIODIC;
  a->impacts = 0;
  *a->z = p;
  return RIC_OK;
}

static ric_status locate_none(const double *z, double low, double high, ric_window *window, void *user,
                              ric_error *error) {
  (void)z, (void)low, (void)high, (void)window, (void)user;
  return ric_fail(error, RIC_ENUMERIC, "no cycle");
}

static ric_status find_windows(void *user) {
  enum { POINTS = 60 };
  double p[POINTS], ends[POINTS];
  ric_attractor attractors[POINTS];
  ric_windows found;
  (void)user;
  for (size_t i = 0; i < POINTS; i++) {
    p[i] = 0.3 + 0.5 * (double)i;
    attractors[i] = (ric_attractor){.z = &ends[i]};
    assert_int_equal(run_window(p[i], NULL, &attractors[i], NULL, NULL), RIC_OK);
  }
  const ric_window_line line = {.points = POINTS,
                                .p = p,
                                .attractors = attractors,
                                .size = 1,
                                .measured = 1000,
                                .run = run_window,
                                .locate = locate_none};
  const ric_status status = ric_windows_find(&line, &found, NULL);
  ric_windows_clear(&found);
  return status;
}

static void basins_and_windows_without_memory(void **state) {
  (void)state;
  refuse_each(fill_basin, NULL, "basin");
  refuse_each(find_windows, NULL, "windows");
}

/* --- normal modes ------------------------------------------------------------------------------------------------- */

static ric_status guess_mode(void *user) {
  const ric_lattice lattice = ric_lattice_default(4, RIC_ENDS_FREE);
  ric_guess guess;
  ric_status status = ric_guess_init(&guess, 4, NULL);
  (void)user;
  if (status == RIC_OK)
    status = ric_guess_mode(&lattice, 2, 1, &guess, NULL);
  ric_guess_clear(&guess);
  return status;
}

static void first_guesses_of_modes_without_memory(void **state) {
  (void)state;
  refuse_each(guess_mode, NULL, "first guess");
}

/* --- special points ----------------------------------------------------------------------------------------------- */

static int ignore(const ric_special_point *point, void *user) {
  (void)point, (void)user;
  return 0;
}

static ric_status list_points(void *user) {
  const scenario *s = user;
  const ric_special_range range = {.chain = &s->chain,
                                   .pattern = s->pattern,
                                   .along = RIC_ALONG_GAMMA,
                                   .period = s->period,
                                   .low = 0,
                                   .high = 1,
                                   .points = 6};
  ric_orbit_solver *solver = NULL;
  ric_status status = ric_orbit_solver_create(NULL, &solver, NULL);
  if (status == RIC_OK)
    status = ric_orbit_special_points(solver, &range, ignore, NULL, NULL);
  ric_orbit_solver_destroy(&solver);
  return status;
}

static void special_points_without_memory(void **state) {
  (void)state;
  scenario s = scenario_word("s.h.", 1, RIC_ENDS_FREE, 0.1, 5.1);
  assert_int_equal(list_points(&s), RIC_OK); /* FFTW keeps tables */
  refuse_each(list_points, &s, "special points");
  scenario_clear(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(basins_and_windows_without_memory),
      cmocka_unit_test(first_guesses_of_modes_without_memory),
      cmocka_unit_test(special_points_without_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void) {
  return 0;
}

#endif
