/* Periods of attractors, found in iterates on them. */
#include "support.h"

#include "attractor/attractor.h"
#include "scenario/random_source.h"

enum { LIMIT = 64, STATES = 2 * LIMIT + 1, SIZE = 3 };

static const double tolerance = 1e-6;

typedef struct record {
  double z[STATES][SIZE];
} record;

/* Exact cycles of random states. */
static record cycle_of_period(random_source *source, size_t period) {
  record r;
  for (size_t k = 0; k < STATES; k++)
    for (size_t i = 0; i < SIZE; i++)
      r.z[k][i] = k < period ? random_uniform(source, -1, 1) : r.z[k - period][i];
  return r;
}

static size_t period_of(const record *r) {
  return period_find(r->z[0], SIZE, SIZE, LIMIT, tolerance, 1e-12);
}

/* Adds part * factor^k to a cycle, at some places of it more than at others. */
static void disturb(record *r, size_t period, double part, double factor) {
  for (size_t k = 0; k < STATES; k++)
    for (size_t i = 0; i < SIZE; i++)
      r->z[k][i] += part * pow(factor, (double)k) * (k % period == period / 2 ? 100 : 1);
}

static void exact_cycles_have_their_period(void **state) {
  (void)state;
  random_source source = {41};
  for (size_t p = 1; p <= LIMIT; p++) {
    record r = cycle_of_period(&source, p);
    assert_int_equal(period_of(&r), p);
  }
  record longer = cycle_of_period(&source, LIMIT + 1);
  assert_int_equal(period_of(&longer), 0);
}

static void rounding_hides_no_period(void **state) {
  (void)state;
  random_source source = {42};
  for (size_t p = 1; p <= LIMIT; p++) {
    record r = cycle_of_period(&source, p);
    for (size_t k = 0; k < STATES; k++)
      for (size_t i = 0; i < SIZE; i++)
        r.z[k][i] *= 1 + random_uniform(&source, -1e-14, 1e-14);
    assert_int_equal(period_of(&r), p);
  }
}

static void motions_that_come_to_a_cycle_have_its_period(void **state) {
  (void)state;
  random_source source = {43};
  for (size_t p = 2; p <= LIMIT; p++)
    for (int sign = -1; sign <= 1; sign += 2) {
      record r = cycle_of_period(&source, p);
      disturb(&r, p, 1e-9, sign * 0.999);
      assert_int_equal(period_of(&r), p);
    }
}

static void motions_that_leave_a_cycle_have_none(void **state) {
  (void)state;
  random_source source = {44};
  for (size_t p = 2; p <= LIMIT; p++) {
    record r = cycle_of_period(&source, p);
    disturb(&r, p, 1e-10, 1.02);
    assert_int_equal(period_of(&r), 0);
  }
}

/* On the way to a point, or away from it, nothing returns within a part of the way. */
static void points_have_period_1_when_motion_has_come_there(void **state) {
  (void)state;
  random_source source = {45};
  static const double parts[] = {1e-3, 1e-8, 1e-14}, factors[] = {0.99, 1.01, -0.99};
  for (size_t i = 0; i < 3; i++)
    for (size_t k = 0; k < 3; k++) {
      record r = cycle_of_period(&source, 1);
      for (size_t j = 0; j < STATES; j++)
        r.z[j][0] = 1;
      disturb(&r, 2, parts[i] / 100, factors[k]);
      assert_int_equal(period_of(&r), i == 2 ? 1 : 0);
    }
  record zero = {0};
  assert_int_equal(period_of(&zero), 1);
}

static void chaos_and_turning_have_none(void **state) {
  (void)state;
  random_source source = {46};
  for (size_t trial = 0; trial < 50; trial++) {
    record chaos, turning;
    double x = random_uniform(&source, 0.1, 0.9), angle = random_uniform(&source, 0.01, 1) * sqrt(2);
    for (size_t k = 0; k < STATES; k++) {
      x = 3.99 * x * (1 - x);
      for (size_t i = 0; i < SIZE; i++) {
        chaos.z[k][i] = pow(x, 1 + (double)i);
        turning.z[k][i] = cos(angle * (double)k + (double)i);
      }
    }
    assert_int_equal(period_of(&chaos), 0);
    assert_int_equal(period_of(&turning), 0);
  }
}

/* A cycle that is approached from alternating sides, slowly: after two of its periods the motion has returned before it
 * has after one. A cycle of twice the period that is approached so keeps its own. */
static void slow_alternation_does_not_double_the_period(void **state) {
  (void)state;
  random_source source = {49};
  for (size_t p = 1; p <= LIMIT / 2; p++) {
    const double factor = pow(0.995, 1 / (double)p); /* of a period */
    record single = cycle_of_period(&source, p), twice;
    for (size_t k = 0; k < STATES && p > 1; k++)
      for (size_t i = 0; i < SIZE && k % p < 2; i++)
        single.z[k][i] = k % p ? 1 : -1; /* the extent */
    twice = single;
    for (size_t k = 0; k < STATES; k++)
      for (size_t i = 0; i < SIZE; i++) {
        const double side = k / p % 2 ? -1 : 1, part = 1e-5 * pow(factor, (double)k);
        single.z[k][i] += side * part;
        twice.z[k][i] += side * (1 + part / 10);
      }
    assert_int_equal(period_of(&single), p > 1 ? p : 0); /* of a point, what is left is the whole extent */
    assert_int_equal(period_of(&twice), 2 * p);
  }
}

/* The first number has the period 2, the last 6 and is a million times as small. */
static void small_numbers_count(void **state) {
  (void)state;
  record r;
  for (size_t k = 0; k < STATES; k++) {
    r.z[k][0] = k % 2 ? 1e6 : -1e6;
    r.z[k][1] = 3;
    r.z[k][2] = (double)(k % 3);
  }
  assert_int_equal(period_of(&r), 6);
}

/* What dies out has no say in the end, however small its own extent is. */
static void what_has_died_out_does_not_count(void **state) {
  (void)state;
  random_source source = {47};
  record r = cycle_of_period(&source, 5);
  for (size_t k = 0; k < STATES; k++)
    r.z[k][2] = 1e-13 * pow(0.9, (double)k);
  assert_int_equal(period_of(&r), 5);
}

static void numbers_that_are_none_have_none(void **state) {
  (void)state;
  random_source source = {48};
  record r = cycle_of_period(&source, 3);
  r.z[77][1] = NAN;
  assert_int_equal(period_of(&r), 0);
  r.z[77][1] = INFINITY;
  assert_int_equal(period_of(&r), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact_cycles_have_their_period),
      cmocka_unit_test(slow_alternation_does_not_double_the_period),
      cmocka_unit_test(rounding_hides_no_period),
      cmocka_unit_test(motions_that_come_to_a_cycle_have_its_period),
      cmocka_unit_test(motions_that_leave_a_cycle_have_none),
      cmocka_unit_test(points_have_period_1_when_motion_has_come_there),
      cmocka_unit_test(chaos_and_turning_have_none),
      cmocka_unit_test(small_numbers_count),
      cmocka_unit_test(what_has_died_out_does_not_count),
      cmocka_unit_test(numbers_that_are_none_have_none),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
