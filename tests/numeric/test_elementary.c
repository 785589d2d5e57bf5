/* Elementary functions: their accuracy, against libm's in long double, and their special values. */
#include "support.h"

#include <float.h>
#include <ricochet/elementary.h>

#include "numeric/complex_number.h"
#include "scenario/random_source.h"

enum { SAMPLES = 20000 };

typedef struct function {
  const char *name;
  double (*ours)(double x);
  long double (*exact)(long double x);
  double low, high;
} function;

static const function functions[] = {
    {"sin", ric_sin, sinl, -1e4, 1e4},  {"cos", ric_cos, cosl, -1e4, 1e4},    {"tan", ric_tan, tanl, -1e4, 1e4},
    {"asin", ric_asin, asinl, -1, 1},   {"sinh", ric_sinh, sinhl, -40, 40},   {"cosh", ric_cosh, coshl, -40, 40},
    {"exp", ric_exp, expl, -700, 700},  {"exp2", ric_exp2, exp2l, -1e3, 1e3}, {"log", ric_log, logl, 0, 10},
    {"log2", ric_log2, log2l, 0, 1e10}, {"cbrt", ric_cbrt, cbrtl, -1e3, 1e3},
};

/* Distance in units of the last place of the exact value. */
static double ulps(double value, long double exact) {
  const double size = fabs((double)exact);
  return (double)(fabsl((long double)value - exact) / (long double)(nextafter(size, INFINITY) - size));
}

static void functions_are_off_by_one_unit_at_most(void **state) {
  (void)state;
  random_source random = {1};
  for (size_t f = 0; f < sizeof functions / sizeof *functions; f++) {
    double worst = 0;
    for (int i = 0; i < SAMPLES; i++) {
      const double x = random_uniform(&random, functions[f].low, functions[f].high);
      worst = fmax(worst, ulps(functions[f].ours(x), functions[f].exact(x)));
    }
    printf("%s: %.3f units\n", functions[f].name, worst);
    assert_true(worst < 1.001);
  }
}

static void functions_of_two_numbers_are_off_by_one_unit_at_most(void **state) {
  (void)state;
  random_source random = {2};
  double worst = 0, worst_length = 0;
  for (int i = 0; i < SAMPLES; i++) {
    const double x = random_uniform(&random, -10, 10), y = random_uniform(&random, -10, 10);
    const double far_x = x * 1e-200, far_y = y * 1e-200; /* their squares are no numbers any more */
    double sine, cosine;
    ric_sincos(x, &sine, &cosine);
    worst = fmax(worst, fmax(ulps(sine, sinl(x)), ulps(cosine, cosl(x))));
    worst = fmax(worst, ulps(ric_pow(fabs(x), y), powl(fabsl((long double)x), y)));
    worst = fmax(worst, ulps(ric_atan2(y, x), atan2l(y, x)));
    worst_length = fmax(worst_length, ulps(ric_hypot(x, y), hypotl(x, y)));
    worst_length = fmax(worst_length, ulps(ric_hypot(far_x, far_y), hypotl(far_x, far_y)));
  }
  printf("%.3f units, lengths %.3f\n", worst, worst_length);
  assert_true(worst < 1.001 && worst_length < 1.5);
}

static void special_values_are_those_of_the_standard(void **state) {
  (void)state;
  assert_true(ric_cos(0) == 1 && ric_sin(0) == 0 && signbit(ric_sin(-0.0)) && ric_exp(0) == 1 && ric_log(1) == 0);
  assert_true(ric_exp(-INFINITY) == 0 && ric_exp(710) == INFINITY && ric_log(0) == -INFINITY && isnan(ric_log(-1)));
  assert_true(ric_exp2(-3) == 0.125 && ric_log2(8) == 3 && ric_cbrt(27) == 3 && ric_pow(2, 10) == 1024);
  assert_true(ric_pow(0, 0) == 1 && ric_pow(-2, 3) == -8 && isnan(ric_pow(-2, 0.5)) && ric_pow(0, -1) == INFINITY);
  assert_true(isnan(ric_sin(INFINITY)) && isnan(ric_cos(NAN)) && isnan(ric_asin(1.5)) && isnan(ric_pow(NAN, 2)));
  assert_true(ric_hypot(3e300, 4e300) == 5e300 && ric_hypot(0, 0) == 0 && ric_hypot(-INFINITY, NAN) == INFINITY);
  assert_true(ric_atan2(0, 1) == 0 && ric_atan2(0, -1) == acos(-1) && signbit(ric_atan2(-0.0, 1)));
}

/* Off by a few units of the modulus. */
static void expect_complex(double complex value, double complex exact) {
  assert_close(creal(value), creal(exact), 4 * DBL_EPSILON * cabs(exact));
  assert_close(cimag(value), cimag(exact), 4 * DBL_EPSILON * cabs(exact));
}

static void complex_functions_agree_with_those_of_the_standard(void **state) {
  (void)state;
  random_source random = {3};
  for (int i = 0; i < SAMPLES; i++) {
    const double complex z = CMPLX(random_uniform(&random, -5, 5), random_uniform(&random, -5, 5));
    double complex sinh, cosh;
    complex_sinh_cosh(z, &sinh, &cosh);
    expect_complex(sinh, csinh(z));
    expect_complex(cosh, ccosh(z));
    expect_complex(complex_exp(z), cexp(z));
    expect_complex(complex_sqrt(z), csqrt(z));
    assert_close(complex_modulus(z), cabs(z), 2 * DBL_EPSILON * cabs(z));
  }
  const double complex cut[] = {CMPLX(-4, 0.0), CMPLX(-4, -0.0), CMPLX(0, 0),
                                CMPLX(9, 0),    CMPLX(0, 2),     CMPLX(1e300, 1)};
  for (size_t i = 0; i < sizeof cut / sizeof *cut; i++)
    expect_complex(complex_sqrt(cut[i]), csqrt(cut[i]));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(functions_are_off_by_one_unit_at_most),
      cmocka_unit_test(functions_of_two_numbers_are_off_by_one_unit_at_most),
      cmocka_unit_test(special_values_are_those_of_the_standard),
      cmocka_unit_test(complex_functions_agree_with_those_of_the_standard),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
