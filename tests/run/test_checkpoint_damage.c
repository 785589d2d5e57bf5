/* Files that end early, have flipped bits, or meet a full disk. */
#include "checkpoint_scenario.h"

#include <sys/resource.h>

#include "run/stop.h"

enum { ROW = 8, COUNT = 4, RECORD = RECORD_HEADER_BYTES + COUNT * ROW };

/* Records of tasks 0-3, 4-7, 8-11 in the file of rank 0. */
static checkpoint_identity three_records(void **state) {
  const checkpoint_identity identity = identity_of(100, ROW);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  for (uint64_t first = 0; first < 3 * COUNT; first += COUNT)
    append(c, &identity, first, COUNT);
  checkpoint_close(&c);
  return identity;
}

static void torn_tail_is_cut_back_to_the_record_before(void **state) {
  const checkpoint_identity identity = three_records(state);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size);
  assert_int_equal(size, PART_HEADER_BYTES + 3 * RECORD);
  for (size_t cut = size - RECORD; cut < size; cut++) {
    write_whole_file(path_of_part(state, 1, 0), bytes, cut);
    checkpoint *c = open_checkpoint(*state, &identity);
    assert_int_equal(checkpoint_done(c), 2 * COUNT);
    assert_rows(c, &identity, 0, 2 * COUNT);
    checkpoint_close(&c);
  }
  free(bytes);
}

static void zeros_in_place_of_the_tail_are_no_record(void **state) {
  const checkpoint_identity identity = three_records(state);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size);
  for (size_t lost = ROW; lost <= RECORD; lost++) { /* as after the death of a machine: the length, but not the data */
    memset(bytes + size - lost, 0, lost);
    write_whole_file(path_of_part(state, 1, 0), bytes, size);
    assert_int_equal(tasks_found(*state, &identity), 2 * COUNT);
  }
  free(bytes);
}

static void file_without_whole_header_counts_as_empty(void **state) {
  const checkpoint_identity identity = three_records(state);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size);
  for (size_t cut = 0; cut < PART_HEADER_BYTES; cut++) {
    write_whole_file(path_of_part(state, 1, 0), bytes, cut);
    assert_int_equal(tasks_found(*state, &identity), 0);
  }
  for (size_t place = 0; place < PART_HEADER_BYTES; place++) {
    bytes[place] ^= 0x40;
    write_whole_file(path_of_part(state, 1, 0), bytes, size);
    assert_int_equal(tasks_found(*state, &identity), 0);
    bytes[place] ^= 0x40;
  }
  free(bytes);
}

static void flipped_bit_hides_its_record_and_the_rest_of_its_file_only(void **state) {
  const checkpoint_identity identity = three_records(state);
  checkpoint *other = begin_checkpoint(*state, &identity, 1);
  append(other, &identity, 50, COUNT);
  checkpoint_close(&other);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size);
  for (size_t place = PART_HEADER_BYTES + RECORD; place < PART_HEADER_BYTES + 2 * RECORD; place++) {
    bytes[place] ^= 1;
    write_whole_file(path_of_part(state, 1, 0), bytes, size);
    checkpoint *c = open_checkpoint(*state, &identity);
    assert_int_equal(checkpoint_done(c), 2 * COUNT);
    assert_rows(c, &identity, 0, COUNT);
    assert_rows(c, &identity, 50, COUNT);
    message why;
    assert_int_equal(checkpoint_rescan(c, &why), 0); /* which trusts headers, but not of a record that failed */
    assert_int_equal(checkpoint_done(c), 2 * COUNT);
    checkpoint_close(&c);
    bytes[place] ^= 1;
  }
  free(bytes);
}

static void record_seen_half_written_is_taken_once_it_is_whole(void **state) {
  const checkpoint_identity identity = three_records(state);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size);
  bytes[size - 1] ^= 1;
  write_whole_file(path_of_part(state, 1, 0), bytes, size);
  checkpoint *c = open_checkpoint(*state, &identity);
  assert_int_equal(checkpoint_done(c), 2 * COUNT);
  bytes[size - 1] ^= 1;
  write_whole_file(path_of_part(state, 1, 0), bytes, size);
  message why;
  assert_int_equal(checkpoint_rescan(c, &why), 0);
  assert_int_equal(checkpoint_done(c), 3 * COUNT);
  assert_rows(c, &identity, 0, 3 * COUNT);
  checkpoint_close(&c);
  free(bytes);
}

static void reading_refuses_rows_damaged_since_the_scan(void **state) {
  const checkpoint_identity identity = three_records(state);
  checkpoint *c = open_checkpoint(*state, &identity);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size), rows[3 * COUNT * ROW];
  bytes[size - 1] ^= 1;
  write_whole_file(path_of_part(state, 1, 0), bytes, size);
  message why;
  assert_rows(c, &identity, 0, 2 * COUNT);
  assert_int_equal(checkpoint_read(c, 8, 1, rows, &why), EXIT_FILES); /* the row itself is whole, its record is not */
  assert_non_null(strstr(why.text, "tasks 8 to 11"));
  assert_non_null(strstr(why.text, path_of_part(state, 1, 0)));
  write_whole_file(path_of_part(state, 1, 0), bytes, size - RECORD / 2);
  assert_int_equal(checkpoint_read(c, 0, 3 * COUNT, rows, &why), EXIT_FILES);
  checkpoint_close(&c);
  free(bytes);
}

static void limit_file_size(rlim_t bytes) {
  struct rlimit limit;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
  limit.rlim_cur = bytes;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static void full_disk_leaves_a_readable_file_and_says_so(void **state) {
  const checkpoint_identity identity = identity_of(100, ROW);
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  append(c, &identity, 0, COUNT);
  message why;
  stop_watch(INFINITY);                                                  /* ignores SIGXFSZ */
  limit_file_size(PART_HEADER_BYTES + RECORD + RECORD_HEADER_BYTES + 5); /* amid the rows of the second record */
  const int code = append_tasks(c, &identity, 4, COUNT, 0, &why);
  limit_file_size(RLIM_INFINITY);
  assert_int_equal(code, EXIT_FILES);
  assert_non_null(strstr(why.text, path_of_part(state, 1, 0)));
  assert_non_null(strstr(why.text, "File too large"));
  assert_int_equal(tasks_found(*state, &identity), COUNT);
  append(c, &identity, 8, COUNT); /* goes on where the good records end */
  checkpoint_close(&c);
  assert_int_equal(tasks_found(*state, &identity), 2 * COUNT);
}

static void file_that_cannot_even_hold_its_header_takes_no_records(void **state) {
  const checkpoint_identity identity = identity_of(100, ROW);
  checkpoint *c = open_checkpoint(*state, &identity);
  message why;
  stop_watch(INFINITY);
  limit_file_size(PART_HEADER_BYTES / 2);
  const int code = checkpoint_begin(c, 0, &why);
  limit_file_size(RLIM_INFINITY);
  assert_int_equal(code, EXIT_FILES);
  assert_int_equal(append_tasks(c, &identity, 0, COUNT, 0, &why), EXIT_FILES);
  checkpoint_close(&c);
  assert_int_equal(tasks_found(*state, &identity), 0);
}

static void file_of_another_run_is_not_written_over(void **state) {
  const checkpoint_identity identity = identity_of(100, ROW);
  checkpoint *a = open_checkpoint(*state, &identity), *b = open_checkpoint(*state, &identity);
  message why;
  assert_int_equal(checkpoint_begin(a, 0, &why), 0);
  assert_int_equal(checkpoint_begin(b, 0, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "File exists"));
  checkpoint_close(&a);
  checkpoint_close(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      checkpoint_test(torn_tail_is_cut_back_to_the_record_before),
      checkpoint_test(zeros_in_place_of_the_tail_are_no_record),
      checkpoint_test(file_without_whole_header_counts_as_empty),
      checkpoint_test(flipped_bit_hides_its_record_and_the_rest_of_its_file_only),
      checkpoint_test(record_seen_half_written_is_taken_once_it_is_whole),
      checkpoint_test(reading_refuses_rows_damaged_since_the_scan),
      checkpoint_test(full_disk_leaves_a_readable_file_and_says_so),
      checkpoint_test(file_that_cannot_even_hold_its_header_takes_no_records),
      checkpoint_test(file_of_another_run_is_not_written_over),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
