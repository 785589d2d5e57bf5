/* Studies for the tests: a valid one, its variations, and what a refusal must say. */
#ifndef RICOCHET_TESTS_STUDY_CASES_H
#define RICOCHET_TESTS_STUDY_CASES_H

#include "support.h"

#include "kind/branch/branch.h"
#include "kind/diagram/diagram.h"
#include "kind/family/family_check.h"
#include "kind/kind.h"

/* Parses a text as a study of the program. */
static inline int read_study(const char *name, const char *text, size_t length, const char *const *sets, size_t n_sets,
                             study **out, message *why) {
  const study_source from = {
      .schema = &studies, .name = name, .text = text, .length = length, .sets = sets, .set_count = n_sets};
  return study_parse(&from, out, why);
}

/* Line numbers in the tests count from here. */
static const char base_study[] = "kind: orbits\n"               /* 1 */
                                 "title: one particle\n"        /* 2 */
                                 "model:\n"                     /* 3 */
                                 "  type: chain\n"              /* 4 */
                                 "  particles: 30\n"            /* 5 */
                                 "  ends: periodic\n"           /* 6 */
                                 "  gamma: 0.1\n"               /* 7 */
                                 "  floor: -1\n"                /* 8 */
                                 "  restitution: 1\n"           /* 9 */
                                 "orbit:\n"                     /* 10 */
                                 "  period: 1.5 pi\n"           /* 11 */
                                 "  at_start: [15, 3]\n"        /* 12 */
                                 "  at_half: [4]\n"             /* 13 */
                                 "  method: impulse\n"          /* 14 */
                                 "  states: true\n"             /* 15 */
                                 "  special_points: false\n"    /* 16 */
                                 "sweep:\n"                     /* 17 */
                                 "  - parameter: model.gamma\n" /* 18 */
                                 "    from: 0\n"                /* 19 */
                                 "    to: 0.187\n"              /* 20 */
                                 "    points: 15\n"             /* 21 */
                                 "    scale: linear\n";         /* 22 */

/* The base study with the first occurrence of `from` replaced; `from` NULL: just `to`. The caller frees. */
static inline char *varied(const char *from, const char *to) {
  const char *at = from ? strstr(base_study, from) : base_study;
  assert_non_null(at);
  const char *rest = from ? at + strlen(from) : base_study + strlen(base_study);
  const size_t head = (size_t)(at - base_study);
  const size_t size = head + strlen(to) + strlen(rest) + 1;
  char *text = malloc(size);
  assert_non_null(text);
  snprintf(text, size, "%.*s%s%s", (int)head, base_study, to, rest);
  return text;
}

static inline study *parsed(const char *text, const char *const *sets, size_t n_sets) {
  study *s = NULL;
  message why = {{0}};
  if (read_study("s.yaml", text, strlen(text), sets, n_sets, &s, &why) != 0)
    fail_msg("refused: %s\nstudy:\n%s", why.text, text);
  assert_non_null(s);
  return s;
}

static inline study *parsed_variation(const char *from, const char *to) {
  char *text = varied(from, to);
  study *s = parsed(text, NULL, 0);
  free(text);
  return s;
}

/* A refusal: its message begins with the place and contains the phrases. */
static inline void assert_refused(const char *text, size_t length, const char *const *sets, size_t n_sets,
                                  const char *place, const char *phrase, const char *other) {
  study *s = NULL;
  message why = {{0}};
  if (read_study("s.yaml", text, length, sets, n_sets, &s, &why) == 0)
    fail_msg("accepted, expected '%s ... %s':\n%.2000s", place, phrase, text);
  assert_null(s);
  if (strncmp(why.text, place, strlen(place)) != 0 || !strstr(why.text, phrase) || !strstr(why.text, other))
    fail_msg("message '%s', expected '%s' and '%s' and '%s'", why.text, place, phrase, other);
  assert_null(strchr(why.text, '\n'));
}

typedef struct refusal {
  const char *from, *to;      /* variation of the base study */
  const char *place, *phrase; /* begin of the message, and what it contains */
  const char *other;          /* another phrase, NULL for none */
} refusal;

static inline void assert_all_refused(const refusal *cases, size_t count) {
  for (size_t i = 0; i < count; i++) {
    char *text = varied(cases[i].from, cases[i].to);
    assert_refused(text, strlen(text), NULL, 0, cases[i].place, cases[i].phrase, cases[i].other ? cases[i].other : "");
    free(text);
  }
}

#define ASSERT_ALL_REFUSED(cases) assert_all_refused((cases), sizeof(cases) / sizeof *(cases))

#endif
