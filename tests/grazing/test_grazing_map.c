/* The return map beside grazing: iterates, derivative, first return and the one-dimensional limit. */
#include "support.h"

#include <float.h>

#include <ricochet/ricochet.h>

#include "witness/allocation_counter.h"
#include "witness/grazing_maps.h"

enum { MOST_SIZE = 6 };

/* [FN97] (6.4), written out. */
static void example_by_hand(double lambda, double omega, double d, const double *z, double *next) {
  double root = sqrt(d - z[0]);
  next[0] = root + lambda * d + 3 * (d - z[0]);
  next[1] = root + 5 * (z[0] - d) - omega * z[2];
  next[2] = root + 7 * (d - z[0]) + omega * z[1];
}

static void example_is_that_of_the_source(void **state) {
  (void)state;
  random_source source = {1};
  for (int i = 0; i < 200; i++) {
    double lambda = random_uniform(&source, 0.1, 0.9), omega = random_uniform(&source, 0, lambda);
    double d = random_uniform(&source, 0.001, 0.2), next[3], expected[3];
    double z[3] = {random_uniform(&source, -1, d), random_uniform(&source, -1, 1), random_uniform(&source, -1, 1)};
    ric_grazing_map map = example_map(lambda, omega);
    assert_true(ric_grazing_map_hits(&map, d, z));
    ric_grazing_map_step(&map, d, z, next);
    example_by_hand(lambda, omega, d, z, expected);
    assert_close(relative_distance(next, expected, 3), 0, 8 * DBL_EPSILON);
    z[0] = d + random_uniform(&source, 0.001, 1);
    assert_false(ric_grazing_map_hits(&map, d, z));
    ric_grazing_map_step(&map, d, z, next);
    assert_close(next[0], lambda * z[0], 0);
    assert_close(next[1], -omega * z[2], 0);
    assert_close(next[2], omega * z[1], 0);
    ric_grazing_map_clear(&map);
  }
}

/* A state with eta z = d - depth, up to rounding. */
static void put_at_depth(const ric_grazing_map *map, random_source *source, double d, double depth, double *z) {
  double seen = 0, square = 0;
  for (size_t i = 0; i < map->size; i++) {
    z[i] = random_uniform(source, -1, 1);
    seen += map->eta[i] * z[i];
    square += map->eta[i] * map->eta[i];
  }
  for (size_t i = 0; i < map->size; i++)
    z[i] += (d - depth - seen) / square * map->eta[i];
}

/* It falls off like the root of the depth. */
static void map_is_continuous_at_the_border(void **state) {
  (void)state;
  random_source source = {2};
  for (size_t size = 1; size <= MOST_SIZE; size++) {
    ric_grazing_map map = random_map(&source, size, 0.8);
    double z[MOST_SIZE], beside[MOST_SIZE], next[MOST_SIZE], next_beside[MOST_SIZE];
    put_at_depth(&map, &source, 0.1, -1e-12, z);
    memcpy(beside, z, sizeof z);
    double square = 0;
    for (size_t i = 0; i < size; i++)
      square += map.eta[i] * map.eta[i];
    for (size_t i = 0; i < size; i++)
      beside[i] -= 2e-12 / square * map.eta[i];
    assert_false(ric_grazing_map_hits(&map, 0.1, z));
    assert_true(ric_grazing_map_hits(&map, 0.1, beside));
    ric_grazing_map_step(&map, 0.1, z, next);
    ric_grazing_map_step(&map, 0.1, beside, next_beside);
    double size_of_jump = map.stretch * 1e-6;
    for (size_t i = 0; i < size; i++)
      assert_close(next_beside[i] - next[i], size_of_jump * map.xi[i], 1e-9);
    ric_grazing_map_clear(&map);
  }
}

static void derivative_is_that_of_central_differences(void **state) {
  (void)state;
  static const double step = 1e-5;
  random_source source = {3};
  for (size_t k = 0; k < 60; k++) {
    size_t size = 1 + k % MOST_SIZE;
    ric_grazing_map map = random_map(&source, size, 0.8);
    double z[MOST_SIZE], D[MOST_SIZE * MOST_SIZE], up[MOST_SIZE], down[MOST_SIZE];
    put_at_depth(&map, &source, 0.1, k % 2 ? 0.3 : -0.3, z);
    ric_grazing_map_derivative(&map, 0.1, z, D);
    for (size_t j = 0; j < size; j++) {
      double at = z[j];
      z[j] = at + step;
      ric_grazing_map_step(&map, 0.1, z, up);
      z[j] = at - step;
      ric_grazing_map_step(&map, 0.1, z, down);
      z[j] = at;
      for (size_t i = 0; i < size; i++)
        assert_close(D[i * size + j], (up[i] - down[i]) / (2 * step), 1e-8);
    }
    ric_grazing_map_clear(&map);
  }
}

static void derivative_is_infinite_at_the_border_only_where_the_root_acts(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  static const double z[3] = {0.25, 1, 2};
  double D[9];
  map.xi[1] = 0;
  ric_grazing_map_derivative(&map, 0.25, z, D);
  assert_true(D[0] == -INFINITY && D[6] == -INFINITY);
  assert_close(D[3], 5, 0); /* -kappa_1 */
  assert_close(D[1], 0, 0);
  assert_close(D[5], -0.3, 0);
  ric_grazing_map_clear(&map);
}

static void not_a_number_goes_on(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  double z[3] = {0.1, NAN, 0}, next[3];
  assert_false(ric_grazing_map_hits(&map, 0.1, z));
  ric_grazing_map_step(&map, 0.1, z, next);
  assert_true(isnan(next[0]) && isnan(next[1]) && isnan(next[2]));
  z[1] = 0;
  ric_grazing_map_step(&map, NAN, z, next);
  assert_true(isnan(next[0]) && isnan(next[1]) && isnan(next[2]));
  ric_grazing_map_clear(&map);
}

/* --- first return ------------------------------------------------------------------------------------------------- */

static void return_counts_iterates_without_impact(void **state) {
  (void)state;
  random_source source = {4};
  size_t seen[64] = {0};
  for (int k = 0; k < 300; k++) {
    ric_grazing_map map = example_map(random_uniform(&source, 0.2, 0.8), 0.15);
    double d = exp(random_uniform(&source, -12, 1)), work[3], x[3];
    double z[3] = {random_uniform(&source, -d, d), random_uniform(&source, -1, 1), random_uniform(&source, -1, 1)};
    size_t count, expected = 0;
    memcpy(x, z, sizeof z);
    map_iterate(&map, d, x, 1, work);
    for (; !ric_grazing_map_hits(&map, d, x); expected++)
      map_iterate(&map, d, x, 1, work);
    assert_int_equal(ric_grazing_map_return(&map, d, z, 1000, work, &count, NULL), RIC_OK);
    assert_int_equal(count, expected);
    assert_memory_equal(z, x, sizeof z);
    seen[count < 63 ? count : 63]++;
    ric_grazing_map_clear(&map);
  }
  assert_true(seen[0] > 0 && seen[1] > 0 && seen[5] > 0);
}

static void return_needs_an_impact_before_and_after(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  double z[3] = {0.2, 0, 0}, work[3];
  size_t count = 7;
  ric_error error;
  assert_int_equal(ric_grazing_map_return(&map, 0.1, z, 10, work, &count, &error), RIC_EINVAL);
  assert_string_equal(error.message, "eta z - d = 0.1, expected an impact: at most 0");
  z[0] = NAN;
  assert_int_equal(ric_grazing_map_return(&map, 0.1, z, 10, work, &count, &error), RIC_EINVAL);
  z[0] = -1;
  assert_int_equal(ric_grazing_map_return(&map, 0.001, z, 3, work, &count, &error), RIC_ENUMERIC);
  assert_string_equal(error.message, "no impact follows within 3 iterates");
  assert_int_equal(count, 3);
  assert_true(z[0] > 0.001);
  ric_grazing_map_clear(&map);
}

/* --- the limit map ------------------------------------------------------------------------------------------------ */

static void limit_map_takes_the_first_count_that_returns(void **state) {
  (void)state;
  random_source source = {5};
  for (int k = 0; k < 2000; k++) {
    double rho = exp(random_uniform(&source, -3, 30)), lambda = random_uniform(&source, 0.01, 0.99);
    double delta = random_uniform(&source, -2, 1), expected = rho * sqrt(1 - delta);
    size_t count, steps = 0;
    double next = ric_grazing_limit_map(rho, lambda, delta, &count);
    while (expected > 1) {
      expected *= lambda;
      steps++;
    }
    assert_int_equal(count, steps);
    assert_close(next / expected, 1, 1e-12);
  }
  assert_close(ric_grazing_limit_map(8, 0.5, 0, NULL), 1, 0); /* a tie is a return */
  assert_close(ric_grazing_limit_map(8, 0.5, 1, NULL), 0, 0);
}

/* The example in the limit: alpha = 1. Its distance from the limit falls like the root of d. */
static void map_tends_to_the_limit_map(void **state) {
  (void)state;
  random_source source = {6};
  for (int k = 0; k < 100; k++) {
    double lambda = random_uniform(&source, 0.2, 0.8), d = 1e-12, delta = random_uniform(&source, -1, 0.99), work[3];
    ric_grazing_map map = example_map(lambda, lambda / 2);
    double z[3] = {delta * d, 0, 0};
    size_t count, expected;
    double limit = ric_grazing_limit_map(1 / sqrt(d), lambda, delta, &expected);
    assert_int_equal(ric_grazing_map_return(&map, d, z, 1000, work, &count, NULL), RIC_OK);
    assert_int_equal(count, expected);
    assert_close(z[0] / d, limit, 1e-4);
    ric_grazing_map_clear(&map);
  }
}

/* rho at which delta is a fixed point with this count. */
static double rho_of(double delta, double lambda, double count) {
  return delta / sqrt(1 - delta) * pow(lambda, -count);
}

static double slope_of_limit_map(double rho, double lambda, double delta) {
  double step = 1e-6;
  return (ric_grazing_limit_map(rho, lambda, delta + step, NULL) -
          ric_grazing_limit_map(rho, lambda, delta - step, NULL)) /
         (2 * step);
}

static void fixed_points_of_the_limit_map_lose_stability_at_two_thirds(void **state) {
  (void)state;
  static const double lambdas[] = {0.1, 0.3, 0.5, 0.65};
  for (size_t i = 0; i < 4; i++)
    for (size_t N = 1; N <= 6; N++)
      for (double delta = lambdas[i] + 0.01; delta < 0.99; delta += 0.01) {
        size_t count;
        double rho = rho_of(delta, lambdas[i], (double)N);
        assert_close(ric_grazing_limit_map(rho, lambdas[i], delta, &count), delta, 1e-13);
        assert_int_equal(count, N);
        double slope = slope_of_limit_map(rho, lambdas[i], delta);
        assert_close(slope, -delta / (2 * (1 - delta)), 1e-4);
        assert_int_equal(slope > -1, delta < 2.0 / 3);
      }
}

/* Whether the limit map has a stable fixed point with this count. */
static bool limit_is_stable(double rho, double lambda, size_t count) {
  double ratio = rho * pow(lambda, (double)count); /* delta / sqrt(1 - delta) */
  double delta = ratio * (sqrt(ratio * ratio + 4) - ratio) / 2;
  size_t found;
  double next = ric_grazing_limit_map(rho, lambda, delta, &found);
  return found == count && fabs(next - delta) < 1e-9 && delta < 2.0 / 3;
}

/* Windows overlap below lambda = 1/4, chaos parts them up to 2/3, and beyond there are none. */
static void thresholds_of_the_limit_map_are_a_quarter_and_two_thirds(void **state) {
  (void)state;
  static const struct {
    double lambda;
    bool together, apart; /* both of two counts somewhere; none somewhere */
  } cases[] = {{0.15, true, false}, {0.24, true, false}, {0.26, false, true},
               {0.5, false, true},  {0.66, false, true}, {0.68, false, true}};
  for (size_t i = 0; i < 6; i++) {
    double lambda = cases[i].lambda;
    bool together = false, apart = false, any = false;
    for (int k = 0; k < 4000; k++) { /* one period of ln rho */
      double rho = pow(lambda, -3 - k / 4000.0);
      int stable = 0;
      for (size_t N = 1; N <= 5; N++)
        stable += limit_is_stable(rho, lambda, N);
      together = together || stable == 2;
      apart = apart || stable == 0;
      any = any || stable > 0;
    }
    assert_int_equal(together, cases[i].together);
    assert_int_equal(apart, cases[i].apart);
    assert_int_equal(any, lambda < 2.0 / 3);
  }
}

static void limit_map_knows_its_range(void **state) {
  (void)state;
  size_t count;
  assert_true(isnan(ric_grazing_limit_map(0, 0.5, 0, NULL)));
  assert_true(isnan(ric_grazing_limit_map(INFINITY, 0.5, 0, &count)));
  assert_int_equal(count, 0);
  assert_true(isnan(ric_grazing_limit_map(3, 0, 0, NULL)));
  assert_true(isnan(ric_grazing_limit_map(3, 1, 0, NULL)));
  assert_true(isnan(ric_grazing_limit_map(3, NAN, 0, NULL)));
  assert_true(isnan(ric_grazing_limit_map(3, 0.5, 1.1, NULL)));
  assert_true(isnan(ric_grazing_limit_map(3, 0.5, NAN, NULL)));
}

/* --- refusals and room -------------------------------------------------------------------------------------------- */

static void check_refused(ric_grazing_map *map, double *entry, double bad, const char *message) {
  ric_error error;
  double good = *entry;
  *entry = bad;
  assert_int_equal(ric_grazing_map_check(map, &error), RIC_EINVAL);
  assert_string_equal(error.message, message);
  *entry = good;
  assert_int_equal(ric_grazing_map_check(map, &error), RIC_OK);
}

static void bad_maps_are_refused(void **state) {
  (void)state;
  ric_error error;
  ric_grazing_map map;
  assert_int_equal(ric_grazing_map_init(&map, 0, &error), RIC_EINVAL);
  assert_string_equal(error.message, "size = 0, expected at least 1");
  assert_int_equal(ric_grazing_map_check(&map, &error), RIC_EINVAL);
  assert_int_equal(ric_grazing_map_init(&map, SIZE_MAX / 2, &error), RIC_ENOMEM);
  assert_int_equal(ric_grazing_map_example(&map, NAN, 0.3, &error), RIC_EINVAL);
  assert_int_equal(ric_grazing_map_example(&map, 0.5, INFINITY, &error), RIC_EINVAL);
  map = example_map(0.5, 0.3);
  check_refused(&map, &map.L[5], NAN, "L[1][2] = nan, expected a finite number");
  check_refused(&map, &map.eta[2], INFINITY, "eta[2] = inf, expected a finite number");
  check_refused(&map, &map.eta[0], 0, "eta = 0, expected a vector other than 0");
  check_refused(&map, &map.kappa[1], NAN, "kappa[1] = nan, expected a finite number");
  check_refused(&map, &map.stretch, 0, "stretch = 0, expected a finite number > 0");
  check_refused(&map, &map.stretch, NAN, "stretch = nan, expected a finite number > 0");
  map.xi[0] = map.xi[1] = 0;
  check_refused(&map, &map.xi[2], 0, "xi = 0, expected a vector other than 0");
  ric_grazing_map_clear(&map);
  ric_grazing_map_clear(&map);
}

#ifdef ALLOCATIONS_ARE_COUNTED

static void iterating_allocates_nothing(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  double z[3] = {0, 0.1, -0.1}, next[3], work[3], D[9];
  size_t count, before = allocations, hits = 0;
  watching = true;
  for (int k = 0; k < 1000; k++) {
    hits += ric_grazing_map_hits(&map, 0.01, z);
    ric_grazing_map_step(&map, 0.01, z, next);
    ric_grazing_map_derivative(&map, 0.01, z, D);
    z[0] = ric_grazing_limit_map(10, 0.5, 0.3, &count) * 0.01;
    ric_grazing_map_return(&map, 0.01, z, 100, work, &count, NULL);
  }
  watching = false;
  assert_int_equal(allocations, before);
  assert_int_equal(hits, 1000);
  ric_grazing_map_clear(&map);
}

/* Whatever allocation fails, that is told, and nothing of the library's is left behind. */
enum { GSL_LEAVES_BEHIND = 64 }; /* the head of its workspace of eigenvalues, when there is none for the rest */

static void want_of_memory_is_told(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3), none;
  ric_grazing_window window;
  ric_grazing_cycle cycles[2];
  size_t count, kept = live, refused = 0;
  ric_status found = RIC_ENOMEM;
  for (size_t k = 1; found != RIC_OK; k++, refused++) {
    until_refusal = k;
    found = ric_grazing_window_find(&map, 4, &window, NULL);
    bool was_refused = until_refusal == 0;
    until_refusal = 0;
    assert_int_equal(found, was_refused ? RIC_ENOMEM : RIC_OK);
    assert_true(live <= kept + GSL_LEAVES_BEHIND);
    kept = live;
  }
  assert_true(refused > 10);
  until_refusal = 5;
  assert_int_equal(ric_grazing_cycles(&map, 4, 0.03, cycles, &count, NULL), RIC_ENOMEM);
  until_refusal = 7;
  assert_int_equal(ric_grazing_cycle_at(&map, 4, 0.2, cycles, NULL, NULL), RIC_ENOMEM);
  until_refusal = 1;
  assert_int_equal(ric_grazing_map_example(&none, 0.5, 0.3, NULL), RIC_ENOMEM);
  until_refusal = 0;
  ric_grazing_map_clear(&map);
}

#endif

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(example_is_that_of_the_source),
      cmocka_unit_test(map_is_continuous_at_the_border),
      cmocka_unit_test(derivative_is_that_of_central_differences),
      cmocka_unit_test(derivative_is_infinite_at_the_border_only_where_the_root_acts),
      cmocka_unit_test(not_a_number_goes_on),
      cmocka_unit_test(return_counts_iterates_without_impact),
      cmocka_unit_test(return_needs_an_impact_before_and_after),
      cmocka_unit_test(limit_map_takes_the_first_count_that_returns),
      cmocka_unit_test(map_tends_to_the_limit_map),
      cmocka_unit_test(fixed_points_of_the_limit_map_lose_stability_at_two_thirds),
      cmocka_unit_test(thresholds_of_the_limit_map_are_a_quarter_and_two_thirds),
      cmocka_unit_test(limit_map_knows_its_range),
      cmocka_unit_test(bad_maps_are_refused),
#ifdef ALLOCATIONS_ARE_COUNTED
      cmocka_unit_test(iterating_allocates_nothing),
      cmocka_unit_test(want_of_memory_is_told),
#endif
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
