#include "pattern_roles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

ric_status ric_pattern_create(size_t particles, const size_t *start, size_t start_count, const size_t *half,
                              size_t half_count, ric_pattern **pattern, ric_error *error) {
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

void ric_pattern_destroy(ric_pattern **pattern) {
  if (!pattern || !*pattern)
    return;
  free((*pattern)->impact);
  free((*pattern)->role);
  free(*pattern);
  *pattern = NULL;
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
