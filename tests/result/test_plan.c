/* How data sets are cut: chunks within bounds, and never shared by two blocks of rows. */
#include "result/plan.h"
#include "support.h"

static table one_column(column_type type, size_t extent, size_t text_bytes, size_t other_bytes) {
  table t = {.group = "g", .row_axis = "task", .column_count = 2};
  t.columns[0] = (column){.name = "a", .type = type, .axes = {"x"}, .extents = {extent}, .text_bytes = text_bytes};
  t.columns[1] = (column){.name = "b", .type = COLUMN_TEXT, .text_bytes = other_bytes};
  table_lay_out(&t);
  return t;
}

static void chunks_are_bounded_and_divide_blocks(void **state) {
  (void)state;
  const size_t extents[] = {0, 1, 2, 3, 30, 1000, 131072, 131073, 1000000}, others[] = {1, 100, 5000, 3 << 20};
  const uint64_t rows[] = {0, 1, 2, 15, 1000, 10000000};
  for (size_t i = 0; i < sizeof extents / sizeof *extents; i++)
    for (size_t j = 0; j < sizeof others / sizeof *others; j++)
      for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        table t = one_column(COLUMN_F64, extents[i], 0, others[j]);
        uint64_t chunk[PLAN_MOST_AXES], block = plan_block_rows(&t);
        plan_chunk(&t, &t.columns[0], rows[k], chunk);
        assert_true(chunk[0] >= 1 && chunk[1] >= 1);
        assert_true(chunk[0] <= rows[k] || rows[k] == 0);
        assert_true(chunk[1] <= extents[i] || extents[i] == 0);
        assert_true(chunk[0] * chunk[1] * 8 <= PLAN_CHUNK_BYTES);
        assert_true(block % chunk[0] == 0 || chunk[0] == rows[k]);
        assert_true(block >= chunk[0]);
        assert_true(block == 1 || block * t.row_bytes <= PLAN_BLOCK_BYTES);
      }
}

static void chunks_of_three_axes_are_bounded_and_divide_blocks(void **state) {
  (void)state;
  const size_t samples[] = {0, 1, 7, 2001, 500000}, particles[] = {0, 1, 30, 1000, 200000};
  const uint64_t rows[] = {0, 1, 15, 100000};
  for (size_t i = 0; i < sizeof samples / sizeof *samples; i++)
    for (size_t j = 0; j < sizeof particles / sizeof *particles; j++)
      for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        table t = one_column(COLUMN_F64, samples[i], 0, 100);
        t.columns[0].axes[1] = "y";
        t.columns[0].extents[1] = particles[j];
        table_lay_out(&t);
        uint64_t chunk[PLAN_MOST_AXES], block = plan_block_rows(&t);
        plan_chunk(&t, &t.columns[0], rows[k], chunk);
        assert_true(chunk[0] >= 1 && chunk[1] >= 1 && chunk[2] >= 1);
        assert_true(chunk[0] <= rows[k] || rows[k] == 0);
        assert_true(chunk[1] <= samples[i] || samples[i] == 0);
        assert_true(chunk[2] <= particles[j] || particles[j] == 0);
        assert_true(chunk[0] * chunk[1] * chunk[2] * 8 <= PLAN_CHUNK_BYTES);
        assert_true(block % chunk[0] == 0 || chunk[0] == rows[k]);
      }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(chunks_are_bounded_and_divide_blocks),
                                     cmocka_unit_test(chunks_of_three_axes_are_bounded_and_divide_blocks)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
