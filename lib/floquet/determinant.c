#include "determinant.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "circle.h"
#include "multiplier_verdict.h"
#include "outside.h"
#include "winding.h"

/* What the counts tell. */
typedef struct told {
  size_t on_circle; /* pairs, at least */
  size_t outside;   /* beyond the last contour */
  double contour;   /* log of its radius */
  size_t farther;   /* beyond the contour before it */
  double far;       /* log of its radius */
  size_t near_one;  /* multipliers too close to 1, besides the trivial ones */
  double from;      /* angle from which the circle is looked at */
} told;

/* More multipliers than this between the last two contours are counted and not located: hundreds of them leave the
 * circle of a large ring by 1e-6 where modes of both signs overlap. */
enum { MOST_BETWEEN = 64 };

/* A contour that meets a multiplier is moved a little. */
static bool count_outside(secular *s, double distance, told *t) {
  t->farther = t->outside;
  t->far = t->contour > 0 ? t->contour : INFINITY;
  for (int i = 0; i < 4; i++) {
    t->contour = log1p(distance * (1 + 0.1371 * i));
    if (winding_outside(s, t->contour, &t->outside))
      return true;
  }
  return false;
}

static bool all_told(const secular *s, const told *t) {
  return t->on_circle + t->outside >= s->particles;
}

/* Multipliers within `band` of 1 besides the trivial ones, on the circle or off it: by winding around 1. There rounding
 * decides about signs, and the circle is looked at beyond. Where a pole is as close, on the circle only. */
static void look_near_one(secular *s, double band, told *t) {
  if (winding_box(s, CMPLX(-band, -band), CMPLX(band, band), &t->near_one)) {
    t->from = t->near_one > 0 ? band : 0;
    return;
  }
  t->near_one = 2 * circle_near_one(s, band);
  t->from = 0;
}

/* Contours that come closer to the circle and bounds on it that become sharper, until nothing is left between. A search
 * of the circle comes last: what is outside decides without it. */
static ric_status tell(secular *s, const ric_orbit_multiplier_options *o, told *t, ric_error *error) {
  static const int depth[] = {4, 40};
  const double distances[] = {fmax(0.1, o->judge.band), fmax(1e-3, o->judge.band), o->judge.band};
  *t = (told){0};
  look_near_one(s, o->judge.band_at_one, t);
  size_t close = 1 + (t->from > 0 ? t->near_one / 2 : 0); /* pairs */
  for (int stage = 0; stage < 3 && !all_told(s, t); stage++) {
    if (stage < 2)
      t->on_circle = close + circle_count(s, t->from, depth[stage]);
    bool counted = all_told(s, t) || count_outside(s, distances[stage], t);
    if (s->stopped)
      return ric_fail(error, RIC_ESTOPPED, "stopped at |mu| = 1 + %g", distances[stage]);
    if (!counted)
      return ric_fail(error, RIC_ENUMERIC, "winding number along |mu| = 1 + %g is not whole", distances[stage]);
  }
  if (all_told(s, t) || t->outside > 0)
    return RIC_OK;
  size_t found;
  RIC_TRY(circle_find(s, t->from, s->particles - close, NULL, &found, error));
  t->on_circle = close + found > t->on_circle ? close + found : t->on_circle;
  return RIC_OK;
}

/* Those beyond the farther contour, then those between the two. */
static void locate(secular *s, const told *t, ric_multipliers *m) {
  size_t between = 0;
  m->count = 0;
  if (t->farther > 0)
    outside_find(s, t->far, INFINITY, t->farther, m->mu, m->dimension, &m->count);
  if (t->outside > t->farther && t->outside - t->farther <= MOST_BETWEEN)
    outside_find(s, t->contour, t->far, t->outside - t->farther, m->mu + m->count, m->dimension - m->count, &between);
  m->count += between;
}

/* On the circle there are two of each pair. */
static void put_on_circle(ric_multipliers *m, const double *angles, size_t count) {
  for (size_t i = 0; i < count && m->count + 2 <= m->dimension; i++) {
    double re = cos(angles[i]), im = sin(angles[i]);
    m->mu[m->count++] = (ric_complex){re, im};
    m->mu[m->count++] = (ric_complex){re, -im};
  }
}

static void put_inverses(ric_multipliers *m) {
  for (size_t i = 0, outside = m->count; i < outside && m->count < m->dimension; i++) {
    double square = m->mu[i].re * m->mu[i].re + m->mu[i].im * m->mu[i].im;
    m->mu[m->count++] = (ric_complex){m->mu[i].re / square, -m->mu[i].im / square};
  }
}

/* All 2n multipliers: those outside, their inverses, those on the circle, and the double 1. Multipliers of opposite
 * sign that nearly meet may escape the search on the circle; then fewer are known. */
static ric_status complete(secular *s, double from, const ric_orbit_multiplier_options *o, ric_multipliers *m,
                           ric_error *error) {
  size_t found = 0, wanted = s->particles - 1 - m->count;
  double *angles = malloc(s->particles * sizeof *angles);
  if (!angles)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu multipliers", s->particles);
  ric_status status = circle_find(s, from, wanted, angles, &found, error);
  put_inverses(m);
  put_on_circle(m, angles, found);
  free(angles);
  for (int i = 0; i < 2 && m->count < m->dimension; i++)
    m->mu[m->count++] = (ric_complex){1, 0};
  RIC_TRY(status);
  if (m->count == m->dimension && found == wanted)
    multipliers_judge(m, 2, &o->judge);
  else
    multipliers_sort(m); /* the verdict stands */
  return RIC_OK;
}

ric_status determinant_multipliers(secular *s, const ric_orbit_multiplier_options *o, ric_multipliers *m,
                                   ric_error *error) {
  told t;
  s->poll = o->poll;
  s->stopped = false;
  RIC_TRY(tell(s, o, &t, error));
  size_t n = s->particles, untold = t.on_circle + t.outside < n ? n - t.on_circle - t.outside : 0;
  locate(s, &t, m);
  if (s->stopped)
    return ric_fail(error, RIC_ESTOPPED, "stopped on the way to the multipliers outside");
  size_t missing = t.outside > m->count ? t.outside - m->count : 0;
  multipliers_judge_outside(m, untold, t.near_one, &o->judge);
  if (missing > t.near_one) {
    m->stable = RIC_UNSTABLE;
    m->outside = t.outside;
    snprintf(m->reason, sizeof m->reason, "%zu multipliers lie outside the unit circle, %zu of them not located",
             t.outside, missing);
    return RIC_OK;
  }
  return o->on_circle ? complete(s, t.from, o, m, error) : RIC_OK;
}
