#include "support.h"

#include "study/number.h"

static const double pi = 3.14159265358979323846;

static number_status read_text(const char *text, double *value) {
  return number_read(text, strlen(text), value);
}

static void decimal_numbers_read_as_the_nearest_double(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double value;
  } cases[] = {{"0", 0},
               {"1", 1},
               {"-1", -1},
               {"+2", 2},
               {"0.1", 0.1},
               {".5", 0.5},
               {"5.", 5},
               {"1e6", 1e6},
               {"1E-3", 1e-3},
               {"-2.5e+2", -250},
               {"007", 7},
               {"1e-400", 0},
               {"4.9e-324", 4.9e-324},
               {"1.7976931348623157e308", 1.7976931348623157e308},
               {"0.1000000000000000055511151231257827", 0.1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double value = 99;
    assert_int_equal(read_text(cases[i].text, &value), NUMBER_OK);
    assert_true(value == cases[i].value);
  }
}

static void multiples_of_pi_are_the_coefficient_times_pi(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double factor;
  } cases[] = {{"pi", 1},     {"-pi", -1},       {"+pi", 1},     {"1.5 pi", 1.5}, {"-0.25 pi", -0.25},
               {"2   pi", 2}, {"1e-3 pi", 1e-3}, {".5 pi", 0.5}, {"0 pi", 0}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double value = 99;
    assert_int_equal(read_text(cases[i].text, &value), NUMBER_OK);
    assert_true(value == cases[i].factor * pi);
  }
}

static void anything_else_is_malformed_and_leaves_the_value(void **state) {
  (void)state;
  static const char *const cases[] = {
      "",      " ",    "-",     "+",    ".",     "e5",     "1e",      "1e+",      "0.1x",    "1 2",   "1,5",
      "1_000", "0x10", "0x1p3", "inf",  "-inf",  ".inf",   "nan",     ".nan",     "NaN",     "1.2.3", "--1",
      "+-1",   "1-",   " 1",    "1 ",   "1.5pi", "1.5*pi", "1.5 pi ", "1.5 pix",  "1.5 PI",  " pi",   "- pi",
      "pi pi", "pi 2", "pi/2",  "1 e5", "1e5.5", "1\tpi",  "1:30",    "infinity", "1.5 pi2", "0o17",  "e pi"};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double value = 99;
    if (read_text(cases[i], &value) != NUMBER_MALFORMED)
      fail_msg("'%s' was read as %g", cases[i], value);
    assert_true(value == 99);
  }
}

static void numbers_beyond_a_double_are_too_large(void **state) {
  (void)state;
  double value = 99;
  assert_int_equal(read_text("1e400", &value), NUMBER_TOO_LARGE);
  assert_int_equal(read_text("-1e309", &value), NUMBER_TOO_LARGE);
  assert_int_equal(read_text("1e308 pi", &value), NUMBER_TOO_LARGE);
  assert_true(value == 99);
}

static void text_behind_a_nul_is_not_ignored(void **state) {
  (void)state;
  double value = 99;
  assert_int_equal(number_read("1\0x", 3, &value), NUMBER_MALFORMED);
  assert_int_equal(number_read("1 p\0", 4, &value), NUMBER_MALFORMED);
}

static void shown_numbers_read_back_as_the_same_double(void **state) {
  (void)state;
  static const double cases[] = {0, 0.1, 0.3, 1.0 / 3, 1e300, -2.5, 4.69756390941, 0.1 + 0.2, 5e-324};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[32];
    double value = 99;
    number_show(cases[i], text, sizeof text);
    assert_int_equal(read_text(text, &value), NUMBER_OK);
    assert_true(value == cases[i]);
  }
  char text[32];
  number_show(0.1, text, sizeof text);
  assert_string_equal(text, "0.1");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(decimal_numbers_read_as_the_nearest_double),
      cmocka_unit_test(multiples_of_pi_are_the_coefficient_times_pi),
      cmocka_unit_test(anything_else_is_malformed_and_leaves_the_value),
      cmocka_unit_test(numbers_beyond_a_double_are_too_large),
      cmocka_unit_test(text_behind_a_nul_is_not_ignored),
      cmocka_unit_test(shown_numbers_read_back_as_the_same_double),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
