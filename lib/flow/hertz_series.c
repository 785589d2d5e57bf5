#include "hertz_series.h"

#include <math.h>

#include "ricochet/elementary.h"

/* A contact acts from this fraction of the step without its force on. */
static const double begun_share = 0.5;

double hertz_series_next(hertz_series *s, int j, double u) {
  s->u[j] = u;
  if (j == 0)
    return s->p[0] = u * sqrt(u);
  enum { LANES = 4 }; /* partial sums in SIMD lanes */
  double sum[LANES] = {0};
  int i = 1;
  for (; i + LANES <= j + 1; i += LANES)
    for (int lane = 0; lane < LANES; lane++)
      sum[lane] += (2.5 * (i + lane) - j) * s->u[i + lane] * s->p[j - i - lane];
  for (; i <= j; i++)
    sum[0] += (2.5 * i - j) * s->u[i] * s->p[j - i];
  return s->p[j] = (sum[0] + sum[1] + (sum[2] + sum[3])) / (j * s->u[0]);
}

void hertz_root_series(const double *u, int order, double *r) {
  r[0] = sqrt(u[0]);
  for (int j = 1; j <= order; j++) {
    double sum = 0;
    for (int i = 1; i <= j; i++)
      sum += (1.5 * i - j) * u[i] * r[j - i];
    r[j] = sum / (j * u[0]);
  }
}

double hertz_left_out(double stiffness, double u_start, double u_end, double duration) {
  double a = fmax(u_start, 0), b = fmax(u_end, 0), change = u_end - u_start;
  if (change == 0)
    return 1.5 * stiffness * sqrt(a) * duration;
  return stiffness * (b * sqrt(b) - a * sqrt(a)) / change * duration;
}

double hertz_series_nearest_zero(const hertz_series *s) {
  return s->u[0] / (fabs(s->u[1]) + sqrt(s->u[0] * fabs(s->u[2]))); /* u_1 x + u_2 x^2 is below u_0 there */
}

/* Longest step from the onset of contact on which omitting the force changes the gap rate by less than the tolerance: k
 * (w h)^{3/2} h / m <= tolerance w with w = |u'| + |u''| h. */
static double negligible_step(const hertz_contact *c, double tolerance, double natural, double *w) {
  double h = 1e-3 * natural, before = 0;
  *w = fabs(c->rate);
  for (int i = 0; i < 12 && !(fabs(h - before) <= 1e-4 * h); i++) { /* converges like 0.2^i */
    before = h;
    *w = fabs(c->rate) + c->bend * h;
    h = fmin(ric_pow(tolerance / (c->strength * sqrt(*w)), 0.4), 0.01 * natural);
  }
  return h;
}

bool hertz_acts(const hertz_contact *c, double tolerance, double natural, double least, double *limit) {
  double w, u = c->penetration, h = fmax(negligible_step(c, tolerance, natural, &w), least);
  if (u > 0 && u >= begun_share * h * w)
    return true;
  if (u > 0 || c->rate >= 0)
    *limit = fmin(*limit, c->rate > 0 && u < 0 ? h - u / c->rate : h);
  return false;
}
