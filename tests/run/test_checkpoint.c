#include "checkpoint_scenario.h"

#include "run/stop.h"

static void digest_is_fnv_1a_and_can_be_continued(void **state) {
  (void)state;
  assert_true(digest_bytes(0, "", 0) == UINT64_C(0xcbf29ce484222325));
  assert_true(digest_bytes(0, "foobar", 6) == UINT64_C(0x85944171f73967e8)); /* test vector of the authors of FNV */
  assert_true(digest_bytes(digest_bytes(0, "foo", 3), "bar", 3) == digest_bytes(0, "foobar", 6));
}

static void rows_come_back_as_they_were_appended(void **state) {
  const checkpoint_identity identity = identity_of(100, 24);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 40, 10);
  append(c, &identity, 0, 5);
  message why;
  assert_int_equal(checkpoint_sync(c, &why), 0);
  assert_int_equal(checkpoint_sync(c, &why), 0);
  checkpoint_close(&c);
  assert_null(c);
  c = open_checkpoint(*state, &identity);
  assert_int_equal(checkpoint_done(c), 15);
  assert_rows(c, &identity, 40, 10);
  assert_rows(c, &identity, 0, 5);
  checkpoint_close(&c);
}

static void missing_tasks_are_numbered_across_the_gaps(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 50, 50);
  append(c, &identity, 10, 5);
  append(c, &identity, 15, 5);
  message why;
  assert_int_equal(checkpoint_rescan(c, &why), 0); /* gaps: 0 to 9, 20 to 49 */
  uint64_t task = 0;
  assert_int_equal(checkpoint_missing(c, 0, &task), 10);
  assert_int_equal(task, 0);
  assert_int_equal(checkpoint_missing(c, 9, &task), 1);
  assert_int_equal(task, 9);
  assert_int_equal(checkpoint_missing(c, 10, &task), 30);
  assert_int_equal(task, 20);
  assert_int_equal(checkpoint_missing(c, 39, &task), 1);
  assert_int_equal(task, 49);
  assert_int_equal(checkpoint_missing(c, 40, &task), 0);
  checkpoint_close(&c);
}

static void missing_tasks_stay_numbered_until_the_next_scan(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 0, 50);
  uint64_t task = 1;
  assert_int_equal(checkpoint_missing(c, 0, &task), 100);
  assert_int_equal(task, 0);
  assert_int_equal(checkpoint_done(c), 0);
  checkpoint_close(&c);
}

static void rows_of_other_arithmetic_are_kept_and_known(void **state) {
  checkpoint_identity identity = identity_of(100, 8);
  identity.arithmetic = 1;
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 0, 50);
  checkpoint_close(&c);
  c = open_checkpoint(*state, &identity);
  assert_false(checkpoint_mixed(c));
  checkpoint_close(&c);
  identity.arithmetic = 2;
  c = open_checkpoint(*state, &identity);
  assert_true(checkpoint_mixed(c));
  assert_int_equal(checkpoint_done(c), 50);
  assert_rows(c, &identity, 0, 50);
  checkpoint_close(&c);
}

static void finished_study_misses_nothing(void **state) {
  const checkpoint_identity identity = identity_of(10, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 0, 10);
  checkpoint_close(&c);
  c = open_checkpoint(*state, &identity);
  uint64_t task;
  assert_int_equal(checkpoint_missing(c, 0, &task), 0);
  assert_int_equal(checkpoint_done(c), 10);
  checkpoint_close(&c);
}

static void reading_goes_across_records_and_files(void **state) {
  const checkpoint_identity identity = identity_of(1000, 16);
  checkpoint *a = open_checkpoint(*state, &identity), *b = open_checkpoint(*state, &identity);
  message why;
  assert_int_equal(checkpoint_begin(a, 0, &why), 0);
  assert_int_equal(checkpoint_begin(b, 1, &why), 0);
  for (uint64_t first = 0; first < 1000; first += 10)
    append(first % 30 ? a : b, &identity, first, 10);
  assert_int_equal(checkpoint_rescan(a, &why), 0);
  assert_int_equal(checkpoint_rescan(b, &why), 0);
  assert_int_equal(checkpoint_done(a), 1000);
  assert_rows(a, &identity, 0, 1000);
  assert_rows(b, &identity, 0, 1000);
  for (uint64_t first = 3; first + 17 <= 1000; first += 17)
    assert_rows(b, &identity, first, 17);
  checkpoint_close(&a);
  checkpoint_close(&b);
}

static void records_may_be_larger_than_the_buffer(void **state) {
  const checkpoint_identity identity = identity_of(5, 700001);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 0, 5);
  checkpoint_close(&c);
  c = open_checkpoint(*state, &identity);
  assert_int_equal(checkpoint_done(c), 5);
  for (uint64_t task = 0; task < 5; task++)
    assert_rows(c, &identity, task, 1);
  checkpoint_close(&c);
}

static void rescan_finds_new_records_and_new_files(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *reader = open_checkpoint(*state, &identity), *early = begin_checkpoint(*state, &identity, 7);
  message why;
  append(early, &identity, 0, 10);
  assert_int_equal(checkpoint_rescan(reader, &why), 0);
  assert_int_equal(checkpoint_done(reader), 10);
  append(early, &identity, 10, 10);
  checkpoint *late = begin_checkpoint(*state, &identity, 2); /* its name sorts elsewhere than it is found */
  append(late, &identity, 20, 10);
  assert_int_equal(checkpoint_rescan(reader, &why), 0);
  assert_int_equal(checkpoint_rescan(reader, &why), 0);
  assert_int_equal(checkpoint_done(reader), 30);
  assert_rows(reader, &identity, 0, 30);
  checkpoint_close(&late);
  checkpoint_close(&early);
  checkpoint_close(&reader);
}

static void resumed_run_leaves_the_old_file_untouched(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 0, 10);
  checkpoint_close(&c);
  size_t before, after;
  unsigned char *old = read_whole_file(path_of_part(state, 1, 0), &before);
  c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 10, 10);
  checkpoint_close(&c);
  unsigned char *same = read_whole_file(path_of_part(state, 1, 0), &after);
  assert_int_equal(before, after);
  assert_memory_equal(old, same, before);
  free(old);
  free(same);
  assert_int_equal(access(path_of_part(state, 2, 0), F_OK), 0);
  assert_int_equal(tasks_found(*state, &identity), 20);
}

static void of_overlapping_records_the_first_wins(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  message why;
  append(c, &identity, 10, 20);
  assert_int_equal(append_tasks(c, &identity, 10, 20, 99, &why), 0); /* the same again */
  assert_int_equal(append_tasks(c, &identity, 15, 5, 99, &why), 0);  /* inside */
  checkpoint_close(&c);
  c = open_checkpoint(*state, &identity);
  assert_int_equal(checkpoint_done(c), 20);
  assert_rows(c, &identity, 10, 20);
  checkpoint_close(&c);
}

static void record_that_sticks_out_of_another_adds_its_rest(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  message why;
  append(c, &identity, 20, 30);
  assert_int_equal(checkpoint_rescan(c, &why), 0);
  append(c, &identity, 10, 20);
  append(c, &identity, 45, 15);
  assert_int_equal(checkpoint_rescan(c, &why), 0);
  assert_int_equal(checkpoint_done(c), 50);
  assert_rows(c, &identity, 10, 50);
  unsigned char row[8];
  assert_int_equal(checkpoint_read(c, 9, 1, row, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "task 9 is in no record"));
  assert_int_equal(checkpoint_read(c, 60, 1, row, &why), EXIT_FILES);
  checkpoint_close(&c);
}

static void another_study_version_or_shape_is_refused_by_name(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 0, 10);
  checkpoint_close(&c);
  checkpoint_identity others[] = {identity, identity, identity, identity};
  others[0].digest++;
  others[1].tasks++;
  others[2].row_bytes++;
  strcpy(others[3].version, "0.2.0");
  const char *const named[] = {"another study", "100 tasks", "rows of 8 bytes, expected 100 of 9", "\"0.1.0\""};
  for (int i = 0; i < 4; i++) {
    message why;
    assert_int_equal(checkpoint_open(*state, &others[i], &c, &why), EXIT_USAGE);
    assert_null(c);
    assert_non_null(strstr(why.text, named[i]));
    assert_non_null(strstr(why.text, path_of_part(state, 1, 0)));
  }
}

static void version_is_compared_up_to_its_end_only(void **state) {
  checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 0, 10);
  checkpoint_close(&c);
  memset(identity.version + 6, 'x', sizeof identity.version - 6);
  assert_int_equal(tasks_found(*state, &identity), 10);
}

static void tasks_outside_the_study_are_not_appended(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = open_checkpoint(*state, &identity);
  const unsigned char rows[16] = {0};
  message why;
  assert_int_equal(checkpoint_append(c, 0, 1, rows, NULL, &why), EXIT_FILES); /* not begun */
  assert_int_equal(checkpoint_begin(c, 0, &why), 0);
  assert_int_equal(checkpoint_append(c, 99, 2, rows, NULL, &why), EXIT_FILES);
  assert_int_equal(checkpoint_append(c, 100, 1, rows, NULL, &why), EXIT_FILES);
  assert_int_equal(checkpoint_append(c, 0, 0, rows, NULL, &why), EXIT_FILES);
  assert_int_equal(checkpoint_append(c, 1, UINT64_MAX, rows, NULL, &why), EXIT_FILES);
  assert_int_equal(checkpoint_append(c, 98, 2, rows, NULL, &why), 0);
  checkpoint_close(&c);
}

static void removing_takes_the_parts_and_leaves_the_rest(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  checkpoint_close(&c);
  char foreign[128];
  snprintf(foreign, sizeof foreign, "%s/part-1-0.txt", (const char *)*state);
  write_whole_file(foreign, "mine", 4);
  message why;
  assert_int_equal(checkpoint_remove(*state, &why), 0);
  assert_int_equal(access(path_of_part(state, 1, 0), F_OK), -1);
  assert_int_equal(access(foreign, F_OK), 0);
  unlink(foreign);
  assert_int_equal(checkpoint_remove(*state, &why), 0);
  assert_int_equal(access(*state, F_OK), -1);
  assert_int_equal(checkpoint_remove(*state, &why), 0);
}

static void folder_that_is_not_there_is_refused(void **state) {
  const checkpoint_identity identity = identity_of(100, 8);
  char path[128];
  snprintf(path, sizeof path, "%s/absent", (const char *)*state);
  checkpoint *c;
  message why;
  assert_int_equal(checkpoint_open(path, &identity, &c, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, path));
}

/* Memory that is zero and takes none. */
static unsigned char *zero_rows(uint64_t bytes) {
  unsigned char *rows = calloc(bytes, 1);
  assert_non_null(rows);
  return rows;
}

static void a_stop_ends_the_reading_of_many_bytes(void **state) {
  enum { ROW = 1 << 20, ROWS = 40 };
  const checkpoint_identity identity = identity_of(ROWS, ROW);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  unsigned char *rows = zero_rows(ROWS * ROW);
  message why;
  assert_int_equal(checkpoint_append(c, 0, ROWS, rows, NULL, &why), 0);
  assert_int_equal(checkpoint_rescan(c, &why), 0);
  stop_watch(0);
  assert_int_equal(checkpoint_read(c, 0, 2, rows, &why), EXIT_STOPPED); /* its whole record is verified */
  checkpoint_close(&c);
  assert_int_equal(checkpoint_open(*state, &identity, &c, &why), EXIT_STOPPED);
  assert_null(c);
  stop_watch(INFINITY);
  assert_int_equal(tasks_found(*state, &identity), ROWS);
  free(rows);
}

/* The opening of a file may take as long as the reading of many bytes. */
static void a_stop_ends_the_reading_of_rows_that_alternate_between_parts(void **state) {
  enum { TASKS = 40 };
  const checkpoint_identity identity = identity_of(TASKS, 8);
  for (int rank = 0; rank < 2; rank++) {
    checkpoint *c = begin_checkpoint(*state, &identity, rank);
    for (uint64_t i = (uint64_t)rank; i < TASKS; i += 2)
      append(c, &identity, i, 1);
    checkpoint_close(&c);
  }
  checkpoint *c = open_checkpoint(*state, &identity);
  unsigned char *rows = zero_rows(TASKS * 8);
  message why;
  stop_watch(0);
  assert_int_equal(checkpoint_read(c, 0, 2, rows, &why), 0); /* little of it is finished */
  assert_int_equal(checkpoint_read(c, 0, TASKS, rows, &why), EXIT_STOPPED);
  stop_watch(INFINITY);
  assert_rows(c, &identity, 0, TASKS);
  checkpoint_close(&c);
  free(rows);
}

/* The finished tasks of a stopped run are written, unless they are so large that nobody would wait. */
static void a_stop_gives_up_only_a_huge_record(void **state) {
  enum { ROW = 10 << 20, FEW = 20, MANY = 30 };
  const checkpoint_identity identity = identity_of(100, ROW);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  unsigned char *rows = zero_rows((uint64_t)MANY * ROW);
  message why;
  stop_watch(0);
  assert_int_equal(checkpoint_append(c, 0, FEW, rows, NULL, &why), 0);
  assert_int_equal(checkpoint_append(c, 50, MANY, rows, NULL, &why), EXIT_STOPPED);
  stop_watch(INFINITY);
  assert_int_equal(checkpoint_append(c, 99, 1, rows, NULL, &why), 0); /* behind a whole record */
  checkpoint_close(&c);
  assert_int_equal(tasks_found(*state, &identity), FEW + 1);
  free(rows);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(digest_is_fnv_1a_and_can_be_continued),
      checkpoint_test(rows_come_back_as_they_were_appended),
      checkpoint_test(missing_tasks_are_numbered_across_the_gaps),
      checkpoint_test(missing_tasks_stay_numbered_until_the_next_scan),
      checkpoint_test(rows_of_other_arithmetic_are_kept_and_known),
      checkpoint_test(finished_study_misses_nothing),
      checkpoint_test(reading_goes_across_records_and_files),
      checkpoint_test(records_may_be_larger_than_the_buffer),
      checkpoint_test(rescan_finds_new_records_and_new_files),
      checkpoint_test(resumed_run_leaves_the_old_file_untouched),
      checkpoint_test(of_overlapping_records_the_first_wins),
      checkpoint_test(record_that_sticks_out_of_another_adds_its_rest),
      checkpoint_test(another_study_version_or_shape_is_refused_by_name),
      checkpoint_test(version_is_compared_up_to_its_end_only),
      checkpoint_test(tasks_outside_the_study_are_not_appended),
      checkpoint_test(removing_takes_the_parts_and_leaves_the_rest),
      checkpoint_test(folder_that_is_not_there_is_refused),
      checkpoint_test(a_stop_ends_the_reading_of_many_bytes),
      checkpoint_test(a_stop_ends_the_reading_of_rows_that_alternate_between_parts),
      checkpoint_test(a_stop_gives_up_only_a_huge_record),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
