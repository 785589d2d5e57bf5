#include "support.h"

#include "kind/kind.h"

static void every_row_is_complete(void **state) {
  (void)state;
  for (size_t key = 0; key < studies.key_count; key++) {
    const study_key row = studies.keys[key];
    assert_non_null(row->path);
    assert_non_null(row->doc);
    assert_ptr_equal(schema_find(&studies, row->path), row);
    assert_true(row->scalar || row->list);
    assert_true(row->required == (row->fallback == NULL));
    assert_true(row->sweep == (row->no_sweep == NULL));
    assert_true((row->type == VALUE_WORD) == (row->words != NULL));
  }
  assert_null(schema_find(&studies, "model.gama"));
  assert_null(schema_find(&studies, "model"));
  assert_null(schema_find(&studies, ""));
}

static void sections_within_sections_have_names_of_their_own(void **state) {
  (void)state;
  char names[256];
  assert_true(schema_is_section(&studies, "branch") && schema_is_section(&studies, "branch.trace"));
  assert_false(schema_is_section(&studies, "branch.trace.low") || schema_is_section(&studies, "branch.from") ||
               schema_is_section(&studies, "bran"));
  schema_names(&studies, "branch", names, sizeof names);
  assert_non_null(strstr(names, "segments, trace"));
  assert_null(strstr(names, "trace."));
  schema_names(&studies, "branch.trace", names, sizeof names);
  assert_int_equal(strncmp(names, "parameter, low, high", 20), 0);
}

static void mistyped_names_find_the_nearest_key(void **state) {
  (void)state;
  static const char *const cases[][2] = {{"model.gama", "model.gamma"},
                                         {"model.gmama", "model.gamma"},
                                         {"model.Gamma", "model.gamma"},
                                         {"orbit.periode", "orbit.period"},
                                         {"orbit.at_strat", "orbit.at_start"},
                                         {"model.partciles", "model.particles"},
                                         {"gamma", "model.gamma"},
                                         {"orbit.gamma", "model.gamma"},
                                         {"period", "orbit.period"},
                                         {"knd", "kind"},
                                         {"modle", "model"},
                                         {"sweeps", "sweep"},
                                         {"sweep.form", "sweep.from"},
                                         {"sweep.point", "sweep.points"},
                                         {"branhc", "branch"},
                                         {"branch.form", "branch.from"},
                                         {"branch.trce", "branch.trace"},
                                         {"branch.trace.hihg", "branch.trace.high"},
                                         {"grazign", "grazing"},
                                         {"grazing.sectoin", "grazing.section"},
                                         {"orbit.special_point", "orbit.special_points"},
                                         {"model.zzz", ""},
                                         {"", ""},
                                         {"colour", ""}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char near[64];
    schema_nearest(&studies, cases[i][0], near, sizeof near);
    assert_string_equal(near, cases[i][1]);
  }
}

static void parameters_are_looked_for_among_the_sweepable(void **state) {
  (void)state;
  char near[64];
  schema_nearest_parameter(&studies, "model.gama", near, sizeof near);
  assert_string_equal(near, "model.gamma");
  schema_nearest_parameter(&studies, "period", near, sizeof near);
  assert_string_equal(near, "orbit.period");
  schema_nearest_parameter(&studies, "model.endz", near, sizeof near);
  assert_string_equal(near, "");
}

static void very_long_names_are_near_to_nothing(void **state) {
  (void)state;
  char name[5000], near[64];
  memset(name, 'a', sizeof name);
  name[sizeof name - 1] = 0;
  schema_nearest(&studies, name, near, sizeof near);
  assert_string_equal(near, "");
  schema_nearest_parameter(&studies, name, near, sizeof near);
  assert_string_equal(near, "");
}

static void assert_allowed(study_key key, const char *expected) {
  char text[256];
  schema_allowed(key, text, sizeof text);
  assert_string_equal(text, expected);
}

static void allowed_values_are_said_in_words(void **state) {
  (void)state;
  assert_allowed(KEY_KIND, "one of orbits, trajectory, branch, grazing, diagram, basin");
  assert_allowed(KEY_TITLE, "text");
  assert_allowed(KEY_MODEL_PARTICLES, "an integer from 1 to 1000000000");
  assert_allowed(KEY_MODEL_ENDS, "one of periodic, fixed, free");
  assert_allowed(KEY_MODEL_GAMMA, "a number >= 0");
  assert_allowed(KEY_MODEL_FLOOR, "a number or null, or a list of them");
  assert_allowed(KEY_MODEL_RESTITUTION, "a number from 0 to 1, or a list of them");
  assert_allowed(KEY_ORBIT_PERIOD, "a number > 0");
  assert_allowed(KEY_ORBIT_AT_START, "a list of integers >= 0");
  assert_allowed(KEY_ORBIT_STATES, "true or false");
  assert_allowed(KEY_ORBIT_MULTIPLIERS, "true or false");
  assert_allowed(KEY_BRANCH_TRACE_KINDS,
                 "a list of words, each one of grazing, fold, period_doubling, impact_lost, impulse_sign");
}

static void open_ranges_are_said_and_checked(void **state) {
  (void)state;
  const schema_entry row = {.type = VALUE_NUMBER, .low = 0, .high = 1, .low_open = true, .high_open = true};
  char text[64];
  schema_allowed_item(&row, text, sizeof text);
  assert_string_equal(text, "a number > 0 and < 1");
  assert_int_equal(schema_check(&row, 0), FIT_OUT_OF_RANGE);
  assert_int_equal(schema_check(&row, 0.5), FIT_OK);
  assert_int_equal(schema_check(&row, 1), FIT_OUT_OF_RANGE);
}

static void numbers_outside_a_row_do_not_fit(void **state) {
  (void)state;
  const study_key gamma = KEY_MODEL_GAMMA, particles = KEY_MODEL_PARTICLES;
  assert_int_equal(schema_check(gamma, 0), FIT_OK);
  assert_int_equal(schema_check(gamma, -1e-300), FIT_OUT_OF_RANGE);
  assert_int_equal(schema_check(gamma, NAN), FIT_OUT_OF_RANGE);
  assert_int_equal(schema_check(gamma, INFINITY), FIT_OUT_OF_RANGE);
  assert_int_equal(schema_check(particles, NAN), FIT_OUT_OF_RANGE);
  assert_int_equal(schema_check(particles, 2.5), FIT_NOT_INTEGER);
  assert_int_equal(schema_check(particles, 0), FIT_OUT_OF_RANGE);
  assert_int_equal(schema_check(KEY_ORBIT_AT_START, 0x1p53), FIT_OUT_OF_RANGE);
  assert_int_equal(schema_check(KEY_ORBIT_PERIOD, 0), FIT_OUT_OF_RANGE);
}

/* Of every key, each section that it stands in: known, listed at the place where it belongs, and found with a
 * letter too many. */
static void sections_follow_from_the_keys(void **state) {
  (void)state;
  for (size_t key = 0; key < studies.key_count; key++) {
    const char *path = studies.keys[key]->path;
    for (const char *dot = strchr(path, '.'); dot; dot = strchr(dot + 1, '.')) {
      char section[64], outer[64] = "", near[64], names[1024];
      snprintf(section, sizeof section, "%.*s", (int)(dot - path), path);
      const char *inner = strrchr(section, '.');
      snprintf(outer, sizeof outer, "%.*s", inner ? (int)(inner - section) : 0, section);
      assert_true(schema_is_section(&studies, section));
      schema_names(&studies, outer, names, sizeof names);
      char listed[1100], wanted[80];
      snprintf(listed, sizeof listed, ", %s,", names);
      snprintf(wanted, sizeof wanted, ", %s,", inner ? inner + 1 : section);
      assert_non_null(strstr(listed, wanted));
      snprintf(wanted, sizeof wanted, "%s_", section);
      schema_nearest(&studies, wanted, near, sizeof near);
      assert_string_equal(near, section);
    }
  }
}

static void reference_lists_every_key(void **state) {
  (void)state;
  char *text = NULL;
  FILE *file = tmpfile();
  assert_non_null(file);
  schema_reference(&studies, file);
  const long length = ftell(file);
  assert_true(length > 0);
  text = calloc((size_t)length + 1, 1);
  assert_non_null(text);
  rewind(file);
  assert_int_equal(fread(text, 1, (size_t)length, file), length);
  fclose(file);
  for (size_t key = 0; key < studies.key_count; key++) {
    char cell[128];
    snprintf(cell, sizeof cell, "| `%s` |", studies.keys[key]->path);
    assert_non_null(strstr(text, cell));
    assert_non_null(strstr(text, studies.keys[key]->doc));
  }
  for (int key = 0; key < SWEEP_KEY_COUNT; key++)
    assert_non_null(strstr(text, schema_sweep_row((sweep_key)key)->doc));
  assert_non_null(strstr(text, "1.5 pi"));
  assert_non_null(strstr(text, "shooting, ritz"));
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_row_is_complete),
      cmocka_unit_test(sections_within_sections_have_names_of_their_own),
      cmocka_unit_test(mistyped_names_find_the_nearest_key),
      cmocka_unit_test(parameters_are_looked_for_among_the_sweepable),
      cmocka_unit_test(very_long_names_are_near_to_nothing),
      cmocka_unit_test(allowed_values_are_said_in_words),
      cmocka_unit_test(open_ranges_are_said_and_checked),
      cmocka_unit_test(numbers_outside_a_row_do_not_fit),
      cmocka_unit_test(sections_follow_from_the_keys),
      cmocka_unit_test(reference_lists_every_key),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
