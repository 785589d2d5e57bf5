#include "study_cases.h"

static void given_values_are_read_with_their_types(void **state) {
  (void)state;
  study *s = parsed(base_study, NULL, 0);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  assert_string_equal(value_word(v, KEY_KIND), "orbits");
  assert_string_equal(value_word(v, KEY_TITLE), "one particle");
  assert_true(value_number(v, KEY_MODEL_PARTICLES, 0) == 30);
  assert_true(value_number(v, KEY_ORBIT_PERIOD, 0) == 1.5 * 3.14159265358979323846);
  assert_true(value_is_list(v, KEY_ORBIT_AT_START));
  assert_int_equal(value_count(v, KEY_ORBIT_AT_START), 2);
  assert_true(value_number(v, KEY_ORBIT_AT_START, 1) == 3);
  assert_true(value_flag(v, KEY_ORBIT_STATES));
  assert_false(value_flag(v, KEY_ORBIT_SPECIAL_POINTS));
  assert_string_equal(study_name(s), "s.yaml");
  study_values_destroy(&v);
  assert_null(v);
  study_values_destroy(&v);
  study_destroy(&s);
  study_destroy(&s);
}

static void omitted_values_have_their_defaults(void **state) {
  (void)state;
  const char text[] = "kind: orbits\nmodel: {type: chain, particles: 1e6, gamma: 0.1}\n"
                      "orbit: {period: pi, at_start: [1]}\n";
  study *s = parsed(text, NULL, 0);
  study_values *v = study_values_create(s);
  assert_string_equal(value_word(v, KEY_TITLE), "");
  assert_false(value_present(v, KEY_TITLE));
  assert_int_equal(value_count(v, KEY_TITLE), 0);
  assert_string_equal(value_word(v, KEY_MODEL_ENDS), "periodic");
  assert_true(value_present(v, KEY_MODEL_ENDS));
  assert_false(value_is_list(v, KEY_MODEL_FLOOR));
  assert_int_equal(value_count(v, KEY_MODEL_FLOOR), 1);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 0) == -1);
  assert_true(value_number(v, KEY_MODEL_RESTITUTION, 0) == 1);
  assert_true(value_number(v, KEY_MODEL_PARTICLES, 0) == 1e6);
  assert_int_equal(value_count(v, KEY_ORBIT_AT_HALF), 0);
  assert_string_equal(value_word(v, KEY_ORBIT_METHOD), "impulse");
  assert_true(value_flag(v, KEY_ORBIT_STATES));
  assert_false(value_flag(v, KEY_ORBIT_MULTIPLIERS));
  assert_int_equal(study_tasks(s), 1);
  assert_int_equal(study_sweeps(s), 0);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void null_floors_are_minus_infinity(void **state) {
  (void)state;
  const char text[] = "kind: orbits\nmodel: {type: chain, particles: 4, gamma: 0.1, floor: [null, ~, -2, ]}\n"
                      "orbit: {period: pi, at_start: [2]}\n";
  study *s = NULL;
  message why;
  assert_int_equal(read_study("s.yaml", text, strlen(text), NULL, 0, &s, &why), EXIT_USAGE); /* three elements */
  const char *set = "model.particles=3";
  s = parsed(text, &set, 1);
  study_values *v = study_values_create(s);
  assert_int_equal(value_count(v, KEY_MODEL_FLOOR), 3);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 0) == -INFINITY);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 1) == -INFINITY);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 2) == -2);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void places_name_the_line_or_the_file(void **state) {
  (void)state;
  study *s = parsed(base_study, NULL, 0);
  char place[128];
  assert_int_equal(study_line(s, KEY_MODEL_GAMMA), 7);
  study_place(s, KEY_MODEL_GAMMA, place, sizeof place);
  assert_string_equal(place, "s.yaml:7: model.gamma");
  assert_int_equal(study_line(s, KEY_ORBIT_VERIFY), 0);
  study_place(s, KEY_ORBIT_VERIFY, place, sizeof place);
  assert_string_equal(place, "s.yaml: orbit.verify");
  study_destroy(&s);
}

static void a_byte_order_mark_is_accepted(void **state) {
  (void)state;
  study *s = parsed_variation("kind: orbits", "\xef\xbb\xbfkind: orbits");
  study_destroy(&s);
  s = parsed_variation("kind: orbits", "%YAML 1.1\n---\nkind: \"orbits\"");
  study_destroy(&s);
}

static void windows_line_ends_are_accepted(void **state) {
  (void)state;
  char text[2 * sizeof base_study];
  size_t length = 0;
  for (const char *c = base_study; *c; c++) {
    if (*c == '\n')
      text[length++] = '\r';
    text[length++] = *c;
  }
  text[length] = 0;
  study *s = parsed(text, NULL, 0);
  assert_int_equal(study_line(s, KEY_MODEL_GAMMA), 7);
  study_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(given_values_are_read_with_their_types), cmocka_unit_test(omitted_values_have_their_defaults),
      cmocka_unit_test(null_floors_are_minus_infinity),         cmocka_unit_test(places_name_the_line_or_the_file),
      cmocka_unit_test(a_byte_order_mark_is_accepted),          cmocka_unit_test(windows_line_ends_are_accepted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
