/* The equations of a periodic motion, F(z) = 0, and their derivatives, piece by piece. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "shooting.h"
#include "numeric/required.h"

/* One piece of a motion: its beginning, its end, and the derivatives of its end. */

/* An even motion begins at rest, or at the obstacles that it has hit. */
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

/* Whether the time at which the piece begins is variable, in a system whose forces depend on time: then there is a
 * tangent vector for that time. */
static bool has_time_vector(const ric_shooting *s, const arc_piece *p) {
  bool fixed = p->begin.index == NO_UNKNOWN && p->begin.of_period == 0 && p->from == 0;
  return s->forced && !fixed;
}

piece_run shooting_begin(ric_shooting *s, size_t piece, const double *z, double period, piece_output output) {
  const arc_piece *p = &s->arcs.pieces[piece];
  size_t numbers = piece == 0 ? arcs_first_numbers(&s->arcs) : s->arcs.size;
  bool whole = output == OUTPUT_WHOLE;
  if (begins_even(s, piece))
    even_start(s, z, s->x);
  else
    memcpy(s->x, z + p->state, s->arcs.size * sizeof *s->x);
  return (piece_run){.piece = p,
                     .begin = piece_begin(p, z, period),
                     .end = piece_finish(p, z, period),
                     .first_numbers = numbers,
                     .output = output,
                     .vectors = whole ? s->spectrum->vectors : s->vectors,
                     .columns = (whole ? s->arcs.size : numbers) + (has_time_vector(s, p) ? 1 : 0)};
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
  return run->output == OUTPUT_WHOLE ? run->columns - n + i : NO_UNKNOWN;
}

/* Initial tangent vectors: unit vectors; and minus the rates, for the time of the beginning. */
static ric_status set_tangents(ric_shooting *s, const piece_run *run, ric_error *error) {
  size_t size = s->arcs.size, columns = run->columns, c = run->first_numbers;
  memset(run->vectors, 0, size * columns * sizeof *run->vectors);
  for (size_t i = 0; i < size; i++) {
    size_t column = shooting_column(s, run, i);
    if (column != NO_UNKNOWN)
      run->vectors[i * columns + column] = 1;
  }
  if (!has_time_vector(s, run->piece))
    return RIC_OK;
  RIC_TRY(read_rates(s, run->begin, error));
  for (size_t i = 0; i < size; i++)
    run->vectors[i * columns + c] = -s->rates[i];
  return RIC_OK;
}

/* Converts tangent vectors to derivatives by the first state and by the times of the arc: a piece [from, to] of an
 * arc from a to b begins at a + from (b - a), and ends at a + to (b - a). */
static void set_ends(ric_shooting *s, const piece_run *run) {
  const arc_piece *p = run->piece;
  size_t c = run->first_numbers;
  bool timed = has_time_vector(s, p);
  for (size_t i = 0; i < s->arcs.size; i++) {
    const double *vectors = run->vectors + i * run->columns;
    double late = s->rates[i], early = timed ? vectors[c] : -late, *row = s->ends + i * (c + 2);
    memcpy(row, vectors, c * sizeof *row);
    row[c] = (1 - p->from) * early + (1 - p->to) * late;
    row[c + 1] = p->from * early + p->to * late;
  }
  memset(s->time_row, 0, c * sizeof *s->time_row);
  s->time_row[c] = 1 - p->to;
  s->time_row[c + 1] = p->to;
}

ric_status shooting_move(ric_shooting *s, const piece_run *run, const arc_watch *watcher, ric_error *error) {
  if (run->output == OUTPUT_STATE)
    return arc_runner_move(&s->runner, run->begin, run->end, s->x, 0, NULL, watcher, error);
  RIC_TRY(set_tangents(s, run, error));
  RIC_TRY(arc_runner_move(&s->runner, run->begin, run->end, s->x, run->columns, run->vectors, watcher, error));
  RIC_TRY(read_rates(s, run->end, error));
  set_ends(s, run);
  return RIC_OK;
}

/* Derivatives of the end of a piece, s->ends, as tangent vectors. */
static tangents shooting_ends(const ric_shooting *s, const piece_run *run) {
  size_t columns = run->first_numbers + 2;
  return (tangents){.columns = columns, .q = s->ends, .u = s->ends + s->arcs.coordinates * columns};
}

/* The gap of the obstacle that is hit at the end of the piece, and its derivative in s->gap_row. A gap may also depend
 * on time explicitly: its rate less its derivative along the motion. */
static ric_status shooting_gap(ric_shooting *s, const piece_run *run, size_t obstacle, double *gap, ric_error *error) {
  const ric_system *system = s->system;
  size_t n = s->arcs.coordinates, c = run->first_numbers;
  tangents ends = shooting_ends(s, run), along = {.columns = 1, .q = s->rates, .u = s->rates + n};
  double rate = NAN, slope = NAN;
  const char *trouble = system->model->gap(system, obstacle, run->end, s->x, gap);
  if (!trouble && run->output != OUTPUT_STATE)
    trouble = system->model->gap_rate(system, obstacle, run->end, s->x, s->x + n, &rate);
  if (!trouble && run->output != OUTPUT_STATE)
    trouble = system->model->gap_derivative(system, obstacle, run->end, s->x, &ends, s->gap_row);
  if (!trouble && run->output != OUTPUT_STATE)
    trouble = system->model->gap_derivative(system, obstacle, run->end, s->x, &along, &slope);
  if (trouble)
    return ric_fail(error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", run->end, obstacle, trouble);
  for (size_t k = c; run->output != OUTPUT_STATE && k < c + 2; k++)
    s->gap_row[k] += (rate - slope) * s->time_row[k];
  return RIC_OK;
}

ric_status shooting_hit(ric_shooting *s, const piece_run *run, ric_error *error) {
  size_t n = s->arcs.coordinates, obstacle = run->piece->obstacle;
  double e = s->system->model->restitution(s->system, obstacle);
  jump_group group = {&obstacle, &e, 1, false};
  tangents ends = shooting_ends(s, run);
  if (run->output == OUTPUT_STATE)
    ends.columns = 0;
  return tangent_jump_map(&s->jump, run->end, &group, s->x, s->x + n, &ends, s->time_row, error);
}

/* F(z) and its derivatives, piece by piece. */

/* Newton's method fails with longer arcs, in periods: no motion near the guess has them, and their integration would
 * take very long. */
static const double longest_arc = 10;

typedef struct equations {
  ric_shooting *s;
  const double *z;
  double period;
  double *F, *J, *F_given; /* the last two may be NULL */
  const shooting_observer *observer;
} equations;

static bool wants_derivatives(const equations *e) {
  return e->J != NULL;
}

static void add(const equations *e, size_t row, size_t unknown, double value) {
  e->J[row * e->s->arcs.unknowns + unknown] += value;
}

/* Derivative by the period: an unknown or the given number. */
static void add_by_period(const equations *e, size_t row, double value) {
  const arc_plan *a = &e->s->arcs;
  if (a->period != NO_UNKNOWN)
    add(e, row, a->period, value);
  else if (e->F_given)
    e->F_given[row] += value;
}

static void add_by_event(const equations *e, size_t row, event_time event, double value) {
  if (event.index != NO_UNKNOWN)
    add(e, row, event.index, value);
  if (event.of_period != 0)
    add_by_period(e, row, event.of_period * value);
}

/* A row of derivatives of a piece's end: by the numbers of its first state, and by the times of its arc. */
static void add_row(const equations *e, const piece_run *run, size_t row, const double *values) {
  size_t c = run->first_numbers;
  double *J = e->J + row * e->s->arcs.unknowns + run->piece->state;
  for (size_t k = 0; k < c; k++)
    J[k] += values[k];
  add_by_event(e, row, run->piece->begin, values[c]);
  add_by_event(e, row, run->piece->end, values[c + 1]);
}

/* Continuity: the end of a piece is the first state of the next one. */
static void continuity_equations(const equations *e, const piece_run *run, size_t row) {
  ric_shooting *s = e->s;
  const arc_piece *next = run->piece->closes ? s->arcs.pieces : run->piece + 1;
  for (size_t i = 0; i < s->arcs.size; i++) {
    e->F[row + i] = s->x[i] - e->z[next->state + i];
    if (!wants_derivatives(e))
      continue;
    add_row(e, run, row + i, s->ends + i * (run->first_numbers + 2));
    add(e, row + i, next->state + i, -1);
  }
  if (!run->piece->closes || s->arcs.lambda == NO_UNKNOWN)
    return;
  for (size_t i = 0; i < s->arcs.size; i++) {
    e->F[row + i] += e->z[s->arcs.lambda] * s->gradient[i];
    if (wants_derivatives(e))
      add(e, row + i, s->arcs.lambda, s->gradient[i]);
  }
}

static ric_status contact_equation(const equations *e, const piece_run *run, size_t obstacle, size_t row,
                                   ric_error *error) {
  RIC_TRY(shooting_gap(e->s, run, obstacle, &e->F[row], error));
  if (wants_derivatives(e))
    add_row(e, run, row, e->s->gap_row);
  return RIC_OK;
}

/* At half the period each coordinate is at rest, or at the obstacle that it hits. */
static ric_status half_period_equations(const equations *e, const piece_run *run, ric_error *error) {
  const arc_plan *a = &e->s->arcs;
  for (size_t i = 0; i < a->coordinates; i++) {
    size_t row = run->piece->row + i, speed = a->coordinates + i;
    if (a->at_half[i] != NO_UNKNOWN) {
      RIC_TRY(contact_equation(e, run, a->at_half[i], row, error));
      continue;
    }
    e->F[row] = e->s->x[speed];
    if (wants_derivatives(e))
      add_row(e, run, row, e->s->ends + speed * (run->first_numbers + 2));
  }
  return RIC_OK;
}

static ric_status end_piece(const equations *e, const piece_run *run, ric_error *error) {
  const arc_piece *p = run->piece;
  if (p->how == PIECE_HALF)
    return half_period_equations(e, run, error);
  if (p->how == PIECE_IMPACT) {
    RIC_TRY(contact_equation(e, run, p->obstacle, p->row, error));
    RIC_TRY(shooting_hit(e->s, run, error));
  }
  continuity_equations(e, run, p->row + (p->how == PIECE_IMPACT ? 1 : 0));
  return RIC_OK;
}

/* The equation of the energy, that of the first state; its unknowns are coordinates or speeds. */
static ric_status energy_equation(const equations *e, double given, ric_error *error) {
  ric_shooting *s = e->s;
  const arc_plan *a = &s->arcs;
  double energy;
  if (a->energy_row == NO_UNKNOWN && a->lambda == NO_UNKNOWN)
    return RIC_OK;
  (void)shooting_begin(s, 0, e->z, e->period, OUTPUT_STATE);
  RIC_TRY(shooting_energy(s, s->x, &energy, error));
  if (a->energy_row == NO_UNKNOWN)
    return RIC_OK;
  e->F[a->energy_row] = energy - given;
  if (e->F_given)
    e->F_given[a->energy_row] = -1;
  for (size_t k = 0; wants_derivatives(e) && k < arcs_first_numbers(a); k++) {
    bool speed = a->at_start[k < a->coordinates ? k : 0] != NO_UNKNOWN && a->kind == RIC_MOTION_EVEN;
    add(e, a->energy_row, k, s->gradient[speed ? a->coordinates + k : k]);
  }
  return RIC_OK;
}

static void phase_equation(const equations *e) {
  const ric_shooting *s = e->s;
  size_t row = s->arcs.phase_row;
  if (row == NO_UNKNOWN)
    return;
  e->F[row] = 0;
  for (size_t i = 0; i < s->arcs.size; i++)
    e->F[row] += s->phase_along[i] * (e->z[i] - s->phase_at[i]);
  for (size_t i = 0; wants_derivatives(e) && i < s->arcs.size; i++)
    add(e, row, i, s->phase_along[i]);
}

ric_status shooting_period(const ric_shooting *s, const double *z, double given, double *period, ric_error *error) {
  *period = arcs_period(&s->arcs, z, given);
  for (size_t i = 0; i < s->arcs.unknowns; i++)
    if (!isfinite(z[i]))
      return ric_fail(error, RIC_ENUMERIC, "z[%zu] = %g, expected a finite number", i, z[i]);
  if (*period > 0 && *period < INFINITY)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "period = %g, expected > 0", *period);
}

static int forward_segment(const ric_segment *piece, double end, void *user) {
  const shooting_observer *o = user;
  o->segment(piece, end, o->user);
  return 0;
}

static piece_output output_of(const equations *e) {
  if (e->observer && e->observer->whole)
    return OUTPUT_WHOLE;
  return wants_derivatives(e) ? OUTPUT_DERIVATIVES : OUTPUT_STATE;
}

static ric_status run_piece(const equations *e, size_t k, ric_error *error) {
  const shooting_observer *o = e->observer;
  const arc_watch watch = {.segment = forward_segment, .user = (void *)(uintptr_t)o};
  piece_run run = shooting_begin(e->s, k, e->z, e->period, output_of(e));
  double periods = (run.end - run.begin) / e->period;
  if (!(fabs(periods) <= longest_arc))
    return ric_fail(error, RIC_ENUMERIC, "an arc from t = %g to %g, expected at most %g periods of %g", run.begin,
                    run.end, longest_arc, e->period);
  if (o && o->begins)
    RIC_TRY(o->begins(&run, o->user, error));
  RIC_TRY(shooting_move(e->s, &run, o && o->segment ? &watch : NULL, error));
  if (o && o->ends)
    RIC_TRY(o->ends(&run, o->user, error));
  return end_piece(e, &run, error);
}

ric_status shooting_evaluate(ric_shooting *s, const double *z, double given, double *F, double *J, double *F_given,
                             const shooting_observer *observer, ric_error *error) {
  equations e = {.s = s, .z = z, .F = F, .J = J, .F_given = J ? F_given : NULL, .observer = observer};
  RIC_TRY(shooting_period(s, z, given, &e.period, error));
  if (J)
    memset(J, 0, s->arcs.unknowns * s->arcs.unknowns * sizeof *J);
  if (e.F_given)
    memset(F_given, 0, s->arcs.unknowns * sizeof *F_given);
  RIC_TRY(energy_equation(&e, given, error));
  for (size_t k = 0; k < s->arcs.count; k++) {
    if (ric_poll_stops(s->poll))
      return ric_fail(error, RIC_ESTOPPED, "stopped before piece %zu of the motion", k);
    RIC_TRY(run_piece(&e, k, error));
  }
  phase_equation(&e);
  return RIC_OK;
}

ric_status ric_shooting_residual(ric_shooting *s, const double *z, double given, double *F, double *J, double *F_given,
                                 ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"z", z}, {"F", F});
  return shooting_evaluate(s, z, given, F, J, F_given, NULL, error);
}
