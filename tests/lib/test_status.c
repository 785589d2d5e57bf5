#include "support.h"

#include <ricochet/ricochet.h>

static void every_status_has_a_sentence(void **state) {
  (void)state;
  for (int k = RIC_OK; k <= RIC_ESTOPPED; k++)
    assert_true(strlen(ric_status_text((ric_status)k)) > 0);
  assert_non_null(ric_status_text((ric_status)99));
}

static void failing_fills_the_error_and_returns_the_status(void **state) {
  (void)state;
  ric_error error = {0};
  assert_int_equal(ric_fail(&error, RIC_EINVAL, "gamma = %g, expected %s", -0.5, "gamma >= 0"), RIC_EINVAL);
  assert_int_equal(error.status, RIC_EINVAL);
  assert_string_equal(error.message, "gamma = -0.5, expected gamma >= 0");
}

static void failing_without_an_error_object_is_allowed(void **state) {
  (void)state;
  assert_int_equal(ric_fail(NULL, RIC_ENOMEM, "%d", 1), RIC_ENOMEM);
}

static void long_messages_are_cut(void **state) {
  (void)state;
  ric_error error;
  char text[1000];
  memset(text, 'x', sizeof text - 1);
  text[sizeof text - 1] = '\0';
  ric_fail(&error, RIC_EINVAL, "%s", text);
  assert_int_equal(strlen(error.message), sizeof error.message - 1);
}

static void version_is_that_of_the_headers(void **state) {
  (void)state;
  assert_string_equal(ric_version(), RIC_VERSION);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_status_has_a_sentence),
      cmocka_unit_test(failing_fills_the_error_and_returns_the_status),
      cmocka_unit_test(failing_without_an_error_object_is_allowed),
      cmocka_unit_test(long_messages_are_cut),
      cmocka_unit_test(version_is_that_of_the_headers),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
