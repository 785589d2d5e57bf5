/* Studies of kind: branch: what is followed, and how it moves. */
#include "study_cases.h"

static const char branch[] = "kind: branch\n"
                             "model: {type: chain, particles: 3, floor: [-1, -2, null]}\n"
                             "orbit: {period: 5, at_start: [0]}\n"
                             "branch: {parameter: model.gamma, from: 0.1, to: 0}\n"
                             "sweep: {parameter: orbit.period, values: [5, 6]}\n";

static void the_parameter_may_be_left_out_and_moves_within_a_task(void **state) {
  (void)state;
  study *s = parsed(branch, NULL, 0);
  assert_string_equal(family_followed(s)->name, "model.gamma");
  assert_true(family_followed(s)->key == KEY_MODEL_GAMMA && family_followed(s)->item == -1);
  assert_false(branch_restarts(s));
  assert_int_equal(study_tasks(s), 2);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  assert_true(value_number(v, KEY_MODEL_GAMMA, 0) == 0.1);
  study_values_move(v, KEY_BRANCH_PARAMETER, 0.05);
  assert_true(value_number(v, KEY_MODEL_GAMMA, 0) == 0.05 && value_number(v, KEY_ORBIT_PERIOD, 0) == 5);
  study_values_at(v, 1);
  assert_true(value_number(v, KEY_MODEL_GAMMA, 0) == 0.1 && value_number(v, KEY_ORBIT_PERIOD, 0) == 6);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void the_second_parameter_of_curves_moves_within_a_task_too(void **state) {
  (void)state;
  const char *set = "branch.trace={parameter: \"model.floor[1]\", low: -3, high: -1}";
  study *s = parsed(branch, &set, 1);
  assert_true(family_traced(s)->key == KEY_MODEL_FLOOR && family_traced(s)->item == 1);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  study_values_move(v, KEY_BRANCH_TRACE_PARAMETER, -2.5);
  study_values_move(v, KEY_BRANCH_PARAMETER, 0.05);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 0) == -1 && value_number(v, KEY_MODEL_FLOOR, 1) == -2.5);
  study_values_at(v, 1);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 1) == -2 && value_number(v, KEY_MODEL_GAMMA, 0) == 0.1);
  study_values_destroy(&v);
  study_destroy(&s);
  s = parsed(branch, NULL, 0);
  assert_null(family_traced(s));
  study_destroy(&s);
}

static void words_of_a_list_are_places_among_those_allowed(void **state) {
  (void)state;
  const char *set = "branch.trace={parameter: orbit.period, low: 4, high: 6, kinds: [impact_lost, fold]}";
  study *s = parsed("kind: branch\nmodel: {type: chain, particles: 1, floor: -1}\norbit: {period: 5, at_start: [0]}\n"
                    "branch: {parameter: model.gamma, from: 0.1, to: 0, trace: {parameter: orbit.period, low: 4, "
                    "high: 6}}\n",
                    NULL, 0);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  assert_int_equal(value_count(v, KEY_BRANCH_TRACE_KINDS), 3); /* the default: grazing, fold, period_doubling */
  for (size_t i = 0; i < 3; i++)
    assert_true(value_number(v, KEY_BRANCH_TRACE_KINDS, i) == (double)i);
  const uint64_t digest = study_digest(s);
  study_values_destroy(&v);
  study_destroy(&s);
  s = parsed("kind: branch\nmodel: {type: chain, particles: 1, floor: -1}\norbit: {period: 5, at_start: [0]}\n"
             "branch: {parameter: model.gamma, from: 0.1, to: 0}\n",
             &set, 1);
  v = study_values_create(s);
  assert_non_null(v);
  assert_int_equal(value_count(v, KEY_BRANCH_TRACE_KINDS), 2);
  assert_true(value_number(v, KEY_BRANCH_TRACE_KINDS, 0) == 3 && value_number(v, KEY_BRANCH_TRACE_KINDS, 1) == 1);
  assert_true(study_digest(s) != digest);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void elements_of_lists_can_be_followed(void **state) {
  (void)state;
  static const char *const sets[] = {"branch.parameter=model.floor[1]", "branch.to=-3", "branch.from=-2",
                                     "model.gamma=0.2"};
  study *s = parsed(branch, sets, 4);
  assert_true(family_followed(s)->key == KEY_MODEL_FLOOR && family_followed(s)->item == 1);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  study_values_move(v, KEY_BRANCH_PARAMETER, -2.5);
  assert_true(value_number(v, KEY_MODEL_FLOOR, 0) == -1 && value_number(v, KEY_MODEL_FLOOR, 1) == -2.5);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void what_is_not_said_is_known_to_be_a_default(void **state) {
  (void)state;
  const char *set = "start.q=0.5";
  study *s = parsed(branch, &set, 1);
  assert_true(study_gives(s, KEY_START_Q) && !study_gives(s, KEY_START_V));
  assert_true(study_gives(s, KEY_MODEL_GAMMA) && study_gives(s, KEY_ORBIT_PERIOD));
  study_destroy(&s);
}

static void a_study_that_restarts_need_not_say_where_it_starts(void **state) {
  (void)state;
  static const char text[] = "kind: branch\nmodel: {type: chain, particles: 3, gamma: 0}\norbit: {motion: even}\n"
                             "branch: {parameter: orbit.period, to: 5}\nrestart: {file: r.h5, point: 3}\n";
  study *s = parsed(text, NULL, 0);
  assert_true(branch_restarts(s) && family_followed(s)->key == KEY_ORBIT_PERIOD);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  assert_string_equal(value_word(v, KEY_RESTART_FILE), "r.h5");
  study_values_destroy(&v);
  study_destroy(&s);
  const char *set = "restart={}";
  assert_refused(text, strlen(text), &set, 1, "s.yaml: ", "missing key orbit.period", "");
}

static void branches_that_do_not_say_start_at_the_own_value(void **state) {
  (void)state;
  static const char text[] = "kind: branch\nmodel: {type: duffing_chain, particles: 2, cubic: [0, 0.1], wall: 2}\n"
                             "orbit: {period: 7, at_start: [1]}\nbranch: {parameter: 'model.cubic[1]', to: 1}\n";
  study *s = parsed(text, NULL, 0);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  assert_true(value_number(v, KEY_BRANCH_FROM, 0) == 0.1 && value_number(v, KEY_MODEL_CUBIC, 1) == 0.1);
  study_values_destroy(&v);
  study_destroy(&s);
  const char *set = "branch.parameter=orbit.energy";
  s = parsed(text, &set, 1);
  v = study_values_create(s);
  assert_non_null(v);
  assert_true(value_number(v, KEY_BRANCH_FROM, 0) == -INFINITY && value_number(v, KEY_ORBIT_ENERGY, 0) == -INFINITY);
  study_values_move(v, KEY_BRANCH_FROM, 1.5);
  study_values_move(v, KEY_BRANCH_PARAMETER, 1.5);
  assert_true(value_number(v, KEY_BRANCH_FROM, 0) == 1.5 && value_number(v, KEY_ORBIT_ENERGY, 0) == 1.5);
  study_values_at(v, 0);
  assert_true(value_number(v, KEY_BRANCH_FROM, 0) == -INFINITY);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void single_values_mean_what_the_type_of_model_says(void **state) {
  (void)state;
  study *s = parsed("kind: trajectory\nmodel: {type: duffing_chain, particles: 3, wall: 2, mass: 4}\nstart: {q: 0}\n"
                    "time: {duration: 1}\n",
                    NULL, 0);
  study_values *v = study_values_create(s);
  assert_non_null(v);
  assert_true(value_of_particle(v, KEY_MODEL_WALL, 0) == -INFINITY && value_of_particle(v, KEY_MODEL_WALL, 2) == 2);
  assert_true(value_of_particle(v, KEY_MODEL_FLOOR, 2) == -INFINITY && value_of_particle(v, KEY_MODEL_MASS, 1) == 4);
  study_values_destroy(&v);
  study_destroy(&s);
}

static void other_kinds_follow_nothing(void **state) {
  (void)state;
  study *s = parsed(base_study, NULL, 0);
  assert_null(family_followed(s));
  assert_false(branch_restarts(s));
  study_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_parameter_may_be_left_out_and_moves_within_a_task),
      cmocka_unit_test(the_second_parameter_of_curves_moves_within_a_task_too),
      cmocka_unit_test(words_of_a_list_are_places_among_those_allowed),
      cmocka_unit_test(elements_of_lists_can_be_followed),
      cmocka_unit_test(what_is_not_said_is_known_to_be_a_default),
      cmocka_unit_test(a_study_that_restarts_need_not_say_where_it_starts),
      cmocka_unit_test(branches_that_do_not_say_start_at_the_own_value),
      cmocka_unit_test(single_values_mean_what_the_type_of_model_says),
      cmocka_unit_test(other_kinds_follow_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
