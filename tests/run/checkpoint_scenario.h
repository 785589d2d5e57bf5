/* Checkpoints with rows whose content follows from the number of their task, so that a row read back tells whether it
 * is the right one. */
#ifndef RICOCHET_TESTS_CHECKPOINT_SCENARIO_H
#define RICOCHET_TESTS_CHECKPOINT_SCENARIO_H

#include "temporary_folder.h"

#include "run/checkpoint.h"

/* Sizes in the file, of which tests compute places to damage. */
enum { PART_HEADER_BYTES = 168, RECORD_HEADER_BYTES = 48 };

static inline checkpoint_identity identity_of(uint64_t tasks, uint64_t row_bytes) {
  return (checkpoint_identity){.digest = 4711, .tasks = tasks, .row_bytes = row_bytes, .version = "0.1.0"};
}

/** @param salt  distinguishes results of the same task */
static inline void fill_rows(unsigned char *rows, uint64_t first, uint64_t count, uint64_t row_bytes, unsigned salt) {
  for (uint64_t i = 0; i < count * row_bytes; i++)
    rows[i] = (unsigned char)((first + i / row_bytes) * 31 + i % row_bytes * 7 + salt);
}

static inline checkpoint *open_checkpoint(const char *folder, const checkpoint_identity *identity) {
  checkpoint *c;
  message why;
  if (checkpoint_open(folder, identity, &c, &why))
    fail_msg("%s", why.text);
  return c;
}

static inline checkpoint *begin_checkpoint(const char *folder, const checkpoint_identity *identity, int rank) {
  checkpoint *c = open_checkpoint(folder, identity);
  message why;
  if (checkpoint_begin(c, rank, &why))
    fail_msg("%s", why.text);
  return c;
}

static inline int append_tasks(checkpoint *c, const checkpoint_identity *identity, uint64_t first, uint64_t count,
                               unsigned salt, message *why) {
  unsigned char *rows = malloc(count * identity->row_bytes);
  assert_non_null(rows);
  fill_rows(rows, first, count, identity->row_bytes, salt);
  const int code = checkpoint_append(c, first, count, rows, NULL, why);
  free(rows);
  return code;
}

static inline void append(checkpoint *c, const checkpoint_identity *identity, uint64_t first, uint64_t count) {
  message why;
  if (append_tasks(c, identity, first, count, 0, &why))
    fail_msg("%s", why.text);
}

static inline void assert_rows(checkpoint *c, const checkpoint_identity *identity, uint64_t first, uint64_t count) {
  unsigned char *rows = malloc(count * identity->row_bytes), *expected = malloc(count * identity->row_bytes);
  assert_true(rows && expected);
  message why;
  if (checkpoint_read(c, first, count, rows, &why))
    fail_msg("%s", why.text);
  fill_rows(expected, first, count, identity->row_bytes, 0);
  assert_memory_equal(rows, expected, count * identity->row_bytes);
  free(rows);
  free(expected);
}

/** Number of tasks that a fresh look at the folder finds. */
static inline uint64_t tasks_found(const char *folder, const checkpoint_identity *identity) {
  checkpoint *c = open_checkpoint(folder, identity);
  const uint64_t done = checkpoint_done(c);
  checkpoint_close(&c);
  return done;
}

/** Path of a part of the temporary folder. */
static inline const char *path_of_part(void **state, int generation, int rank) {
  static char path[128];
  snprintf(path, sizeof path, "%s/part-%04d-%05d", (const char *)*state, generation, rank);
  return path;
}

#define checkpoint_test(name) cmocka_unit_test_setup_teardown(name, make_temporary_folder, remove_temporary_folder)

#endif
