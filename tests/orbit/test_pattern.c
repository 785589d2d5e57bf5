/* Patterns: what is refused, what is kept, and the text for messages. */
#include "support.h"

#include <ricochet/ricochet.h>

static void refuse(size_t n, const size_t *start, size_t starts, const size_t *half, size_t halves, const char *part) {
  ric_pattern *pattern = (ric_pattern *)&n; /* must be set to NULL */
  ric_error error = {0};
  assert_int_equal(ric_pattern_create(n, start, starts, half, halves, &pattern, &error), RIC_EINVAL);
  assert_null(pattern);
  assert_int_equal(error.status, RIC_EINVAL);
  if (!strstr(error.message, part))
    fail_msg("'%s' not in '%s'", part, error.message);
  assert_int_equal(ric_pattern_create(n, start, starts, half, halves, &pattern, NULL), RIC_EINVAL);
}

static void particles_out_of_range_are_refused_with_value_and_place(void **state) {
  (void)state;
  const size_t start[] = {0, 5, 2}, far[] = {SIZE_MAX};
  refuse(5, start, 3, NULL, 0, "start[1] = 5, expected a particle from 0 to 4");
  refuse(5, NULL, 0, start, 3, "half[1] = 5, expected a particle from 0 to 4");
  refuse(5, far, 1, NULL, 0, "start[0] = 18446744073709551615");
}

static void particles_given_twice_or_in_both_sets_are_refused_with_value_and_place(void **state) {
  (void)state;
  const size_t twice[] = {3, 1, 3}, one[] = {1}, both[] = {0, 1};
  refuse(5, twice, 3, NULL, 0, "start[2] = 3 is given twice");
  refuse(5, one, 1, twice, 3, "half[1] = 1 is in start, too");
  refuse(5, one, 1, both, 2, "half[1] = 1 is in start, too");
  refuse(5, NULL, 0, twice, 3, "half[2] = 3 is given twice");
}

static void patterns_without_impacts_or_with_too_many_are_refused(void **state) {
  (void)state;
  const size_t all[] = {0, 1, 2};
  refuse(5, NULL, 0, NULL, 0, "0 impacts at start and 0 at half");
  refuse(0, NULL, 0, NULL, 0, "particles = 0");
  refuse(2, all, 3, NULL, 0, "3 impacts at start");
  refuse(2, all, 2, all, 2, "start, too");
}

static void patterns_that_cannot_fit_are_refused(void **state) {
  (void)state;
  const size_t start[] = {0};
  ric_pattern *pattern;
  ric_error error;
  assert_int_equal(ric_pattern_create(SIZE_MAX / 2, start, 1, NULL, 0, &pattern, &error), RIC_ENOMEM);
  assert_null(pattern);
}

static void roles_and_impacts_are_kept_in_the_order_given(void **state) {
  (void)state;
  const size_t start[] = {4, 0}, half[] = {5, 2}, order[] = {4, 0, 5, 2};
  const ric_role roles[] = {RIC_ROLE_START, RIC_ROLE_FREE, RIC_ROLE_HALF, RIC_ROLE_FREE, RIC_ROLE_START, RIC_ROLE_HALF};
  ric_pattern *pattern;
  assert_int_equal(ric_pattern_create(6, start, 2, half, 2, &pattern, NULL), RIC_OK);
  assert_int_equal(ric_pattern_particles(pattern), 6);
  assert_int_equal(ric_pattern_impacts(pattern), 4);
  for (size_t i = 0; i < 6; i++)
    assert_int_equal(ric_pattern_role(pattern, i), roles[i]);
  for (size_t r = 0; r < 4; r++)
    assert_int_equal(ric_pattern_impact(pattern, r), order[r]);
  ric_pattern_destroy(&pattern);
  assert_null(pattern);
}

static void equality_is_of_roles_not_of_order(void **state) {
  (void)state;
  const size_t a[] = {1, 3}, b[] = {3, 1}, c[] = {1};
  ric_pattern *first, *second, *third, *exchanged, *longer;
  assert_int_equal(ric_pattern_create(5, a, 2, NULL, 0, &first, NULL), RIC_OK);
  assert_int_equal(ric_pattern_create(5, b, 2, NULL, 0, &second, NULL), RIC_OK);
  assert_int_equal(ric_pattern_create(5, c, 1, NULL, 0, &third, NULL), RIC_OK);
  assert_int_equal(ric_pattern_create(5, NULL, 0, a, 2, &exchanged, NULL), RIC_OK);
  assert_int_equal(ric_pattern_create(6, a, 2, NULL, 0, &longer, NULL), RIC_OK);
  assert_true(ric_pattern_equal(first, second));
  assert_false(ric_pattern_equal(first, third));
  assert_false(ric_pattern_equal(first, exchanged));
  assert_false(ric_pattern_equal(first, longer));
  ric_pattern *all[] = {first, second, third, exchanged, longer};
  for (size_t k = 0; k < 5; k++)
    ric_pattern_destroy(&all[k]);
}

static void text_lists_both_sets(void **state) {
  (void)state;
  const size_t one[] = {15}, half[] = {1}, many[] = {0, 3, 6, 9, 12, 15, 18, 21, 24, 27};
  const struct {
    const size_t *start;
    size_t starts;
    const size_t *half;
    size_t halves;
    const char *text;
  } cases[] = {{one, 1, NULL, 0, "start 15 of 30"},
               {NULL, 0, half, 1, "half 1 of 30"},
               {one, 1, half, 1, "start 15 half 1 of 30"},
               {many, 6, NULL, 0, "start 0 3 6 9 12 15 of 30"}};
  char text[128];
  ric_pattern *pattern;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    assert_int_equal(
        ric_pattern_create(30, cases[k].start, cases[k].starts, cases[k].half, cases[k].halves, &pattern, NULL),
        RIC_OK);
    assert_ptr_equal(ric_pattern_text(pattern, text, sizeof text), text);
    assert_string_equal(text, cases[k].text);
    ric_pattern_destroy(&pattern);
  }
}

/* The example of the header: first and last particles of a long list, and how many there are. */
static void text_of_a_long_list_ends_with_its_last_particle_and_their_number(void **state) {
  (void)state;
  const size_t many[] = {0, 3, 6, 9, 12, 15, 18, 21, 24, 27}, half[] = {1};
  char text[128];
  ric_pattern *pattern;
  assert_int_equal(ric_pattern_create(30, many, 10, half, 1, &pattern, NULL), RIC_OK);
  assert_string_equal(ric_pattern_text(pattern, text, sizeof text), "start 0 3 6 ... 27 (10) half 1 of 30");
  ric_pattern_destroy(&pattern);
}

static void text_is_cut_with_dots_and_never_overruns(void **state) {
  (void)state;
  const size_t many[] = {0, 3, 6, 9, 12, 15, 18, 21, 24, 27}, half[] = {1, 2};
  char text[128], whole[128];
  ric_pattern *pattern;
  assert_int_equal(ric_pattern_create(30, many, 10, half, 2, &pattern, NULL), RIC_OK);
  size_t length = strlen(ric_pattern_text(pattern, whole, sizeof whole));
  for (size_t size = 1; size < sizeof text; size++) {
    memset(text, '#', sizeof text);
    ric_pattern_text(pattern, text, size);
    assert_int_equal(text[size], '#');
    assert_true(strlen(text) < size);
    if (size > length)
      assert_string_equal(text, whole);
    else if (size > 3)
      assert_string_equal(text + strlen(text) - 3, "...");
  }
  ric_pattern_destroy(&pattern);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(particles_out_of_range_are_refused_with_value_and_place),
      cmocka_unit_test(particles_given_twice_or_in_both_sets_are_refused_with_value_and_place),
      cmocka_unit_test(patterns_without_impacts_or_with_too_many_are_refused),
      cmocka_unit_test(patterns_that_cannot_fit_are_refused),
      cmocka_unit_test(roles_and_impacts_are_kept_in_the_order_given),
      cmocka_unit_test(equality_is_of_roles_not_of_order),
      cmocka_unit_test(text_lists_both_sets),
      cmocka_unit_test(text_of_a_long_list_ends_with_its_last_particle_and_their_number),
      cmocka_unit_test(text_is_cut_with_dots_and_never_overruns),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
