/* Texts of a result are as wide as the longest: rows in memory have room for any reason, and most results have none. */
#include <stdlib.h>
#include <string.h>

#include "../run/ranks.h"
#include "run.h"

enum { BLOCK_BYTES = 4 << 20 /* of rows read at a time; one row may be longer */ };

/* Columns with a text in every row. */
static bool is_fitted(const column *c) {
  return c->type == COLUMN_TEXT && column_axes(c) == 0;
}

static bool has_texts(const table *t) {
  for (size_t k = 0; k < t->column_count; k++)
    if (is_fitted(&t->columns[k]))
      return true;
  return false;
}

/* @param longest  [columns] bytes of the longest text so far */
static void measure(const table *t, const unsigned char *rows, uint64_t count, size_t *longest) {
  for (size_t k = 0; k < t->column_count; k++) {
    const column *c = &t->columns[k];
    for (uint64_t i = 0; is_fitted(c) && i < count; i++) {
      const size_t length = strnlen((const char *)rows + i * t->row_bytes + c->offset, c->text_bytes);
      longest[k] = length > longest[k] ? length : longest[k];
    }
  }
}

/* The blocks of this rank: every so many-th. */
static int measure_table(const result_table *from, size_t *longest, message *why) {
  const table *t = from->layout;
  const uint64_t fit = t->row_bytes < BLOCK_BYTES ? BLOCK_BYTES / t->row_bytes : 1;
  const uint64_t block = fit < from->rows ? fit : from->rows;
  unsigned char *rows = malloc(block * t->row_bytes + 1);
  if (!rows)
    return refuse(why, EXIT_RUN, "no memory for %llu rows", (unsigned long long)block);
  int code = 0;
  for (uint64_t first = block * (uint64_t)ranks_rank(); !code && first < from->rows;
       first += block * (uint64_t)ranks_count()) {
    const uint64_t count = from->rows - first < block ? from->rows - first : block;
    code = from->read(from->user, first, count, rows, why);
    if (!code)
      measure(t, rows, count, longest);
  }
  free(rows);
  return code;
}

static void fit(table *stored, const size_t *longest) {
  for (size_t k = 0; k < stored->column_count; k++)
    if (is_fitted(&stored->columns[k])) {
      const size_t all = (size_t)ranks_max((double)longest[k]);
      stored->columns[k].text_bytes = all > 0 ? all : 1;
    }
}

int fit_texts(result_table *tables, size_t count, table *stored, message *why) {
  int code = 0;
  for (size_t i = 0; !code && i < count; i++) {
    size_t longest[TABLE_MAX_COLUMNS] = {0};
    if (!has_texts(tables[i].layout) || tables[i].rows == 0)
      continue;
    code = ranks_agree(measure_table(&tables[i], longest, why), why);
    if (code)
      break;
    stored[i] = *tables[i].layout;
    fit(&stored[i], longest);
    tables[i].layout = &stored[i];
  }
  return code;
}
