/* What `show` prints about the attractors of diagrams and basins, in sentences. */
#include "diagram.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "result/reader.h"

enum {
  BLOCK = 4096,       /* rows read at a time */
  LONGEST = 64,       /* periods that are counted one by one */
  PERIODS_SHOWN = 12, /* of them, the shortest first */
  ROWS_SHOWN = 12,    /* of windows and attractors */
  DIGITS = 9,
  CELL = 128
};

static bool is_column(const reader_set *s, reader_type type) {
  return s && s->type == type && s->rank == 1;
}

/* --- how many tasks have which period ----------------------------------------------------------------------------- */

static int count_periods(const file_place *at, const reader_set *periods, uint64_t *counts) {
  int64_t values[BLOCK];
  for (uint64_t first = 0; first < periods->shape[0]; first += BLOCK) {
    const uint64_t count = periods->shape[0] - first < BLOCK ? periods->shape[0] - first : BLOCK;
    const int code = reader_rows(at, periods, first, count, (unsigned char *)values);
    if (code)
      return code;
    for (uint64_t i = 0; i < count; i++)
      counts[values[i] < 0 ? 0 : values[i] <= LONGEST ? values[i] : LONGEST + 1]++;
  }
  return 0;
}

/* "periods: 4 in 37, 5 in 191; longer ones in 3; none in 369 of 600 tasks" */
static int print_periods(const file_place *at, const reader_group *g) {
  const reader_set *periods = reader_find(g, "attractor_period");
  uint64_t counts[LONGEST + 2] = {0}, longer = 0;
  int shown = 0;
  if (!is_column(periods, READER_INTEGER))
    return 0;
  const int code = count_periods(at, periods, counts);
  if (code)
    return code;
  printf("\nperiods:");
  for (size_t p = 1; p <= LONGEST + 1; p++) {
    if (counts[p] > 0 && p <= LONGEST && shown < PERIODS_SHOWN)
      printf("%s %zu in %" PRIu64, shown++ ? "," : "", p, counts[p]);
    else
      longer += counts[p];
  }
  if (longer > 0)
    printf("%s longer ones in %" PRIu64, shown ? ";" : "", longer);
  if (counts[0] > 0)
    printf("%s none in %" PRIu64, shown || longer > 0 ? ";" : "", counts[0]);
  printf(" of %" PRIu64 " tasks\n", periods->shape[0]);
  return 0;
}

/* --- rows of windows and of attractors ---------------------------------------------------------------------------- */

/* "  task 181: period 5, 1 impact: 0.00429471273 (flip) to 0.0138888889 (border)" */
static int print_window(const file_place *at, const reader_group *g, uint64_t row) {
  static const char *const names[] = {"period", "impacts", "low", "low_kind", "high", "high_kind", "reason", "task"};
  char cells[8][CELL];
  for (size_t i = 0; i < 8; i++) {
    const int code = reader_cell(at, reader_find(g, names[i]), row, DIGITS, cells[i], CELL);
    if (code)
      return code;
  }
  printf("  task %s: period %s", cells[7], cells[0]);
  if (strcmp(cells[1], "-1") == 0)
    printf(": not located, %s\n", cells[6]);
  else
    printf(", %s impact%s: %s (%s) to %s (%s)\n", cells[1], strcmp(cells[1], "1") == 0 ? "" : "s", cells[2], cells[3],
           cells[4], cells[5]);
  return 0;
}

/* "  attractor 0, of period 3: 800 starts, the first of them task 0" */
static int print_attractor(const file_place *at, const reader_group *g, uint64_t row) {
  char period[CELL], tasks[CELL], first[CELL];
  int code = reader_cell(at, reader_find(g, "found_period"), row, DIGITS, period, CELL);
  if (!code)
    code = reader_cell(at, reader_find(g, "found_tasks"), row, DIGITS, tasks, CELL);
  if (!code)
    code = reader_cell(at, reader_find(g, "found_first"), row, DIGITS, first, CELL);
  if (code)
    return code;
  printf("  attractor %" PRIu64 ", ", row);
  if (strcmp(period, "0") == 0)
    printf("without a period");
  else
    printf("of period %s", period);
  printf(": %s starts, the first of them task %s\n", tasks, first);
  return 0;
}

typedef int row_printer(const file_place *at, const reader_group *g, uint64_t row);

static int print_rows(const file_place *at, const reader_group *g, const char *counted, const char *heading,
                      row_printer *print) {
  const reader_set *s = reader_find(g, counted);
  const uint64_t rows = is_column(s, READER_INTEGER) ? s->shape[0] : 0;
  int code = 0;
  if (rows > 0)
    printf("%s\n", heading);
  for (uint64_t i = 0; !code && i < rows && i < ROWS_SHOWN; i++)
    code = print(at, g, i);
  if (!code && rows > ROWS_SHOWN)
    printf("  ... %" PRIu64 " more\n", rows - ROWS_SHOWN);
  return code;
}

/* --- the card ----------------------------------------------------------------------------------------------------- */

static int print_windows(const file_place *at, reader_handle file) {
  reader_group windows = {0};
  if (!reader_has(file, "window"))
    return 0;
  int code = reader_group_open(at, file, "window", &windows);
  if (!code)
    code =
        print_rows(at, &windows, "period", "windows along the last sweep, in which a cycle is stable:", print_window);
  reader_group_clear(&windows);
  return code;
}

static int show_group(const file_place *at, reader_handle file, const char *name) {
  reader_group group = {0};
  int code = reader_group_open(at, file, name, &group);
  if (!code)
    code = print_periods(at, &group);
  if (!code)
    code = print_rows(at, &group, "found_period", "attractors that starts come to:", print_attractor);
  reader_group_clear(&group);
  return code;
}

int diagram_show(const file_place *at, reader_handle file) {
  const int code = show_group(at, file, "diagram");
  return code ? code : print_windows(at, file);
}

int basin_show(const file_place *at, reader_handle file) {
  return show_group(at, file, "basin");
}
