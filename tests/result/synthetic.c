#include "synthetic.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fake_study.h"

static const char *const outcomes[] = {"admissible", "inadmissible", "grazing", "failed"};
static const char *const kinds[] = {"resonance", "zero"};

static column number(const char *name, const char *axis, size_t extent) {
  return (column){name, COLUMN_F64, {axis}, {extent}, 0, NULL, 0, "length", "a made-up number", "synthetic.c", 0};
}

static column block(const char *name, const char *axis, size_t extent, const char *other, size_t other_extent) {
  column c = number(name, axis, extent);
  c.axes[1] = other;
  c.extents[1] = other_extent;
  return c;
}

static column integer(const char *name) {
  return (column){name, COLUMN_I64, {NULL}, {0}, 0, NULL, 0, "1", "a made-up integer", "synthetic.c", 0};
}

static column word(const char *name, const char *const *names, size_t count) {
  return (column){name, COLUMN_ENUM, {NULL}, {0}, 0, names, count, "1", "a made-up verdict", "synthetic.c", 0};
}

static column text(const char *name, size_t bytes) {
  return (column){name, COLUMN_TEXT, {NULL}, {0}, bytes, NULL, 0, "", "a made-up remark", "synthetic.c", 0};
}

/* One value per value of the type's range that a reader could trip over: NaN, infinity, quotes, UTF-8, a full text. */
static void fill_numbers(unsigned char *row, const column *c, uint64_t task) {
  const size_t count = column_values(c);
  double *values = malloc((count + 1) * sizeof *values);
  for (size_t i = 0; values && i < count; i++)
    values[i] = sin((double)task + 0.001 * (double)i);
  if (values && count && task % 7 == 3)
    values[0] = -NAN;
  if (values && count && task % 7 == 4)
    values[0] = -INFINITY;
  if (values)
    row_put_numbers(row, c, values);
  free(values);
}

static void fill_text(unsigned char *row, const column *c, uint64_t task) {
  static const char *const texts[] = {"", "particle 3, \"at once\"", "caf\xc3\xa9", "0123456789abcdef0123456789abcdef"};
  row_put_text(row, c, texts[task % 4]);
}

static int fill_rows(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  const table *t = user;
  (void)why;
  for (uint64_t i = 0; i < count; i++)
    for (size_t k = 0; k < t->column_count; k++) {
      const column *c = &t->columns[k];
      unsigned char *row = rows + i * t->row_bytes;
      uint64_t task = first + i;
      if (c->type == COLUMN_F64)
        fill_numbers(row, c, task);
      else if (c->type == COLUMN_I64)
        row_put_integer(row, c, (long)task * 1000003 - 5);
      else if (c->type == COLUMN_ENUM)
        row_put_word(row, c, (int)(task * task % c->name_count));
      else
        fill_text(row, c, task);
    }
  return 0;
}

static void lay_out(synthetic *s, const synthetic_size *size) {
  s->layouts[0] =
      (table){.group = "orbits",
              .row_axis = "task",
              .columns = {word("outcome", outcomes, 4), text("reason", 32), number("energy", NULL, 1),
                          integer("clearance_particle"), number("q", "particle", size->particles),
                          number("v", "particle", size->particles), number("impulse", "impact", size->impacts),
                          block("path", "sample", 5, "particle", size->particles)},
              .column_count = 8};
  s->layouts[1] = (table){.group = "special",
                          .row_axis = "special_point",
                          .columns = {word("kind", kinds, 2), number("gamma", NULL, 1), text("remark", 32)},
                          .column_count = 3};
  s->layouts[2] =
      (table){.group = "nothing", .row_axis = "none", .columns = {number("value", NULL, 1)}, .column_count = 1};
}

int synthetic_init(synthetic *s, const synthetic_size *size, int ranks) {
  *s = (synthetic){.study = fake_study_create(size->gammas, size->floors, size->text_bytes)};
  if (!s->study)
    return 1;
  lay_out(s, size);
  const uint64_t rows[SYNTHETIC_TABLES] = {study_tasks(s->study), size->special, 0};
  for (int i = 0; i < SYNTHETIC_TABLES; i++) {
    table_lay_out(&s->layouts[i]);
    s->tables[i] = (result_table){&s->layouts[i], rows[i], fill_rows, &s->layouts[i]};
  }
  s->header = (result_header){.study = s->study,
                              .command = "ricochet run made-up.yaml",
                              .git_sha = "0123456",
                              .libraries = "",
                              .compiler = "GNU",
                              .version = "0.1.0",
                              .compute_seconds = 1.5,
                              .total_seconds = 2,
                              .ranks = ranks,
                              .tasks_computed = rows[0]};
  return 0;
}

void synthetic_clear(synthetic *s) {
  study_destroy(&s->study);
}
