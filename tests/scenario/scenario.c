#include "scenario.h"

#include <stdlib.h>
#include <string.h>

void scenario_clear(scenario *s) {
  ric_pattern_destroy(&s->pattern);
}

static scenario on_chain(size_t particles, ric_ends ends, double gamma, double period) {
  scenario s = {.chain = ric_chain_default(particles, gamma), .period = period};
  s.chain.ends = ends;
  return s;
}

scenario scenario_single(size_t particles, ric_ends ends, double gamma, double period, size_t particle) {
  scenario s = on_chain(particles, ends, gamma, period);
  ric_pattern_create(particles, &particle, 1, NULL, 0, &s.pattern, NULL);
  return s;
}

scenario scenario_middle(size_t particles, ric_ends ends, double gamma, double period) {
  return scenario_single(particles, ends, gamma, period, particles / 2);
}

/* Pattern from letters [n]; NULL when none of them is an impact. */
static ric_pattern *pattern_of(const char *letters, size_t n) {
  ric_pattern *pattern = NULL;
  size_t *start = calloc(2 * n, sizeof *start), starts = 0, halves = 0;
  if (!start)
    return NULL;
  size_t *half = start + n;
  for (size_t i = 0; i < n; i++)
    if (letters[i] == 's')
      start[starts++] = i;
    else if (letters[i] == 'h')
      half[halves++] = i;
  ric_pattern_create(n, start, starts, half, halves, &pattern, NULL);
  free(start);
  return pattern;
}

scenario scenario_word(const char *word, size_t times, ric_ends ends, double gamma, double period) {
  size_t length = strlen(word), n = length * times;
  scenario s = on_chain(n, ends, gamma, period);
  char *letters = malloc(n);
  if (!letters)
    return s;
  for (size_t i = 0; i < n; i++)
    letters[i] = word[i % length];
  s.pattern = pattern_of(letters, n);
  free(letters);
  return s;
}

scenario scenario_random(random_source *source, const scenario_ranges *ranges) {
  static const ric_ends kinds[] = {RIC_ENDS_PERIODIC, RIC_ENDS_FIXED, RIC_ENDS_FREE};
  size_t n = 1 + random_below(source, ranges->most_particles);
  ric_ends ends = kinds[random_below(source, 3)];
  double gamma = random_uniform(source, 0, ranges->highest_gamma);
  double period = random_uniform(source, ranges->shortest_period, ranges->longest_period);
  scenario s = on_chain(n, ends, gamma, period);
  char *letters = malloc(n);
  if (!letters)
    return s;
  double density = random_uniform(source, 0, 1);
  for (size_t i = 0; i < n; i++)
    letters[i] = ".sh"[random_uniform(source, 0, 1) < density ? 1 + random_below(source, 2) : 0];
  letters[random_below(source, n)] = 's';
  s.pattern = pattern_of(letters, n);
  free(letters);
  return s;
}

scenario scenario_few(random_source *source, const scenario_ranges *ranges, size_t most_impacts) {
  static const ric_ends kinds[] = {RIC_ENDS_PERIODIC, RIC_ENDS_FIXED, RIC_ENDS_FREE};
  size_t n = 2 + random_below(source, ranges->most_particles - 1);
  ric_ends ends = kinds[random_below(source, 3)];
  double gamma = random_uniform(source, 0, ranges->highest_gamma);
  scenario s = on_chain(n, ends, gamma, random_uniform(source, ranges->shortest_period, ranges->longest_period));
  char *letters = malloc(n);
  if (!letters)
    return s;
  memset(letters, '.', n);
  for (size_t impacts = 1 + random_below(source, most_impacts); impacts > 0; impacts--)
    letters[random_below(source, n)] = "sh"[random_below(source, 2)];
  s.pattern = pattern_of(letters, n);
  free(letters);
  return s;
}

ric_status scenario_solve(const scenario *s, ric_orbit_solver *solver, ric_orbit *orbit, ric_error *error) {
  RIC_TRY(ric_orbit_init(orbit, s->chain.particles, ric_pattern_impacts(s->pattern), error));
  return ric_orbit_solve(solver, &s->chain, s->pattern, s->period, orbit, error);
}
