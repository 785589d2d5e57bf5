/* What a damaged or foreign file does: a message and EXIT_FILES, never a crash, a hang or silence. */
#include <unistd.h>

#include "result/result.h"
#include "support.h"
#include "synthetic.h"

#include "witness/countdown.h"

#define RESULT_FILE "to_be_damaged.h5"

typedef struct bytes {
  unsigned char *at;
  size_t count;
} bytes;

static bytes good; /* of the small file, or of one with a long list */

static int load_of(size_t list) {
  free(good.at);
  good = (bytes){0};
  if (synthetic_write(RESULT_FILE, list) != 0)
    return -1;
  FILE *from = fopen(RESULT_FILE, "rb");
  if (!from || fseek(from, 0, SEEK_END) != 0)
    return -1;
  good.count = (size_t)ftell(from);
  good.at = malloc(good.count);
  rewind(from);
  int failed = !good.at || fread(good.at, good.count, 1, from) != 1;
  return fclose(from) != 0 || failed ? -1 : 0;
}

static int load(void **state) {
  (void)state;
  return load_of(3);
}

static int load_long(void **state) {
  (void)state;
  return load_of(1000000);
}

static int unload(void **state) {
  (void)state;
  free(good.at);
  return unlink("damaged.h5") || unlink(RESULT_FILE);
}

/* A file of the first `count` good bytes with bits of one byte flipped. */
static void store(size_t count, size_t place, unsigned char flip) {
  FILE *to = fopen("damaged.h5", "wb");
  assert_non_null(to);
  if (place < count)
    good.at[place] ^= flip;
  assert_int_equal(fwrite(good.at, 1, count, to), count);
  if (place < count)
    good.at[place] ^= flip;
  assert_int_equal(fclose(to), 0);
}

/* Where a text stands in the file; it is there. */
static size_t find(const char *text, size_t length) {
  for (size_t i = 0; i + length <= good.count; i++)
    if (memcmp(good.at + i, text, length) == 0)
      return i;
  fail_msg("%s is not in the file", text);
  return 0;
}

static void assert_refused(const char *says) {
  message why = {""};
  assert_int_equal(result_verify("damaged.h5", (ric_poll){0}, &why), EXIT_FILES);
  assert_ptr_equal(strstr(why.text, "damaged.h5: "), why.text);
  if (!strstr(why.text, says))
    fail_msg("\"%s\" does not say \"%s\"", why.text, says);
}

static void good_file_verifies(void **state) {
  (void)state;
  message why = {""};
  assert_int_equal(result_verify(RESULT_FILE, (ric_poll){0}, &why), 0);
}

static void verifying_stops_at_any_call(void **state) {
  (void)state;
  countdown all = {.limit = INT32_MAX};
  message why = {""};
  assert_int_equal(result_verify(RESULT_FILE, (ric_poll){count, &all}, &why), 0);
  assert_true(all.calls > 10);
  for (int limit = 1; limit <= all.calls; limit++) {
    countdown c = {.limit = limit};
    assert_int_equal(result_verify(RESULT_FILE, (ric_poll){count, &c}, &why), EXIT_STOPPED);
    assert_int_equal(c.calls, limit);
  }
}

static void digest_is_that_of_the_study(void **state) {
  (void)state;
  message why;
  uint64_t digest = 0;
  assert_int_equal(result_study_digest(RESULT_FILE, &digest, &why), 0);
  assert_true(digest == 0x0123456789abcdefu + 2);
}

static void flipped_bit_in_text_data_is_refused(void **state) {
  (void)state;
  store(good.count, find("particle 3, \"at once\"", 21), 0x01);
  assert_refused("Fletcher32");
}

static void flipped_bit_in_numbers_is_refused(void **state) {
  (void)state;
  double energy = sin(5.0);
  char pattern[sizeof energy];
  memcpy(pattern, &energy, sizeof energy);
  store(good.count, find(pattern, sizeof pattern), 0x80);
  assert_refused("Fletcher32");
}

static void flipped_bit_in_study_is_refused(void **state) {
  (void)state;
  store(good.count, find("kind: orbits", 12), 0x01);
  assert_refused("");
}

static size_t find_number(double number) {
  char pattern[sizeof number];
  memcpy(pattern, &number, sizeof number);
  return find(pattern, sizeof pattern);
}

static void flipped_bit_in_a_value_of_the_study_is_refused(void **state) {
  (void)state;
  store(good.count, find("periodic", 8), 0x01);
  assert_refused("");
  store(good.count, find_number(0.5), 0x01);
  assert_refused("");
}

/* HDF5 keeps no checksum of so long an attribute. */
static void flipped_bit_in_a_long_list_of_the_study_is_refused(void **state) {
  (void)state;
  message why = {""};
  assert_int_equal(result_verify(RESULT_FILE, (ric_poll){0}, &why), 0);
  store(good.count, find_number(700001), 0x01);
  assert_refused("/study is damaged");
}

/* HDF5 itself would loop for ever on some of these. */
static void flipped_bits_in_references_to_axes_are_refused(void **state) {
  (void)state;
  size_t heap = find("GCOL", 4);
  for (size_t i = 0; i < 200; i++) {
    store(good.count, heap + i, 0x01);
    assert_refused("");
  }
}

/* More than half of this small file is looked at; the rest is unused space. */
static void flipped_bits_anywhere_neither_crash_nor_hang(void **state) {
  (void)state;
  size_t noticed = 0, tried = 0;
  for (size_t i = 0; i < good.count; i += 37, tried++) {
    message why;
    store(good.count, i, 0x10);
    int code = result_verify("damaged.h5", (ric_poll){0}, &why);
    assert_true(code == 0 || code == EXIT_FILES);
    noticed += code != 0;
  }
  assert_true(noticed > tried / 2);
}

static void truncated_file_is_refused(void **state) {
  (void)state;
  for (size_t count = 0; count < good.count; count += good.count / 50) {
    message why;
    uint64_t digest;
    store(count, good.count, 0);
    assert_refused("");
    assert_int_equal(result_study_digest("damaged.h5", &digest, &why), EXIT_FILES);
    assert_int_equal(result_show("damaged.h5", synthetic_card, &why), EXIT_FILES);
    assert_int_equal(result_show_csv("damaged.h5", NULL, &why), EXIT_FILES);
  }
}

static void foreign_files_are_refused(void **state) {
  (void)state;
  message why;
  assert_int_equal(result_verify("no such file.h5", (ric_poll){0}, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "No such file or directory"));
  assert_int_equal(result_verify(".", (ric_poll){0}, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "not a regular file"));
  FILE *to = fopen("damaged.h5", "wb");
  fputs("kind: orbits\n", to);
  fclose(to);
  assert_refused("not an HDF5 file");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(good_file_verifies),
      cmocka_unit_test(verifying_stops_at_any_call),
      cmocka_unit_test(digest_is_that_of_the_study),
      cmocka_unit_test(flipped_bit_in_text_data_is_refused),
      cmocka_unit_test(flipped_bit_in_numbers_is_refused),
      cmocka_unit_test(flipped_bit_in_study_is_refused),
      cmocka_unit_test(flipped_bit_in_a_value_of_the_study_is_refused),
      cmocka_unit_test_setup_teardown(flipped_bit_in_a_long_list_of_the_study_is_refused, load_long, load),
      cmocka_unit_test(flipped_bits_in_references_to_axes_are_refused),
      cmocka_unit_test(flipped_bits_anywhere_neither_crash_nor_hang),
      cmocka_unit_test(truncated_file_is_refused),
      cmocka_unit_test(foreign_files_are_refused),
  };
  return cmocka_run_group_tests(tests, load, unload);
}
