#include "study_cases.h"

/* Parses what may or may not be a study; a refusal must have a message that begins with the name. */
static void parse_anything(const char *text, size_t length, const char *const *sets, size_t n_sets) {
  study *s = NULL;
  message why = {{0}};
  const int code = read_study("s.yaml", text, length, sets, n_sets, &s, &why);
  assert_true(code == 0 || code == EXIT_USAGE);
  assert_true((s != NULL) == (code == 0));
  const char *begin = n_sets ? "--set " : "s.yaml:";
  if (code && strncmp(why.text, begin, strlen(begin)) != 0 && strncmp(why.text, "s.yaml:", 7) != 0)
    fail_msg("message '%s' without a place", why.text);
  study_destroy(&s);
}

/* What is a study stays the same study when a set has it written out again. */
static void round_trip_a_study(const char *text, size_t length) {
  const char *set = "model.ends=free";
  study *s = NULL, *again = NULL;
  message why = {{0}};
  if (read_study("s.yaml", text, length, &set, 1, &s, &why) != 0)
    return;
  if (read_study("again", study_text(s), strlen(study_text(s)), NULL, 0, &again, &why) != 0)
    fail_msg("%s: not a study any more:\n%s", why.text, study_text(s));
  assert_true(study_digest(s) == study_digest(again));
  study_destroy(&s);
  study_destroy(&again);
}

/* A fixed sequence, so that a failure can be repeated (xorshift64). */
static uint64_t next_random(uint64_t *state) {
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return *state;
}

static void every_truncation_is_a_study_or_a_refusal(void **state) {
  (void)state;
  for (size_t length = 0; length <= strlen(base_study); length++)
    parse_anything(base_study, length, NULL, 0);
}

static void mutations_are_studies_or_refusals(void **state) {
  (void)state;
  static const char interesting[] = "[]{}:,-#'\"&*!|>%@?~ \t\n\r.0159exp\x00\x01\x7f\xc3\xff\xef";
  uint64_t random = 0x9e3779b97f4a7c15u;
  char text[sizeof base_study];
  for (int round = 0; round < 20000; round++) {
    memcpy(text, base_study, sizeof text);
    size_t length = strlen(base_study);
    for (uint64_t edits = 1 + next_random(&random) % 4; edits > 0; edits--) {
      const size_t at = next_random(&random) % length;
      if (next_random(&random) % 3 == 0) { /* drop a character */
        memmove(text + at, text + at + 1, length - at);
        length--;
      } else {
        text[at] = interesting[next_random(&random) % (sizeof interesting - 1)];
      }
    }
    parse_anything(text, length, NULL, 0);
    round_trip_a_study(text, length);
  }
}

static void mutated_sets_are_applied_or_refused(void **state) {
  (void)state;
  static const char *const sets[] = {"model.gamma=0.1", "sweep[0].points=5", "orbit.at_start=[1, 2]", "sweep={a: [b]}"};
  static const char interesting[] = "[]{}:,-#'\"&*!=. 019ax\x01\xff";
  uint64_t random = 0x2545f4914f6cdd1du;
  for (int round = 0; round < 8000; round++) {
    char set[64];
    strcpy(set, sets[round % 4]);
    for (int edits = 0; edits < 2; edits++)
      set[next_random(&random) % strlen(set)] = interesting[next_random(&random) % (sizeof interesting - 1)];
    const char *list[] = {set};
    parse_anything(base_study, strlen(base_study), list, 1);
  }
}

static char *repeated(const char *head, const char *unit, size_t count, const char *ending) {
  char *text = malloc(strlen(head) + count * strlen(unit) + strlen(ending) + 1);
  assert_non_null(text);
  char *end = text + sprintf(text, "%s", head);
  for (size_t i = 0; i < count; i++, end += strlen(unit))
    memcpy(end, unit, strlen(unit));
  strcpy(end, ending);
  return text;
}

static void assert_repeated_is_refused(const char *head, const char *unit, size_t count, const char *phrase) {
  char *text = repeated(head, unit, count, "\n");
  assert_refused(text, strlen(text), NULL, 0, "s.yaml:", phrase, "");
  free(text);
}

/* Nearly as long as a study may be: with work in proportion to the square of the depth this would take hours. */
static void assert_deep_is_refused(const char *head, const char *unit) {
  assert_repeated_is_refused(head, unit, (STUDY_MAX_BYTES - 10) / strlen(unit), "nested deeper than 32");
}

static void deep_nesting_is_refused_at_any_length(void **state) {
  (void)state;
  assert_deep_is_refused("a: ", "[");
  assert_deep_is_refused("", "{a: ");
  assert_deep_is_refused("", "- ");
  assert_deep_is_refused("", "? ");
  assert_deep_is_refused("", "[\n");
  char *set = repeated("model.gamma=", "[", 100000, "");
  const char *sets[] = {set};
  assert_refused(base_study, strlen(base_study), sets, 1, "--set model.gamma=[[[", "nested deeper than 32", "");
  free(set);
}

static void nesting_within_the_limit_is_read(void **state) {
  (void)state;
  assert_repeated_is_refused("a: ", "[", 31, "not YAML");
  char *text = repeated("title: ", "[", 31, "]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]\n");
  assert_refused(text, strlen(text), NULL, 0, "s.yaml:1: ", "title = a list", "");
  free(text);
}

static void large_texts_are_refused(void **state) {
  (void)state;
  assert_repeated_is_refused("# ", "x", STUDY_MAX_BYTES, "bytes, expected at most");
}

/* Backslashes stand once in single quotes and twice in the double quotes of the text written out. */
static void studies_that_outgrow_the_limit_with_their_sets_are_refused(void **state) {
  (void)state;
  char *title = repeated("title: '", "\\", STUDY_MAX_BYTES * 3 / 4, "'");
  char *text = varied("title: one particle", title);
  study *s = parsed(text, NULL, 0);
  study_destroy(&s);
  const char *set = "model.gamma=1";
  assert_refused(text, strlen(text), &set, 1, "s.yaml: ", "when written out with its --set values", "8388608");
  free(text);
  free(title);
}

/* So many keys that comparing each with each would not end. */
static void large_mappings_are_read_without_comparing_each_key_with_each(void **state) {
  (void)state;
  enum { COUNT = 600000 };
  char *text = malloc(COUNT * 16);
  assert_non_null(text);
  char *end = text;
  for (int i = 0; i < COUNT; i++)
    end += sprintf(end, "k%d: 1\n", COUNT - i);
  assert_refused(text, strlen(text), NULL, 0, "s.yaml:1: ", "unknown key 'k600000'", "");
  free(text);
}

/* A million floors and a hundred thousand impacts: more than near linear work would not end. */
static void lists_of_a_million_elements_are_read(void **state) {
  (void)state;
  enum { COUNT = 1000000, HITS = 100000 };
  char *text = malloc(COUNT * 4 + HITS * 8 + 1000);
  assert_non_null(text);
  char *end = text + sprintf(text, "kind: orbits\nmodel:\n  {type: chain, particles: %d, gamma: 0.1, floor: [", COUNT);
  for (int i = 0; i < COUNT; i++)
    end += sprintf(end, "%s", i ? ",-1" : "-1");
  end += sprintf(end, "]}\norbit:\n  period: 2\n  at_start: [");
  for (int i = 0; i < HITS; i++)
    end += sprintf(end, "%s%d", i ? "," : "", COUNT - 1 - 7 * i);
  sprintf(end, "]\n");
  study *s = parsed(text, NULL, 0);
  study_values *v = study_values_create(s);
  assert_int_equal(value_count(v, KEY_MODEL_FLOOR), COUNT);
  assert_true(value_number(v, KEY_ORBIT_AT_START, HITS - 1) == COUNT - 1 - 7 * (HITS - 1));
  study_values_destroy(&v);
  study_destroy(&s);
  const char *set = "model.gamma=0.2";
  s = parsed(text, &set, 1);
  study *again = parsed(study_text(s), NULL, 0);
  assert_true(study_digest(s) == study_digest(again));
  study_destroy(&again);
  study_destroy(&s);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_truncation_is_a_study_or_a_refusal),
      cmocka_unit_test(mutations_are_studies_or_refusals),
      cmocka_unit_test(mutated_sets_are_applied_or_refused),
      cmocka_unit_test(deep_nesting_is_refused_at_any_length),
      cmocka_unit_test(nesting_within_the_limit_is_read),
      cmocka_unit_test(large_texts_are_refused),
      cmocka_unit_test(studies_that_outgrow_the_limit_with_their_sets_are_refused),
      cmocka_unit_test(large_mappings_are_read_without_comparing_each_key_with_each),
      cmocka_unit_test(lists_of_a_million_elements_are_read),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
