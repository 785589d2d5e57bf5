/* What `show` prints about the first tasks of a result of kind `grazing`, in sentences. */
#include "grazing.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "result/reader.h"

enum {
  CARDS_SHOWN = 5,
  MULTIPLIERS_SHOWN = 4,
  COEFFICIENTS_SHOWN = 6,
  WINDOWS_SHOWN = 6,
  DIGITS = 6,        /* of explanations */
  DIGITS_WHERE = 12, /* of parameters */
  TEXT = 320
};

/* The state of a card: after the first failure nothing more is read. */
typedef struct card {
  const file_place *at;
  const reader_group *sweep, *group;
  uint64_t task;
  int code;
} card;

static const reader_set *find(const card *k, const char *name) {
  return reader_find(k->group, name);
}

/* A value of the task as text; "" when it cannot be read. */
static const char *text_of(card *k, const reader_set *s, int digits, char *text) {
  *text = '\0';
  if (!k->code)
    k->code = reader_cell(k->at, s, k->task, digits, text, TEXT);
  return text;
}

static const char *named(card *k, const char *name, int digits, char *text) {
  return text_of(k, find(k, name), digits, text);
}

static bool says(card *k, const char *name, const char *word) {
  char text[TEXT];
  return strcmp(named(k, name, DIGITS, text), word) == 0;
}

static double number(card *k, const char *name) {
  char text[TEXT];
  return strtod(named(k, name, 17, text), NULL);
}

/* The values of a row with one further axis, to be freed; NULL where there is none of that type. */
static unsigned char *row_of(card *k, const char *name, reader_type type, const reader_set **set, size_t *count) {
  const reader_set *s = *set = find(k, name);
  *count = 0;
  if (!s || s->type != type || s->rank != 2 || s->shape[0] <= k->task || s->shape[1] == 0 || k->code)
    return NULL;
  unsigned char *values = calloc(s->shape[1], s->value_bytes);
  if (!values)
    k->code = refuse(k->at->why, EXIT_RUN, "%s: out of memory", k->at->path);
  else
    k->code = reader_rows(k->at, s, k->task, 1, values);
  *count = k->code ? 0 : (size_t)s->shape[1];
  return values;
}

/* A real value is printed without its imaginary part. */
static void print_value(const reader_set *s, const unsigned char *value, const char *before) {
  char text[TEXT], imaginary[TEXT];
  reader_part(s, value, reader_parts(s) - 1, DIGITS, imaginary, sizeof imaginary);
  if (s->type == READER_COMPLEX && strtod(imaginary, NULL) == 0)
    reader_part(s, value, 0, DIGITS, text, sizeof text);
  else
    reader_value(s, value, DIGITS, text, sizeof text);
  printf("%s%s", before, text);
}

static void print_row(card *k, const char *name, reader_type type, size_t most) {
  const reader_set *s;
  size_t count;
  unsigned char *values = row_of(k, name, type, &s, &count);
  for (size_t i = 0; i < count && i < most; i++) {
    print_value(s, values + i * s->value_bytes, i ? ", " : "");
  }
  printf("%s\n", count > most ? ", ..." : "");
  free(values);
}

/* --- the windows --- */

/* The windows of the task, by columns. */
typedef struct window_columns {
  unsigned char *period, *exists, *edges[2], *kinds[2], *predicted[2];
  const reader_set *word; /* of the kinds */
  size_t count;           /* of windows with values in all columns */
} window_columns;

static double at_place(const unsigned char *values, size_t i) {
  double value;
  memcpy(&value, values + i * sizeof value, sizeof value);
  return value;
}

static unsigned char *column_of(card *k, window_columns *w, const char *name, reader_type type) {
  const reader_set *s;
  size_t count;
  unsigned char *values = row_of(k, name, type, &s, &count);
  w->count = count < w->count ? count : w->count;
  w->word = type == READER_WORD ? s : w->word;
  return values;
}

static void read_windows(card *k, window_columns *w) {
  static const char *const edges[] = {"window_low", "window_high"};
  static const char *const kinds[] = {"window_low_kind", "window_high_kind"};
  static const char *const predicted[] = {"predicted_flip_d", "predicted_border_d"};
  w->count = SIZE_MAX;
  w->period = column_of(k, w, "window_period", READER_INTEGER);
  w->exists = column_of(k, w, "window_exists", READER_WORD);
  for (int e = 0; e < 2; e++) {
    w->edges[e] = column_of(k, w, edges[e], READER_NUMBER);
    w->predicted[e] = column_of(k, w, predicted[e], READER_NUMBER);
    w->kinds[e] = column_of(k, w, kinds[e], READER_WORD);
  }
}

static void print_window(const window_columns *w, size_t i, double parameter, double slope) {
  int64_t period;
  char kinds[2][TEXT];
  memcpy(&period, w->period + i * sizeof period, sizeof period);
  for (int e = 0; e < 2; e++)
    reader_value(w->word, w->kinds[e] + i * w->word->value_bytes, DIGITS, kinds[e], TEXT);
  printf("    period %" PRId64 ": %.*g (%s) to %.*g (%s)", period, DIGITS_WHERE, at_place(w->edges[0], i), kinds[0],
         DIGITS_WHERE, at_place(w->edges[1], i), kinds[1]);
  const double flip = at_place(w->predicted[0], i), border = at_place(w->predicted[1], i);
  if (flip < border) /* not above lambda = 2/3, where the limit map has no window, and not NaN */
    printf("; to leading order %.*g to %.*g", DIGITS_WHERE, parameter - flip / slope, DIGITS_WHERE,
           parameter - border / slope);
  printf("\n");
}

static void print_windows(card *k, const char *followed) {
  window_columns w = {0};
  size_t shown = 0;
  const double parameter = number(k, "parameter"), slope = number(k, "slope");
  read_windows(k, &w);
  for (size_t i = 0; !k->code && i < w.count && shown < WINDOWS_SHOWN; i++) {
    if (!w.exists[i])
      continue;
    if (shown++ == 0)
      printf("  windows of the return map along %s, in which motions with one impact are stable, by their periods:\n",
             followed);
    print_window(&w, i, parameter, slope);
  }
  free(w.period);
  free(w.exists);
  for (int e = 0; e < 2; e++) {
    free(w.edges[e]);
    free(w.kinds[e]);
    free(w.predicted[e]);
  }
}

/* --- the card --- */

static void print_heading(card *k) {
  char text[TEXT];
  printf("\ntask %" PRIu64, (uint64_t)k->task);
  for (size_t i = 0; i < k->sweep->count; i++)
    printf("%s %s = %s", i ? "," : ":", k->sweep->sets[i].name, text_of(k, &k->sweep->sets[i], DIGITS_WHERE, text));
  printf("\n");
}

static void print_where(card *k, const char *followed) {
  char a[TEXT], b[TEXT], c[TEXT];
  printf("  grazes at %s = %s: ", followed, named(k, "parameter", DIGITS_WHERE, a));
  printf("the %s of particle %s, at t = %s", named(k, "side", DIGITS, a), named(k, "particle", DIGITS, b),
         named(k, "time", DIGITS, c));
  printf(", phase %s of the period %s\n", named(k, "phase", DIGITS, a), named(k, "period", DIGITS, b));
  printf("  A_g = %s, restitution %s\n", named(k, "A_g", DIGITS, a), named(k, "restitution", DIGITS, b));
}

static void print_verdict(card *k) {
  static const char *const regimes[][2] = {
      {"chaos", "chaos follows at once (lambda > 2/3)"},
      {"windows", "windows of rising periods follow, with chaos between them (1/4 < lambda < 2/3)"},
      {"overlap", "windows of rising periods follow, which overlap (lambda < 1/4)"},
      {"border", "lambda lies at the border of two regimes, 1/4 or 2/3"}};
  char verdict[TEXT], text[TEXT];
  printf("  %s", named(k, "verdict", DIGITS, verdict));
  if (strcmp(verdict, "continuous") == 0)
    printf(": all coefficients c_i are positive, as those up to c_%s prove\n", named(k, "settled", DIGITS, text));
  else
    printf(": %s\n", named(k, "verdict_reason", DIGITS, text));
  printf("  c_0, c_1, ...: ");
  print_row(k, "coefficient", READER_NUMBER, COEFFICIENTS_SHOWN);
  for (size_t i = 0; i < sizeof regimes / sizeof *regimes; i++)
    if (says(k, "regime", regimes[i][0]))
      printf("  regime %s: %s\n", regimes[i][0], regimes[i][1]);
}

static void print_card(card *k) {
  char outcome[TEXT], reason[TEXT];
  const reader_set *parameter = find(k, "parameter");
  const char *followed = parameter ? reader_parameter(parameter) : "the parameter";
  print_heading(k);
  named(k, "outcome", DIGITS, outcome);
  if (strcmp(outcome, "grazing") != 0) {
    printf("  %s: %s\n", outcome, named(k, "reason", DIGITS, reason));
    return;
  }
  print_where(k, followed);
  printf("  multipliers of L: ");
  print_row(k, "multipliers", READER_COMPLEX, MULTIPLIERS_SHOWN);
  print_verdict(k);
  print_windows(k, followed);
}

static int print_cards(const file_place *at, const reader_group *sweep, const reader_group *group) {
  card k = {.at = at, .sweep = sweep, .group = group};
  const reader_set *outcome = find(&k, "outcome");
  const uint64_t tasks = outcome && outcome->rank == 1 ? outcome->shape[0] : 0;
  for (; !k.code && k.task < tasks && k.task < CARDS_SHOWN; k.task++)
    print_card(&k);
  if (!k.code && tasks > CARDS_SHOWN)
    printf("\n... %" PRIu64 " more tasks\n", (uint64_t)(tasks - CARDS_SHOWN));
  return k.code;
}

int grazing_show(const file_place *at, reader_handle file) {
  reader_group sweep = {0}, group = {0};
  int code = reader_group_open(at, file, "grazing", &group);
  if (!code && reader_has(file, "sweep"))
    code = reader_group_open(at, file, "sweep", &sweep);
  if (!code)
    code = print_cards(at, &sweep, &group);
  reader_group_clear(&group);
  reader_group_clear(&sweep);
  return code;
}
