/* Callbacks of a user, and the gaps that they define. */
#include "user_gap.h"

#include <math.h>
#include <string.h>

bool all_finite(const double *x, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(x[i]))
      return false;
  return true;
}

const char *callback_check(int code, const double *x, size_t count, const char *failed, const char *not_finite) {
  if (code != 0)
    return failed;
  return all_finite(x, count) ? NULL : not_finite;
}

/* Problems are dimensionless: with this step the error of the extrapolated differences is 2e-15 for functions that vary
 * over lengths of 1, 2e-11 for lengths of 0.1; rounding adds about 3e-13. */
static const double difference_step = 1.0 / 1024;

const char *user_gap_value(const user_gap *g, size_t obstacle, double t, const double *q, double *h) {
  return callback_check(g->gap(t, q, obstacle, h, g->user), h, 1, CALLBACK_TEXTS("gap"));
}

/* Central difference in one variable, *x, which is the time or an entry of g->point. The divisor is the difference of
 * the rounded arguments, so that large coordinates cost no accuracy. */
static const char *slope(const user_gap *g, size_t obstacle, const double *t, double *x, double step, double *out) {
  double middle = *x, up = middle + step, down = middle - step, above, below;
  *x = up;
  TRY_TEXT(user_gap_value(g, obstacle, *t, g->point, &above));
  *x = down;
  TRY_TEXT(user_gap_value(g, obstacle, *t, g->point, &below));
  *x = middle;
  *out = (above - below) / (up - down);
  return NULL;
}

static const char *extrapolated_slope(const user_gap *g, size_t obstacle, const double *t, double *x, double *out) {
  double coarse, fine;
  TRY_TEXT(slope(g, obstacle, t, x, difference_step, &coarse));
  TRY_TEXT(slope(g, obstacle, t, x, difference_step / 2, &fine));
  *out = fine + (fine - coarse) / 3;
  return NULL;
}

const char *user_gap_gradient(const user_gap *g, size_t obstacle, double t, const double *q, double *gradient,
                              double *in_time) {
  if (g->gradient) {
    int code = g->gradient(t, q, obstacle, gradient, in_time, g->user);
    TRY_TEXT(callback_check(code, gradient, g->coordinates, CALLBACK_TEXTS("gap_gradient")));
    return callback_check(0, in_time, 1, CALLBACK_TEXTS("gap_gradient"));
  }
  double time = t;
  memcpy(g->point, q, g->coordinates * sizeof *q);
  for (size_t i = 0; i < g->coordinates; i++)
    TRY_TEXT(extrapolated_slope(g, obstacle, &time, &g->point[i], &gradient[i]));
  return extrapolated_slope(g, obstacle, &time, &time, in_time);
}

const char *user_gap_derivative(const user_gap *g, size_t obstacle, double t, const double *q, const tangents *d,
                                double *gradient, double *derivative) {
  double in_time;
  TRY_TEXT(user_gap_gradient(g, obstacle, t, q, gradient, &in_time));
  memset(derivative, 0, d->columns * sizeof *derivative);
  for (size_t i = 0; i < g->coordinates; i++)
    for (size_t k = 0; k < d->columns; k++)
      derivative[k] += gradient[i] * d->q[i * d->columns + k];
  return NULL;
}
