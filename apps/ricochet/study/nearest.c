/* The known name nearest to a mistyped one. */
#include "schema.h"

#include <stdio.h>
#include <string.h>

enum { LONGEST_NAME = 63 }; /* longer ones are close to no name of the schema */

static size_t least(size_t a, size_t b) {
  return a < b ? a : b;
}

/* Edit distance of two names of at most LONGEST_NAME characters: insertions, deletions, replacements, and swaps of
 * neighbours, each counting once (optimal string alignment). Row i holds the distances of the first i characters. */
static size_t edit_distance(const char *a, const char *b) {
  size_t table[LONGEST_NAME + 1][LONGEST_NAME + 1];
  const size_t rows = strlen(a), columns = strlen(b);
  for (size_t j = 0; j <= columns; j++)
    table[0][j] = j;
  for (size_t i = 1; i <= rows; i++) {
    table[i][0] = i;
    for (size_t j = 1; j <= columns; j++) {
      const size_t replaced = table[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      table[i][j] = least(replaced, 1 + least(table[i - 1][j], table[i][j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        table[i][j] = least(table[i][j], table[i - 2][j - 2] + 1);
    }
  }
  return table[rows][columns];
}

static const char *last_name(const char *path) {
  const char *dot = strrchr(path, '.');
  return dot ? dot + 1 : path;
}

/* Distance of two paths: of the whole paths, or of their last names plus one for a name in the wrong section. */
static size_t path_distance(const char *path, const char *known) {
  return least(edit_distance(path, known), edit_distance(last_name(path), last_name(known)) + 1);
}

typedef struct search {
  const char *path;
  char best[LONGEST_NAME + 1];
  size_t distance; /* twice the edit distance, plus 1 in another section */
} search;

static bool in_one_section(const char *a, const char *b) {
  const size_t length = strcspn(a, ".");
  return strcspn(b, ".") == length && strncmp(a, b, length) == 0;
}

/* Among names at equal distance, one in the same section is preferred. */
static void consider(search *s, const char *known) {
  const size_t distance = 2 * path_distance(s->path, known) + !in_one_section(s->path, known);
  if (distance < s->distance) {
    snprintf(s->best, sizeof s->best, "%s", known);
    s->distance = distance;
  }
}

static void consider_section(const char *name, size_t length, void *user) {
  char known[LONGEST_NAME + 1];
  snprintf(known, sizeof known, "%.*s", (int)length, name);
  consider(user, known);
}

/* Up to a third of the name may be wrong; beyond that no name is suggested. */
static search begin(const char *path) {
  const size_t third = strlen(last_name(path)) / 3;
  return (search){.path = path, .distance = 2 * (1 + (third > 1 ? third : 1))};
}

static void finish(const search *s, char *near, size_t size) {
  snprintf(near, size, "%s", s->best);
}

void schema_nearest(const schema *t, const char *path, char *near, size_t size) {
  search s = begin(path);
  if (strlen(path) <= LONGEST_NAME) {
    for (size_t i = 0; i < t->key_count; i++)
      consider(&s, t->keys[i]->path);
    for (int key = 0; key < SWEEP_KEY_COUNT; key++)
      consider(&s, schema_sweep_row((sweep_key)key)->path);
    schema_sections(t, consider_section, &s);
  }
  finish(&s, near, size);
}

void schema_nearest_parameter(const schema *t, const char *path, char *near, size_t size) {
  search s = begin(path);
  for (size_t i = 0; i < t->key_count && strlen(path) <= LONGEST_NAME; i++)
    if (t->keys[i]->sweep)
      consider(&s, t->keys[i]->path);
  finish(&s, near, size);
}
