/* One-impact orbits of the map beside grazing in closed form. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/grazing_maps.h"

enum { MOST_SIZE = 6 };

/* As a step of the map, but with an impact at the first iterate only; and the product of the derivatives. */
static void go_round(const ric_grazing_map *map, double d, size_t period, double *z, double *product) {
  size_t m = map->size;
  double next[MOST_SIZE], D[MOST_SIZE * MOST_SIZE], old[MOST_SIZE * MOST_SIZE];
  ric_grazing_map_derivative(map, d, z, product);
  ric_grazing_map_step(map, d, z, next);
  memcpy(z, next, m * sizeof *z);
  for (size_t k = 1; k < period; k++) {
    ric_grazing_map_step(map, -INFINITY, z, next);
    ric_grazing_map_derivative(map, -INFINITY, z, D);
    memcpy(z, next, m * sizeof *z);
    memcpy(old, product, sizeof old);
    for (size_t i = 0; i < m; i++)
      for (size_t j = 0; j < m; j++) {
        product[i * m + j] = 0;
        for (size_t l = 0; l < m; l++)
          product[i * m + j] += D[i * m + l] * old[l * m + j];
      }
  }
}

/* The smallest eta z_j - d after the impact, and whether the plain map comes back. */
static void check_clearance(const ric_grazing_map *map, const ric_grazing_cycle *c, const double *start, double size) {
  double z[MOST_SIZE], work[MOST_SIZE], least = INFINITY;
  memcpy(z, start, map->size * sizeof *z);
  map_iterate(map, c->d, z, 1, work);
  for (size_t j = 1; j < c->period; j++) {
    double clearance = -c->d;
    for (size_t i = 0; i < map->size; i++)
      clearance += map->eta[i] * z[i];
    least = fmin(least, clearance);
    if (j == c->nearest)
      assert_close(clearance, c->clearance, 1e-12 * size);
    map_iterate(map, -INFINITY, z, 1, work);
  }
  if (c->period > 1)
    assert_close(least, c->clearance, 1e-12 * size);
  assert_int_equal(c->admissible, c->clearance > 0);
  if (c->clearance > 1e-12 * size) {
    memcpy(z, start, map->size * sizeof *z);
    map_iterate(map, c->d, z, c->period, work);
    assert_close(relative_distance(z, start, map->size), 0, 1e-10);
  }
}

static void orbits_come_back_with_these_multipliers(void **state) {
  (void)state;
  random_source source = {11};
  size_t admissible = 0, complex_ones = 0;
  for (size_t k = 0; k < 1200; k++) {
    size_t size = 1 + k % MOST_SIZE, period = 1 + random_below(&source, 8);
    ric_grazing_map map = random_map(&source, size, random_uniform(&source, 0.3, 0.95));
    double y = exp(random_uniform(&source, -5, 2)), z[MOST_SIZE], back[MOST_SIZE], D[MOST_SIZE * MOST_SIZE];
    ric_grazing_cycle c = cycle_of(&map, period, y, z);
    ric_multipliers m;
    memcpy(back, z, sizeof z);
    go_round(&map, c.d, period, back, D);
    assert_close(relative_distance(back, z, size), 0, 1e-10);
    assert_int_equal(ric_multipliers_init(&m, size, NULL), RIC_OK);
    assert_int_equal(ric_multipliers_of_matrix(D, size, 0, NULL, &m, NULL), RIC_OK);
    assert_close(hypot(c.largest.re, c.largest.im), m.largest, 1e-10 * (m.largest + 1));
    assert_int_equal(c.stable, m.largest < 1);
    check_clearance(&map, &c, z, fabs(c.d) + y * y + 1);
    admissible += c.admissible;
    complex_ones += c.largest.im != 0;
    ric_multipliers_clear(&m);
    ric_grazing_map_clear(&map);
  }
  assert_true(admissible > 100 && complex_ones > 30);
}

static void orbits_at_one_d_have_that_d(void **state) {
  (void)state;
  random_source source = {12};
  size_t seen[3] = {0};
  for (size_t k = 0; k < 600; k++) {
    size_t period = 1 + random_below(&source, 6), count, known = 0;
    ric_grazing_map map = random_map(&source, 1 + k % MOST_SIZE, 0.8);
    double y = exp(random_uniform(&source, -5, 1)), d = cycle_of(&map, period, y, NULL).d;
    ric_grazing_cycle cycles[2];
    assert_int_equal(ric_grazing_cycles(&map, period, d, cycles, &count, NULL), RIC_OK);
    assert_in_range(count, 1, 2);
    for (size_t i = 0; i < count; i++) {
      double size = fabs(d) + cycles[i].y * cycles[i].y;
      assert_close(cycles[i].d, d, 0);
      assert_close(cycle_of(&map, period, cycles[i].y, NULL).d, d, 1e-13 * size);
      known += fabs(cycles[i].y - y) < 1e-9 * y;
    }
    assert_int_equal(known, 1);
    assert_true(count < 2 || cycles[0].y < cycles[1].y);
    seen[count]++;
    ric_grazing_map_clear(&map);
  }
  assert_true(seen[1] > 20 && seen[2] > 20);
}

/* d = 3/4 y^2 - y of a map of size 1 and period 1: no orbit below the fold d = -1/3, one there, two up to d = 0. */
static void orbits_meet_at_the_fold_and_leave_at_0(void **state) {
  (void)state;
  ric_grazing_map map = map_of_size_1(0.5, -0.5, -0.125);
  ric_grazing_cycle cycles[2];
  size_t count;
  static const double ds[] = {-0.4, -0.3, 0, 0.5};
  static const size_t expected[] = {0, 2, 1, 1};
  for (size_t i = 0; i < 4; i++) {
    assert_int_equal(ric_grazing_cycles(&map, 1, ds[i], cycles, &count, NULL), RIC_OK);
    assert_int_equal(count, expected[i]);
  }
  ric_grazing_map_clear(&map);
}

static void example_has_period_4_at_3_hundredths(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  double z[3] = {0, 0, 0}, back[3], work[3];
  ric_grazing_cycle cycles[2];
  size_t count;
  assert_int_equal(ric_grazing_cycles(&map, 4, 0.03, cycles, &count, NULL), RIC_OK);
  assert_int_equal(count, 1);
  assert_true(cycles[0].admissible && cycles[0].stable);
  map_iterate(&map, 0.03, z, 10000, work);
  memcpy(back, z, sizeof z);
  map_iterate(&map, 0.03, back, 4, work);
  assert_close(relative_distance(back, z, 3), 0, 1e-12);
  while (!ric_grazing_map_hits(&map, 0.03, z))
    map_iterate(&map, 0.03, z, 1, work);
  assert_close(sqrt(0.03 - z[0]), cycles[0].y, 1e-12);
  ric_grazing_map_clear(&map);
}

static void bad_arguments_are_refused(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  ric_grazing_cycle cycles[2];
  ric_error error;
  size_t count;
  assert_int_equal(ric_grazing_cycle_at(&map, 0, 1, cycles, NULL, &error), RIC_EINVAL);
  assert_string_equal(error.message, "period = 0, expected 1 to 10000");
  assert_int_equal(ric_grazing_cycle_at(&map, 10001, 1, cycles, NULL, &error), RIC_EINVAL);
  assert_int_equal(ric_grazing_cycle_at(&map, 4, 0, cycles, NULL, &error), RIC_EINVAL);
  assert_string_equal(error.message, "y = 0, expected a finite number > 0");
  assert_int_equal(ric_grazing_cycle_at(&map, 4, NAN, cycles, NULL, &error), RIC_EINVAL);
  assert_int_equal(ric_grazing_cycles(&map, 4, NAN, cycles, &count, &error), RIC_EINVAL);
  assert_string_equal(error.message, "d = nan, expected a finite number");
  assert_int_equal(ric_grazing_cycles(&map, 0, 1, cycles, &count, &error), RIC_EINVAL);
  ric_grazing_map_clear(&map);
}

static void singular_and_overflowing_maps_are_told(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 1); /* L^4 has the eigenvalue 1 */
  ric_grazing_cycle cycle;
  ric_error error;
  assert_int_equal(ric_grazing_cycle_at(&map, 4, 1, &cycle, NULL, &error), RIC_ENUMERIC);
  assert_string_equal(error.message, "period = 4: I - L^n is singular");
  assert_int_equal(ric_grazing_cycle_at(&map, 2, 1, &cycle, NULL, &error), RIC_OK);
  assert_int_equal(ric_grazing_cycle_at(&map, 2, 1e200, &cycle, NULL, &error), RIC_ENUMERIC);
  assert_string_equal(error.message, "y = 1e+200: d overflows");
  assert_int_equal(ric_grazing_cycle_at(&map, 2, 1e-310, &cycle, NULL, &error), RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "the derivative of iterate 2 overflows"));
  ric_grazing_map_clear(&map);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(orbits_come_back_with_these_multipliers),
      cmocka_unit_test(orbits_at_one_d_have_that_d),
      cmocka_unit_test(orbits_meet_at_the_fold_and_leave_at_0),
      cmocka_unit_test(example_has_period_4_at_3_hundredths),
      cmocka_unit_test(bad_arguments_are_refused),
      cmocka_unit_test(singular_and_overflowing_maps_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
