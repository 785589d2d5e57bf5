/* The approximated motion at any time, and what it leaves of the equations of motion. */
#include <math.h>

#include "numeric/largest.h"
#include "model/lattice_system.h"
#include "ritz_parts.h"
#include "numeric/constants.h"

/* Samples per function over half a period: 16 per wave of the fastest one. */
enum { SAMPLES = 16 };

void ritz_functions_at(const ric_ritz *r, double phase, double *cosine, double *sine) {
  for (size_t m = 0; m < ritz_width(r); m++) {
    cosine[m] = cos(ritz_number(r, m) * phase);
    sine[m] = sin(ritz_number(r, m) * phase);
  }
}

/* sum_i c_i cos(i phase) over the functions, and its first two derivatives by the phase. */
static void sum_series(const ric_ritz *r, const double *c, double phase, double sums[3]) {
  sums[0] = sums[1] = sums[2] = 0;
  for (size_t m = 0; m < ritz_width(r); m++) {
    double number = ritz_number(r, m), wave = c[m] * cos(number * phase);
    sums[0] += wave;
    sums[1] -= number * c[m] * sin(number * phase);
    sums[2] -= number * number * wave;
  }
}

void ritz_motion(const ric_ritz *r, const double *c, double period, double tau, double *q, double *v, double *bend) {
  for (size_t j = 0; j < r->coordinates; j++) {
    bool hit = j == r->hit;
    double frequency = hit ? -ritz_frequency(r, c) : two_pi / period, sums[3]; /* w (T/2 - t) runs back */
    sum_series(r, c + j * ritz_width(r), hit ? -frequency * period * (0.5 - tau) : two_pi * tau, sums);
    if (q)
      q[j] = sums[0];
    if (v)
      v[j] = frequency * sums[1];
    if (bend)
      bend[j] = frequency * frequency * sums[2];
  }
}

void ric_ritz_state(const ric_ritz *ritz, const double *c, double period, double t, double *q, double *v) {
  ritz_motion(ritz, c, period, t / period, q, v, NULL);
}

double ric_ritz_defect(ric_ritz *r, const double *c, double period) {
  size_t samples = SAMPLES * (r->functions + 1), n = r->coordinates;
  double left = 0, most = 0;
  if (ritz_check_numbers(r, c, period, NULL) != RIC_OK)
    return NAN;
  for (size_t s = 0; s <= samples; s++) {
    ritz_motion(r, c, period, (double)s / (double)(2 * samples), r->q, NULL, r->bend);
    ric_lattice_acceleration(lattice_system_lattice(r->system), 0, r->q, r->nothing, r->rate);
    most = fmax(most, largest(r->bend, n));
    for (size_t i = 0; i < n; i++)
      left = fmax(left, fabs(r->bend[i] - r->rate[i]));
  }
  return left > 0 ? left / most : 0; /* rest is exact */
}
