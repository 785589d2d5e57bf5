#include "synthetic.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fake_study.h"

static const char *const outcomes[] = {"admissible", "inadmissible", "grazing", "failed"};
static const char *const kinds[] = {"resonance", "zero"};

static column made_up(const char *name, column_type type, const char *units, const char *what) {
  return (column){.name = name, .type = type, .units = units, .long_name = what, .source = "synthetic.c"};
}

static column along(column c, const char *axis, size_t extent) {
  const int k = column_axes(&c);
  c.axes[k] = axis;
  c.extents[k] = extent;
  return c;
}

static column number(const char *name) {
  return made_up(name, COLUMN_F64, "length", "a made-up number");
}

static column complex_number(const char *name) {
  return made_up(name, COLUMN_COMPLEX, "1", "a made-up complex number");
}

static column integer(const char *name) {
  return made_up(name, COLUMN_I64, "1", "a made-up integer");
}

static column word(const char *name, const char *const *names, size_t count) {
  column c = made_up(name, COLUMN_ENUM, "1", "a made-up verdict");
  c.names = names;
  c.name_count = count;
  return c;
}

static column text(const char *name, size_t bytes) {
  column c = made_up(name, COLUMN_TEXT, "", "a made-up remark");
  c.text_bytes = bytes;
  return c;
}

/* One value per value of the type's range that a reader could trip over: NaN, infinity, quotes, UTF-8, a full text. */
static void fill_numbers(unsigned char *row, const column *c, uint64_t task) {
  const size_t count = column_bytes(c) / sizeof(double); /* two for each complex number */
  double *values = malloc((count + 1) * sizeof *values);
  for (size_t i = 0; values && i < count; i++)
    values[i] = sin((double)task + 0.001 * (double)i);
  if (values && count && task % 7 == 3)
    values[0] = -NAN;
  if (values && count && task % 7 == 4)
    values[0] = -INFINITY;
  if (values)
    memcpy(row + c->offset, values, count * sizeof *values);
  free(values);
}

static void fill_text(unsigned char *row, const column *c, uint64_t task) {
  static const char *const texts[] = {"", "particle 3, \"at once\"", "caf\xc3\xa9", "0123456789abcdef0123456789abcdef"};
  const char *text = texts[task % 4];
  memcpy(row + c->offset, text, strnlen(text, c->text_bytes));
}

static int fill_rows(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  const table *t = user;
  (void)why;
  memset(rows, 0, count * t->row_bytes);
  for (uint64_t i = 0; i < count; i++)
    for (size_t k = 0; k < t->column_count; k++) {
      const column *c = &t->columns[k];
      unsigned char *row = rows + i * t->row_bytes;
      uint64_t task = first + i;
      if (c->type == COLUMN_F64 || c->type == COLUMN_COMPLEX)
        fill_numbers(row, c, task);
      else if (c->type == COLUMN_I64)
        memcpy(row + c->offset, &(int64_t){(int64_t)task * 1000003 - 5}, sizeof(int64_t));
      else if (c->type == COLUMN_ENUM)
        row[c->offset] = (unsigned char)(task * task % c->name_count);
      else
        fill_text(row, c, task);
    }
  return 0;
}

static void lay_out(synthetic *s, const synthetic_size *size) {
  const size_t n = size->particles;
  const column orbits[] = {word("outcome", outcomes, 4),
                           text("reason", 32),
                           number("energy"),
                           integer("clearance_particle"),
                           along(number("q"), "particle", n),
                           along(number("v"), "particle", n),
                           along(number("impulse"), "impact", size->impacts),
                           along(along(number("path"), "sample", 5), "particle", n),
                           along(complex_number("multipliers"), "multiplier", 2 * n)};
  const column special[] = {word("kind", kinds, 2), number("gamma"), complex_number("multiplier"), text("remark", 32)};
  const column nothing[] = {number("value"), complex_number("other")};
  const column *const lists[SYNTHETIC_TABLES] = {orbits, special, nothing};
  const size_t counts[SYNTHETIC_TABLES] = {sizeof orbits / sizeof *orbits, sizeof special / sizeof *special, 2};
  s->layouts[0] = (table){.group = "orbits", .row_axis = "task"};
  s->layouts[1] = (table){.group = "special", .row_axis = "special_point"};
  s->layouts[2] = (table){.group = "nothing", .row_axis = "none"};
  for (int i = 0; i < SYNTHETIC_TABLES; i++) {
    memcpy(s->layouts[i].columns, lists[i], counts[i] * sizeof *lists[i]);
    s->layouts[i].column_count = counts[i];
  }
  table_put_attribute(&s->layouts[0], "outcome", "tolerance", 1e-6);
  table_put_attribute(&s->layouts[0], "outcome", "band", 0.25);
  table_put_parameter(&s->layouts[1], "gamma", "model.gamma");
  table_put_text(&s->layouts[0], "energy", "observed", "q0");
}

int synthetic_init(synthetic *s, const synthetic_size *size, int ranks) {
  *s = (synthetic){.study = fake_study_create(size->gammas, size->floors, size->text_bytes, size->list)};
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

int synthetic_write(const char *path, size_t list) {
  synthetic s;
  message why;
  int code = synthetic_init(&s, &(synthetic_size){5, 4, 6, 0, 50, 300, list}, 1);
  if (!code)
    code = result_write(path, &s.header, s.tables, SYNTHETIC_TABLES, NULL, &why);
  synthetic_clear(&s);
  return code;
}

result_card *synthetic_card(const char *group) {
  (void)group;
  return NULL;
}
