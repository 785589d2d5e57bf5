#include "study_cases.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static void unknown_keys_name_the_nearest(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"gamma:", "gama:", "s.yaml:7: ", "unknown key 'gama' in model; did you mean 'gamma'?", NULL},
      {"  gamma:", "  Gamma:", "s.yaml:7: ", "unknown key 'Gamma' in model; did you mean 'gamma'?", NULL},
      {"period:", "perod:", "s.yaml:11: ", "unknown key 'perod' in orbit; did you mean 'period'?", NULL},
      {"from:", "form:", "s.yaml:19: ", "unknown key 'form' in sweep; did you mean 'from'?", NULL},
      {"model:", "modle:", "s.yaml:3: ", "unknown key 'modle'; did you mean 'model'?", NULL},
      {"kind: orbits\n", "kind: orbits\ngamma: 1\n", "s.yaml:2: ", "unknown key 'gamma'; did you mean 'model.gamma'?",
       NULL},
      {"kind: orbits\n", "kind: orbits\nmodel.gamma: 1\n", "s.yaml:2: ", "unknown key 'model.gamma'", NULL},
      {"gamma:", "colour:", "s.yaml:7: ", "unknown key 'colour' in model, expected one of type, particles",
       "restitution"},
      {"kind:", "\"kind\\0\": a\nkind:", "s.yaml:1: ", "unknown key", NULL},
      {"kind:", "sweep.from: a\nkind:", "s.yaml:1: ", "unknown key 'sweep.from'", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
}

static void later_versions_are_refused_by_name(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"kind: orbits", "kind: atlas",
       "s.yaml:1: ", "kind = atlas is not in this version, expected one of orbits, trajectory, branch, grazing", NULL},
      {"type: chain", "type: oscillator",
       "s.yaml:4: ", "model.type = oscillator is not in this version, expected one of chain", NULL},
      {NULL, "model: {type: oscillator, lambda: 0.5}\nkind: atlas\n",
       "s.yaml:2: ", "kind = atlas is not in this version", NULL},
      {"restitution: 1", "restitution: 0.8", "s.yaml:9: ",
       "model.restitution = 0.8 is not in this version: orbits of an undamped chain need restitution 1", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
}

static void wrong_numbers_are_refused_with_what_is_allowed(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"gamma: 0.1", "gamma: 0.1x", "s.yaml:7: ", "model.gamma = 0.1x is not a number", "a number >= 0"},
      {"gamma: 0.1", "gamma: .nan", "s.yaml:7: ", "model.gamma = .nan is not a number", NULL},
      {"gamma: 0.1", "gamma: nan", "s.yaml:7: ", "model.gamma = nan is not a number", NULL},
      {"gamma: 0.1", "gamma: .inf", "s.yaml:7: ", "model.gamma = .inf is not a number", NULL},
      {"gamma: 0.1", "gamma: 1e999", "s.yaml:7: ", "model.gamma = 1e999 is out of range", NULL},
      {"gamma: 0.1", "gamma: -0.1", "s.yaml:7: ", "model.gamma = -0.1 is out of range, expected a number >= 0", NULL},
      {"gamma: 0.1", "gamma: 0x10", "s.yaml:7: ", "model.gamma = 0x10 is not a number", NULL},
      {"gamma: 0.1", "gamma: \"0.1\"", "s.yaml:7: ", "\"0.1\" (a quoted string), expected a number >= 0", NULL},
      {"gamma: 0.1", "gamma: null", "s.yaml:7: ", "model.gamma = null, expected a number >= 0", NULL},
      {"gamma: 0.1", "gamma:", "s.yaml:7: ", "model.gamma = null, expected a number >= 0", NULL},
      {"gamma: 0.1", "gamma: [0.1]", "s.yaml:7: ", "model.gamma = a list, expected a number >= 0", NULL},
      {"gamma: 0.1", "gamma: {a: 1}", "s.yaml:7: ", "model.gamma = a mapping, expected a number >= 0", NULL},
      {"particles: 30", "particles: 2.5", "s.yaml:5: ", "model.particles = 2.5, expected an integer", "1000000000"},
      {"particles: 30", "particles: 0", "s.yaml:5: ", "model.particles = 0 is out of range, expected an integer from 1",
       NULL},
      {"particles: 30", "particles: 1e12", "s.yaml:5: ", "model.particles = 1e12 is out of range", NULL},
      {"restitution: 1", "restitution: 1.2", "s.yaml:9: ", "model.restitution = 1.2 is out of range", "from 0 to 1"},
      {"period: 1.5 pi", "period: 0", "s.yaml:11: ", "orbit.period = 0 is out of range, expected a number > 0", NULL},
      {"period: 1.5 pi", "period: -1.5 pi", "s.yaml:11: ", "orbit.period = -1.5 pi is out of range", NULL},
      {"period: 1.5 pi", "period: 1.5pi", "s.yaml:11: ", "orbit.period = 1.5pi is not a number", NULL},
      {"floor: -1", "floor: [-1, x]", "s.yaml:8: ", "model.floor[1] = x is not a number, expected a number or null",
       NULL},
      {"floor: -1", "floor:\n    - -1\n    - x", "s.yaml:10: ", "model.floor[1] = x is not a number", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
}

static void wrong_words_flags_and_texts_are_refused(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"ends: periodic", "ends: ring", "s.yaml:6: ", "model.ends = ring, expected one of periodic, fixed, free", NULL},
      {"ends: periodic", "ends: Periodic", "s.yaml:6: ", "model.ends = Periodic, expected one of", NULL},
      {"ends: periodic", "ends: periodic|fixed", "s.yaml:6: ", "model.ends = periodic|fixed, expected one of", NULL},
      {"ends: periodic", "ends: \"\"", "s.yaml:6: ", "model.ends = \"\" (a quoted string), expected one of", NULL},
      {"ends: periodic", "ends: [fixed]", "s.yaml:6: ", "model.ends = a list, expected one of", NULL},
      {"ends: periodic", "ends:", "s.yaml:6: ", "model.ends = null, expected one of", NULL},
      {"kind: orbits", "kind: 3", "s.yaml:1: ", "kind = 3, expected one of orbits, trajectory", NULL},
      {"states: true", "states: yes", "s.yaml:15: ", "orbit.states = yes, expected true or false", NULL},
      {"states: true", "states: on", "s.yaml:15: ", "orbit.states = on, expected true or false", NULL},
      {"states: true", "states: \"true\"", "s.yaml:15: ", "(a quoted string), expected true or false", NULL},
      {"states: true", "states: 1", "s.yaml:15: ", "orbit.states = 1, expected true or false", NULL},
      {"title: one particle", "title: [a]", "s.yaml:2: ", "title = a list, expected text", NULL},
      {"title: one particle", "title:", "s.yaml:2: ", "title = null, expected text", NULL},
      {"title: one particle", "title: \"a\\0b\"", "s.yaml:2: ", "contains a NUL", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
}

static void patterns_that_no_chain_has_are_refused(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"[15, 3]", "[15, 30]", "s.yaml:12: ", "orbit.at_start[1] = 30 is out of range", "a particle from 0 to 29"},
      {"[15, 3]", "[15, -1]", "s.yaml:12: ", "orbit.at_start[1] = -1 is out of range", "an integer >= 0"},
      {"[15, 3]", "[15, 2.5]", "s.yaml:12: ", "orbit.at_start[1] = 2.5, expected an integer", NULL},
      {"[15, 3]", "[15, null]", "s.yaml:12: ", "orbit.at_start[1] = null, expected an integer", NULL},
      {"[15, 3]", "15", "s.yaml:12: ", "orbit.at_start = 15, expected a list of integers >= 0", NULL},
      {"[15, 3]", "\n    - 15\n    - 3\n    - 15", "s.yaml:15: ", "orbit.at_start[2] = 15 is in the pattern twice",
       "orbit.at_start[0] too"},
      {"at_half: [4]", "at_half: [4, 3]", "s.yaml:13: ", "orbit.at_half[1] = 3 is in the pattern twice",
       "orbit.at_start[1] too"},
      {"  at_start: [15, 3]\n  at_half: [4]\n", "  at_start: []\n", "s.yaml:12: ", "both empty", "at least one"},
      {"  at_start: [15, 3]\n  at_half: [4]\n", "", "s.yaml: ", "both empty", "at least one"},
      {"floor: -1", "floor: null", "s.yaml:12: ", "orbit.at_start[0] = 15 has no floor or wall to hit", NULL},
      {"30\n  ends: periodic\n  gamma: 0.1\n  floor: -1",
       "16\n  ends: periodic\n  gamma: 0.1\n  floor: [-1, -1, -1, "
       "-1, ~, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1]",
       "s.yaml:13: ", "orbit.at_half[0] = 4 has no floor or wall to hit", NULL},
      {"floor: -1", "floor: [-1, -1]", "s.yaml:8: ", "model.floor has 2 elements, expected 30", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
}

static void missing_keys_are_named_with_what_they_allow(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"kind: orbits\n", "",
       "s.yaml: ", "missing key kind (one of orbits, trajectory, branch, grazing, diagram, basin)", NULL},
      {"  type: chain\n", "", "s.yaml: ", "missing key model.type (one of chain, duffing_chain, grazing_map)", NULL},
      {"  particles: 30\n", "", "s.yaml: ", "missing key model.particles (an integer from 1 to 1000000000)", NULL},
      {"  period: 1.5 pi\n", "", "s.yaml: ", "missing key orbit.period (a number > 0)", NULL},
      {NULL, "kind: orbits\nmodel: {type: chain, particles: 2}\norbit: {period: 1, at_start: [0]}\n",
       "s.yaml: ", "missing key model.gamma (a number >= 0)", NULL},
      {NULL, "kind: orbits\n", "s.yaml: ", "missing key model.type", NULL},
      {NULL, "{}", "s.yaml: ", "missing key kind", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
}

static void what_is_not_one_yaml_mapping_is_refused(void **state) {
  (void)state;
  static const refusal cases[] = {
      {NULL, "", "s.yaml:1: ", "empty", NULL},
      {NULL, "# nothing\n\n", "s.yaml:1: ", "empty", NULL},
      {NULL, "---\n", "s.yaml:", "empty", NULL},
      {NULL, "- 1\n- 2\n", "s.yaml:1: ", "the study is a list, expected a mapping", "model"},
      {NULL, "\norbits\n", "s.yaml:2: ", "the study is orbits, expected a mapping", NULL},
      {NULL, "kind: [orbits\n", "s.yaml:2: ", "not YAML: ", NULL},
      {NULL, "kind: orbits\n\tmodel: 1\n", "s.yaml:2: ", "not YAML: ", NULL},
      {NULL, "kind: orbits\n---\nkind: orbits\n", "s.yaml:2: ", "second document", NULL},
      {NULL, "kind: orbits\n...\n---\nkind: orbits\n", "s.yaml:3: ", "second document", NULL},
      {NULL, "kind: \xff\xfe\n", "s.yaml:1: ", "not UTF-8 text", NULL},
      {NULL, "kind: orbits\ntitle: \xc3\n", "s.yaml:2: ", "not UTF-8 text", NULL},
      {NULL, "kind: orbits\ntitle: \x01\n", "s.yaml:2: ", "control characters", NULL},
      {"model:", "model: 3\norbits:", "s.yaml:3: ", "model = 3, expected a mapping of the keys type, particles", NULL},
      {"sweep:", "sweep: 3\nsweeps:", "s.yaml:", "unknown key 'sweeps'", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
  assert_refused("kind: or\0bits\n", 14, NULL, 0, "s.yaml:1: ", "NUL", "");
  assert_refused("a\n\0", 3, NULL, 0, "s.yaml:2: ", "NUL", "");
}

static void yaml_beyond_plain_values_is_refused(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"gamma: 0.1", "gamma: &g 0.1", "s.yaml:7: ", "anchor &g", NULL},
      {"gamma: 0.1", "gamma: *g", "s.yaml:7: ", "alias *g", NULL},
      {"gamma: 0.1", "gamma: !!float 0.1", "s.yaml:7: ", "tag tag:yaml.org,2002:float", NULL},
      {"gamma: 0.1", "gamma: !mine 0.1", "s.yaml:7: ", "tag !mine", NULL},
      {"gamma: 0.1", "gamma: ! 0.1", "s.yaml:7: ", "tag !", NULL},
      {"[15, 3]", "!!seq [15, 3]", "s.yaml:12: ", "tag ", NULL},
      {"[15, 3]", "&a [15, 3]", "s.yaml:12: ", "anchor &a", NULL},
      {"[15, 3]", "! [15, 3]", "s.yaml:12: ", "tag !", NULL},
      {"title: one particle", "title: \xc3\xa9\xe2\x82\xac\nx: ! 'a'", "s.yaml:3: ", "tag !", NULL},
      {"title: one", "? [a]\n: one", "s.yaml:2: ", "a list where a key is expected", NULL},
      {"title: one", "{a: 1}: one", "s.yaml:2: ", "a mapping where a key is expected", NULL},
      {"gamma: 0.1", "<<: {gamma: 0.1}", "s.yaml:7: ", "unknown key '<<' in model", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
}

static void duplicate_keys_are_refused_with_both_lines(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"  floor: -1", "  gamma: 0.1", "s.yaml:8: ", "duplicate key 'gamma'", "line 7"},
      {"sweep:", "kind: orbits\nsweep:", "s.yaml:17: ", "duplicate key 'kind'", "line 1"},
      {"to: 0.187", "from: 1", "s.yaml:20: ", "duplicate key 'from'", "line 19"},
      {"  floor: -1", "  'gamma': 0.1", "s.yaml:8: ", "duplicate key 'gamma'", "line 7"},
  };
  ASSERT_ALL_REFUSED(cases);
}

static void special_points_need_one_sweep_over_gamma_or_period(void **state) {
  (void)state;
  static const refusal cases[] = {
      {NULL,
       "kind: orbits\nmodel: {type: chain, particles: 2, gamma: 1}\norbit: {period: 1, at_start: [0],\n"
       " special_points: true}\n",
       "s.yaml:4: ", "requires exactly one sweep entry, over model.gamma or orbit.period", NULL},
      {NULL,
       "kind: orbits\nmodel: {type: chain, particles: 2, gamma: 1}\norbit: {period: 1, at_start: [0],\n"
       " special_points: true}\nsweep: {parameter: model.floor, values: [-1]}\n",
       "s.yaml:4: ", "requires exactly one sweep entry, over model.gamma or orbit.period", NULL},
      {NULL,
       "kind: orbits\nmodel: {type: chain, particles: 2}\norbit: {at_start: [0],\n"
       " special_points: true}\nsweep: [{parameter: model.gamma, values: [1]}, {parameter: orbit.period, values: "
       "[1]}]\n",
       "s.yaml:4: ", "requires exactly one sweep entry, over model.gamma or orbit.period", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
  study *s = parsed_variation("special_points: false", "special_points: true");
  study_destroy(&s);
}

static void long_values_are_cut_in_messages(void **state) {
  (void)state;
  char long_number[5000];
  memset(long_number, '1', sizeof long_number - 2);
  memcpy(long_number, "gamma: ", 7);
  long_number[sizeof long_number - 2] = 'x';
  long_number[sizeof long_number - 1] = 0;
  char *text = varied("gamma: 0.1", long_number);
  assert_refused(text, strlen(text), NULL, 0, "s.yaml:7: model.gamma = 1111", "... is not a number", "a number >= 0");
  free(text);
}

static void cut_values_keep_whole_characters(void **state) {
  (void)state;
  char value[600] = "ends: ";
  for (int i = 0; i < 100; i++)
    strcat(value, i % 3 ? "\xe2\x82\xac" : "\xc3\xa9");
  char *text = varied("ends: periodic", value);
  study *s = NULL;
  message why = {{0}};
  assert_int_equal(read_study("s.yaml", text, strlen(text), NULL, 0, &s, &why), EXIT_USAGE);
  char *cut = strstr(why.text, "...");
  assert_non_null(cut);
  *cut = 0; /* what is left must end with a whole character of the value */
  assert_true(strcmp(cut - 3, "\xe2\x82\xac") == 0 || strcmp(cut - 2, "\xc3\xa9") == 0);
  free(text);
}

static void files_that_cannot_be_read_are_refused(void **state) {
  (void)state;
  char *text = NULL;
  size_t length = 0;
  message why = {{0}};
  assert_int_equal(study_read_file("no/such/study.yaml", (ric_poll){0}, &text, &length, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "no/such/study.yaml: "));
  assert_int_equal(study_read_file("/", (ric_poll){0}, &text, &length, &why), EXIT_FILES);
  assert_null(text);
}

static int stop_at_third(void *user) {
  return ++*(int *)user >= 3;
}

/* A named pipe without a writer, and one whose writer takes its time. */
static void a_pipe_is_waited_for_until_a_stop(void **state) {
  (void)state;
  static const char name[] = "test_study_refusals.pipe";
  char *text = NULL;
  size_t length = 0;
  int asked = 0;
  message why = {{0}};
  unlink(name);
  assert_int_equal(mkfifo(name, 0600), 0);
  assert_int_equal(study_read_file(name, (ric_poll){stop_at_third, &asked}, &text, &length, &why), EXIT_STOPPED);
  assert_int_equal(asked, 3);
  assert_null(text);
  const pid_t writer = fork();
  if (writer == 0) {
    const int to = open(name, O_WRONLY);
    bool written = write(to, "kind: ", 6) == 6;
    nanosleep(&(struct timespec){.tv_nsec = 250000000}, NULL);
    written = written && write(to, "orbits", 6) == 6;
    _exit(!written);
  }
  assert_int_equal(study_read_file(name, (ric_poll){0}, &text, &length, &why), 0);
  assert_string_equal(text, "kind: orbits");
  assert_int_equal(waitpid(writer, NULL, 0), writer);
  free(text);
  unlink(name);
}

static void files_are_read_whole_up_to_the_limit(void **state) {
  (void)state;
  char name[64] = "test_study_refusals.tmp.yaml", *text = NULL;
  size_t length = 0;
  message why = {{0}};
  FILE *file = fopen(name, "wb");
  assert_non_null(file);
  assert_int_equal(fputs(base_study, file) >= 0, 1);
  fclose(file);
  assert_int_equal(study_read_file(name, (ric_poll){0}, &text, &length, &why), 0);
  assert_int_equal(length, strlen(base_study));
  assert_string_equal(text, base_study);
  free(text);
  file = fopen(name, "wb");
  assert_non_null(file);
  for (size_t i = 0; i <= STUDY_MAX_BYTES; i++)
    fputc('#', file);
  fclose(file);
  text = NULL;
  assert_int_equal(study_read_file(name, (ric_poll){0}, &text, &length, &why), EXIT_USAGE);
  assert_non_null(strstr(why.text, "8 MiB"));
  assert_null(text);
  remove(name);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unknown_keys_name_the_nearest),
      cmocka_unit_test(later_versions_are_refused_by_name),
      cmocka_unit_test(wrong_numbers_are_refused_with_what_is_allowed),
      cmocka_unit_test(wrong_words_flags_and_texts_are_refused),
      cmocka_unit_test(patterns_that_no_chain_has_are_refused),
      cmocka_unit_test(missing_keys_are_named_with_what_they_allow),
      cmocka_unit_test(what_is_not_one_yaml_mapping_is_refused),
      cmocka_unit_test(yaml_beyond_plain_values_is_refused),
      cmocka_unit_test(duplicate_keys_are_refused_with_both_lines),
      cmocka_unit_test(special_points_need_one_sweep_over_gamma_or_period),
      cmocka_unit_test(long_values_are_cut_in_messages),
      cmocka_unit_test(cut_values_keep_whole_characters),
      cmocka_unit_test(files_that_cannot_be_read_are_refused),
      cmocka_unit_test(a_pipe_is_waited_for_until_a_stop),
      cmocka_unit_test(files_are_read_whole_up_to_the_limit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
