/* Images of patterns and their canonical representatives. */
#include <stdlib.h>

#include "ricochet/pattern.h"

/* Letters in the order of the canonical word. */
enum { LETTER_START, LETTER_HALF, LETTER_FREE };

static unsigned char letter(ric_role role, bool exchange) {
  if (role == RIC_ROLE_FREE)
    return LETTER_FREE;
  return (role == RIC_ROLE_START) != exchange ? LETTER_START : LETTER_HALF;
}

static void write_word(const ric_pattern *pattern, bool reflect, bool exchange, unsigned char *word) {
  size_t n = ric_pattern_particles(pattern);
  for (size_t i = 0; i < n; i++)
    word[i] = letter(ric_pattern_role(pattern, reflect ? n - 1 - i : i), exchange);
}

/* Start of the least rotation of a word, by two racing candidates; O(n). */
static size_t least_rotation(const unsigned char *word, size_t n) {
  size_t a = 0, b = 1, matched = 0;
  while (a < n && b < n && matched < n) {
    unsigned char x = word[(a + matched) % n], y = word[(b + matched) % n];
    if (x == y) {
      matched++;
      continue;
    }
    if (x > y)
      a += matched + 1;
    else
      b += matched + 1;
    if (a == b)
      b++;
    matched = 0;
  }
  return a < b ? a : b;
}

/* Whether the word read from `from` comes before the other read from `other_from`. */
static bool comes_before(const unsigned char *word, size_t from, const unsigned char *other, size_t other_from,
                         size_t n) {
  for (size_t i = 0; i < n; i++) {
    unsigned char x = word[(from + i) % n], y = other[(other_from + i) % n];
    if (x != y)
      return x < y;
  }
  return false;
}

ric_status ric_pattern_reduce(const ric_pattern *pattern, ric_ends ends, ric_symmetry *symmetry, ric_error *error) {
  size_t n = ric_pattern_particles(pattern), best_from = 0;
  unsigned char *best = malloc(2 * n), *word = best ? best + n : NULL, *owner = best;
  if (!best)
    return ric_fail(error, RIC_ENOMEM, "no memory for the words of %zu particles", n);
  for (int image = 0; image < 4; image++) {
    bool reflect = image & 1, exchange = image & 2;
    write_word(pattern, reflect, exchange, image == 0 ? best : word);
    size_t from = ends == RIC_ENDS_PERIODIC ? least_rotation(image == 0 ? best : word, n) : 0;
    if (image > 0 && !comes_before(word, from, best, best_from, n))
      continue;
    if (image > 0) {
      unsigned char *previous = best;
      best = word;
      word = previous;
    }
    best_from = from;
    *symmetry = (ric_symmetry){.shift = (n - from) % n, .reflect = reflect, .exchange = exchange};
  }
  free(owner);
  return RIC_OK;
}

/* Particle of the image that particle i becomes. */
static size_t image_of(size_t i, size_t n, ric_symmetry symmetry) {
  return ((symmetry.reflect ? n - 1 - i : i) + symmetry.shift) % n;
}

ric_status ric_pattern_image(const ric_pattern *pattern, ric_ends ends, ric_symmetry symmetry, ric_pattern **image,
                             ric_error *error) {
  size_t n = ric_pattern_particles(pattern), m = ric_pattern_impacts(pattern), starts = 0, halves = 0;
  if (symmetry.shift >= n || (ends != RIC_ENDS_PERIODIC && symmetry.shift != 0))
    return ric_fail(error, RIC_EINVAL, "shift = %zu, expected %s", symmetry.shift,
                    ends == RIC_ENDS_PERIODIC ? "less than the number of particles" : "0 on a chain with ends");
  size_t *start = calloc(2 * m, sizeof *start), *half = start ? start + m : NULL;
  if (!start)
    return ric_fail(error, RIC_ENOMEM, "no memory for a pattern of %zu impacts", m);
  for (size_t r = 0; r < m; r++) {
    size_t particle = ric_pattern_impact(pattern, r), to = image_of(particle, n, symmetry);
    if (letter(ric_pattern_role(pattern, particle), symmetry.exchange) == LETTER_START)
      start[starts++] = to;
    else
      half[halves++] = to;
  }
  ric_status status = ric_pattern_create(n, start, starts, half, halves, image, error);
  free(start);
  return status;
}
