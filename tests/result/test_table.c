/* Rows of tables: from a struct to bytes and back, by the members that columns name. */
#include <ricochet/multipliers.h>

#include "support.h"
#include "base/table.h"

static const char *const colours[] = {"red", "green", "blue"};

typedef struct sample {
  double energy;
  long long particle;
  ric_complex multiplier;
  int colour;
  const char *reason;
  double *q;
  int64_t *periods;
  unsigned char *kinds;
  double absent;
} sample;

static const column columns[] = {
    {.name = "energy", NUMBER(sample, energy)},
    {.name = "particle", INTEGER(sample, particle)},
    {.name = "multiplier", COMPLEX(sample, multiplier), .units = "kg"},
    {.name = "colour", WORD(sample, colour, colours)},
    {.name = "reason", TEXT(sample, reason, 8)},
    {.name = "q", NUMBERS(sample, q), .axes = {"particle"}},
    {.name = "periods", INTEGERS(sample, periods), .axes = {"window"}},
    {.name = "kinds", WORDS(sample, kinds, colours), .axes = {"window"}},
    {.name = "absent", NUMBER(sample, absent), .axes = {"nowhere"}},
};

static table laid_out(void) {
  const table_axis axes[] = {{"particle", 3}, {"window", 2}};
  table t = {0};
  table_add(&t, &(column_list){"samples", "task", COLUMNS(columns)}, axes, 2);
  table_lay_out(&t);
  return t;
}

/* A row that points to what holds its numbers. */
typedef struct pointing {
  const sample *of;
  double own;
} pointing;

static void columns_of_what_a_row_points_to_are_written(void **state) {
  (void)state;
  static const column list[] = {{.name = "own", NUMBER(pointing, own)},
                                {.name = "energy", NUMBER(sample, energy), OF(pointing, of)},
                                {.name = "reason", TEXT(sample, reason, 8), OF(pointing, of)},
                                {.name = "q", NUMBERS(sample, q), .axes = {"particle"}, OF(pointing, of)}};
  const table_axis axis = {"particle", 2};
  table t = {0};
  double row[5];
  table_add(&t, &(column_list){"samples", "task", COLUMNS(list)}, &axis, 1);
  assert_int_equal(table_lay_out(&t), sizeof row);
  const sample of = {.energy = 3, .reason = "why", .q = (double[]){-1, 4}};
  row_fill(&t, (unsigned char *)row, &(pointing){.of = &of, .own = 0.5});
  assert_memory_equal(row, ((double[]){0.5, 3}), 2 * sizeof *row);
  assert_memory_equal(row + 2, "why\0\0\0\0", 8);
  assert_memory_equal(row + 3, ((double[]){-1, 4}), 2 * sizeof *row);
  pointing back = {.of = &of};
  row_load(&t, (unsigned char *)row, &back);
  assert_true(back.of == &of && back.own == 0.5);
}

static const double positions[] = {0.5, -1, 7};
static const int64_t periods[] = {4, -9};
static const unsigned char kinds[] = {2, 1};

static void what_is_stored_is_loaded(void **state) {
  (void)state;
  const table t = laid_out();
  double row[32];
  assert_true(t.row_bytes <= sizeof row);
  const sample in = {.energy = -2.5,
                     .particle = -7,
                     .multiplier = {0.25, -3},
                     .colour = 2,
                     .reason = "because of it", /* longer than the column */
                     .q = (double[]){0.5, -1, 7},
                     .periods = (int64_t[]){4, -9},
                     .kinds = (unsigned char[]){2, 1}};
  sample out = {.absent = 11};
  memset(row, 0xff, sizeof row);
  row_fill(&t, (unsigned char *)row, &in);
  row_load(&t, (unsigned char *)row, &out);
  assert_true(out.energy == -2.5 && out.particle == -7 && out.colour == 2);
  assert_true(out.multiplier.re == 0.25 && out.multiplier.im == -3);
  assert_memory_equal(out.reason, "because ", 8);
  assert_memory_equal(out.q, positions, sizeof positions);
  assert_memory_equal(out.periods, periods, sizeof periods);
  assert_memory_equal(out.kinds, kinds, sizeof kinds);
  assert_true(out.absent == 11); /* a member without a column stays */
}

static void several_values_are_filled_in_their_places(void **state) {
  (void)state;
  const table t = laid_out();
  double row[32] = {0};
  sample first = {0}, again = {0};
  row_load(&t, (unsigned char *)row, &first);
  memcpy(first.q, positions, sizeof positions);
  first.reason = "";
  first.periods = NULL; /* left alone */
  row_store(&t, (unsigned char *)row, &first);
  row_load(&t, (unsigned char *)row, &again);
  assert_ptr_equal(again.q, first.q);
  assert_memory_equal(again.q, positions, sizeof positions);
  assert_int_equal(again.periods[0], 0);
  assert_int_equal(again.reason[0], 0);
}

static void rows_have_no_bytes_of_what_was_there(void **state) {
  (void)state;
  const table t = laid_out();
  double a[32], b[32];
  const sample in = {.reason = "x", .q = (double[]){1, 2, 3}};
  memset(a, 0xff, sizeof a);
  memset(b, 0x55, sizeof b);
  row_fill(&t, (unsigned char *)a, &in);
  row_fill(&t, (unsigned char *)b, &in);
  assert_memory_equal(a, b, t.row_bytes);
}

static void layouts_leave_out_what_has_no_axis_and_say_their_size(void **state) {
  (void)state;
  const table t = laid_out();
  assert_string_equal(t.group, "samples");
  assert_string_equal(t.row_axis, "task");
  assert_int_equal(t.column_count, 8);
  assert_null(table_column(&t, "absent"));
  assert_string_equal(table_column(&t, "energy")->units, "1");
  assert_string_equal(table_column(&t, "multiplier")->units, "kg");
  assert_int_equal(t.row_bytes, 8 + 8 + 16 + 8 + 8 + 24 + 16 + 8);
  assert_true(table_row_bytes(&t) == (double)t.row_bytes);
  for (size_t i = 0; i < t.column_count; i++)
    assert_int_equal(t.columns[i].offset % 8, 0);
}

/* Extents whose product does not fit into a size. */
static void sizes_do_not_overflow(void **state) {
  (void)state;
  table t = {0};
  const column wide[] = {{.name = "q", NUMBERS(sample, q), .axes = {"a", "b"}}};
  const column_list list = {"samples", "task", COLUMNS(wide)};
  table_add(&t, &list, (table_axis[]){{"a", (size_t)1 << 40}, {"b", (size_t)1 << 40}}, 2);
  assert_true(table_row_bytes(&t) == ldexp(1, 83));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(columns_of_what_a_row_points_to_are_written),
      cmocka_unit_test(what_is_stored_is_loaded),
      cmocka_unit_test(several_values_are_filled_in_their_places),
      cmocka_unit_test(rows_have_no_bytes_of_what_was_there),
      cmocka_unit_test(layouts_leave_out_what_has_no_axis_and_say_their_size),
      cmocka_unit_test(sizes_do_not_overflow),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
