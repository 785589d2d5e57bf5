#include "winding.h"
#include "numeric/constants.h"

#include <math.h>

/* Halvings of a step of length 1/2: 2^-40 is far below any distance that counts. */
enum { MOST_HALVINGS = 40 };

/* Distance of zeta from the nearest pole of g, at +- i angle + 2 pi i k. */
static double pole_distance(const secular *s, double complex zeta) {
  double angle = fabs(remainder(cimag(zeta), 2 * pi)), gap = INFINITY;
  size_t low = 0, high = s->particles;
  while (low < high) {
    size_t middle = (low + high) / 2;
    if (s->poles[middle].angle < angle)
      low = middle + 1;
    else
      high = middle;
  }
  for (size_t j = low; j < s->particles && j < low + 1; j++)
    gap = s->poles[j].angle - angle;
  if (low > 0)
    gap = fmin(gap, angle - s->poles[low - 1].angle);
  return hypot(creal(zeta), gap);
}

/* Change of log g, with the phase in half a turn. */
static double complex change(double complex from, double complex to) {
  return CMPLX(creal(to) - creal(from), remainder(cimag(to) - cimag(from), 2 * pi));
}

/* Whether log g runs straight enough between three points for its phase not to turn unseen. */
static bool straight(double complex first, double complex second) {
  double quarter = pi / 4;
  return cabs(first) < quarter && cabs(second) < quarter && cabs(first - second) < quarter / 2;
}

/* Phase from a to b, with the logarithms of g there. */
static double phase(secular *s, double complex a, double complex log_a, double complex b, double complex log_b,
                    int halvings) {
  double complex middle = (a + b) / 2, log_middle = secular_log(s, middle);
  double complex first = change(log_a, log_middle), second = change(log_middle, log_b);
  if (cabs(b - a) <= 0.7 * pole_distance(s, middle) && straight(first, second))
    return cimag(first) + cimag(second);
  if (halvings == 0 || !isfinite(creal(first + second)))
    return NAN;
  return phase(s, a, log_a, middle, log_middle, halvings - 1) + phase(s, middle, log_middle, b, log_b, halvings - 1);
}

double winding_phase(secular *s, double complex from, double complex to) {
  double sum = 0;
  int steps = (int)ceil(cabs(to - from) / 0.5);
  double complex here = from, log_here = secular_log(s, from);
  for (int i = 1; i <= steps && isfinite(sum); i++) {
    double complex next = from + (to - from) * ((double)i / steps), log_next = secular_log(s, next);
    sum += phase(s, here, log_here, next, log_next, MOST_HALVINGS);
    here = next;
    log_here = log_next;
  }
  return sum;
}

/* A number of whole turns that must not be negative. */
static bool whole(double turns, size_t *count) {
  if (!(fabs(turns - nearbyint(turns)) < 0.1 && turns > -0.5))
    return false;
  *count = (size_t)llrint(turns);
  return true;
}

bool winding_outside(secular *s, double radius, size_t *outside) {
  return whole(-1 - winding_phase(s, radius, CMPLX(radius, pi)) / pi, outside);
}

bool winding_box(secular *s, double complex low, double complex high, size_t *zeros) {
  double complex right = CMPLX(creal(high), cimag(low)), left = CMPLX(creal(low), cimag(high));
  double sum = winding_phase(s, low, right);
  sum += winding_phase(s, right, high);
  sum += winding_phase(s, high, left);
  sum += winding_phase(s, left, low);
  return whole(sum / (2 * pi), zeros);
}
