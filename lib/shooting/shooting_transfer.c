/* Derivatives of the state of a motion between two of its times. */
#include <math.h>
#include <string.h>

#include "shooting_spectrum.h"

/* Ends of pieces this near to one of the times, over the period, are at it: after them. */
static const double end_tol = 1e-12;

typedef struct transfer {
  ric_shooting *s;
  const double *z;
  double period, origin; /* time of the first state */
  double from, to;       /* since then */
  double *x;             /* state at `from` */
  double *matrix;        /* NULL: only the state is wanted */
  bool begun;
} transfer;

static ric_status move(const transfer *k, double from, double to, bool carry, ric_error *error) {
  ric_shooting *s = k->s;
  return arc_runner_move(&s->runner, k->origin + from, k->origin + to, s->x, carry ? s->arcs.size : 0,
                         carry ? s->spectrum->matrix : NULL, NULL, error);
}

/* The part of a piece that lies between the times; `shift` is the period before its own that it is looked at in. */
static ric_status pass(transfer *k, size_t index, double shift, ric_error *error) {
  ric_shooting *s = k->s;
  const double slack = end_tol * k->period;
  const piece_run run = shooting_begin(s, index, k->z, k->period, WISH_STATE);
  double begin = run.begin - k->origin, end = run.end - k->origin, from = k->from - shift, to = k->to - shift;
  if (end <= from + slack || begin > to + slack)
    return RIC_OK;
  if (!k->begun) {
    RIC_TRY(move(k, begin, fmax(begin, from), false, error));
    memcpy(k->x, s->x, s->arcs.size * sizeof *s->x);
    begin = fmax(begin, from);
    k->begun = true;
  }
  if (!k->matrix)
    return RIC_OK;
  RIC_TRY(move(k, begin, fmax(begin, fmin(end, to)), true, error));
  if (run.piece->how != PIECE_IMPACT || end > to + slack)
    return RIC_OK;
  RIC_TRY(shooting_spectrum_jump(s, &run, error));
  if (s->spectrum->grazing)
    return ric_fail(error, RIC_ENUMERIC, "the impact on obstacle %zu at t = %g is too slow for a derivative",
                    run.piece->obstacle, run.end);
  return RIC_OK;
}

static ric_status check(const ric_shooting *s, double from, double to, double period, ric_error *error) {
  if (s->arcs.kind == RIC_MOTION_EVEN)
    return ric_fail(error, RIC_EINVAL, "derivatives between times of an even motion, expected another kind");
  if (fabs(from) < INFINITY && to >= from && to <= from + period * (1 + end_tol))
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "from = %.9g, to = %.9g, expected from <= to <= from + %.9g, the period", from, to,
                  period);
}

ric_status ric_shooting_transfer(ric_shooting *s, const double *z, double given, double from, double to, double *x,
                                 double *matrix, ric_error *error) {
  const size_t size = s->arcs.size;
  transfer k = {.s = s, .z = z, .x = x, .matrix = matrix};
  RIC_TRY(shooting_period(s, z, given, &k.period, error));
  RIC_TRY(check(s, from, to, k.period, error));
  RIC_TRY(shooting_spectrum_reserve(s, error));
  k.origin = piece_begin(&s->arcs.pieces[0], z, k.period);
  k.from = fmod(from - k.origin, k.period);
  k.from += k.from < 0 ? k.period : 0;
  k.to = k.from + (to - from);
  s->spectrum->grazing = false;
  shooting_spectrum_identity(s->spectrum);
  for (int round = 0; round < 2; round++)
    for (size_t p = 0; p < s->arcs.count; p++)
      RIC_TRY(pass(&k, p, round * k.period, error));
  if (!k.begun)
    return ric_fail(error, RIC_ENUMERIC, "no arc of the motion is at t = %g", from);
  if (matrix)
    memcpy(matrix, s->spectrum->matrix, size * size * sizeof *matrix);
  return RIC_OK;
}
