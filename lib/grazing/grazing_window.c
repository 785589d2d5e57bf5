#include "ricochet/grazing_map.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>

#include "circle_crossings.h"
#include "one_impact.h"

const char *ric_grazing_edge_name(ric_grazing_edge_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_GRAZING_EDGE_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_GRAZING_EDGES ? names[kind] : "unknown edge";
}

/* Where the orbits of a period change: at an edge of their admissible range, or with a multiplier on the circle. */
typedef struct cuts {
  ric_grazing_edge *list; /* [size of the map + 4] by y, smallest first */
  size_t count;
} cuts;

/* The orbits are admissible where steady_j + slope_j y > 0 for all j: on one range of y at most. */
static bool find_admissible(const one_impact *o, ric_grazing_edge *low, ric_grazing_edge *high) {
  *low = (ric_grazing_edge){.kind = RIC_EDGE_ZERO, .y = 0};
  *high = (ric_grazing_edge){.kind = RIC_EDGE_OPEN, .y = INFINITY};
  for (size_t j = 1; j < o->period; j++) {
    double steady, slope;
    one_impact_clearance(o, j, &steady, &slope);
    double y = -steady / slope;
    if (slope == 0 && !(steady > 0))
      return false;
    if (slope > 0 && y > low->y)
      *low = (ric_grazing_edge){.kind = RIC_EDGE_BORDER, .y = y, .iterate = j};
    if (slope < 0 && y < high->y)
      *high = (ric_grazing_edge){.kind = RIC_EDGE_BORDER, .y = y, .iterate = j};
  }
  return low->y < high->y;
}

/* A cut that lies inside of the admissible range, the first two of the list. */
static void add_cut(cuts *c, ric_grazing_edge_kind kind, double y) {
  if (y > c->list[0].y && y < c->list[1].y)
    c->list[c->count++] = (ric_grazing_edge){.kind = kind, .y = y};
}

/* The multiplier -1: s / (2 y) eta (I + L^n)^-1 r xi + eta (I + L^n)^-1 r kappa = 1. */
static ric_status find_flip(one_impact *o, double *y, ric_error *error) {
  double first, second;
  for (size_t i = 0; i < o->map->size; i++)
    gsl_vector_set(o->vector, i, o->map->eta[i]);
  RIC_TRY(one_impact_solve(o, 1, true, o->vector, error));
  gsl_blas_ddot(o->vector, o->xi, &first);
  gsl_blas_ddot(o->vector, o->kappa, &second);
  *y = o->map->stretch * first / (2 * (1 - second));
  return RIC_OK;
}

static int by_y(const void *a, const void *b) {
  double first = ((const ric_grazing_edge *)a)->y, second = ((const ric_grazing_edge *)b)->y;
  return (first > second) - (first < second);
}

static ric_status find_cuts(one_impact *o, cuts *c, double *crossings, ric_error *error) {
  size_t n = o->period, found;
  double flip;
  c->count = 0;
  if (!find_admissible(o, &c->list[0], &c->list[1]))
    return RIC_OK;
  c->count = 2;
  RIC_TRY(find_flip(o, &flip, error));
  add_cut(c, RIC_EDGE_FLIP, flip);
  add_cut(c, RIC_EDGE_FOLD, -o->first[n - 1] / (2 * (1 + o->second[n - 1]))); /* d' = 0 */
  RIC_TRY(circle_crossings_find(o, crossings, &found, error));
  for (size_t i = 0; i < found; i++)
    add_cut(c, RIC_EDGE_COMPLEX, crossings[i]);
  qsort(c->list, c->count, sizeof *c->list, by_y);
  for (size_t i = 0; i < c->count; i++)
    c->list[i].d = one_impact_d(o, c->list[i].y);
  return RIC_OK;
}

static double middle_of(double low, double high) {
  if (high == INFINITY)
    return low > 0 ? 2 * low : 1;
  return low > 0 ? sqrt(low) * sqrt(high) : high / 2;
}

/* In ln d; infinite where d comes to 0, or passes it. */
static double width_of(double low, double high) {
  return low * high > 0 ? fabs(log(high / low)) : INFINITY;
}

/* No multiplier crosses the circle between two cuts: one orbit tells for all. At a cut that leaves both sides stable
 * a pair has touched the circle only. */
static ric_status choose_widest(one_impact *o, const cuts *c, ric_grazing_window *window, ric_error *error) {
  const ric_grazing_edge *from = NULL, *chosen = NULL;
  double widest = 0;
  for (size_t i = 1; i < c->count; i++) {
    const ric_grazing_edge *a = &c->list[i - 1], *b = &c->list[i];
    if (!(a->y < b->y))
      continue;
    RIC_TRY(one_impact_multipliers(o, middle_of(a->y, b->y), error));
    bool stable = o->multipliers.largest < 1;
    from = !stable ? NULL : from && a->kind != RIC_EDGE_FOLD ? from : a;
    if (!from || from->d == b->d)
      continue;
    double width = width_of(from->d, b->d);
    if (!(width > widest || chosen == from))
      continue;
    chosen = from;
    widest = width;
    window->exists = true;
    window->low = from->d < b->d ? *from : *b;
    window->high = from->d < b->d ? *b : *from;
  }
  return RIC_OK;
}

ric_status ric_grazing_window_find(const ric_grazing_map *map, size_t period, ric_grazing_window *window,
                                   ric_error *error) {
  one_impact orbits;
  cuts c = {0};
  double *crossings = NULL;
  ric_grazing_window found = {.period = period};
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = one_impact_init(&orbits, map, period, error);
  if (status != RIC_OK)
    goto out;
  c.list = calloc(map->size + 4, sizeof *c.list);
  crossings = calloc(map->size, sizeof *crossings);
  if (!c.list || !crossings) {
    status = ric_fail(error, RIC_ENOMEM, "no memory for %zu edges of windows", map->size + 4);
    goto out;
  }
  status = find_cuts(&orbits, &c, crossings, error);
  if (status == RIC_OK)
    status = choose_widest(&orbits, &c, &found, error);
  if (status == RIC_OK)
    *window = found;
out:
  free(crossings);
  free(c.list);
  one_impact_clear(&orbits);
  gsl_set_error_handler(handler);
  return status;
}
