/* Cycles of several impacts that random maps come to: iterates stay inside of their windows and leave outside. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/grazing_maps.h"
#include "map_lines.h"

enum { MOST_SIZE = 5 };

/* The period up to `most` of what z comes to; 0: none. */
static size_t period_of(const ric_grazing_map *map, double d, double *z, size_t transient, size_t most) {
  double start[MOST_SIZE], work[MOST_SIZE];
  map_iterate(map, d, z, transient, work);
  memcpy(start, z, map->size * sizeof *z);
  for (size_t n = 1; n <= most && isfinite(z[0]); n++) {
    map_iterate(map, d, z, 1, work);
    if (relative_distance(z, start, map->size) < 1e-10)
      return n;
  }
  return 0;
}

/* Whether two states have the same impacts in n iterates; both are moved on. */
static bool same_itinerary(const ric_grazing_map *map, double d_a, double *a, double d_b, double *b, size_t n) {
  double work[MOST_SIZE];
  bool same = true;
  for (size_t k = 0; k < n; k++) {
    same = same && ric_grazing_map_hits(map, d_a, a) == ric_grazing_map_hits(map, d_b, b);
    map_iterate(map, d_a, a, 1, work);
    map_iterate(map, d_b, b, 1, work);
  }
  return same;
}

/* Whether iterates from beside a cycle, that of `home` inside its window, come to rest with its impacts. */
static bool stays(const ric_grazing_map *map, double d, size_t n, const double *cycle, double home) {
  double z[MOST_SIZE], back[MOST_SIZE], old[MOST_SIZE], work[MOST_SIZE];
  for (size_t i = 0; i < map->size; i++)
    z[i] = cycle[i] * (1 + 1e-9);
  map_iterate(map, d, z, 30000 / n * n, work);
  memcpy(back, z, sizeof z);
  memcpy(old, cycle, sizeof old);
  for (size_t k = 1; k < n; k++) { /* a shorter period is another motion */
    map_iterate(map, d, back, 1, work);
    if (relative_distance(back, z, map->size) < 1e-5)
      return false;
  }
  memcpy(back, z, sizeof z);
  const bool same = isfinite(z[0]) && same_itinerary(map, d, back, home, old, n);
  return same && relative_distance(back, z, map->size) < 1e-8;
}

/* The cycle beside an edge, from one at `from`, in steps that are predicted from the last two. */
static ric_cycle_window cycle_beside(const ric_map_line *line, size_t n, double from, double edge, double to,
                                     double *z) {
  double last[MOST_SIZE], guess[MOST_SIZE], at = from, before = from;
  ric_cycle_window w = {0};
  memcpy(last, z, line->size * sizeof *z);
  while (at != to) {
    double p = edge + (at == from ? 1 - 1e-4 : 0.93) * (at - edge);
    p = fabs(p - edge) < fabs(to - edge) ? to : p;
    for (size_t i = 0; i < line->size; i++)
      guess[i] = z[i] + (at != before ? (z[i] - last[i]) / (at - before) * (p - at) : 0);
    memcpy(last, z, line->size * sizeof *z);
    assert_int_equal(ric_cycle_find(line, p, n, guess, &w, NULL), RIC_OK);
    memcpy(z, guess, line->size * sizeof *z);
    before = at;
    at = p;
  }
  return w;
}

/* Where a cycle is born of one of half its period: beyond that edge is the other one, whose flip it is. */
static bool check_half(ric_grazing_map *map, const ric_cycle_window *w, double edge, double outside, double *z) {
  const ric_map_line line = map_line_along_d(map);
  ric_cycle_window found;
  if (period_of(map, outside, z, 30000, w->period) * 2 != w->period ||
      ric_cycle_find(&line, outside, w->period / 2, z, &found, NULL) != RIC_OK)
    return false;
  const ric_cycle_window half = cycle_window_of(&line, outside, w->period / 2, outside - 1, outside + 1, z);
  const ric_cycle_edge *flip = edge > outside ? &half.high : &half.low;
  if (flip->kind != RIC_EDGE_FLIP || half.impacts * 2 != w->impacts ||
      fabs(flip->p - edge) > 1e-2 * fabs(outside - edge)) /* another cycle */
    return false;
  assert_close(flip->p, edge, 1e-9 * fabs(edge));
  return true;
}

/* Beyond a fold motion may come to another cycle with the same impacts, which is there before the fold, too. */
static void check_another(ric_grazing_map *map, const ric_cycle_window *w, const ric_cycle_edge *edge, double outside,
                          const double *cycle) {
  const ric_map_line line = map_line_along_d(map);
  double z[MOST_SIZE], work[MOST_SIZE];
  assert_int_equal(edge->kind, RIC_EDGE_FOLD);
  memcpy(z, cycle, sizeof z);
  map_iterate(map, outside, z, 30000 / w->period * w->period, work);
  const ric_cycle_window other = cycle_window_of(&line, outside, w->period, outside - 1, outside + 1, z);
  assert_true(other.low.p < fmin(edge->p, outside) && other.high.p > fmax(edge->p, outside));
  assert_true(fabs(other.low.p - edge->p) > 1e-3 * fabs(w->p - edge->p));
  assert_true(fabs(other.high.p - edge->p) > 1e-3 * fabs(w->p - edge->p));
}

/* Iterates from beside the cycle stay a little inside of the edge, and leave a little outside. */
static void check_by_iterating(ric_grazing_map *map, const ric_cycle_window *w, const double *z, size_t *halved) {
  const ric_map_line line = map_line_along_d(map);
  const ric_cycle_edge *edges[] = {&w->low, &w->high};
  for (int k = 0; k < 2; k++) {
    if (edges[k]->kind == RIC_EDGE_OPEN)
      continue;
    const double part = 0.02 * (w->p - edges[k]->p), inside = edges[k]->p + part;
    double at_edge[MOST_SIZE];
    memcpy(at_edge, z, map->size * sizeof *z);
    const ric_cycle_window there = cycle_beside(&line, w->period, w->p, edges[k]->p, inside, at_edge);
    assert_int_equal(there.impacts, w->impacts);
    assert_true(there.stable);
    assert_true(stays(map, inside, w->period, at_edge, inside));
    const double outside = edges[k]->p - part;
    if (stays(map, outside, w->period, at_edge, inside))
      check_another(map, w, edges[k], outside, at_edge);
    if (edges[k]->kind == RIC_EDGE_FOLD)
      *halved += check_half(map, w, edges[k]->p, outside, at_edge);
  }
}

typedef struct tally {
  size_t windows, impacts, period, halved, kinds[RIC_GRAZING_EDGES];
} tally;

/* Windows of what random maps come to, where that has more than one impact. */
static void collect(random_source *source, double least, double most, size_t maps, tally *t) {
  for (size_t k = 0; k < maps; k++) {
    ric_grazing_map map = random_map(source, 1 + k % MOST_SIZE, random_uniform(source, least, most));
    const ric_map_line line = map_line_along_d(&map);
    const double d = random_uniform(source, -1, 2);
    double z[MOST_SIZE];
    ric_cycle_window w;
    for (size_t i = 0; i < map.size; i++)
      z[i] = random_uniform(source, -1, 1);
    const size_t n = period_of(&map, d, z, 6000, 60);
    if (n > 1 && ric_cycle_find(&line, d, n, z, &w, NULL) == RIC_OK && w.impacts > 1 && w.stable) {
      w = cycle_window_of(&line, d, n, d - 1, d + 1, z);
      check_by_iterating(&map, &w, z, &t->halved);
      t->kinds[w.low.kind]++;
      t->kinds[w.high.kind]++;
      t->impacts = w.impacts > t->impacts ? w.impacts : t->impacts;
      t->period = n > t->period ? n : t->period;
      t->windows++;
    }
    ric_grazing_map_clear(&map);
  }
  print_message("[ %zu windows, periods up to %zu, impacts up to %zu; edges: border %zu, flip %zu, fold %zu, complex "
                "%zu, open %zu ]\n",
                t->windows, t->period, t->impacts, t->kinds[RIC_EDGE_BORDER], t->kinds[RIC_EDGE_FLIP],
                t->kinds[RIC_EDGE_FOLD], t->kinds[RIC_EDGE_COMPLEX], t->kinds[RIC_EDGE_OPEN]);
}

static void windows_of_several_impacts_hold_what_they_say(void **state) {
  (void)state;
  random_source source = {24};
  tally t = {0};
  collect(&source, 0.3, 0.99, 3000, &t);
  assert_true(t.windows >= 20 && t.impacts >= 4 && t.halved > 0);
}

/* Motions that may grow between impacts: those cycles are cut into pieces. */
static void windows_of_growing_maps_hold_what_they_say(void **state) {
  (void)state;
  random_source source = {25};
  tally t = {0};
  collect(&source, 1, 2.5, 3000, &t);
  assert_true(t.windows >= 20);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(windows_of_several_impacts_hold_what_they_say),
      cmocka_unit_test(windows_of_growing_maps_hold_what_they_say),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
