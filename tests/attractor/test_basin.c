/* Basins of attraction, the distance of two attractors, and the choice of a variant of the runner by a clock. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "scenario/random_source.h"

enum { SIZE = 3, STARTS = 300 };

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

static int64_t add(ric_basin *basin, ric_attractor_kind kind, size_t period, double *lowest) {
  const ric_attractor run = {.kind = kind, .period = period, .lowest = lowest};
  int64_t label = 77;
  ric_error error;
  check(ric_basin_add(basin, &run, &label, &error), &error);
  return label;
}

static ric_basin *basin_of(const ric_basin_options *options) {
  ric_basin *basin = NULL;
  ric_error error;
  check(ric_basin_create(SIZE, options, &basin, &error), &error);
  return basin;
}

/* --- which attractors are one ------------------------------------------------------------------------------------- */

/* Six cycles, of any scale, reached with what is left of a transient: each start is told the one that it was made from.
 */
static void starts_of_one_attractor_have_one_label(void **state) {
  (void)state;
  enum { CYCLES = 6 };
  random_source source = {5};
  ric_basin *basin = basin_of(NULL);
  double at[CYCLES][SIZE];
  int64_t label[CYCLES];
  size_t first[CYCLES], starts[CYCLES] = {0};
  for (size_t c = 0; c < CYCLES; c++)
    for (size_t i = 0; i < SIZE; i++)
      at[c][i] = pow(10, (double)c - 3) * random_uniform(&source, -1, 1);
  for (size_t k = 0; k < STARTS; k++) {
    const size_t c = random_below(&source, CYCLES);
    double largest = 0, lowest[SIZE];
    for (size_t i = 0; i < SIZE; i++)
      largest = fmax(largest, fabs(at[c][i]));
    for (size_t i = 0; i < SIZE; i++)
      lowest[i] = at[c][i] + 1e-5 * largest * random_uniform(&source, -1, 1);
    const int64_t found = add(basin, RIC_ATTRACTOR_PERIODIC, 1 + c / 2, lowest);
    if (starts[c]++ == 0) {
      label[c] = found;
      first[c] = k;
    }
    assert_int_equal(found, label[c]);
  }
  assert_int_equal(ric_basin_count(basin), CYCLES);
  for (size_t c = 0; c < CYCLES; c++) {
    const ric_basin_attractor a = ric_basin_at(basin, (size_t)label[c]);
    const ric_attractor run = {.kind = RIC_ATTRACTOR_PERIODIC, .period = 1 + c / 2, .lowest = at[c]};
    assert_int_equal(ric_basin_label(basin, &run), label[c]);
    assert_true(a.period == 1 + c / 2 && a.first == first[c] && a.starts == starts[c]);
    for (size_t i = 0; i < SIZE; i++)
      assert_close(a.lowest[i], at[c][i], 1e-5 * pow(10, (double)c - 3));
  }
  ric_basin_destroy(&basin);
  assert_null(basin);
}

static void attractors_differ_by_their_period_or_by_more_than_the_tolerance(void **state) {
  (void)state;
  const ric_basin_options options = {.limit = 10, .same_tol = 1e-3};
  ric_basin *basin = basin_of(&options);
  double a[SIZE] = {1, -2, 0.5}, near[SIZE] = {1, -2, 0.5 + 1.9e-3}, far[SIZE] = {1, -2, 0.5 + 2.1e-3};
  assert_int_equal(add(basin, RIC_ATTRACTOR_PERIODIC, 3, a), 0);
  assert_int_equal(add(basin, RIC_ATTRACTOR_PERIODIC, 3, near), 0);
  assert_int_equal(add(basin, RIC_ATTRACTOR_PERIODIC, 3, far), 1);
  assert_int_equal(add(basin, RIC_ATTRACTOR_PERIODIC, 6, a), 2);
  ric_basin_destroy(&basin);
}

static void attractors_without_a_period_are_one_and_runs_that_came_to_nothing_none(void **state) {
  (void)state;
  ric_basin *basin = basin_of(NULL);
  double a[SIZE] = {1, 2, 3}, b[SIZE] = {4, 5, 6};
  assert_int_equal(add(basin, RIC_ATTRACTOR_FAILED, 0, NULL), RIC_BASIN_NONE);
  assert_int_equal(add(basin, RIC_ATTRACTOR_APERIODIC, 0, a), 0);
  assert_int_equal(add(basin, RIC_ATTRACTOR_DIVERGED, 0, NULL), RIC_BASIN_NONE);
  assert_int_equal(add(basin, RIC_ATTRACTOR_APERIODIC, 0, b), 0);
  assert_int_equal(add(basin, RIC_ATTRACTOR_APERIODIC, 0, NULL), 0);
  const ric_attractor failed = {.kind = RIC_ATTRACTOR_FAILED}, aperiodic = {.kind = RIC_ATTRACTOR_APERIODIC};
  assert_int_equal(ric_basin_label(basin, &failed), RIC_BASIN_NONE);
  assert_int_equal(ric_basin_label(basin, &aperiodic), 0);
  assert_int_equal(ric_basin_count(basin), 1);
  assert_int_equal(ric_basin_at(basin, 0).first, 1);
  assert_int_equal(ric_basin_at(basin, 0).starts, 3);
  ric_basin_destroy(&basin);
}

static void attractors_beyond_the_limit_are_not_told_apart(void **state) {
  (void)state;
  const ric_basin_options options = {.limit = 3, .same_tol = 1e-4};
  ric_basin *basin = basin_of(&options);
  for (int round = 0; round < 2; round++)
    for (size_t period = 1; period < 7; period++) {
      double lowest[SIZE] = {1, 1, 1};
      const ric_attractor run = {.kind = RIC_ATTRACTOR_PERIODIC, .period = period, .lowest = lowest};
      const int64_t label = add(basin, RIC_ATTRACTOR_PERIODIC, period, lowest);
      assert_int_equal(ric_basin_label(basin, &run), label);
      assert_int_equal(label, period <= 3 ? (int64_t)period - 1 : RIC_BASIN_OTHER);
    }
  assert_int_equal(ric_basin_count(basin), 3);
  assert_int_equal(ric_basin_at(basin, 2).starts, 2);
  ric_basin_destroy(&basin);
}

static void basins_out_of_range_are_refused(void **state) {
  (void)state;
  const ric_basin_options none = {.limit = 0, .same_tol = 1}, nan = {.limit = 1, .same_tol = NAN};
  const ric_attractor run = {.kind = RIC_ATTRACTOR_PERIODIC, .period = 2};
  ric_basin *basin = NULL;
  ric_error error;
  int64_t label = 77;
  assert_int_equal(ric_basin_create(0, NULL, &basin, &error), RIC_EINVAL);
  assert_int_equal(ric_basin_create(1, &none, &basin, &error), RIC_EINVAL);
  assert_int_equal(ric_basin_create(1, &nan, &basin, &error), RIC_EINVAL);
  assert_null(basin);
  ric_basin_destroy(&basin);
  basin = basin_of(NULL);
  assert_int_equal(ric_basin_add(basin, &run, &label, &error), RIC_EINVAL);
  assert_int_equal(label, 77);
  ric_basin_destroy(&basin);
}

/* --- the distance of two attractors ------------------------------------------------------------------------------- */

/* As its definition says, over all pairs. */
static double distance_of_pairs(const double *a, const double *b, size_t count) {
  double most = 0, low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < count; i++) {
    double from_a = INFINITY, from_b = INFINITY;
    for (size_t k = 0; k < count; k++) {
      from_a = fmin(from_a, fabs(a[i] - b[k]));
      from_b = fmin(from_b, fabs(b[i] - a[k]));
    }
    most = fmax(most, fmax(from_a, from_b));
    low = fmin(low, b[i]);
    high = fmax(high, b[i]);
  }
  return most / (high - low);
}

static void the_distance_is_that_of_the_farthest_pair(void **state) {
  (void)state;
  random_source source = {9};
  for (int round = 0; round < 200; round++) {
    double a[40], b[40];
    const size_t count = 2 + random_below(&source, 39);
    for (size_t i = 0; i < count; i++) {
      a[i] = floor(random_uniform(&source, -9, 9)) / 3; /* some of them equal */
      b[i] = i == 0 ? 10 : floor(random_uniform(&source, -12, 5)) / 3;
    }
    const double exact = distance_of_pairs(a, b, count);
    assert_true(ric_attractor_distance(a, b, count) == exact);
  }
}

static void equal_sets_have_no_distance_and_numbers_that_are_not_finite_none_known(void **state) {
  (void)state;
  double a[3] = {3, 1, 2}, b[3] = {2, 3, 1}, c[3] = {1, INFINITY, 2};
  assert_true(ric_attractor_distance(a, b, 3) == 0);
  assert_true(isnan(ric_attractor_distance(a, c, 3)));
  assert_true(isnan(ric_attractor_distance(c, a, 3)));
  assert_true(isnan(ric_attractor_distance(a, b, 0)));
}

/* --- the fastest variant ------------------------------------------------------------------------------------------ */

/* A clock by which the trials of each variant that is there take what the test says. */
typedef struct fake_clock {
  double taken[RIC_MAP_LANES_KINDS];
  size_t asked;
  double time;
} fake_clock;

static double fake_now(void *user) {
  fake_clock *c = user;
  size_t trial = c->asked++ / 2 / 3; /* asked before and after each of three runs */
  int lanes = 0;
  for (; lanes < RIC_MAP_LANES_KINDS; lanes++)
    if (ric_map_lanes_available((ric_map_lanes)lanes) && trial-- == 0)
      break;
  assert_true(lanes < RIC_MAP_LANES_KINDS);
  if (c->asked % 2 == 0)
    c->time += c->taken[lanes];
  return c->time;
}

static void the_variant_whose_trial_is_shortest_is_taken(void **state) {
  (void)state;
  for (int best = 0; best < RIC_MAP_LANES_KINDS; best++) {
    fake_clock clock = {0};
    if (!ric_map_lanes_available((ric_map_lanes)best))
      continue;
    for (int lanes = 0; lanes < RIC_MAP_LANES_KINDS; lanes++)
      clock.taken[lanes] = lanes == best ? 1 : 2;
    assert_int_equal(ric_map_lanes_fastest(3, 2, fake_now, &clock), best);
    assert_true(clock.asked > 0);
  }
  assert_int_equal(ric_map_lanes_fastest(3, 0, NULL, NULL), ric_map_lanes_widest());
}

/* With which one trial would take minutes. */
static void large_maps_are_not_tried(void **state) {
  (void)state;
  fake_clock clock = {0};
  assert_int_equal(ric_map_lanes_fastest(600, 600, fake_now, &clock), ric_map_lanes_widest());
  assert_int_equal(ric_map_lanes_fastest(SIZE_MAX / 1000, 0, fake_now, &clock), ric_map_lanes_widest());
  assert_int_equal(clock.asked, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(starts_of_one_attractor_have_one_label),
      cmocka_unit_test(attractors_differ_by_their_period_or_by_more_than_the_tolerance),
      cmocka_unit_test(attractors_without_a_period_are_one_and_runs_that_came_to_nothing_none),
      cmocka_unit_test(attractors_beyond_the_limit_are_not_told_apart),
      cmocka_unit_test(basins_out_of_range_are_refused),
      cmocka_unit_test(the_distance_is_that_of_the_farthest_pair),
      cmocka_unit_test(equal_sets_have_no_distance_and_numbers_that_are_not_finite_none_known),
      cmocka_unit_test(the_variant_whose_trial_is_shortest_is_taken),
      cmocka_unit_test(large_maps_are_not_tried),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
