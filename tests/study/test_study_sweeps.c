#include "study_cases.h"

/* A study whose sweep, on line 4, is the given YAML. The caller frees. */
static char *swept(const char *sweep) {
  static const char head[] = "kind: orbits\n"
                             "model: {type: chain, particles: 4, gamma: 0.1, floor: [-1, -1, null, -1]}\n"
                             "orbit: {period: 1.5 pi, at_start: [0, 1]}\n"
                             "sweep: ";
  char *text = malloc(sizeof head + strlen(sweep) + 1);
  assert_non_null(text);
  strcpy(text, head);
  strcat(text, sweep);
  strcat(text, "\n");
  return text;
}

static study *swept_study(const char *sweep) {
  char *text = swept(sweep);
  study *s = parsed(text, NULL, 0);
  free(text);
  return s;
}

static void linear_range_meets_its_ends_and_formula(void **state) {
  (void)state;
  study *s = swept_study("{parameter: model.gamma, from: 0.1, to: 0.7, points: 8}");
  const study_sweep *sweep = study_sweep_at(s, 0);
  assert_int_equal(sweep->points, 8);
  assert_true(sweep->values[0] == 0.1 && sweep->values[7] == 0.7);
  for (int i = 1; i < 7; i++)
    assert_true(sweep->values[i] == 0.1 + i * (0.7 - 0.1) / 7);
  assert_string_equal(sweep->name, "model.gamma");
  assert_int_equal(sweep->key, KEY_MODEL_GAMMA);
  assert_int_equal(sweep->item, -1);
  study_destroy(&s);
}

static void log_range_meets_its_ends_with_equal_ratios(void **state) {
  (void)state;
  study *s = swept_study("[{parameter: model.gamma, from: 1e-5, to: 0.3, points: 7, scale: log}]");
  const double *values = study_sweep_at(s, 0)->values;
  assert_true(values[0] == 1e-5 && values[6] == 0.3);
  const double ratio = pow(0.3 / 1e-5, 1.0 / 6);
  for (int i = 0; i < 6; i++)
    assert_close(values[i + 1] / values[i], ratio, 1e-13 * ratio);
  study_destroy(&s);
}

static void one_point_range_is_its_value(void **state) {
  (void)state;
  study *s = swept_study("{parameter: model.gamma, from: 0.25, to: 0.25, points: 1}");
  assert_int_equal(study_tasks(s), 1);
  assert_true(study_sweep_value(s, 0, 0) == 0.25);
  study_destroy(&s);
}

static void the_last_sweep_varies_fastest(void **state) {
  (void)state;
  study *s =
      swept_study("[{parameter: model.gamma, values: [0.1, 0.2]}, {parameter: 'model.floor[1]', values: [-1, -2]},"
                  " {parameter: orbit.period, from: 1, to: 3, points: 3}]");
  static const double expected[12][3] = {{0.1, -1, 1}, {0.1, -1, 2}, {0.1, -1, 3}, {0.1, -2, 1},
                                         {0.1, -2, 2}, {0.1, -2, 3}, {0.2, -1, 1}, {0.2, -1, 2},
                                         {0.2, -1, 3}, {0.2, -2, 1}, {0.2, -2, 2}, {0.2, -2, 3}};
  assert_int_equal(study_tasks(s), 12);
  assert_int_equal(study_sweeps(s), 3);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  for (size_t visit = 0; visit < 24; visit++) {
    const size_t task = visit * 7 % 12; /* not in order: a task does not depend on the one before */
    study_values_at(v, task);
    for (size_t i = 0; i < 3; i++)
      assert_true(study_sweep_value(s, i, task) == expected[task][i]);
    assert_true(value_number(v, KEY_MODEL_GAMMA, 0) == expected[task][0]);
    assert_true(value_number(v, KEY_MODEL_FLOOR, 1) == expected[task][1]);
    assert_true(value_number(v, KEY_ORBIT_PERIOD, 0) == expected[task][2]);
    assert_true(value_number(v, KEY_MODEL_FLOOR, 0) == -1);
    assert_true(value_number(v, KEY_MODEL_FLOOR, 2) == -INFINITY);
  }
  study_values_destroy(&v);
  study_destroy(&s);
}

static void two_elements_of_a_list_can_be_swept(void **state) {
  (void)state;
  study *s =
      swept_study("[{parameter: 'model.floor[03]', values: [-4, -5]}, {parameter: 'model.floor[2]', values: [-6]}]");
  assert_string_equal(study_sweep_at(s, 0)->name, "model.floor[3]");
  assert_int_equal(study_sweep_at(s, 0)->item, 3);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 3) == -4); /* task 0 without asking */
  study_values_at(v, 1);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 3) == -5);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 2) == -6);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 0) == -1);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void swept_keys_may_be_left_out(void **state) {
  (void)state;
  const char text[] = "kind: orbits\nmodel: {type: chain, particles: 4}\norbit: {at_start: [0]}\n"
                      "sweep:\n- {parameter: model.gamma, values: [0.2, 0.1]}\n"
                      "- {parameter: orbit.period, from: 1, to: 2, points: 2}\n";
  study *s = parsed(text, NULL, 0);
  study_values *v = study_values_create(s);
  assert_true(value_present(v, KEY_MODEL_GAMMA));
  assert_true(value_number(v, KEY_MODEL_GAMMA, 0) == 0.2);
  study_values_at(v, 3);
  assert_true(value_number(v, KEY_MODEL_GAMMA, 0) == 0.1);
  assert_true(value_number(v, KEY_ORBIT_PERIOD, 0) == 2);
  assert_int_equal(study_line(s, KEY_MODEL_GAMMA), 5);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void indices_of_the_pattern_can_be_swept(void **state) {
  (void)state;
  /* 1 meets the other impact of the list: an outcome of that grid point, not of the study */
  study *s = swept_study("{parameter: 'orbit.at_start[0]', from: 0, to: 3, points: 4}");
  assert_int_equal(study_tasks(s), 4);
  assert_true(study_sweep_value(s, 0, 2) == 2);
  study_destroy(&s);
}

static void a_swept_floor_replaces_null(void **state) {
  (void)state;
  const char text[] = "kind: orbits\nmodel: {type: chain, particles: 4, gamma: 1, floor: null}\n"
                      "orbit: {period: 2, at_start: [0]}\nsweep: {parameter: model.floor, values: [-1, 1 pi]}\n";
  study *s = parsed(text, NULL, 0);
  assert_int_equal(study_tasks(s), 2);
  study_destroy(&s);
}

typedef struct sweep_refusal {
  const char *sweep, *place, *phrase, *other;
} sweep_refusal;

static void assert_sweeps_refused(const sweep_refusal *cases, size_t count) {
  for (size_t i = 0; i < count; i++) {
    char *text = swept(cases[i].sweep);
    assert_refused(text, strlen(text), NULL, 0, cases[i].place, cases[i].phrase, cases[i].other);
    free(text);
  }
}

#define ASSERT_SWEEPS_REFUSED(cases) assert_sweeps_refused((cases), sizeof(cases) / sizeof *(cases))

static void sweeps_over_what_is_no_number_are_refused(void **state) {
  (void)state;
  static const sweep_refusal cases[] = {
      {"{parameter: model.gama, values: [1]}", "s.yaml:4: ", "unknown sweep parameter 'model.gama'",
       "did you mean 'model.gamma'?"},
      {"{parameter: colour, values: [1]}", "s.yaml:4: ", "unknown sweep parameter 'colour'", "such as model.gamma"},
      {"{parameter: model, values: [1]}", "s.yaml:4: ", "unknown sweep parameter 'model'", ""},
      {"{parameter: model.ends, values: [1]}", "s.yaml:4: ", "sweep.parameter = model.ends cannot be swept", "a word"},
      {"{parameter: title, values: [1]}", "s.yaml:4: ", "title cannot be swept", "text"},
      {"{parameter: orbit.states, values: [1]}", "s.yaml:4: ", "orbit.states cannot be swept", "flag"},
      {"{parameter: model.particles, values: [1]}", "s.yaml:4: ", "model.particles cannot be swept",
       "it changes the shape of the result"},
      {"{parameter: iterate.keep, values: [1]}", "s.yaml:4: ", "iterate.keep cannot be swept",
       "it changes the shape of the result"},
      {"{parameter: 'start.q', values: [1]}", "s.yaml:4: ", "start.q is a key of kind: trajectory", ""},
      {"{parameter: [a], values: [1]}", "s.yaml:4: ", "sweep.parameter = a list", "expected text"},
      {"[{parameter: model.gamma, values: [1]},\n {parameter: model.gamma, values: [2]}]",
       "s.yaml:5: ", "sweep[1].parameter = model.gamma is swept twice", ""},
      {"{values: [1]}", "s.yaml:4: ", "missing key sweep.parameter", "such as model.gamma"},
  };
  ASSERT_SWEEPS_REFUSED(cases);
}

static void lists_are_swept_by_element_and_scalars_without(void **state) {
  (void)state;
  static const sweep_refusal cases[] = {
      {"{parameter: model.floor, values: [1]}", "s.yaml:4: ", "model.floor is a list: sweep one element",
       "model.floor[0]"},
      {"{parameter: 'model.floor[4]', values: [1]}", "s.yaml:4: ", "model.floor has 4 elements", "index from 0 to 3"},
      {"{parameter: 'model.floor[x]', values: [1]}", "s.yaml:4: ", "index from 0 to 3", ""},
      {"{parameter: 'model.floor[-1]', values: [1]}", "s.yaml:4: ", "index from 0 to 3", ""},
      {"{parameter: 'model.floor[1]x', values: [1]}", "s.yaml:4: ", "index from 0 to 3", ""},
      {"{parameter: 'model.gamma[0]', values: [1]}", "s.yaml:4: ", "model.gamma is a single number here",
       "without an index"},
      {"{parameter: orbit.at_start, values: [1]}", "s.yaml:4: ", "orbit.at_start is a list: sweep one element", ""},
      {"{parameter: 'orbit.at_half[0]', values: [1]}", "s.yaml:4: ", "orbit.at_half is an empty list", ""},
  };
  ASSERT_SWEEPS_REFUSED(cases);
  const refusal scalar = {"parameter: model.gamma", "parameter: model.floor[3]",
                          "s.yaml:18: ", "model.floor is a single number here", "without an index"};
  assert_all_refused(&scalar, 1);
}

static void ranges_that_are_none_are_refused(void **state) {
  (void)state;
  static const sweep_refusal cases[] = {
      {"{parameter: model.gamma, from: 2, to: 1, points: 3}", "s.yaml:4: ", "reversed range from 2 to 1", "from <= to"},
      {"{parameter: model.gamma, from: 1, to: 1, points: 3}", "s.yaml:4: ", "empty range from 1 to 1", "points: 1"},
      {"{parameter: model.gamma, from: 1, to: 2, points: 1}", "s.yaml:4: ", "1 point cannot span", "points >= 2"},
      {"{parameter: model.gamma, from: 1, to: 2, points: 0}", "s.yaml:4: ", "sweep.points = 0 is out of range",
       "from 1"},
      {"{parameter: model.gamma, from: 1, to: 2, points: 1.5}", "s.yaml:4: ", "sweep.points = 1.5, expected an integer",
       ""},
      {"{parameter: model.gamma, from: 1, to: 2, points: 1e13}", "s.yaml:4: ", "sweep.points = 1e13 is out of range",
       ""},
      {"{parameter: model.gamma, from: 1, to: 2}", "s.yaml:4: ", "missing key sweep.points (an integer from 1",
       "values"},
      {"[{parameter: model.gamma, to: 2, points: 2}]", "s.yaml:4: ", "missing key sweep[0].from (a number)", ""},
      {"{parameter: model.gamma, from: 2, points: 2}", "s.yaml:4: ", "missing key sweep.to", ""},
      {"{parameter: model.gamma}", "s.yaml:4: ", "missing key sweep.from", "either values"},
      {"{parameter: model.gamma, values: [1],\n from: 2}", "s.yaml:5: ", "both values and from", "either"},
      {"{parameter: model.gamma, values: [1],\n scale: log}", "s.yaml:5: ", "both values and scale", "either"},
      {"{parameter: model.gamma, values: []}", "s.yaml:4: ", "sweep.values is empty", "one number or more"},
      {"{parameter: model.gamma, values: 1}", "s.yaml:4: ", "sweep.values = 1, expected a list of numbers", ""},
      {"{parameter: model.gamma, values: [1, 0.1x]}", "s.yaml:4: ", "sweep.values[1] = 0.1x is not a number", ""},
      {"{parameter: model.gamma, from: 0, to: 2, points: 2, scale: log}",
       "s.yaml:4: ", "sweep.from = 0 with scale: log", "> 0"},
      {"{parameter: model.gamma, from: 1, to: 2, points: 2, scale: cubic}", "s.yaml:4: ", "sweep.scale = cubic",
       "one of linear, log"},
      {"{parameter: model.gamma, from: -1e308, to: 1.7e308, points: 3}", "s.yaml:4: ", "out of range", ""},
      {"[]", "s.yaml:4: ", "sweep has 0 entries, expected from 1 to 8", ""},
      {"[1]", "s.yaml:4: ", "sweep[0] = 1, expected a mapping", ""},
      {"[1, 2, 3, 4, 5, 6, 7, 8, 9]", "s.yaml:4: ", "sweep has 9 entries, expected from 1 to 8", ""},
      {"", "s.yaml:4: ", "sweep = null, expected a mapping", ""},
      {"[{parameter: model.gamma, from: 1, to: 2, points: 1e7},\n {parameter: orbit.period, from: 1, to: 2, points: "
       "1e7}]",
       "s.yaml:4: ", "1e+14 grid points", "fewer than 2^40"},
  };
  ASSERT_SWEEPS_REFUSED(cases);
}

static void every_swept_value_meets_the_rules_of_its_key(void **state) {
  (void)state;
  static const sweep_refusal cases[] = {
      {"{parameter: model.gamma, values: [0.1,\n -0.1]}", "s.yaml:5: ", "swept model.gamma = -0.1 is out of range",
       "a number >= 0"},
      {"{parameter: model.gamma, from: -1, to: 1, points: 3}", "s.yaml:4: ", "swept model.gamma = -1 is out of range",
       ""},
      {"{parameter: orbit.period, values: [1, 0]}", "s.yaml:4: ", "swept orbit.period = 0 is out of range", "> 0"},
      {"{parameter: 'orbit.at_start[0]', values: [0, 2.5]}", "s.yaml:4: ", "swept orbit.at_start[0] = 2.5",
       "expected an integer"},
      {"{parameter: 'orbit.at_start[0]', from: 0, to: 3, points: 3}", "s.yaml:4: ", "swept orbit.at_start[0] = 1.5",
       "expected an integer"},
      {"{parameter: 'orbit.at_start[0]', values: [0, 4]}", "s.yaml:4: ", "swept orbit.at_start[0] = 4 is out of range",
       "a particle from 0 to 3"},
      {"{parameter: model.restitution, values: [1, 0.5]}", "s.yaml:4: ", "swept model.restitution = 0.5 is not in this",
       "orbits of an undamped chain need restitution 1"},
      {"{parameter: model.restitution, values: [1, 1.5]}", "s.yaml:4: ", "1.5 is out of range", "from 0 to 1"},
      {"{parameter: 'model.floor[2]', values: [null]}", "s.yaml:4: ", "sweep.values[0] = null, expected a number", ""},
  };
  ASSERT_SWEEPS_REFUSED(cases);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(linear_range_meets_its_ends_and_formula),
      cmocka_unit_test(log_range_meets_its_ends_with_equal_ratios),
      cmocka_unit_test(one_point_range_is_its_value),
      cmocka_unit_test(the_last_sweep_varies_fastest),
      cmocka_unit_test(two_elements_of_a_list_can_be_swept),
      cmocka_unit_test(swept_keys_may_be_left_out),
      cmocka_unit_test(indices_of_the_pattern_can_be_swept),
      cmocka_unit_test(a_swept_floor_replaces_null),
      cmocka_unit_test(sweeps_over_what_is_no_number_are_refused),
      cmocka_unit_test(lists_are_swept_by_element_and_scalars_without),
      cmocka_unit_test(ranges_that_are_none_are_refused),
      cmocka_unit_test(every_swept_value_meets_the_rules_of_its_key),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
