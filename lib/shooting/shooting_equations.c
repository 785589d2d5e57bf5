/* F(z) and its derivatives, piece by piece. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "shooting_parts.h"

/* Arcs that are longer, in periods, belong to no motion near: Newton's method has lost its way, and running along them
 * would take for ever. */
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

/* Derivative by the period, which is an unknown or the given number. */
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

/* The end of a piece is the beginning of the next one. */
static void match(const equations *e, const piece_run *run, size_t row) {
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

static ric_status touch(const equations *e, const piece_run *run, size_t obstacle, size_t row, ric_error *error) {
  RIC_TRY(shooting_gap(e->s, run, obstacle, &e->F[row], error));
  if (wants_derivatives(e))
    add_row(e, run, row, e->s->gap_row);
  return RIC_OK;
}

/* At half the period coordinates are at rest, or hit. */
static ric_status turn(const equations *e, const piece_run *run, ric_error *error) {
  const arc_plan *a = &e->s->arcs;
  for (size_t i = 0; i < a->coordinates; i++) {
    size_t row = run->piece->row + i, speed = a->coordinates + i;
    if (a->at_half[i] != NO_UNKNOWN) {
      RIC_TRY(touch(e, run, a->at_half[i], row, error));
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
    return turn(e, run, error);
  if (p->how == PIECE_IMPACT) {
    RIC_TRY(touch(e, run, p->obstacle, p->row, error));
    RIC_TRY(shooting_hit(e->s, run, error));
  }
  match(e, run, p->row + (p->how == PIECE_IMPACT ? 1 : 0));
  return RIC_OK;
}

/* The energy is that of the first state, whose numbers are coordinates or speeds. */
static ric_status hold_energy(const equations *e, double given, ric_error *error) {
  ric_shooting *s = e->s;
  const arc_plan *a = &s->arcs;
  double energy;
  if (a->energy_row == NO_UNKNOWN && a->lambda == NO_UNKNOWN)
    return RIC_OK;
  (void)shooting_begin(s, 0, e->z, e->period, WISH_STATE);
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

static void hold_phase(const equations *e) {
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

static int show_segment(const ric_segment *piece, double end, void *user) {
  const shooting_observer *o = user;
  o->segment(piece, end, o->user);
  return 0;
}

static piece_wish wish_of(const equations *e) {
  if (e->observer && e->observer->whole)
    return WISH_WHOLE;
  return wants_derivatives(e) ? WISH_DERIVATIVES : WISH_STATE;
}

static ric_status run_piece(const equations *e, size_t k, ric_error *error) {
  const shooting_observer *o = e->observer;
  const arc_watch watch = {.segment = show_segment, .user = (void *)(uintptr_t)o};
  piece_run run = shooting_begin(e->s, k, e->z, e->period, wish_of(e));
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
  RIC_TRY(hold_energy(&e, given, error));
  for (size_t k = 0; k < s->arcs.count; k++) {
    if (ric_poll_stops(s->poll))
      return ric_fail(error, RIC_ESTOPPED, "stopped before piece %zu of the motion", k);
    RIC_TRY(run_piece(&e, k, error));
  }
  hold_phase(&e);
  return RIC_OK;
}

ric_status ric_shooting_residual(ric_shooting *s, const double *z, double given, double *F, double *J, double *F_given,
                                 ric_error *error) {
  return shooting_evaluate(s, z, given, F, J, F_given, NULL, error);
}
