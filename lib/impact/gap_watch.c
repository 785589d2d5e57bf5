/* The smallest gaps along a periodic motion, and when the first obstacle is passed. */
#include "gap_watch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Relative, on large values of minima: less would not take anything away from them. */
static const double value_rounding = 1e-14;

static const gap_found nothing = {.value = INFINITY, .time = NAN, .obstacle = NO_OBSTACLE};

void gap_watch_begin(gap_watch *w, double tolerance, double zero, double most_own) {
  *w = (gap_watch){.tolerance = tolerance,
                   .zero = zero,
                   .most_own = most_own,
                   .free = nothing,
                   .own = nothing,
                   .first = nothing,
                   .next_free = INFINITY,
                   .next_own = most_own};
  w->first.time = INFINITY;
}

static double time_at(const gap_piece *p, double y) {
  return p->start + (p->from + y * (p->to - p->from)) * p->length;
}

static void keep(gap_watch *w, bool hit, gap_found found) {
  gap_found *best = hit ? &w->own : &w->free;
  if (!(found.value < best->value))
    return;
  *best = found;
  double next = found.value - fmax(w->tolerance, value_rounding * fabs(found.value));
  if (hit)
    w->next_own = fmin(next, w->most_own);
  else
    w->next_free = next;
}

static void keep_at(gap_watch *w, const gap_piece *p, double value, double y) {
  keep(w, p->hit, (gap_found){.value = value, .time = time_at(p, y), .obstacle = p->obstacle, .divided = p->divided});
}

/* The same of a divided polynomial. What it says of a violation is told by the gap itself, if that is one. */
static void keep_divided(gap_watch *w, const gap_piece *p, double value, double y) {
  gap_piece whole = *p;
  double least, at;
  whole.c--;
  whole.degree++;
  whole.divided = false;
  if (value < -w->zero && ric_poly_minimum(whole.c, whole.degree, -w->zero, w->tolerance, &at, &least))
    keep_at(w, &whole, least, at);
  else
    keep_at(w, p, value, y);
}

/* When the gap first falls below -zero; first in time is last in x where time runs back. */
static void find_violation(gap_watch *w, const gap_piece *p) {
  double c[RIC_POLY_DEGREE + 1], x;
  bool back = p->length < 0;
  if (!(time_at(p, back) < w->first.time))
    return;
  if (back)
    ric_poly_reflect(p->c, p->degree, c);
  else
    memcpy(c, p->c, (size_t)(p->degree + 1) * sizeof *c);
  c[0] += w->zero;
  if (!ric_poly_first_root(c, p->degree, &x))
    return;
  double time = time_at(p, back ? 1 - x : x);
  if (time < w->first.time)
    w->first = (gap_found){.value = -w->zero, .time = time, .obstacle = p->obstacle};
}

void gap_watch_value(gap_watch *w, const gap_piece *p) {
  double x, value;
  if (ric_poly_minimum(p->c, p->degree, p->hit ? w->next_own : w->next_free, w->tolerance, &x, &value)) {
    if (p->divided)
      keep_divided(w, p, value, x);
    else
      keep_at(w, p, value, x);
  }
  if (fmin(w->free.value, w->own.value) < -w->zero)
    find_violation(w, p);
}

/* The slope at 0 and at 1. */
static void ends_of_slope(const gap_piece *p, double *first, double *last) {
  *first = *last = p->degree > 0 ? p->c[1] : 0;
  for (int j = 2; j <= p->degree; j++)
    *last += j * p->c[j];
}

/* Looks for local minima, also one between the last polynomial of the obstacle and this.
 * @param slope  in time at the end of the last one, NaN after an impact; set to that at the end of this one */
static void gap_watch_minima(gap_watch *w, const gap_piece *p, double *slope) {
  double x, value, first, last, sense = copysign(1, p->length);
  ends_of_slope(p, &first, &last);
  if (*slope < 0 && sense * first > 0)
    keep_at(w, p, p->c[0], 0);
  while (ric_poly_first_minimum(p->c, p->degree, w->next_own, &x, &value))
    keep_at(w, p, value, x);
  *slope = sense * last;
  if (w->own.value < -w->zero)
    find_violation(w, p);
}

/* Adds a minimum of an obstacle that is hit. */
static void gap_watch_add(gap_watch *w, double value, double time, size_t obstacle) {
  keep(w, true, (gap_found){.value = value, .time = time, .obstacle = obstacle});
  if (value < -w->zero && time < w->first.time)
    w->first = (gap_found){.value = -w->zero, .time = time, .obstacle = obstacle};
}

/* --- the gaps of a system ----------------------------------------------------------------------------------------- */

enum { HALVINGS = 30 };

static const double system_tol = 1e-14;

ric_status system_gaps_init(system_gaps *g, ric_flow *flow, ric_error *error) {
  size_t count = flow->system->obstacle_count, n = flow->system->coordinates;
  *g = (system_gaps){.system = flow->system};
  RIC_TRY(gap_reader_init(&g->reader, flow, error));
  g->hit = calloc(count + 1, sizeof *g->hit);
  g->slope = malloc((count + 1 + 2 * n) * sizeof *g->slope);
  if (!g->hit || !g->slope)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu gaps", count);
  g->lower = g->slope + count + 1;
  g->upper = g->lower + n;
  return RIC_OK;
}

void system_gaps_clear(system_gaps *g) {
  gap_reader_clear(&g->reader);
  free(g->hit);
  free(g->slope);
  *g = (system_gaps){0};
}

void system_gaps_begin(system_gaps *g, double zero) {
  gap_watch_begin(&g->watch, system_tol, zero, INFINITY);
  g->trouble = NULL;
  g->any_free = false;
  for (size_t j = 0; j < g->system->obstacle_count; j++) {
    g->slope[j] = NAN;
    g->any_free = g->any_free || (!g->hit[j] && !system_complies(g->system, j));
  }
}

void system_gaps_after(system_gaps *g, size_t obstacle) {
  g->slope[obstacle] = NAN;
}

/* The gap of a coordinate is read on the whole of a segment: cuts it off at the end. */
static void cut(gap_part *part, double end) {
  double power = 1;
  for (int j = 1; j <= part->degree; j++)
    part->c[j] *= power *= end;
  part->to = end;
}

static void watch_part(system_gaps *g, const ric_segment *s, size_t obstacle, double from, double to, double before,
                       int halvings) {
  gap_part part;
  const char *trouble = gap_read(&g->reader, s, obstacle, WATCH_GAP, from, to, &part);
  if (trouble) {
    g->trouble = trouble;
    return;
  }
  if (g->system->obstacles && to < 1)
    cut(&part, to);
  if (!gap_is_resolved(&part, before) && halvings > 0) {
    double middle = (from + to) / 2;
    watch_part(g, s, obstacle, from, middle, part.residual, halvings - 1);
    watch_part(g, s, obstacle, middle, to, part.residual, halvings - 1);
    return;
  }
  const gap_piece p = {.c = part.c,
                       .degree = part.degree,
                       .start = s->start,
                       .length = s->length,
                       .from = part.from,
                       .to = part.to,
                       .obstacle = obstacle,
                       .hit = g->hit[obstacle]};
  if (p.hit)
    gap_watch_minima(&g->watch, &p, &g->slope[obstacle]);
  else
    gap_watch_value(&g->watch, &p);
}

/* Obstacles at the coordinates of a segment, most of which bounds exclude. */
static void watch_coordinates(system_gaps *g, const ric_segment *s, double end) {
  const ric_system *system = g->system;
  double from = fmin(s->start, s->start + end * s->length);
  if (g->any_free)
    ric_segment_bounds(s, g->lower, g->upper);
  for (size_t k = system_first_obstacle(system, s->first); k < system->obstacle_count; k++) {
    size_t j = system->by_coordinate[k];
    const ric_obstacle *o = &system->obstacles[j];
    size_t i = o->coordinate - s->first;
    if (i >= s->coordinates)
      break;
    if (o->stiffness == INFINITY &&
        (g->hit[j] || gap_watch_cares(&g->watch, false, obstacle_least_gap(o, g->lower[i], g->upper[i]), from)))
      watch_part(g, s, j, 0, end, INFINITY, 0);
  }
}

void system_gaps_segment(system_gaps *g, const ric_segment *s, double end) {
  gap_reader_reset(&g->reader);
  if (g->system->obstacles)
    watch_coordinates(g, s, end);
  for (size_t j = 0; !g->system->obstacles && j < g->system->obstacle_count; j++)
    watch_part(g, s, j, 0, end, INFINITY, HALVINGS);
}

/* Whether a gap is smallest where its coordinate turns: at rest, or thrown back by another obstacle of the same side.
 */
static bool turns_around(const system_gaps *g, size_t obstacle, size_t hit, const double *acceleration) {
  const ric_obstacle *o = &g->system->obstacles[obstacle];
  if (hit != NO_OBSTACLE)
    return hit != obstacle && g->system->obstacles[hit].side == o->side;
  return o->side * acceleration[o->coordinate] >= 0;
}

void system_gaps_turn(system_gaps *g, const size_t *hit, double time, const double *q, const double *rates) {
  for (size_t j = 0; j < g->system->obstacle_count; j++) {
    const ric_obstacle *o = &g->system->obstacles[j];
    if (g->hit[j] && turns_around(g, j, hit[o->coordinate], rates + g->system->coordinates))
      gap_watch_add(&g->watch, ric_obstacle_gap(o, q[o->coordinate]), time, j);
  }
}

void system_gaps_close(system_gaps *g, size_t obstacle, double time, const double *before, const double *after) {
  size_t n = g->system->coordinates;
  for (size_t j = 0; j < g->system->obstacle_count; j++)
    if (g->hit[j] && j != obstacle && ric_system_gap_rate(g->system, j, time, before, before + n) < 0 &&
        ric_system_gap_rate(g->system, j, time, after, after + n) > 0)
      gap_watch_add(&g->watch, ric_system_gap(g->system, j, time, before), time, j);
}
