/* Segments as such: state, gap and bounds of a polynomial per coordinate. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "scenario/random_source.h"

enum { DEGREE = 5, COORDINATES = 3, STRIDE = 4 };

/* Coefficients with a column of padding that nothing may look at. */
static ric_segment random_segment(random_source *source, double *coef) {
  for (size_t e = 0; e < (DEGREE + 1) * STRIDE; e++)
    coef[e] = e % STRIDE < COORDINATES ? random_uniform(source, -1, 1) : NAN;
  return (ric_segment){.coordinates = COORDINATES,
                       .stride = STRIDE,
                       .degree = DEGREE,
                       .start = 3,
                       .length = random_uniform(source, -2, 2),
                       .coef = coef};
}

static void state_is_the_polynomial_and_its_time_derivative(void **state) {
  (void)state;
  random_source source = {.state = 11};
  for (int k = 0; k < 50; k++) {
    double coef[(DEGREE + 1) * STRIDE], q[COORDINATES], v[COORDINATES], x = random_uniform(&source, 0, 1);
    ric_segment s = random_segment(&source, coef);
    ric_segment_state(&s, x, q, v);
    for (size_t i = 0; i < COORDINATES; i++) {
      double place = 0, speed = 0;
      for (int j = 0; j <= DEGREE; j++) {
        place += coef[(size_t)j * STRIDE + i] * pow(x, j);
        speed += j > 0 ? j * coef[(size_t)j * STRIDE + i] * pow(x, j - 1) : 0;
      }
      assert_close(q[i], place, 1e-14);
      assert_close(v[i], speed / s.length, 1e-13 / fabs(s.length));
    }
    double alone[COORDINATES];
    ric_segment_state(&s, x, alone, NULL);
    assert_memory_equal(alone, q, sizeof q);
  }
}

/* Speeds that are no derivatives have polynomials of their own, after those of the coordinates. */
static void speeds_of_their_own_are_read_from_their_polynomials(void **state) {
  (void)state;
  random_source source = {.state = 14};
  double coef[(DEGREE + 1) * STRIDE], q[COORDINATES], all[COORDINATES], u[1];
  ric_segment s = random_segment(&source, coef);
  ric_segment_state(&s, 0.7, all, NULL);
  s.coordinates = COORDINATES - 1;
  s.speeds = 1;
  ric_segment_state(&s, 0.7, q, u);
  assert_true(q[0] == all[0] && q[1] == all[1] && u[0] == all[2]);
}

static void gap_is_the_coordinate_above_its_floor(void **state) {
  (void)state;
  random_source source = {.state = 12};
  double coef[(DEGREE + 1) * STRIDE], c[DEGREE + 1], q[COORDINATES];
  ric_segment s = random_segment(&source, coef);
  ric_segment_state(&s, 0.3, q, NULL);
  for (size_t i = 0; i < COORDINATES; i++) {
    ric_segment_gap(&s, i, -0.6, c);
    assert_close(ric_poly_value(c, DEGREE, 0.3, NULL), q[i] + 0.6, 1e-15);
  }
}

static void bounds_are_those_of_the_polynomials(void **state) {
  (void)state;
  random_source source = {.state = 13};
  double coef[(DEGREE + 1) * STRIDE], c[DEGREE + 1], lower[COORDINATES], upper[COORDINATES];
  ric_segment s = random_segment(&source, coef);
  ric_segment_bounds(&s, lower, upper);
  for (size_t i = 0; i < COORDINATES; i++) {
    ric_segment_gap(&s, i, 0, c);
    assert_close(lower[i], ric_poly_lower_bound(c, DEGREE), 1e-15);
    for (int j = 0; j <= DEGREE; j++)
      c[j] = -c[j];
    assert_close(upper[i], -ric_poly_lower_bound(c, DEGREE), 1e-15);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(state_is_the_polynomial_and_its_time_derivative),
      cmocka_unit_test(speeds_of_their_own_are_read_from_their_polynomials),
      cmocka_unit_test(gap_is_the_coordinate_above_its_floor),
      cmocka_unit_test(bounds_are_those_of_the_polynomials),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
