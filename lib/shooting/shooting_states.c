/* States of a motion at times of its period. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "shooting_parts.h"

/* Times this near to the end of a segment, over the period, belong to it: before an impact there. */
static const double end_tol = 1e-12;

typedef struct sampling {
  const ric_shooting *s;
  double first, step, slack; /* times */
  size_t count;              /* of those that are run along: half of an even motion */
  double *q, *v;             /* [all][n], [all][m] */
} sampling;

static ric_status begins(const piece_run *run, void *user, ric_error *error) {
  sampling *p = user;
  size_t n = p->s->arcs.coordinates;
  (void)error;
  if (run->piece != p->s->arcs.pieces)
    return RIC_OK;
  p->first = run->begin;
  memcpy(p->q, p->s->x, n * sizeof *p->q);
  if (p->s->arcs.speeds > 0) /* v may be NULL */
    memcpy(p->v, p->s->x + n, p->s->arcs.speeds * sizeof *p->v);
  return RIC_OK;
}

/* The first time after one; rounding beside it does not count. */
static size_t first_after(const sampling *p, double time) {
  double k = floor((time + p->slack - p->first) / p->step) + 1;
  return k < 1 ? 1 : k < (double)p->count ? (size_t)k : p->count;
}

static void segment(const ric_segment *piece, double end, void *user) {
  sampling *p = user;
  size_t n = p->s->arcs.coordinates, m = p->s->arcs.speeds;
  size_t last = first_after(p, piece->start + end * piece->length);
  for (size_t k = first_after(p, piece->start); k < last; k++) {
    double x = (p->first + (double)k * p->step - piece->start) / piece->length;
    ric_segment_state(piece, fmax(0, fmin(x, end)), p->q + k * n + piece->first,
                      m > 0 ? p->v + k * m + piece->first : NULL);
  }
}

/* The second half of an even motion is the first one backwards. */
static void mirror(const sampling *p, size_t count) {
  size_t n = p->s->arcs.coordinates;
  for (size_t k = p->count; k < count; k++)
    for (size_t i = 0; i < n; i++) {
      p->q[k * n + i] = p->q[(count - 1 - k) * n + i];
      p->v[k * n + i] = -p->v[(count - 1 - k) * n + i];
    }
}

ric_status ric_shooting_states(ric_shooting *s, const double *z, double given, size_t count, double *q, double *v,
                               ric_error *error) {
  bool even = s->arcs.kind == RIC_MOTION_EVEN;
  double period;
  if (count < 2 || count > SIZE_MAX / 64 / s->arcs.size)
    return ric_fail(error, RIC_EINVAL, "count = %zu, expected at least 2 states, and fewer than memory has room for",
                    count);
  RIC_TRY(shooting_period(s, z, given, &period, error));
  sampling p = {.s = s,
                .step = period / (double)(count - 1),
                .slack = end_tol * period,
                .count = even ? (count + 1) / 2 : count,
                .q = q,
                .v = v};
  const shooting_observer observer = {.begins = begins, .segment = segment, .user = &p};
  for (size_t k = 0; k < count * s->arcs.coordinates; k++)
    q[k] = NAN;
  for (size_t k = 0; k < count * s->arcs.speeds; k++)
    v[k] = NAN;
  RIC_TRY(shooting_evaluate(s, z, given, s->residual, NULL, NULL, &observer, error));
  if (even)
    mirror(&p, count);
  return RIC_OK;
}
