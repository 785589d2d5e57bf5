/* One piece of a motion: where it begins, where it ends, and how its end depends on what. */
#include <math.h>
#include <string.h>

#include "shooting_spectrum.h"

/* An even motion begins at rest, or on the obstacles that it has hit. */
static void even_start(const ric_shooting *s, const double *z, double *x) {
  size_t n = s->arcs.coordinates;
  for (size_t i = 0; i < n; i++) {
    size_t obstacle = s->arcs.at_start[i];
    x[i] = obstacle == NO_UNKNOWN ? z[i] : s->system->obstacles[obstacle].position;
    x[n + i] = obstacle == NO_UNKNOWN ? 0 : z[i];
  }
}

static bool begins_even(const ric_shooting *s, size_t piece) {
  return s->arcs.kind == RIC_MOTION_EVEN && piece == 0;
}

/* Whether the beginning of the piece is a time that moves, in a system that knows the time: then its derivative is
 * carried along, too. */
static bool carries_time(const ric_shooting *s, const arc_piece *p) {
  bool fixed = p->begin.index == NO_UNKNOWN && p->begin.of_period == 0 && p->from == 0;
  return s->forced && !fixed;
}

piece_run shooting_begin(ric_shooting *s, size_t piece, const double *z, double period, piece_wish wish) {
  const arc_piece *p = &s->arcs.pieces[piece];
  size_t numbers = piece == 0 ? arcs_first_numbers(&s->arcs) : s->arcs.size;
  bool whole = wish == WISH_WHOLE;
  if (begins_even(s, piece))
    even_start(s, z, s->x);
  else
    memcpy(s->x, z + p->state, s->arcs.size * sizeof *s->x);
  return (piece_run){.piece = p,
                     .begin = piece_begin(p, z, period),
                     .end = piece_finish(p, z, period),
                     .first_numbers = numbers,
                     .wish = wish,
                     .carried = whole ? s->spectrum->carried : s->carried,
                     .columns = (whole ? s->arcs.size : numbers) + (carries_time(s, p) ? 1 : 0)};
}

static ric_status read_rates(ric_shooting *s, double t, ric_error *error) {
  size_t n = s->arcs.coordinates;
  return ric_system_rate(s->system, t, s->x, s->x + n, s->rates, s->rates + n, error);
}

size_t shooting_column(const ric_shooting *s, const piece_run *run, size_t row) {
  size_t n = s->arcs.coordinates, i = row < n ? row : row - n, c = run->first_numbers;
  if (c == s->arcs.size)
    return row;
  if ((s->arcs.at_start[i] != NO_UNKNOWN) == (row >= n))
    return i;
  return run->wish == WISH_WHOLE ? run->columns - n + i : NO_UNKNOWN;
}

/* Tangent vectors to begin with: unit vectors; and minus the rates, for the beginning in time. */
static ric_status set_carried(ric_shooting *s, const piece_run *run, ric_error *error) {
  size_t size = s->arcs.size, columns = run->columns, c = run->first_numbers;
  memset(run->carried, 0, size * columns * sizeof *run->carried);
  for (size_t i = 0; i < size; i++) {
    size_t column = shooting_column(s, run, i);
    if (column != NO_UNKNOWN)
      run->carried[i * columns + column] = 1;
  }
  if (!carries_time(s, run->piece))
    return RIC_OK;
  RIC_TRY(read_rates(s, run->begin, error));
  for (size_t i = 0; i < size; i++)
    run->carried[i * columns + c] = -s->rates[i];
  return RIC_OK;
}

/* From what was carried to derivatives by the first state and by the times of the arc: a piece [from, to] of an arc
 * from a to b begins at a + from (b - a), and ends at a + to (b - a). */
static void set_ends(ric_shooting *s, const piece_run *run) {
  const arc_piece *p = run->piece;
  size_t c = run->first_numbers;
  bool timed = carries_time(s, p);
  for (size_t i = 0; i < s->arcs.size; i++) {
    const double *carried = run->carried + i * run->columns;
    double late = s->rates[i], early = timed ? carried[c] : -late, *row = s->ends + i * (c + 2);
    memcpy(row, carried, c * sizeof *row);
    row[c] = (1 - p->from) * early + (1 - p->to) * late;
    row[c + 1] = p->from * early + p->to * late;
  }
  memset(s->in_time, 0, c * sizeof *s->in_time);
  s->in_time[c] = 1 - p->to;
  s->in_time[c + 1] = p->to;
}

ric_status shooting_move(ric_shooting *s, const piece_run *run, const arc_watch *watcher, ric_error *error) {
  if (run->wish == WISH_STATE)
    return arc_runner_move(&s->runner, run->begin, run->end, s->x, 0, NULL, watcher, error);
  RIC_TRY(set_carried(s, run, error));
  RIC_TRY(arc_runner_move(&s->runner, run->begin, run->end, s->x, run->columns, run->carried, watcher, error));
  RIC_TRY(read_rates(s, run->end, error));
  set_ends(s, run);
  return RIC_OK;
}

/* The gap depends on time by itself, too: what its rate has beyond its derivative along the motion. */
ric_status shooting_gap(ric_shooting *s, const piece_run *run, size_t obstacle, double *gap, ric_error *error) {
  const ric_system *system = s->system;
  size_t n = s->arcs.coordinates, c = run->first_numbers;
  tangents ends = shooting_ends(s, run), along = {.columns = 1, .q = s->rates, .u = s->rates + n};
  double rate = NAN, slope = NAN;
  const char *trouble = system->model->gap(system, obstacle, run->end, s->x, gap);
  if (!trouble && run->wish != WISH_STATE)
    trouble = system->model->gap_rate(system, obstacle, run->end, s->x, s->x + n, &rate);
  if (!trouble && run->wish != WISH_STATE)
    trouble = system->model->gap_derivative(system, obstacle, run->end, s->x, &ends, s->gap_row);
  if (!trouble && run->wish != WISH_STATE)
    trouble = system->model->gap_derivative(system, obstacle, run->end, s->x, &along, &slope);
  if (trouble)
    return ric_fail(error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", run->end, obstacle, trouble);
  for (size_t k = c; run->wish != WISH_STATE && k < c + 2; k++)
    s->gap_row[k] += (rate - slope) * s->in_time[k];
  return RIC_OK;
}

ric_status shooting_hit(ric_shooting *s, const piece_run *run, ric_error *error) {
  size_t n = s->arcs.coordinates, obstacle = run->piece->obstacle;
  double e = s->system->model->restitution(s->system, obstacle);
  jump_group group = {&obstacle, &e, 1, false};
  tangents ends = shooting_ends(s, run);
  if (run->wish == WISH_STATE)
    ends.columns = 0;
  return tangent_jump_map(&s->jump, run->end, &group, s->x, s->x + n, &ends, s->in_time, error);
}
