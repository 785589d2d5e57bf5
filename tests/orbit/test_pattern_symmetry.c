/* Images and representatives, by brute force over every word of roles and the whole group. */
#include "support.h"

#include <ricochet/ricochet.h>

enum { MOST = 8 };

/* A word of roles, one letter per particle: s < h < '.', the order of representatives. */
static int rank_of(char letter) {
  return letter == 's' ? 0 : letter == 'h' ? 1 : 2;
}

static int compare_words(const char *a, const char *b, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (a[i] != b[i])
      return rank_of(a[i]) - rank_of(b[i]);
  return 0;
}

static char exchanged(char letter) {
  return letter == 's' ? 'h' : letter == 'h' ? 's' : '.';
}

/* What the definition says: particle i becomes (reflect ? n - 1 - i : i) + shift. */
static void image_of_word(const char *word, size_t n, ric_symmetry symmetry, char *image) {
  for (size_t i = 0; i < n; i++) {
    size_t to = ((symmetry.reflect ? n - 1 - i : i) + symmetry.shift) % n;
    image[to] = symmetry.exchange ? exchanged(word[i]) : word[i];
  }
}

static ric_pattern *pattern_of(const char *word, size_t n) {
  size_t start[MOST], half[MOST], starts = 0, halves = 0;
  ric_pattern *pattern;
  for (size_t i = 0; i < n; i++)
    if (word[i] == 's')
      start[starts++] = i;
    else if (word[i] == 'h')
      half[halves++] = i;
  assert_int_equal(ric_pattern_create(n, start, starts, half, halves, &pattern, NULL), RIC_OK);
  return pattern;
}

static void word_of(const ric_pattern *pattern, char *word) {
  for (size_t i = 0; i < ric_pattern_particles(pattern); i++)
    word[i] = ".sh"[ric_pattern_role(pattern, i)];
}

/* Next word in the alphabet; 0 after the last. Starts from all free, which is no pattern. */
static int next_word(char *word, size_t n) {
  for (size_t i = 0; i < n; i++) {
    if (word[i] == '.') {
      word[i] = 's';
      return 1;
    }
    if (word[i] == 's') {
      word[i] = 'h';
      return 1;
    }
    word[i] = '.';
  }
  return 0;
}

static size_t shifts_of(size_t n, int ends) {
  return ends == RIC_ENDS_PERIODIC ? n : 1;
}

static void smallest_image(const char *word, size_t n, int ends, char *smallest) {
  char image[MOST];
  memcpy(smallest, word, n);
  for (size_t g = 0; g < 4 * shifts_of(n, ends); g++) {
    image_of_word(word, n, (ric_symmetry){.shift = g / 4, .reflect = g & 1, .exchange = g & 2}, image);
    if (compare_words(image, smallest, n) < 0)
      memcpy(smallest, image, n);
  }
}

/* The representative, by the library: reduce, then take the image. */
static void representative(const char *word, size_t n, int ends, char *found) {
  ric_pattern *pattern = pattern_of(word, n), *image;
  ric_symmetry symmetry;
  assert_int_equal(ric_pattern_reduce(pattern, (ric_ends)ends, &symmetry, NULL), RIC_OK);
  assert_int_equal(ric_pattern_image(pattern, (ric_ends)ends, symmetry, &image, NULL), RIC_OK);
  word_of(image, found);
  ric_pattern_destroy(&pattern);
  ric_pattern_destroy(&image);
}

/* Hence all images of a pattern have the same representative: the smallest image is one of the orbit, not of the word.
 */
static void representative_is_the_smallest_of_all_images(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t n = 1; n <= MOST; n++) {
      char word[MOST + 1] = "........", expected[MOST], found[MOST];
      while (next_word(word, n)) {
        smallest_image(word, n, ends, expected);
        representative(word, n, ends, found);
        assert_memory_equal(found, expected, n);
      }
    }
}

static void images_are_those_of_the_definition(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t n = 1; n <= 5; n++) {
      char word[MOST + 1] = "........", expected[MOST], found[MOST];
      while (next_word(word, n))
        for (size_t g = 0; g < 4 * shifts_of(n, ends); g++) {
          ric_symmetry symmetry = {.shift = g / 4, .reflect = g & 1, .exchange = g & 2};
          ric_pattern *pattern = pattern_of(word, n), *image;
          assert_int_equal(ric_pattern_image(pattern, (ric_ends)ends, symmetry, &image, NULL), RIC_OK);
          word_of(image, found);
          image_of_word(word, n, symmetry, expected);
          assert_memory_equal(found, expected, n);
          ric_pattern_destroy(&pattern);
          ric_pattern_destroy(&image);
        }
    }
}

static ric_pattern *image_of(const ric_pattern *pattern, size_t shift, int reflect, int exchange) {
  ric_pattern *image;
  ric_symmetry symmetry = {.shift = shift, .reflect = reflect, .exchange = exchange};
  assert_int_equal(ric_pattern_image(pattern, RIC_ENDS_PERIODIC, symmetry, &image, NULL), RIC_OK);
  return image;
}

static void assert_equal_and_destroy(ric_pattern *a, ric_pattern *b) {
  assert_true(ric_pattern_equal(a, b));
  ric_pattern_destroy(&a);
  ric_pattern_destroy(&b);
}

/* Shifts add, reflections and exchanges undo themselves, and reflecting turns a shift around. */
static void images_compose_like_the_group(void **state) {
  (void)state;
  ric_pattern *pattern = pattern_of("s.hs..h.", 8);
  for (size_t a = 0; a < 8; a++)
    for (size_t b = 0; b < 8; b++) {
      ric_pattern *by_a = image_of(pattern, a, 0, 0), *reflected = image_of(by_a, b, 1, 1);
      assert_equal_and_destroy(image_of(by_a, b, 0, 0), image_of(pattern, (a + b) % 8, 0, 0));
      assert_equal_and_destroy(image_of(reflected, 0, 1, 1), image_of(pattern, (a + 8 - b) % 8, 0, 0));
      ric_pattern_destroy(&by_a);
      ric_pattern_destroy(&reflected);
    }
  ric_pattern_destroy(&pattern);
}

static void shifts_that_the_chain_does_not_have_are_refused(void **state) {
  (void)state;
  ric_pattern *pattern = pattern_of("s..h", 4), *image;
  ric_error error;
  const struct {
    ric_ends ends;
    size_t shift;
  } cases[] = {{RIC_ENDS_PERIODIC, 4}, {RIC_ENDS_FIXED, 1}, {RIC_ENDS_FREE, 3}};
  for (size_t k = 0; k < 3; k++) {
    ric_symmetry symmetry = {.shift = cases[k].shift};
    assert_int_equal(ric_pattern_image(pattern, cases[k].ends, symmetry, &image, &error), RIC_EINVAL);
    assert_non_null(strstr(error.message, "shift"));
  }
  ric_pattern_destroy(&pattern);
}

/* Periodic words have many equal rotations: the search for the least one must not be quadratic. */
static void long_patterns_are_reduced_in_linear_time(void **state) {
  (void)state;
  enum { LONG = 1000000 };
  size_t *start = malloc(LONG / 2 * sizeof *start);
  assert_non_null(start);
  for (size_t i = 0; i < LONG / 2; i++)
    start[i] = 2 * i + 1;
  ric_pattern *pattern, *image;
  ric_symmetry symmetry;
  assert_int_equal(ric_pattern_create(LONG, start, LONG / 2, NULL, 0, &pattern, NULL), RIC_OK);
  assert_int_equal(ric_pattern_reduce(pattern, RIC_ENDS_PERIODIC, &symmetry, NULL), RIC_OK);
  assert_int_equal(ric_pattern_image(pattern, RIC_ENDS_PERIODIC, symmetry, &image, NULL), RIC_OK);
  assert_int_equal(ric_pattern_role(image, 0), RIC_ROLE_START);
  ric_pattern_destroy(&image);
  ric_pattern_destroy(&pattern);
  free(start);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(representative_is_the_smallest_of_all_images),
      cmocka_unit_test(images_are_those_of_the_definition),
      cmocka_unit_test(images_compose_like_the_group),
      cmocka_unit_test(shifts_that_the_chain_does_not_have_are_refused),
      cmocka_unit_test(long_patterns_are_reduced_in_linear_time),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
