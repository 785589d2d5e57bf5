#include "leap.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/largest.h"

enum { LEAP_ROWS = 9 }; /* of 2, 4, 6, ... midpoint steps */

static const double least_size = 1e-3; /* of a state, as flows have it */

ric_status leap_init(leap *l, const ric_system *system, ric_error *error) {
  size_t size = system->coordinates + system->speeds;
  *l = (leap){.system = system, .rows = malloc((LEAP_ROWS + 4) * size * sizeof *l->rows)};
  if (!l->rows)
    return ric_fail(error, RIC_ENOMEM, "no memory for states of %zu numbers", size);
  l->before = l->rows + LEAP_ROWS * size;
  l->now = l->before + size;
  l->rate = l->now + size;
  l->point = l->rate + size;
  return RIC_OK;
}

void leap_clear(leap *l) {
  free(l->rows);
}

static bool find_rate(leap *l, double t) {
  const ric_system *s = l->system;
  size_t n = s->coordinates;
  return s->model->rate(s, NULL, t, l->point, l->point + n, l->rate, l->rate + n) == NULL;
}

/* The way from x after `steps` steps, in l->now. */
static bool midpoint(leap *l, double t, double dt, const double *x, int steps) {
  size_t size = l->system->coordinates + l->system->speeds;
  double h = dt / steps;
  memset(l->before, 0, size * sizeof *l->before);
  memset(l->now, 0, size * sizeof *l->now);
  for (int k = 0; k < steps; k++) {
    for (size_t i = 0; i < size; i++)
      l->point[i] = x[i] + l->now[i];
    if (!find_rate(l, t + k * h))
      return false;
    for (size_t i = 0; i < size; i++) {
      double next = l->before[i] + (k == 0 ? h : 2 * h) * l->rate[i];
      l->before[i] = l->now[i];
      l->now[i] = next;
    }
  }
  return true;
}

/* Adds row `row` to the Aitken-Neville scheme, whose last row is kept, highest order first; returns by how much the
 * highest order changed what the one below it says. */
static double extrapolate(leap *l, int row) {
  size_t size = l->system->coordinates + l->system->speeds;
  double change = 0;
  for (int order = 1; order <= row; order++) {
    double ratio = (double)(row + 1) / (row + 1 - order), divisor = ratio * ratio - 1;
    double *coarse = l->rows + (size_t)(order - 1) * size; /* of the row before; this row's takes its place */
    change = 0;
    for (size_t i = 0; i < size; i++) {
      double fine = l->now[i], step = (fine - coarse[i]) / divisor;
      coarse[i] = fine;
      l->now[i] = fine + step;
      change = fmax(change, fabs(step));
    }
  }
  memcpy(l->rows + (size_t)row * size, l->now, size * sizeof *l->now);
  return row > 0 ? change : INFINITY;
}

bool leap_move(leap *l, double t, double dt, double *x, double tolerance) {
  size_t size = l->system->coordinates + l->system->speeds;
  double scale = fmax(largest(x, size), least_size), change, best = INFINITY;
  for (int row = 0; row < LEAP_ROWS && !(best <= DBL_EPSILON / 4 * scale); row++) {
    if (!midpoint(l, t, dt, x, 2 * (row + 1)))
      return false;
    change = extrapolate(l, row);
    if (row > 0 && !(change < best)) /* rounding, or no convergence */
      break;
    best = change;
  }
  if (!(best <= tolerance * scale))
    return false;
  for (size_t i = 0; i < size; i++)
    x[i] += l->now[i];
  return true;
}
