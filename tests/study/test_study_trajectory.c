/* Studies of kind: trajectory, and the keys that only they may change. */
#include "study_cases.h"

static const char trajectory[] = "kind: trajectory\n"         /* 1 */
                                 "model:\n"                   /* 2 */
                                 "  type: chain\n"            /* 3 */
                                 "  particles: 3\n"           /* 4 */
                                 "  gamma: 0.1\n"             /* 5 */
                                 "  wall: [null, 2, 1]\n"     /* 6 */
                                 "  mass: [1, 2, 3]\n"        /* 7 */
                                 "  restitution: 0.5\n"       /* 8 */
                                 "start: {q: [0, 0, 0.5]}\n"  /* 9 */
                                 "time: {duration: 10 pi}\n"; /* 10 */

static char *changed(const char *text, const char *from, const char *to) {
  const char *at = strstr(text, from);
  assert_non_null(at);
  const size_t size = strlen(text) + strlen(to) + 1;
  char *out = malloc(size);
  assert_non_null(out);
  snprintf(out, size, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
  return out;
}

static study *parsed_change(const char *from, const char *to) {
  char *text = changed(trajectory, from, to);
  study *s = parsed(text, NULL, 0);
  free(text);
  return s;
}

static void values_and_defaults_are_read(void **state) {
  (void)state;
  study *s = parsed(trajectory, NULL, 0);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  assert_true(value_number(v, KEY_MODEL_WALL, 0) == -INFINITY);
  assert_true(value_number(v, KEY_MODEL_WALL, 2) == 1);
  assert_true(value_number(v, KEY_MODEL_MASS, 1) == 2);
  assert_true(value_number(v, KEY_MODEL_RESTITUTION, 0) == 0.5);
  assert_true(value_number(v, KEY_MODEL_HERTZ, 0) == -INFINITY);
  assert_true(value_number(v, KEY_TIME_TOLERANCE, 0) == -INFINITY);
  assert_true(value_number(v, KEY_TIME_SAMPLES, 0) == 1001);
  assert_true(value_number(v, KEY_TIME_EVENTS_PER_TIME, 0) == 1e5);
  assert_true(value_number(v, KEY_START_Q, 2) == 0.5);
  assert_true(!value_is_list(v, KEY_START_V) && value_number(v, KEY_START_V, 0) == 0);
  assert_false(value_present(v, KEY_ORBIT_PERIOD));
  study_values_destroy(&v);
  study_destroy(&s);
}

static void a_start_is_given_by_its_section_an_orbit_or_a_sweep(void **state) {
  (void)state;
  static const char *const starts[] = {"start: {}\n", "start: {v: 1}\n",
                                       "sweep: {parameter: start.v, values: [1, 2]}\n"};
  for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
    study *s = parsed_change("start: {q: [0, 0, 0.5]}\n", starts[i]);
    study_destroy(&s);
  }
  study *s = parsed("kind: trajectory\nmodel: {type: chain, particles: 3, gamma: 0}\n"
                    "orbit: {period: 4, at_start: [0]}\ntime: {duration: 1}\n",
                    NULL, 0);
  study_destroy(&s);
}

static void every_number_can_be_swept_but_the_shape(void **state) {
  (void)state;
  static const char *const swept[] = {"model.stiffness",    "model.quadratic",     "model.cubic",     "model.damping",
                                      "model.link_damping", "model.mass[1]",       "model.wall[1]",   "model.hertz",
                                      "model.link_cubic",   "model.force",         "model.frequency", "model.phase",
                                      "model.restitution",  "start.q[0]",          "start.v",         "time.duration",
                                      "time.tolerance",     "time.events_per_time"};
  for (size_t i = 0; i < sizeof swept / sizeof *swept; i++) {
    char sweep[128];
    snprintf(sweep, sizeof sweep, "pi}\nsweep: {parameter: '%s', values: [0.01, 0.002]}\n", swept[i]);
    study *s = parsed_change("pi}\n", sweep);
    assert_int_equal(study_tasks(s), 2);
    study_destroy(&s);
  }
}

static void assert_changes_refused(const refusal *cases, size_t count) {
  for (size_t i = 0; i < count; i++) {
    char *text = changed(trajectory, cases[i].from, cases[i].to);
    assert_refused(text, strlen(text), NULL, 0, cases[i].place, cases[i].phrase, cases[i].other ? cases[i].other : "");
    free(text);
  }
}

static void what_no_trajectory_has_is_refused(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"start: {q: [0, 0, 0.5]}\n", "", "s.yaml: ", "neither start nor orbit, expected exactly one", NULL},
      {"start:", "orbit: {period: 3, at_start: [0]}\nstart:", "s.yaml:10: ", "both start and orbit", "exactly one"},
      {"start:", "orbit: {method: dense}\nstart:", "s.yaml: ", "missing key orbit.period", NULL},
      {"start: {q: [0, 0, 0.5]}", "orbit: {period: 3, at_start: [0], states: true}",
       "s.yaml:9: ", "orbit.states is a key of kind: orbits, and this is kind: trajectory", NULL},
      {"time: {duration: 10 pi}\n", "", "s.yaml: ", "missing key time.duration (a number > 0 and <= 1000000000)", NULL},
      {"10 pi", "0", "s.yaml:10: ", "time.duration = 0 is out of range, expected a number > 0 and <= 1000000000", NULL},
      {"10 pi}", "1, samples: 1}", "s.yaml:10: ", "time.samples = 1 is out of range", "from 2 to"},
      {"10 pi}", "1, samples: 2.5}", "s.yaml:10: ", "time.samples = 2.5", NULL},
      {"10 pi}", "1, flow: euler}", "s.yaml:10: ", "time.flow = euler, expected one of auto, taylor, cvodes", NULL},
      {"10 pi}", "1, tolerance: 1}", "s.yaml:10: ", "time.tolerance = 1 is out of range", NULL},
      {"10 pi}", "1, stop: 1}", "s.yaml:10: ", "unknown key 'stop' in time, expected one of duration, samples", NULL},
      {"pi}\n", "pi}\nsweep: {parameter: time.samples, values: [3]}\n",
       "s.yaml:11: ", "time.samples cannot be swept: it changes the shape", NULL},
      {"[0, 0, 0.5]", "[0, 0]", "s.yaml:9: ", "start.q has 2 elements, expected 3", "or a single number"},
      {"[0, 0, 0.5]", "[0, 0, null]", "s.yaml:9: ", "start.q[2] = null, expected a number", NULL},
      {"[1, 2, 3]", "[1, 2, 3, 4]", "s.yaml:7: ", "model.mass has 4 elements, expected 3", NULL},
      {"[1, 2, 3]", "[1, 2, 0]", "s.yaml:7: ", "model.mass[2] = 0 is out of range, expected a number > 0", NULL},
      {"[null, 2, 1]", "[1]", "s.yaml:6: ", "model.wall has 1 elements, expected 3", NULL},
      {"restitution: 0.5", "restitution: [0.5, 1, 2]", "s.yaml:8: ", "model.restitution[2] = 2 is out of range", NULL},
      {"restitution: 0.5", "restitution: [0.5, 1]", "s.yaml:8: ", "model.restitution has 2 elements", NULL},
      {"restitution: 0.5", "hertz: 0", "s.yaml:8: ", "model.hertz = 0 is out of range, expected a number > 0 or null",
       NULL},
      {"restitution: 0.5", "damping: -1", "s.yaml:8: ", "model.damping = -1 is out of range", NULL},
  };
  assert_changes_refused(cases, sizeof cases / sizeof *cases);
}

static void orbits_need_the_default_of_every_new_key(void **state) {
  (void)state;
  static const char *const keys[][2] = {
      {"mass", "1"},      {"stiffness", "1"},      {"quadratic", "0"},  {"cubic", "0"},        {"damping", "0"},
      {"wall", "null"},   {"link_quadratic", "0"}, {"link_cubic", "0"}, {"link_damping", "0"}, {"hertz", "null"},
      {"frequency", "1"}, {"force", "0"},          {"phase", "0"}};
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
    char line[64], says[128];
    snprintf(line, sizeof line, "  floor: -1\n  %s: %s\n", keys[i][0], keys[i][1]);
    study *s = parsed_variation("  floor: -1\n", line);
    study_destroy(&s);
    snprintf(line, sizeof line, "  floor: -1\n  %s: 2.5\n", keys[i][0]);
    snprintf(says, sizeof says, "model.%s = 2.5, but kind: orbits needs model.%s = %s", keys[i][0], keys[i][0],
             keys[i][1]);
    const refusal refused = {"  floor: -1\n", line, "s.yaml:9: ", says, NULL};
    assert_all_refused(&refused, 1);
  }
}

static void what_orbits_need_holds_for_lists_sweeps_and_starts_on_orbits(void **state) {
  (void)state;
  static const refusal cases[] = {
      {"parameter: model.gamma\n    from: 0\n    to: 0.187\n    points: 15\n    scale: linear\n",
       "parameter: model.damping\n    values: [0, 0.1]\n",
       "s.yaml:19: ", "swept model.damping = 0.1, but kind: orbits needs model.damping = 0", NULL},
      {"sweep:", "time: {duration: 1}\nsweep:", "s.yaml:17: ",
       "time.duration is a key of kind: trajectory, and this is kind: orbits", NULL},
      {NULL,
       "kind: trajectory\nmodel: {type: chain, particles: 2, gamma: 0,\n  mass: [1, 2]}\n"
       "orbit: {period: 4, at_start: [0]}\ntime: {duration: 1}\n",
       "s.yaml:3: ", "model.mass[1] = 2, but a start on an orbit needs model.mass = 1", NULL},
      {NULL,
       "kind: trajectory\nmodel: {type: chain, particles: 2, gamma: 0,\n  restitution: [1, 0.5]}\n"
       "orbit: {period: 4, at_start: [0]}\ntime: {duration: 1}\n",
       "s.yaml:3: ", "model.restitution[1] = 0.5 is not in this version", "need restitution 1"},
      {NULL,
       "kind: trajectory\nmodel: {type: chain, particles: 2, gamma: 0}\n"
       "orbit: {period: 4, at_start: [2]}\ntime: {duration: 1}\n",
       "s.yaml:3: ", "orbit.at_start[0] = 2 is out of range", NULL},
  };
  ASSERT_ALL_REFUSED(cases);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_and_defaults_are_read),
      cmocka_unit_test(a_start_is_given_by_its_section_an_orbit_or_a_sweep),
      cmocka_unit_test(every_number_can_be_swept_but_the_shape),
      cmocka_unit_test(what_no_trajectory_has_is_refused),
      cmocka_unit_test(orbits_need_the_default_of_every_new_key),
      cmocka_unit_test(what_orbits_need_holds_for_lists_sweeps_and_starts_on_orbits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
