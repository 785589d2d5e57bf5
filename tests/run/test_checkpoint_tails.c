/* Rows of varying size: the tails of tasks, their offsets, and what damage does to them. */
#include "checkpoint_scenario.h"

enum { ROW = 16, TAILS = 2, ENTRY = 8, OTHER_ENTRY = 3, TASKS = 60 };

static checkpoint_identity with_tails(void) {
  checkpoint_identity identity = identity_of(TASKS, ROW);
  identity.entry_bytes[0] = ENTRY;
  identity.entry_bytes[1] = OTHER_ENTRY;
  return identity;
}

/* Very different numbers, none now and then. */
static uint64_t entries_of(uint64_t task, size_t tail) {
  return tail == 0 ? (task % 7 == 3 ? 400 : task % 3) : (task % 5 == 0 ? 2 : 0);
}

static unsigned char entry_byte(uint64_t task, size_t tail, uint64_t entry, uint64_t byte) {
  return (unsigned char)(task * 17 + tail * 5 + entry * 3 + byte);
}

/* The entries of some tasks, one after the other. The caller frees. */
static unsigned char *make_entries(const checkpoint_identity *identity, size_t tail, uint64_t first, uint64_t count) {
  const uint64_t size = identity->entry_bytes[tail];
  uint64_t total = 0, at = 0;
  for (uint64_t i = 0; i < count; i++)
    total += entries_of(first + i, tail);
  unsigned char *bytes = malloc(total * size + 1);
  assert_non_null(bytes);
  for (uint64_t i = 0; i < count; i++)
    for (uint64_t k = 0; k < entries_of(first + i, tail); k++)
      for (uint64_t b = 0; b < size; b++)
        bytes[at++] = entry_byte(first + i, tail, k, b);
  return bytes;
}

static int append_tails(checkpoint *c, const checkpoint_identity *identity, uint64_t first, uint64_t count) {
  uint64_t counts[TASKS * TAILS];
  unsigned char rows[TASKS * ROW];
  message why;
  for (uint64_t i = 0; i < count * TAILS; i++)
    counts[i] = entries_of(first + i / TAILS, i % TAILS);
  unsigned char *entries[TAILS] = {make_entries(identity, 0, first, count), make_entries(identity, 1, first, count)};
  const checkpoint_tails tails = {.counts = counts, .entries = {entries[0], entries[1]}};
  fill_rows(rows, first, count, ROW, 0);
  const int code = checkpoint_append(c, first, count, rows, &tails, &why);
  free(entries[0]);
  free(entries[1]);
  return code;
}

/* Tasks in records of different lengths, in the files of two ranks, overlapping once. */
static checkpoint_identity spread_over_two_files(void **state) {
  const checkpoint_identity identity = with_tails();
  checkpoint *a = open_checkpoint(*state, &identity), *b = open_checkpoint(*state, &identity);
  message why;
  assert_int_equal(checkpoint_begin(a, 0, &why), 0);
  assert_int_equal(checkpoint_begin(b, 1, &why), 0);
  assert_int_equal(append_tails(b, &identity, 20, 5), 0);
  assert_int_equal(append_tails(a, &identity, 0, 7), 0);
  assert_int_equal(append_tails(a, &identity, 5, 16), 0); /* 5, 6 and 20 are there already */
  assert_int_equal(append_tails(b, &identity, 25, 1), 0);
  assert_int_equal(append_tails(a, &identity, 26, TASKS - 26), 0);
  checkpoint_close(&a);
  checkpoint_close(&b);
  return identity;
}

static checkpoint *open_counted(const char *folder, const checkpoint_identity *identity) {
  checkpoint *c = open_checkpoint(folder, identity);
  message why;
  if (checkpoint_count_entries(c, &why))
    fail_msg("%s", why.text);
  return c;
}

static void rows_offsets_and_entries_come_back(void **state) {
  const checkpoint_identity identity = spread_over_two_files(state);
  checkpoint *c = open_counted(*state, &identity);
  assert_int_equal(checkpoint_done(c), TASKS);
  assert_rows(c, &identity, 0, TASKS);
  assert_rows(c, &identity, 5, 3);
  for (size_t tail = 0; tail < TAILS; tail++) {
    uint64_t offsets[TASKS + 1], expected = 0;
    message why;
    assert_int_equal(checkpoint_read_offsets(c, tail, 0, TASKS + 1, offsets, 1, &why), 0);
    for (uint64_t task = 0; task <= TASKS; task++) {
      assert_int_equal(offsets[task], expected);
      expected += task < TASKS ? entries_of(task, tail) : 0;
    }
    assert_int_equal(checkpoint_entries(c, tail), expected);
  }
  checkpoint_close(&c);
}

static void any_stretch_of_entries_can_be_read(void **state) {
  const checkpoint_identity identity = spread_over_two_files(state);
  checkpoint *c = open_counted(*state, &identity);
  for (size_t tail = 0; tail < TAILS; tail++) {
    const uint64_t total = checkpoint_entries(c, tail), size = identity.entry_bytes[tail];
    unsigned char *all = make_entries(&identity, tail, 0, TASKS), *some = malloc(total * size);
    assert_non_null(some);
    const uint64_t lengths[] = {1, 3, 64, 401, total};
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++)
      for (uint64_t first = 0; first + lengths[k] <= total; first += lengths[k]) {
        message why;
        assert_int_equal(checkpoint_read_entries(c, tail, first, lengths[k], some, &why), 0);
        assert_memory_equal(some, all + first * size, lengths[k] * size);
      }
    free(all);
    free(some);
  }
  checkpoint_close(&c);
}

static void offsets_can_be_read_in_blocks_and_interleaved(void **state) {
  const checkpoint_identity identity = spread_over_two_files(state);
  checkpoint *c = open_counted(*state, &identity);
  uint64_t all[TASKS + 1], block[2 * 8];
  message why;
  assert_int_equal(checkpoint_read_offsets(c, 0, 0, TASKS + 1, all, 1, &why), 0);
  for (uint64_t first = 0; first <= TASKS; first += 8) {
    const uint64_t count = TASKS + 1 - first < 8 ? TASKS + 1 - first : 8;
    assert_int_equal(checkpoint_read_offsets(c, 0, first, count, block + 1, 2, &why), 0);
    for (uint64_t i = 0; i < count; i++)
      assert_int_equal(block[1 + 2 * i], all[first + i]);
  }
  checkpoint_close(&c);
}

static void tails_without_any_entry_are_empty(void **state) {
  const checkpoint_identity identity = with_tails();
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  const uint64_t counts[2 * TAILS] = {0};
  const unsigned char rows[2 * ROW] = {0};
  const checkpoint_tails none = {.counts = counts};
  message why;
  assert_int_equal(checkpoint_append(c, 0, 2, rows, &none, &why), 0);
  assert_int_equal(checkpoint_rescan(c, &why), 0);
  assert_int_equal(checkpoint_count_entries(c, &why), 0);
  assert_int_equal(checkpoint_entries(c, 0), 0);
  assert_int_equal(checkpoint_read_entries(c, 1, 0, 0, NULL, &why), 0);
  unsigned char entry[ENTRY];
  assert_int_equal(checkpoint_read_entries(c, 0, 0, 1, entry, &why), EXIT_FILES);
  checkpoint_close(&c);
}

static void a_rescan_forgets_the_counts(void **state) {
  const checkpoint_identity identity = with_tails();
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  message why;
  assert_int_equal(append_tails(c, &identity, 0, 5), 0);
  assert_int_equal(checkpoint_rescan(c, &why), 0);
  assert_int_equal(checkpoint_count_entries(c, &why), 0);
  const uint64_t before = checkpoint_entries(c, 0);
  assert_int_equal(append_tails(c, &identity, 5, TASKS - 5), 0);
  assert_int_equal(checkpoint_rescan(c, &why), 0);
  assert_int_equal(checkpoint_entries(c, 0), 0);
  assert_int_equal(checkpoint_count_entries(c, &why), 0);
  assert_true(checkpoint_entries(c, 0) > before);
  checkpoint_close(&c);
}

static void other_tails_are_another_shape(void **state) {
  checkpoint_identity identity = spread_over_two_files(state);
  checkpoint *c;
  message why;
  identity.entry_bytes[1]++;
  assert_int_equal(checkpoint_open(*state, &identity, &c, &why), EXIT_USAGE);
  assert_non_null(strstr(why.text, "another study"));
  identity = identity_of(TASKS, ROW);
  assert_int_equal(checkpoint_open(*state, &identity, &c, &why), EXIT_USAGE);
}

static void torn_tails_are_cut_back_to_the_record_before(void **state) {
  const checkpoint_identity identity = with_tails();
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  assert_int_equal(append_tails(c, &identity, 0, 2), 0);
  assert_int_equal(append_tails(c, &identity, 2, 3), 0);
  checkpoint_close(&c);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size);
  for (size_t lost = 1; lost <= 500; lost++) {
    write_whole_file(path_of_part(state, 1, 0), bytes, size - lost);
    assert_int_equal(tasks_found(*state, &identity), 2);
  }
  free(bytes);
}

static void any_flipped_bit_hides_its_record(void **state) {
  const checkpoint_identity identity = with_tails();
  checkpoint *c = begin_checkpoint(*state, &identity, 0);
  assert_int_equal(append_tails(c, &identity, 4, 3), 0);
  checkpoint_close(&c);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size);
  for (size_t place = PART_HEADER_BYTES; place < size; place++) {
    bytes[place] ^= 1;
    write_whole_file(path_of_part(state, 1, 0), bytes, size);
    assert_int_equal(tasks_found(*state, &identity), 0);
    bytes[place] ^= 1;
  }
  free(bytes);
}

static void counts_damaged_since_the_scan_are_refused(void **state) {
  const checkpoint_identity identity = spread_over_two_files(state);
  checkpoint *c = open_checkpoint(*state, &identity);
  size_t size;
  unsigned char *bytes = read_whole_file(path_of_part(state, 1, 0), &size);
  const size_t place = PART_HEADER_BYTES + RECORD_HEADER_BYTES + 8;
  bytes[place] ^= 1;
  write_whole_file(path_of_part(state, 1, 0), bytes, size);
  message why;
  assert_int_equal(checkpoint_count_entries(c, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "has been damaged"));
  bytes[place] ^= 1;
  write_whole_file(path_of_part(state, 1, 0), bytes, size);
  assert_int_equal(checkpoint_count_entries(c, &why), 0);
  bytes[size - 1] ^= 1;
  write_whole_file(path_of_part(state, 1, 0), bytes, size);
  unsigned char entry[ENTRY];
  assert_int_equal(checkpoint_read_entries(c, 0, checkpoint_entries(c, 0) - 1, 1, entry, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "has been damaged"));
  free(bytes);
  checkpoint_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      checkpoint_test(rows_offsets_and_entries_come_back),
      checkpoint_test(any_stretch_of_entries_can_be_read),
      checkpoint_test(offsets_can_be_read_in_blocks_and_interleaved),
      checkpoint_test(tails_without_any_entry_are_empty),
      checkpoint_test(a_rescan_forgets_the_counts),
      checkpoint_test(other_tails_are_another_shape),
      checkpoint_test(torn_tails_are_cut_back_to_the_record_before),
      checkpoint_test(any_flipped_bit_hides_its_record),
      checkpoint_test(counts_damaged_since_the_scan_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
