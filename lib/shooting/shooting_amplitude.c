/* The largest displacement of a motion over its period. */
#include <math.h>

#include "shooting_parts.h"

/* On the value, relative to it. */
static const double amplitude_tol = 1e-14;

/* A coordinate on a segment that counts up to `end`, with a sign, as a polynomial on [0, 1]. */
static void read_coordinate(const ric_segment *piece, size_t i, double end, double sign, double *c) {
  double power = sign;
  for (int j = 0; j <= piece->degree; j++, power *= end)
    c[j] = power * piece->coef[(size_t)j * piece->stride + i];
}

static void segment(const ric_segment *piece, double end, void *user) {
  double *most = user, c[RIC_POLY_DEGREE + 1], at, value;
  for (size_t i = 0; i < piece->coordinates; i++)
    for (int sign = -1; sign <= 1; sign += 2) {
      read_coordinate(piece, i, end, sign, c);
      if (ric_poly_minimum(c, piece->degree, -*most, amplitude_tol * *most, &at, &value))
        *most = fmax(*most, -value);
    }
}

ric_status ric_shooting_amplitude(ric_shooting *s, const double *z, double given, double *amplitude, ric_error *error) {
  const shooting_observer observer = {.segment = segment, .user = amplitude};
  *amplitude = 0;
  return shooting_evaluate(s, z, given, s->residual, NULL, NULL, &observer, error);
}
