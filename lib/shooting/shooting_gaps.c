#include "shooting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HALVINGS = 30 };

/* On values of minima, absolute; relative to values above 1, from which less would not take anything away. */
static const double minimum_tol = 1e-14;

static ric_status build_gaps(shooting_gaps *g, ric_shooting *s, ric_error *error) {
  size_t count = s->system->obstacle_count, n = s->arcs.coordinates;
  *g = (shooting_gaps){.s = s, .zero = s->grazing_tol};
  RIC_TRY(gap_reader_init(&g->reader, arc_runner_flow(&s->runner), error));
  g->hit = calloc(count + 1, sizeof *g->hit);
  g->slope = malloc((count + 1 + 2 * n) * sizeof *g->slope);
  if (!g->hit || !g->slope)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu gaps", count);
  g->lower = g->slope + count + 1;
  g->upper = g->lower + n;
  for (size_t k = 0; k < s->arcs.sequence_count; k++)
    g->hit[s->arcs.sequence[k]] = true;
  for (size_t i = 0; s->arcs.kind == RIC_MOTION_EVEN && i < n; i++) {
    if (s->arcs.at_start[i] != NO_UNKNOWN)
      g->hit[s->arcs.at_start[i]] = true;
    if (s->arcs.at_half[i] != NO_UNKNOWN)
      g->hit[s->arcs.at_half[i]] = true;
  }
  for (size_t j = 0; j < count; j++)
    g->any_free = g->any_free || (!g->hit[j] && !system_complies(s->system, j));
  return RIC_OK;
}

ric_status shooting_gaps_create(ric_shooting *s, shooting_gaps **gaps, ric_error *error) {
  *gaps = calloc(1, sizeof **gaps);
  if (!*gaps)
    return ric_fail(error, RIC_ENOMEM, "no memory for the gaps of a motion");
  ric_status status = build_gaps(*gaps, s, error);
  if (status != RIC_OK)
    shooting_gaps_destroy(gaps);
  return status;
}

void shooting_gaps_destroy(shooting_gaps **gaps) {
  if (!*gaps)
    return;
  gap_reader_clear(&(*gaps)->reader);
  free((*gaps)->hit);
  free((*gaps)->slope);
  free(*gaps);
  *gaps = NULL;
}

void shooting_gaps_reset(shooting_gaps *g) {
  g->free = g->own = g->first = (gap_found){INFINITY, NAN, NO_UNKNOWN};
  g->trouble = NULL;
}

/* The piece before ended with an impact of an obstacle: its gap starts anew. */
static void forget_slope_of_last(shooting_gaps *g, const piece_run *run) {
  if (run->piece > g->s->arcs.pieces && (run->piece - 1)->how == PIECE_IMPACT)
    g->slope[(run->piece - 1)->obstacle] = NAN;
}

void shooting_gaps_begin(shooting_gaps *g, const piece_run *run) {
  g->run = run;
  if (run->piece == g->s->arcs.pieces)
    for (size_t j = 0; j < g->s->system->obstacle_count; j++)
      g->slope[j] = NAN;
  forget_slope_of_last(g, run);
}

static void keep_smaller(gap_found *best, double value, double time, size_t obstacle) {
  if (value < best->value)
    *best = (gap_found){value, time, obstacle};
}

/* What a value must not exceed to be smaller: a search that goes on below it makes progress. */
static double below(const gap_found *best) {
  return best->value < INFINITY ? best->value - minimum_tol * fmax(1, fabs(best->value)) : INFINITY;
}

/* The gap of an obstacle on a part of a segment. */
typedef struct gap_view {
  shooting_gaps *g;
  const ric_segment *piece;
  size_t obstacle;
  const gap_part *part;
} gap_view;

static double time_at(const gap_view *v, double y) {
  double x = v->part->from + y * (v->part->to - v->part->from);
  return v->piece->start + x * v->piece->length;
}

/* When the gap first falls below -zero; segments may run backwards in time, and then it is the last. */
static void look_for_violation(const gap_view *v) {
  double c[RIC_POLY_DEGREE + 1], y;
  if (v->g->first.obstacle != NO_UNKNOWN && !(time_at(v, 0) < v->g->first.time))
    return;
  memcpy(c, v->part->c, (size_t)(v->part->degree + 1) * sizeof *c);
  c[0] += v->g->zero;
  if (ric_poly_first_root(c, v->part->degree, &y) && !(time_at(v, y) >= v->g->first.time))
    v->g->first = (gap_found){-v->g->zero, time_at(v, y), v->obstacle};
}

static void look_at_free(const gap_view *v) {
  double y, value;
  gap_found *best = &v->g->free;
  if (ric_poly_minimum(v->part->c, v->part->degree, below(best), minimum_tol, &y, &value))
    keep_smaller(best, value, time_at(v, y), v->obstacle);
  if (best->value < -v->g->zero)
    look_for_violation(v);
}

/* The slope at 0 and at 1. */
static void ends_of_slope(const gap_part *part, double *first, double *last) {
  *first = *last = part->degree > 0 ? part->c[1] : 0;
  for (int j = 2; j <= part->degree; j++)
    *last += j * part->c[j];
}

/* Local minima inside the part, and one that lies between the last part and this; slopes are those forwards in time. */
static void look_at_own(const gap_view *v) {
  double y, value, slope, slope_end, *last = &v->g->slope[v->obstacle], sense = copysign(1, v->piece->length);
  gap_found *best = &v->g->own;
  ends_of_slope(v->part, &slope, &slope_end);
  if (*last < 0 && sense * slope > 0)
    keep_smaller(best, v->part->c[0], time_at(v, 0), v->obstacle);
  while (ric_poly_first_minimum(v->part->c, v->part->degree, below(best), &y, &value))
    keep_smaller(best, value, time_at(v, y), v->obstacle);
  *last = sense * slope_end;
  if (best->value < -v->g->zero)
    look_for_violation(v);
}

/* The gap of a coordinate is read on the whole of a segment: cuts it off at the end. */
static void cut(gap_part *part, double end) {
  double power = 1;
  for (int j = 1; j <= part->degree; j++)
    part->c[j] *= power *= end;
  part->to = end;
}

static void look_at_part(shooting_gaps *g, const ric_segment *piece, size_t obstacle, double from, double to,
                         double before, int halvings) {
  gap_part part;
  const char *trouble = gap_read(&g->reader, piece, obstacle, WATCH_GAP, from, to, &part);
  if (g->s->system->obstacles && to < 1)
    cut(&part, to);
  if (!trouble && !gap_is_resolved(&part, before) && halvings > 0) {
    double middle = (from + to) / 2;
    look_at_part(g, piece, obstacle, from, middle, part.residual, halvings - 1);
    look_at_part(g, piece, obstacle, middle, to, part.residual, halvings - 1);
    return;
  }
  gap_view view = {g, piece, obstacle, &part};
  if (trouble)
    g->trouble = trouble;
  else if (g->hit[obstacle])
    look_at_own(&view);
  else
    look_at_free(&view);
}

/* Obstacles at the coordinates of a segment, most of which bounds exclude. */
static void look_at_coordinates(shooting_gaps *g, const ric_segment *piece, double end) {
  const ric_system *system = g->s->system;
  if (g->any_free)
    ric_segment_bounds(piece, g->lower, g->upper);
  for (size_t k = system_first_obstacle(system, piece->first); k < system->obstacle_count; k++) {
    size_t j = system->by_coordinate[k];
    const ric_obstacle *o = &system->obstacles[j];
    size_t i = o->coordinate - piece->first;
    if (i >= piece->coordinates)
      break;
    if (o->stiffness == INFINITY && (g->hit[j] || obstacle_least_gap(o, g->lower[i], g->upper[i]) < g->free.value))
      look_at_part(g, piece, j, 0, end, INFINITY, 0);
  }
}

void shooting_gaps_segment(shooting_gaps *g, const ric_segment *piece, double end) {
  gap_reader_reset(&g->reader);
  if (g->s->system->obstacles)
    look_at_coordinates(g, piece, end);
  for (size_t j = 0; !g->s->system->obstacles && j < g->s->system->obstacle_count; j++)
    look_at_part(g, piece, j, 0, end, INFINITY, HALVINGS);
}

/* --- where segments do not tell ----------------------------------------------------------------------------------- */

static void add_own(shooting_gaps *g, double value, double time, size_t obstacle) {
  keep_smaller(&g->own, value, time, obstacle);
  if (value < -g->zero && !(time >= g->first.time))
    g->first = (gap_found){-g->zero, time, obstacle};
}

/* Whether a gap is smallest where its coordinate turns: at rest, or thrown back by another obstacle of the same side.
 */
static bool turns_around(const shooting_gaps *g, size_t obstacle, size_t hit) {
  const ric_system *system = g->s->system;
  const ric_obstacle *o = &system->obstacles[obstacle];
  if (hit != NO_UNKNOWN)
    return hit != obstacle && system->obstacles[hit].side == o->side;
  return o->side * g->s->rates[system->coordinates + o->coordinate] >= 0;
}

ric_status shooting_gaps_turn(shooting_gaps *g, const size_t *hit, double time, ric_error *error) {
  ric_shooting *s = g->s;
  const ric_system *system = s->system;
  size_t n = s->arcs.coordinates;
  RIC_TRY(ric_system_rate(system, time, s->x, s->x + n, s->rates, s->rates + n, error));
  for (size_t j = 0; j < system->obstacle_count; j++) {
    const ric_obstacle *o = &system->obstacles[j];
    if (g->hit[j] && turns_around(g, j, hit[o->coordinate]))
      add_own(g, ric_obstacle_gap(o, s->x[o->coordinate]), time, j);
  }
  return RIC_OK;
}

void shooting_gaps_close(shooting_gaps *g, const piece_run *run, const double *before, const double *after) {
  const ric_system *system = g->s->system;
  size_t n = g->s->arcs.coordinates;
  for (size_t j = 0; j < system->obstacle_count; j++)
    if (g->hit[j] && j != run->piece->obstacle && ric_system_gap_rate(system, j, run->end, before, before + n) < 0 &&
        ric_system_gap_rate(system, j, run->end, after, after + n) > 0)
      add_own(g, ric_system_gap(system, j, run->end, before), run->end, j);
}
