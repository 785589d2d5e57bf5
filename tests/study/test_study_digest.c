#include "study_cases.h"

static uint64_t digest_of(const char *text) {
  study *s = parsed(text, NULL, 0);
  const uint64_t digest = study_digest(s);
  study_destroy(&s);
  return digest;
}

static uint64_t digest_of_variation(const char *from, const char *to) {
  char *text = varied(from, to);
  const uint64_t digest = digest_of(text);
  free(text);
  return digest;
}

static void layout_comments_and_order_do_not_count(void **state) {
  (void)state;
  const uint64_t digest = digest_of(base_study);
  assert_true(digest == digest_of_variation("kind: orbits\n", "# a comment\n\nkind:   'orbits'  # another\n"));
  assert_true(digest == digest_of_variation("[15, 3]", "\n    - 15\n    - 3"));
  assert_true(digest == digest_of("sweep: {points: 15, to: 0.187, from: 0, parameter: model.gamma}\n"
                                  "orbit: {at_half: [4], at_start: [15, 3.0], period: 1.5 pi}\n"
                                  "model: {gamma: 1e-1, particles: 3e1, type: chain}\n"
                                  "title: one particle\nkind: orbits\n"));
}

static void defaults_count_as_if_written(void **state) {
  (void)state;
  assert_true(digest_of(base_study) == digest_of_variation("  ends: periodic\n", ""));
  assert_true(digest_of(base_study) == digest_of_variation("    scale: linear\n", ""));
}

static void multiples_of_pi_count_as_their_value(void **state) {
  (void)state;
  assert_true(digest_of(base_study) == digest_of_variation("1.5 pi", "4.7123889803846899"));
  assert_true(digest_of(base_study) != digest_of_variation("1.5 pi", "4.7123889803846890"));
}

static void a_range_counts_as_its_values(void **state) {
  (void)state;
  const uint64_t range = digest_of_variation("from: 0\n    to: 0.187\n    points: 15\n    scale: linear\n",
                                             "from: 0\n    to: 2\n    points: 3\n");
  const uint64_t values =
      digest_of_variation("from: 0\n    to: 0.187\n    points: 15\n    scale: linear\n", "values: [0, 1, 2]\n");
  assert_true(range == values);
}

static void every_value_counts(void **state) {
  (void)state;
  static const char *const changes[][2] = {{"one particle", "two particles"},
                                           {"particles: 30", "particles: 31"},
                                           {"periodic", "fixed"},
                                           {"gamma: 0.1", "gamma: 0.2"},
                                           {"floor: -1", "floor: -2"},
                                           {"floor: -1", "floor: 1"},
                                           {"1.5 pi", "1.6 pi"},
                                           {"[15, 3]", "[3, 15]"},
                                           {"[15, 3]", "[15]"},
                                           {"at_half: [4]", "at_half: []"},
                                           {"impulse", "dense"},
                                           {"states: true", "states: false"},
                                           {"points: 15", "points: 16"},
                                           {"to: 0.187", "to: 0.1871"},
                                           {"special_points: false", "special_points: true"},
                                           {"model.gamma\n", "orbit.period\n    values: [1]\n"}};
  const uint64_t digest = digest_of(base_study);
  for (size_t i = 0; i + 1 < sizeof changes / sizeof *changes; i++)
    assert_true(digest != digest_of_variation(changes[i][0], changes[i][1]));
}

static void elements_do_not_run_from_one_list_into_the_other(void **state) {
  (void)state;
  const uint64_t one = digest_of_variation("at_start: [15, 3]\n  at_half: [4]", "at_start: [15]\n  at_half: [3, 4]");
  assert_true(one != digest_of(base_study));
}

static void the_text_is_verbatim_without_sets(void **state) {
  (void)state;
  char *text = varied("kind: orbits\n", "# note\nkind:   orbits   # end\n\n");
  study *s = parsed(text, NULL, 0);
  assert_string_equal(study_text(s), text);
  study_destroy(&s);
  free(text);
}

/* With sets, the text written out must be a study of its own with the same digest. */
static void assert_round_trip(const char *text, const char *const *sets, size_t n_sets) {
  study *first = parsed(text, sets, n_sets);
  study *second = parsed(study_text(first), NULL, 0);
  assert_true(study_digest(first) == study_digest(second));
  assert_int_equal(study_tasks(first), study_tasks(second));
  study_destroy(&first);
  study_destroy(&second);
}

static void the_text_with_sets_reads_back_as_the_same_study(void **state) {
  (void)state;
  static const char *const sets[] = {"model.gamma=0.3",     "orbit.at_start=[1, 2]", "sweep[0].points=5",
                                     "title='a: \"b\" #c'", "orbit.period=-0 pi",    "orbit.period=0.3 pi"};
  for (size_t i = 0; i < 4; i++)
    assert_round_trip(base_study, sets + i, 1);
  assert_round_trip(base_study, sets, 6);
}

static void titles_of_every_style_survive_the_round_trip(void **state) {
  (void)state;
  static const char *const titles[] = {"title: >\n  folded\n   more\n\n  text\n\n\n",
                                       "title: |+\n  kept\n\n\n",
                                       "title: |2\n    indented\n  less\n",
                                       "title: 'single ''quoted'''\n",
                                       "title: \"a\\tb\\n c \\u00e9 \\x85 \\u2028 \\\\\"\n",
                                       "title: plain\n  over\n\n  lines\n",
                                       "title: \xc3\xa9\xe2\x82\xac \xf0\x9f\x98\x80\n",
                                       "title: '  spaces  '\n",
                                       "title: ''\n",
                                       "title: '~'\n",
                                       "title: '-'\n",
                                       "title: 'true'\n",
                                       "title: a#b:c\n",
                                       "title: \"\\e\\a\"\n"};
  const char *set = "model.gamma=0.3";
  for (size_t i = 0; i < sizeof titles / sizeof *titles; i++) {
    char *text = varied("title: one particle\n", titles[i]);
    assert_round_trip(text, &set, 1);
    free(text);
  }
}

static void null_floors_survive_the_round_trip(void **state) {
  (void)state;
  const char text[] =
      "{kind: orbits, model: {type: chain, particles: 3, gamma: 1, floor: [-1, ~, null]}, orbit: {period: "
      "1, at_start: [0]}}";
  const char *const sets[] = {"model.floor[1]=-1", "model.gamma=2"};
  assert_round_trip(text, sets, 2);
  const char empty[] =
      "kind: orbits\nmodel: {type: chain, particles: 3, gamma: 1, floor: }\norbit: {period: 1, at_start: [0]}\n"
      "sweep: {parameter: model.floor, values: [-1]}\n";
  assert_round_trip(empty, sets + 1, 1);
  const char block[] = "kind: orbits\nmodel:\n  type: chain\n  particles: 2\n  gamma: 1\n  floor:\n  -\n  - -1\n"
                       "orbit: {period: 1, at_start: [1]}\n";
  assert_round_trip(block, sets + 1, 1);
}

static void a_set_to_the_same_value_keeps_the_digest(void **state) {
  (void)state;
  const char *set = "orbit.period=1.5 pi";
  study *s = parsed(base_study, &set, 1);
  assert_true(study_digest(s) == digest_of(base_study));
  study_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(layout_comments_and_order_do_not_count),
      cmocka_unit_test(defaults_count_as_if_written),
      cmocka_unit_test(multiples_of_pi_count_as_their_value),
      cmocka_unit_test(a_range_counts_as_its_values),
      cmocka_unit_test(every_value_counts),
      cmocka_unit_test(elements_do_not_run_from_one_list_into_the_other),
      cmocka_unit_test(the_text_is_verbatim_without_sets),
      cmocka_unit_test(the_text_with_sets_reads_back_as_the_same_study),
      cmocka_unit_test(titles_of_every_style_survive_the_round_trip),
      cmocka_unit_test(null_floors_survive_the_round_trip),
      cmocka_unit_test(a_set_to_the_same_value_keeps_the_digest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
