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

/* What study_each says of some keys. */
typedef struct seen_entries {
  study_entry gamma, floor, half, states, title;
  double gamma_value, floors[3];
  size_t foreign; /* keys of another kind or type of model */
} seen_entries;

static int see_entry(void *user, const study_entry *e, message *why) {
  seen_entries *seen = user;
  study_entry *const kept[] = {&seen->gamma, &seen->floor, &seen->half, &seen->states, &seen->title};
  const study_key keys[] = {KEY_MODEL_GAMMA, KEY_MODEL_FLOOR, KEY_ORBIT_AT_HALF, KEY_ORBIT_STATES, KEY_TITLE};
  (void)why;
  for (size_t i = 0; i < 5; i++)
    if (e->key == keys[i])
      *kept[i] = *e;
  if (e->key == KEY_MODEL_GAMMA)
    seen->gamma_value = e->numbers[0];
  if (e->key == KEY_MODEL_FLOOR)
    memcpy(seen->floors, e->numbers, sizeof seen->floors);
  seen->foreign += e->key == KEY_MODEL_D || e->key == KEY_BRANCH_FROM;
  return 0;
}

static int stop_at_third(void *user, const study_entry *e, message *why) {
  (void)e;
  return ++*(int *)user == 3 ? refuse(why, EXIT_FILES, "stop") : 0;
}

static void every_value_is_called_for_with_swept_ones_at_the_first_task(void **state) {
  (void)state;
  const char text[] = "kind: orbits\nmodel: {type: chain, particles: 3, gamma: 0.5, floor: [null, -2, -3]}\n"
                      "orbit: {period: pi, at_start: [1]}\n"
                      "sweep:\n- {parameter: model.gamma, values: [0.25, 0.125]}\n"
                      "- {parameter: 'model.floor[2]', values: [-7, -8]}\n"
                      "- {parameter: 'model.floor[1]', values: [-5]}\n";
  study *s = parsed(text, NULL, 0);
  seen_entries seen = {0};
  message why = {{0}};
  int calls = 0;
  assert_int_equal(study_each(s, see_entry, &seen, &why), 0);
  assert_true(seen.gamma.given && !seen.gamma.list && seen.gamma_value == 0.25);
  assert_true(seen.floor.given && seen.floor.list && seen.floor.count == 3);
  assert_true(seen.floors[0] == -INFINITY && seen.floors[1] == -5 && seen.floors[2] == -7);
  assert_true(!seen.half.given && seen.half.list && seen.half.count == 0);
  assert_true(!seen.states.given && seen.states.numbers[0] == 1);
  assert_true(!seen.title.given && !seen.title.numbers);
  assert_string_equal(seen.title.text, "");
  assert_int_equal(seen.foreign, 0);
  assert_int_equal(study_each(s, stop_at_third, &calls, &why), EXIT_FILES);
  assert_int_equal(calls, 3);
  study_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(given_values_are_read_with_their_types),
      cmocka_unit_test(omitted_values_have_their_defaults),
      cmocka_unit_test(null_floors_are_minus_infinity),
      cmocka_unit_test(places_name_the_line_or_the_file),
      cmocka_unit_test(a_byte_order_mark_is_accepted),
      cmocka_unit_test(windows_line_ends_are_accepted),
      cmocka_unit_test(every_value_is_called_for_with_swept_ones_at_the_first_task),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
