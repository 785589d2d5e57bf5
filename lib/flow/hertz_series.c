#include "hertz_series.h"

#include <float.h>
#include <math.h>

/* Of the way in the first step: the force of the penetration that is left out is a thirtieth of that at its end. */
static const double begun_share = 0.1;

double hertz_series_next(hertz_series *s, int j, double u) {
  s->u[j] = u;
  if (j == 0)
    return s->p[0] = u * sqrt(u);
  double sum = 0;
  for (int i = 1; i <= j; i++)
    sum += (2.5 * i - j) * s->u[i] * s->p[j - i];
  return s->p[j] = sum / (j * s->u[0]);
}

/* Speed that the force would give over a step, from its largest value there. */
static double speed_left_out(const hertz_begin *b, double h) {
  double reach = fmax(b->penetration, 0) + fabs(b->rate) * h + fabs(b->acceleration) * h * h / 2;
  if (b->penetration < 0)
    reach = fmax(reach + b->penetration, 0);
  return b->strength * reach * sqrt(reach) * h;
}

double hertz_begin_step(const hertz_begin *b, double length, double negligible) {
  double h = length;
  while (h > DBL_MIN && !(speed_left_out(b, h) <= negligible))
    h /= 2;
  return h;
}

int hertz_begins(const hertz_begin *b, double step) {
  return !(b->penetration > begun_share * fabs(b->rate) * step);
}
