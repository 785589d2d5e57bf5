/* Patterns of impacts, their images and canonical representatives. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/pattern.h"
#include "unit_cell.h"
#include "numeric/required.h"

struct ric_pattern {
  size_t particles, start_count, half_count;
  size_t *impact;      /* [start_count + half_count] */
  unsigned char *role; /* [particles] */
};

static ric_status assign(ric_pattern *p, const size_t *list, size_t count, size_t offset, ric_role role,
                         ric_error *error) {
  const char *name = role == RIC_ROLE_START ? "start" : "half";
  for (size_t i = 0; i < count; i++) {
    if (list[i] >= p->particles)
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %zu, expected a particle from 0 to %zu", name, i, list[i],
                      p->particles - 1);
    if (p->role[list[i]] != RIC_ROLE_FREE)
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %zu is %s, expected one impact per particle", name, i, list[i],
                      p->role[list[i]] == role ? "given twice" : "in start, too");
    p->role[list[i]] = (unsigned char)role;
    p->impact[offset + i] = list[i];
  }
  return RIC_OK;
}

void ric_pattern_destroy(ric_pattern **pattern) {
  if (!pattern || !*pattern)
    return;
  free((*pattern)->impact);
  free((*pattern)->role);
  free(*pattern);
  *pattern = NULL;
}

ric_status ric_pattern_create(size_t particles, const size_t *start, size_t start_count, const size_t *half,
                              size_t half_count, ric_pattern **pattern, ric_error *error) {
  REQUIRE(error, {"start", unless_empty(start_count, start)}, {"half", unless_empty(half_count, half)},
          {"pattern", pattern});
  *pattern = NULL;
  if (particles < 1)
    return ric_fail(error, RIC_EINVAL, "particles = 0, expected at least 1");
  if (start_count > particles || half_count > particles || start_count + half_count < 1)
    return ric_fail(error, RIC_EINVAL, "%zu impacts at start and %zu at half, expected 1 to %zu in all", start_count,
                    half_count, particles);
  ric_status status = RIC_ENOMEM;
  ric_pattern *p = calloc(1, sizeof *p);
  if (p) {
    *p = (ric_pattern){.particles = particles, .start_count = start_count, .half_count = half_count};
    p->impact = calloc(start_count + half_count, sizeof *p->impact);
    p->role = calloc(particles, 1);
  }
  if (!p || !p->impact || !p->role)
    ric_fail(error, status, "no memory for a pattern of %zu particles", particles);
  else if ((status = assign(p, start, start_count, 0, RIC_ROLE_START, error)) == RIC_OK)
    status = assign(p, half, half_count, start_count, RIC_ROLE_HALF, error);
  if (status != RIC_OK)
    ric_pattern_destroy(&p);
  *pattern = p;
  return status;
}

size_t ric_pattern_particles(const ric_pattern *pattern) {
  return pattern->particles;
}

size_t ric_pattern_impacts(const ric_pattern *pattern) {
  return pattern->start_count + pattern->half_count;
}

size_t ric_pattern_impact(const ric_pattern *pattern, size_t index) {
  return pattern->impact[index];
}

ric_role ric_pattern_role(const ric_pattern *pattern, size_t particle) {
  return (ric_role)pattern->role[particle];
}

const unsigned char *pattern_roles(const ric_pattern *pattern) {
  return pattern->role;
}

bool ric_pattern_equal(const ric_pattern *a, const ric_pattern *b) {
  return a->particles == b->particles && memcmp(a->role, b->role, a->particles) == 0;
}

/* Appends "name i j k ... l (count) ", the first few particles and the last. */
static size_t append_list(char *text, size_t size, size_t used, const char *name, const size_t *list, size_t count) {
  enum { ALL = 6, FIRST = 3 };
  if (count == 0 || used >= size)
    return used;
  used += (size_t)snprintf(text + used, size - used, "%s ", name);
  for (size_t i = 0; i < (count > ALL ? FIRST : count) && used < size; i++)
    used += (size_t)snprintf(text + used, size - used, "%zu ", list[i]);
  if (count > ALL && used < size)
    used += (size_t)snprintf(text + used, size - used, "... %zu (%zu) ", list[count - 1], count);
  return used;
}

const char *ric_pattern_text(const ric_pattern *pattern, char *text, size_t size) {
  size_t used = append_list(text, size, 0, "start", pattern->impact, pattern->start_count);
  used = append_list(text, size, used, "half", pattern->impact + pattern->start_count, pattern->half_count);
  if (used < size)
    used += (size_t)snprintf(text + used, size - used, "of %zu", pattern->particles);
  if (used >= size && size > 3)
    memcpy(text + size - 4, "...", 4);
  return text;
}

/* Images of patterns and their canonical representatives. */

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
  REQUIRE(error, {"pattern", pattern}, {"symmetry", symmetry});
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
  REQUIRE(error, {"pattern", pattern}, {"image", image});
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
