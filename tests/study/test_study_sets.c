#include "study_cases.h"

static study *with_sets(const char *text, size_t count, const char *const *sets) {
  return parsed(text, sets, count);
}

static study *with_set(const char *set) {
  return with_sets(base_study, 1, &set);
}

static double number_of(const study *s, study_key key, size_t i) {
  study_values *v = study_values_create(s);
  assert_non_null(v);
  const double value = value_number(v, key, i);
  study_values_destroy(&v);
  return value;
}

static void set_replaces_a_value_of_the_file(void **state) {
  (void)state;
  study *s = with_set("orbit.period=0.5 pi");
  assert_true(number_of(s, KEY_ORBIT_PERIOD, 0) == 0.5 * 3.14159265358979323846);
  assert_int_equal(study_line(s, KEY_ORBIT_PERIOD), 0);
  char place[128];
  study_place(s, KEY_ORBIT_PERIOD, place, sizeof place);
  assert_string_equal(place, "--set orbit.period=0.5 pi: orbit.period");
  study_destroy(&s);
}

static void set_creates_missing_keys_and_sections(void **state) {
  (void)state;
  const char *const sets[] = {"model.type=chain", "model.particles=3", "model.gamma=0.1", "orbit.period=2",
                              "orbit.at_start=[1, 2]"};
  study *s = with_sets("kind: orbits\norbit:\n", 5, sets);
  assert_true(number_of(s, KEY_MODEL_PARTICLES, 0) == 3);
  assert_true(number_of(s, KEY_ORBIT_AT_START, 1) == 2);
  study_destroy(&s);
}

static void set_reaches_into_lists(void **state) {
  (void)state;
  const char *const sets[] = {"sweep[0].points=5", "orbit.at_start[1]=7"};
  study *s = with_sets(base_study, 2, sets);
  assert_int_equal(study_tasks(s), 5);
  assert_true(number_of(s, KEY_ORBIT_AT_START, 0) == 15);
  assert_true(number_of(s, KEY_ORBIT_AT_START, 1) == 7);
  study_destroy(&s);
}

static void set_takes_whole_lists_and_sections(void **state) {
  (void)state;
  const char *const sets[] = {"sweep={parameter: orbit.period, values: [1, 2]}", "orbit.at_half=[]",
                              "title=a: b is one mapping", "title='a: b'"};
  study *s = NULL;
  message why;
  assert_int_not_equal(read_study("s.yaml", base_study, strlen(base_study), sets, 3, &s, &why), 0);
  s = with_sets(base_study, 4, sets);
  assert_int_equal(study_tasks(s), 2);
  study_destroy(&s);
}

static void the_last_set_of_a_path_wins(void **state) {
  (void)state;
  const char *const sets[] = {"model.floor=-2", "model.floor=null", "model.floor=-3"};
  study *s = with_sets(base_study, 3, sets);
  assert_true(number_of(s, KEY_MODEL_FLOOR, 0) == -3);
  study_destroy(&s);
}

static void refused_sets_begin_with_themselves(void **state) {
  (void)state;
  static const struct {
    const char *set, *place, *phrase, *other;
  } cases[] = {
      {"model.gama=0.1", "--set model.gama=0.1: ", "unknown key 'gama' in model; did you mean 'gamma'?", ""},
      {"modle.gamma=0.1", "--set modle.gamma=0.1: ", "unknown key 'modle'; did you mean 'model'?", ""},
      {"model.gamma=0.1x", "--set model.gamma=0.1x: ", "model.gamma = 0.1x is not a number", "a number >= 0"},
      {"model.gamma=-1", "--set model.gamma=-1: ", "model.gamma = -1 is out of range", "a number >= 0"},
      {"model.gamma='1'", "--set model.gamma='1': ", "a quoted string", "a number >= 0"},
      {"model.gamma", "--set model.gamma: ", "no '='", "path=value"},
      {"=3", "--set =3: ", "no path", "path=value"},
      {"model.gamma=", "--set model.gamma=: ", "no value", ""},
      {"model.gamma=  ", "--set model.gamma=  : ", "no value", ""},
      {"model..gamma=1", "--set model..gamma=1: ", "malformed path", "model.gamma"},
      {".model=1", "--set .model=1: ", "malformed path", ""},
      {"model.=1", "--set model.=1: ", "malformed path", ""},
      {"[0]=1", "--set [0]=1: ", "malformed path", ""},
      {"sweep[]=1", "--set sweep[]=1: ", "malformed path", ""},
      {"sweep[-1]=1", "--set sweep[-1]=1: ", "malformed path", ""},
      {"sweep[0=1", "--set sweep[0=1: ", "malformed path", ""},
      {"sweep[0]points=1", "--set sweep[0]points=1: ", "malformed path", ""},
      {"sweep[99999999999]=1", "--set sweep[99999999999]=1: ", "malformed path", ""},
      {"model gamma=1", "--set model gamma=1: ", "malformed path", ""},
      {"sweep[1].points=5", "--set sweep[1].points=5: ", "sweep has no element 1", "it has 1"},
      {"model[0]=5", "--set model[0]=5: ", "model is a mapping, expected a list", ""},
      {"orbit.verify[0]=5", "--set orbit.verify[0]=5: ", "orbit.verify is not given, expected a list", ""},
      {"model.gamma.x=5", "--set model.gamma.x=5: ", "model.gamma is 0.1, expected a mapping", "'x'"},
      {"model.gamma=[1", "--set model.gamma=[1: ", "not YAML", ""},
      {"model.gamma=#1", "--set model.gamma=#1: ", "empty", ""},
      {"model.gamma=&a 1", "--set model.gamma=&a 1: ", "anchor &a", ""},
      {"model.gamma=*a", "--set model.gamma=*a: ", "alias *a", ""},
      {"model.gamma=!!int 1", "--set model.gamma=!!int 1: ", "tag ", ""},
      {"model={type: chain, type: chain}", "--set model={type: chain, type: chain}: ", "duplicate key 'type'", ""},
      {"model={type: chain, x: 1}", "--set model={type: chain, x: 1}: ", "unknown key 'x' in model", ""},
      {"sweep[0].parameter=model.gama", "--set sweep[0].parameter=model.gama: ", "did you mean 'model.gamma'?", ""},
      {"sweep[0].points=0", "--set sweep[0].points=0: ", "sweep[0].points = 0 is out of range", "from 1 to"},
      {"orbit.at_start[0]=30", "--set orbit.at_start[0]=30: ", "orbit.at_start[0] = 30 is out of range", "0 to 29"},
      {"start.q=[1]", "--set start.q=[1]: ",
       "start.q is a key of kind: trajectory or branch or grazing or diagram or basin, and this is kind: orbits", ""},
      {"kind=atlas", "--set kind=atlas: ", "kind = atlas is not in this version", ""},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_refused(base_study, strlen(base_study), &cases[i].set, 1, cases[i].place, cases[i].phrase, cases[i].other);
}

static void lines_of_the_file_still_count_beside_sets(void **state) {
  (void)state;
  const char *set = "orbit.period=2";
  char *text = varied("gamma: 0.1", "gamma: x");
  assert_refused(text, strlen(text), &set, 1, "s.yaml:7: ", "model.gamma = x", "");
  free(text);
}

static void very_long_sets_have_a_short_place(void **state) {
  (void)state;
  enum { COUNT = 3000 };
  char *set = malloc(COUNT + 32);
  assert_non_null(set);
  strcpy(set, "model.gamma=");
  memset(set + 12, '1', COUNT);
  strcpy(set + 12 + COUNT, "x");
  const char *sets[] = {set};
  assert_refused(base_study, strlen(base_study), sets, 1, "--set model.gamma=1111", "...: model.gamma = 111",
                 "a number >= 0");
  free(set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(set_replaces_a_value_of_the_file),
      cmocka_unit_test(set_creates_missing_keys_and_sections),
      cmocka_unit_test(set_reaches_into_lists),
      cmocka_unit_test(set_takes_whole_lists_and_sections),
      cmocka_unit_test(the_last_set_of_a_path_wins),
      cmocka_unit_test(refused_sets_begin_with_themselves),
      cmocka_unit_test(lines_of_the_file_still_count_beside_sets),
      cmocka_unit_test(very_long_sets_have_a_short_place),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
