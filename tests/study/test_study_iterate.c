/* Studies of kinds: diagram and basin: what they iterate, what is observed, how their keys fit together. */
#include "study_cases.h"

static const char map[] = "kind: diagram\n"                                                      /* 1 */
                          "model: {type: grazing_map, lambda: 0.5, omega: 0.3, d: 0.01}\n"       /* 2 */
                          "iterate: {transient: 100, keep: 50}\n";                               /* 3 */
static const char listed[] = "kind: diagram\n"                                                   /* 1 */
                             "model:\n"                                                          /* 2 */
                             "  type: grazing_map\n"                                             /* 3 */
                             "  L: [0.5, 0, 0, 0.2]\n"                                           /* 4 */
                             "  eta: [1, 0]\n"                                                   /* 5 */
                             "  xi: [1, 1]\n"                                                    /* 6 */
                             "  kappa: []\n"                                                     /* 7 */
                             "  d: 0.01\n"                                                       /* 8 */
                             "iterate: {keep: 5}\n";                                             /* 9 */
static const char chain[] = "kind: diagram\n"                                                    /* 1 */
                            "model: {type: chain, particles: 2, gamma: 0.1, floor: null,\n"      /* 2 */
                            "        wall: [null, 1], force: 2}\n"                               /* 3 */
                            "iterate: {keep: 5}\n";                                              /* 4 */
static const char beyond_study[] = "kind: diagram\n"                                             /* 1 */
                                   "model: {type: chain, particles: 1, gamma: 0, floor: null,\n" /* 2 */
                                   "        wall: 1, damping: 3, force: 1}\n"                    /* 3 */
                                   "orbit: {motion: forced}\n"                                   /* 4 */
                                   "branch: {parameter: model.force, from: 1, to: 50}\n"         /* 5 */
                                   "iterate: {keep: 5}\n"                                        /* 6 */
                                   "sweep: {parameter: grazing.beyond, values: [1e-3, 2e-3]}\n"; /* 7 */

/* A study with one line replaced or, with an empty `from`, added. */
typedef struct refused_case {
  const char *study, *from, *to;
  const char *place, *phrase;
} refused_case;

static void assert_cases(const refused_case *cases, size_t count) {
  for (size_t i = 0; i < count; i++) {
    const refused_case *c = &cases[i];
    char text[2048];
    const char *at = *c->from ? strstr(c->study, c->from) : c->study + strlen(c->study);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - c->study), c->study, c->to, at + strlen(c->from));
    assert_refused(text, strlen(text), NULL, 0, c->place, c->phrase, "");
  }
}

#define ASSERT_CASES(cases) assert_cases((cases), sizeof(cases) / sizeof *(cases))

static study *with(const char *text, const char *set) {
  return parsed(text, &set, set != NULL);
}

/* --- what they are ------------------------------------------------------------------------------------------------ */

static void states_have_the_size_of_their_model(void **state) {
  (void)state;
  const struct {
    const char *text, *set;
    size_t size;
    bool is_map;
  } cases[] = {{map, NULL, 3, true},
               {listed, NULL, 2, true},
               {chain, NULL, 4, false},
               {chain, "iterate.section=impact", 5, false},
               {beyond_study, NULL, 2, false}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    study *s = with(cases[i].text, cases[i].set);
    assert_int_equal(diagram_state_size(s), cases[i].size);
    assert_true(model_has(s, MODEL_MAP) == cases[i].is_map);
    study_destroy(&s);
  }
}

static void what_is_observed_is_an_index_into_the_state(void **state) {
  (void)state;
  const struct {
    const char *text, *set;
    size_t observed;
  } cases[] = {{map, NULL, 0},
               {map, "iterate.observe=z3", 2},
               {listed, "iterate.observe=z2", 1},
               {chain, NULL, 1}, /* the last one with an obstacle */
               {chain, "model.wall=[1, null]", 0},
               {chain, "model.wall=null", 1},
               {chain, "iterate.observe=q0", 0},
               {chain, "iterate.observe=v1", 3},
               {chain, "iterate={section: impact, observe: time}", 4}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    study *s = with(cases[i].text, cases[i].set);
    assert_int_equal(diagram_observed(s), cases[i].observed);
    study_destroy(&s);
  }
}

static void only_diagrams_with_grazing_beyond_follow_a_family(void **state) {
  (void)state;
  const char *const texts[] = {map, listed, chain, beyond_study};
  for (size_t i = 0; i < 4; i++) {
    study *s = parsed(texts[i], NULL, 0);
    assert_true(diagram_is_beyond(s) == (i == 3) && (family_followed(s) != NULL) == (i == 3));
    study_destroy(&s);
  }
  study *s = parsed("kind: basin\nmodel: {type: grazing_map, lambda: 0.5, omega: 0.3, d: 0.01}\n", NULL, 0);
  assert_true(!diagram_is_beyond(s) && !diagram_has_windows(s));
  study_destroy(&s);
}

static void sweeps_come_back_in_the_reverse_order(void **state) {
  (void)state;
  const char *const sets[] = {"sweep={parameter: model.d, values: [1, 3, 2], back: true}",
                              "sweep={parameter: model.d, from: 1, to: 3, points: 3, back: true}",
                              "sweep={parameter: model.d, values: [1, 3, 2], back: false}"};
  const double expected[2][6] = {{1, 3, 2, 2, 3, 1}, {1, 2, 3, 3, 2, 1}};
  for (size_t i = 0; i < 3; i++) {
    study *s = with(map, sets[i]);
    assert_int_equal(study_tasks(s), i < 2 ? 6 : 3);
    for (size_t k = 0; k < study_tasks(s); k++)
      assert_true(study_sweep_at(s, 0)->values[k] == expected[i % 2][k]);
    study_destroy(&s);
  }
}

/* --- refusals ----------------------------------------------------------------------------------------------------- */

static void maps_are_given_by_three_numbers_or_by_lists(void **state) {
  (void)state;
  static const char other[] = "kind: KIND\nmodel: {type: grazing_map, lambda: 0.5, omega: 0.3, d: 0.01}\n";
  static const refused_case cases[] = {
      {map, "lambda: 0.5, ", "", "s.yaml: ", "missing key model.lambda: a map is given by lambda and omega, or by L"},
      {map, ", omega: 0.3", "", "s.yaml: ", "missing key model.omega: a map is given by lambda and omega"},
      {map, ", d: 0.01", "", "s.yaml: ", "missing key model.d (a number)"},
      {map, "lambda", "lamda", "s.yaml:2: ", "unknown key 'lamda' in model; did you mean 'lambda'?"},
      {map, "0.5", "[0.5]", "s.yaml:2: ", "model.lambda = a list, expected a number"},
      {map, "d: 0.01", "d: 0.01, stretch: 0", "s.yaml:2: ", "model.stretch = 0 is out of range, expected a number > 0"},
      {listed, "0.5, 0, 0, 0.2", "0.5, 0, 0", "s.yaml:4: ", "model.L has 3 elements, expected 4: model.eta has 2"},
      {listed, "eta: [1, 0]", "eta: []", "s.yaml:4: ", "model.eta is empty, expected the vector of the map"},
      {listed, "xi: [1, 1]", "xi: [1]", "s.yaml:6: ", "model.xi has 1 elements, expected 2: model.eta has 2"},
      {listed, "  xi: [1, 1]\n", "", "s.yaml:5: ", "model.xi has 0 elements, expected 2: model.eta has 2"},
      {listed, "kappa: []", "kappa: [1, 2, 3]", "s.yaml:7: ", "model.kappa has 3 elements, expected 2"},
      {listed, "d: 0.01", "d: 0.01\n  omega: 1", "s.yaml:9: ", "model.omega and model.L both give the map"},
      {listed, "", "sweep: {parameter: model.lambda, values: [1]}\n",
       "s.yaml:10: ", "model.lambda and model.L both give the map"},
      {listed, "", "sweep: {parameter: 'model.L[4]', values: [1]}\n", "s.yaml:10: ", "expected an index from 0 to 3"},
      {listed, "", "sweep: {parameter: 'model.kappa[0]', values: [1]}\n",
       "s.yaml:10: ", "model.kappa is an empty list"},
      {other, "KIND", "orbits\norbit: {period: 5, at_start: [0]}",
       "s.yaml:1: ", "kind = orbits is for model.type: chain or duffing_chain, and this is model.type: grazing_map"},
      {other, "KIND", "trajectory\ntime: {duration: 1}", "s.yaml:1: ", "kind = trajectory is for model.type: chain"},
      {other, "KIND", "grazing\norbit: {motion: forced}\nbranch: {parameter: model.d, from: 0, to: 1}",
       "s.yaml:1: ", "kind = grazing is for model.type: chain or duffing_chain, and this is model.type: grazing_map"},
  };
  ASSERT_CASES(cases);
}

static void keys_are_of_maps_or_of_motions(void **state) {
  (void)state;
  static const char of_map[] = "is a key of model.type: grazing_map, and this is model.type: chain";
  static const char of_motion[] = "is a key of model.type: chain or duffing_chain, and this is model.type: grazing_map";
  static const refused_case cases[] = {
      {map, "lambda", "particles: 3, lambda", "s.yaml:2: ", of_motion},
      {map, "", "start: {q: 1}\n", "s.yaml:4: ", of_motion},
      {map, "keep: 50", "section: strobe", "s.yaml:3: ", of_motion},
      {map, "keep: 50", "phase: 0.5", "s.yaml:3: ", of_motion},
      {map, "keep: 50", "tolerance: 1e-9", "s.yaml:3: ", of_motion},
      {map, "", "sweep: {parameter: grazing.beyond, values: [1]}\n", "s.yaml:4: ", of_motion},
      {chain, "force", "d: 1, force", "s.yaml:3: ", of_map},
      {chain, "keep: 5", "start: 1", "s.yaml:4: ", of_map},
      {map, "keep: 50", "start: [0, 0]", "s.yaml:3: ", "iterate.start has 2 elements, expected 3, or a single number"},
      {map, "keep: 50", "start: [0, null, 0]", "s.yaml:3: ", "iterate.start[1] = null, expected a number"},
      {map, "", "sweep: {parameter: 'iterate.start[0]', values: [1]}\n",
       "s.yaml:4: ", "iterate.start is a single number here: sweep iterate.start without an index, or give a list"},
  };
  ASSERT_CASES(cases);
}

static void numbers_of_a_run_are_refused_with_what_is_allowed(void **state) {
  (void)state;
  static const refused_case cases[] = {
      {map, "transient", "trasient", "s.yaml:3: ", "unknown key 'trasient' in iterate; did you mean 'transient'?"},
      {map, "{transient: 100, keep: 50}", "3",
       "s.yaml:3: ", "iterate = 3, expected a mapping of the keys transient, measure"},
      {map, "transient: 100", "transient: 1.5", "s.yaml:3: ", "iterate.transient = 1.5, expected an integer from 0"},
      {map, "keep: 50", "keep: -1", "s.yaml:3: ", "iterate.keep = -1 is out of range, expected an integer from 0 to"},
      {map, "keep: 50", "keep: 50, measure: 49",
       "s.yaml:3: ", "iterate.measure = 49, expected at least iterate.keep = 50"},
      {map, "", "sweep: {parameter: iterate.measure, values: [60, 40]}\n",
       "s.yaml:4: ", "swept iterate.measure = 40, expected at least iterate.keep = 50"},
      {map, "keep: 50", "lyapunov: true, exponents: 4", "s.yaml:3: ", "iterate.exponents = 4, expected at most 3"},
      {map, "keep: 50", "exponents: 3", "s.yaml:3: ", "iterate.exponents = 3 needs iterate.lyapunov: true"},
      {map, "keep: 50", "period_limit: 0",
       "s.yaml:3: ", "iterate.period_limit = 0 is out of range, expected an integer from 1"},
      {map, "keep: 50", "period_tol: 0", "s.yaml:3: ", "iterate.period_tol = 0 is out of range, expected a number > 0"},
      {map, "keep: 50", "lyapunov: yes", "s.yaml:3: ", "iterate.lyapunov = yes, expected true or false"},
      {chain, "keep: 5", "phase: 1", "s.yaml:4: ", "iterate.phase = 1 is out of range, expected a number >= 0 and < 1"},
      {map, "", "sweep: {parameter: iterate.keep, values: [1]}\n",
       "s.yaml:4: ", "iterate.keep cannot be swept: it changes the shape of the result"},
      {map, "", "sweep: {parameter: iterate.exponents, values: [1]}\n",
       "s.yaml:4: ", "iterate.exponents cannot be swept"},
  };
  ASSERT_CASES(cases);
}

static void what_is_observed_is_a_number_of_the_state(void **state) {
  (void)state;
  static const refused_case cases[] = {
      {map, "keep: 50", "observe: z4", "s.yaml:3: ", "iterate.observe = z4, expected z1 to z3"},
      {map, "keep: 50", "observe: z0", "s.yaml:3: ", "iterate.observe = z0, expected z1 to z3"},
      {map, "keep: 50", "observe: q1", "s.yaml:3: ", "iterate.observe = q1, expected z1 to z3"},
      {listed, "keep: 5", "observe: z3", "s.yaml:9: ", "iterate.observe = z3, expected z1 to z2"},
      {chain, "keep: 5", "observe: q5", "s.yaml:4: ", "iterate.observe = q5, expected q0 to q1 or v0 to v1"},
      {chain, "keep: 5", "observe: z1", "s.yaml:4: ", "iterate.observe = z1, expected q0 to q1 or v0 to v1"},
      {chain, "keep: 5", "observe: time", "s.yaml:4: ", "iterate.observe = time, expected q0 to q1 or v0 to v1"},
      {chain, "keep: 5", "section: impact, observe: v2", "s.yaml:4: ", "expected q0 to q1 or v0 to v1 or time"},
  };
  ASSERT_CASES(cases);
}

static void sections_at_impacts_need_an_obstacle(void **state) {
  (void)state;
  static const refused_case cases[] = {
      {chain, "keep: 5", "particle: 1",
       "s.yaml:4: ", "iterate.particle is a key of iterate.section: impact, and this is strobe"},
      {chain, "keep: 5", "section: impact, particle: 0",
       "s.yaml:4: ", "iterate.particle = 0 has no floor or wall to hit"},
      {chain, "keep: 5", "section: impact, particle: 2",
       "s.yaml:4: ", "iterate.particle = 2 is out of range, expected a particle from 0 to 1"},
      {chain, "wall: [null, 1], force: 2}\niterate: {", "force: 2}\niterate: {section: impact, ",
       "s.yaml:4: ", "iterate.section = impact, and no particle has a floor or a wall to hit"},
  };
  ASSERT_CASES(cases);
}

static void lines_need_a_sweep_and_windows_one_that_rises_or_falls(void **state) {
  (void)state;
  static const char neither[] = "iterate.windows = true needs rising or falling values of the last sweep, and those of "
                                "model.d are neither";
  static const refused_case cases[] = {
      {map, "keep: 50", "follow: true",
       "s.yaml:3: ", "iterate.follow = true refers to the last sweep, but the study has none"},
      {map, "keep: 50", "windows: true",
       "s.yaml:3: ", "iterate.windows = true refers to the last sweep, but the study has none"},
      {map, "keep: 50}", "windows: true}\nsweep: {parameter: model.d, values: [1, 2, 1]}", "s.yaml:3: ", neither},
      {map, "keep: 50}", "windows: true}\nsweep: {parameter: model.d, values: [1, 1]}", "s.yaml:3: ", neither},
      {map, "keep: 50}", "windows: true}\nsweep: {parameter: model.d, values: [1, 2], back: true}",
       "s.yaml:3: ", neither},
      {map, "keep: 50}", "windows: true}\nsweep: {parameter: iterate.start, values: [1, 2]}", "s.yaml:3: ",
       "lists windows of a number of model, or of grazing.beyond, and the last sweep is over iterate.start"},
      {chain, "keep: 5}", "section: impact, windows: true}\nsweep: {parameter: model.force, values: [1, 2]}",
       "s.yaml:4: ", "iterate.windows = true needs iterate.section: strobe, and this is impact"},
      {map, "", "sweep: {parameter: model.d, values: [1, 2], points: 3}\n",
       "s.yaml:4: ", "sweep has both values and points"},
      {map, "", "sweep: {parameter: model.d, values: [1, 2], back: 2}\n",
       "s.yaml:4: ", "sweep.back = 2, expected true or false"},
  };
  ASSERT_CASES(cases);
  study *s = with(map, "sweep={parameter: model.d, values: [1], back: true}");
  assert_int_equal(study_tasks(s), 2);
  study_destroy(&s);
}

static void families_are_of_diagrams_beyond_grazing(void **state) {
  (void)state;
  static const char lonely[] = "of kind: diagram is for diagrams with grazing.beyond";
  static const refused_case cases[] = {
      {map, "", "orbit: {motion: forced}\n", "s.yaml:4: ", lonely},
      {map, "", "branch: {parameter: model.d, from: 1, to: 2}\n", "s.yaml:4: ", lonely},
      {chain, "", "orbit: {motion: forced}\n", "s.yaml:5: ", lonely},
      {beyond_study, "grazing.beyond", "iterate.phase", "s.yaml:5: ", lonely},
      {beyond_study, "motion: forced", "motion: conservative",
       "s.yaml:7: ", "grazing.beyond needs orbit.motion: forced, and this is conservative"},
      {beyond_study, "motion: forced", "period: 3",
       "s.yaml:7: ", "grazing.beyond needs orbit.motion: forced, and this is even"},
      {beyond_study, "keep: 5", "section: impact",
       "s.yaml:7: ", "grazing.beyond needs iterate.section: strobe, and this is impact"},
      {beyond_study, "branch: {parameter: model.force, from: 1, to: 50}\n", "",
       "s.yaml: ", "missing key branch.parameter"},
      {beyond_study, "to: 50", "to: 50, cross: true",
       "s.yaml:5: ", "branch.cross is a key of kind: branch, and this is kind: diagram"},
      {beyond_study, "to: 50", "to: 50, trace: {parameter: model.damping, low: 1, high: 4}",
       "s.yaml:5: ", "branch.trace.parameter is a key of kind: branch or grazing, and this is kind: diagram"},
      {beyond_study, "", "grazing: {windows: 3}\n", "s.yaml:8: ", "grazing.windows is a key of kind: grazing"},
  };
  ASSERT_CASES(cases);
}

static void basins_take_what_their_attractors_need(void **state) {
  (void)state;
  static const char text[] = "kind: basin\n"
                             "model: {type: grazing_map, lambda: 0.5, omega: 0.3, d: 0.01}\n"
                             "iterate: {measure: 10}\n"; /* nothing is kept */
  static const refused_case cases[] = {
      {text, "measure: 10", "states: true",
       "s.yaml:3: ", "iterate.states is a key of kind: diagram, and this is kind: basin"},
      {text, "measure: 10", "lyapunov: true", "s.yaml:3: ", "iterate.lyapunov is a key of kind: diagram"},
      {text, "measure: 10", "exponents: 2", "s.yaml:3: ", "iterate.exponents is a key of kind: diagram"},
      {text, "measure: 10", "follow: true", "s.yaml:3: ", "iterate.follow is a key of kind: diagram"},
      {text, "measure: 10", "windows: true", "s.yaml:3: ", "iterate.windows is a key of kind: diagram"},
      {map, "kind: diagram", "kind: basin",
       "s.yaml:3: ", "iterate.keep is a key of kind: diagram, and this is kind: basin"},
      {text, "kind: basin", "kind: atlas", "s.yaml:1: ", "kind = atlas is not in this version"},
  };
  study *s = parsed(text, NULL, 0);
  study_destroy(&s);
  ASSERT_CASES(cases);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(states_have_the_size_of_their_model),
      cmocka_unit_test(what_is_observed_is_an_index_into_the_state),
      cmocka_unit_test(only_diagrams_with_grazing_beyond_follow_a_family),
      cmocka_unit_test(sweeps_come_back_in_the_reverse_order),
      cmocka_unit_test(maps_are_given_by_three_numbers_or_by_lists),
      cmocka_unit_test(keys_are_of_maps_or_of_motions),
      cmocka_unit_test(numbers_of_a_run_are_refused_with_what_is_allowed),
      cmocka_unit_test(what_is_observed_is_a_number_of_the_state),
      cmocka_unit_test(sections_at_impacts_need_an_obstacle),
      cmocka_unit_test(lines_need_a_sweep_and_windows_one_that_rises_or_falls),
      cmocka_unit_test(families_are_of_diagrams_beyond_grazing),
      cmocka_unit_test(basins_take_what_their_attractors_need),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
