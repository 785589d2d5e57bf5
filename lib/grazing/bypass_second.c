/* kappa, the coefficient of y^2 in the bypass map.
 *
 * Seen from x = x* - y^2 n with eta n = 1, psi(x) = -y^2 + O(y^4), and (C(x) - x) / y^2 - s xi / y = kappa + O(y) is
 * a series in y. Another n moves x along the surface psi = const by O(y^2), and that changes C - x by O(y |x - x*|),
 * which is O(y^3): kappa does not depend on it. Here n is along eta.
 *
 * The limit y -> 0 is by Neville's scheme, as far as rounding allows: that of psi over y^3, and the error of s, whose
 * A_g comes from differences where the gap is a user's, over y. Without s, as the slope of (C(x) - x) / y, kappa has
 * three digits less: one order is lost at each level. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bypass_parts.h"

enum { LEVELS = 7, SKIPPED = 8 }; /* halvings of y; and those before the map works at all */

/* Time that the first one of the states spends behind the obstacle until the minimum, as a part of the reach; no more
 * than that of a motion whose times are of order one. */
static const double first_part = 0.25;

/* Neville's scheme towards y = 0, one row per level of y. */
typedef struct scheme {
  ric_bypass *b;
  const ric_grazing_local *at;
  double t;
  const double *x;
  double *row, *last;      /* [LEVELS][n + m] orders of this level and of the one before */
  double *state, *image;   /* [n + m] */
  double *best;            /* [n + m] slope so far */
  double y[LEVELS], error; /* of best */
  int level;
} scheme;

/* (C(z) - z) / y^2 - s xi / y at z = x - depth eta / |eta|^2. */
static ric_status sample(scheme *k, double depth, ric_error *error) {
  const ric_grazing_local *at = k->at;
  size_t size = k->b->size;
  double square = 0, s = sqrt(2 * at->acceleration);
  ric_bypass_seen seen;
  for (size_t i = 0; i < size; i++)
    square += at->eta[i] * at->eta[i];
  for (size_t i = 0; i < size; i++)
    k->state[i] = k->x[i] - depth * at->eta[i] / square;
  RIC_TRY(ric_bypass_map(k->b, k->t, k->state, k->image, &seen, error));
  double y = k->y[k->level] = sqrt(fmax(-seen.psi, 0));
  if (!(y > 0))
    return ric_fail(error, RIC_ENUMERIC, "the gap is %.3g at a state %.3g behind grazing, expected less than zero",
                    seen.psi, depth);
  for (size_t i = 0; i < size; i++)
    k->row[i] = ((k->image[i] - k->state[i]) / y - s * at->xi[i]) / y;
  return RIC_OK;
}

static double difference(const double *a, const double *b, size_t size) {
  double most = 0;
  for (size_t i = 0; i < size; i++)
    most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* The orders of this level. An entry is as good as it agrees with the two it is made of: beyond the best one rounding
 * takes over. */
static void extrapolate(scheme *k) {
  size_t size = k->b->size;
  for (int order = 1; order <= k->level; order++) {
    const double *fine = k->row + (size_t)(order - 1) * size, *coarse = k->last + (size_t)(order - 1) * size;
    double *now = k->row + (size_t)order * size, ratio = k->y[k->level - order] / k->y[k->level];
    for (size_t i = 0; i < size; i++)
      now[i] = fine[i] + (fine[i] - coarse[i]) / (ratio - 1);
    double error = fmax(difference(now, fine, size), difference(now, coarse, size));
    if (!(error < k->error))
      continue;
    k->error = error;
    memcpy(k->best, now, size * sizeof *now);
  }
}

static ric_status run(scheme *k, ric_error *error) {
  double time = first_part * fmin(1, k->b->reach), rate = k->at->acceleration / 2;
  for (int skipped = 0; k->level < LEVELS; time /= 2) {
    ric_status status = sample(k, rate * time * time, error);
    if (status == RIC_ENUMERIC && k->level == 0 && skipped++ < SKIPPED)
      continue;
    RIC_TRY(status);
    extrapolate(k);
    double *row = k->row;
    k->row = k->last;
    k->last = row;
    k->level++;
  }
  return RIC_OK;
}

ric_status ric_bypass_second(ric_bypass *b, const ric_grazing_local *at_grazing, double t, const double *x,
                             double *kappa, ric_error *error) {
  RIC_TRY(grazing_check_local(at_grazing, b->system, error));
  double *work = malloc((2 * LEVELS + 3) * b->size * sizeof *work);
  if (!work)
    return ric_fail(error, RIC_ENOMEM, "no memory for an extrapolation of %zu numbers", b->size);
  scheme k = {.b = b, .at = at_grazing, .t = t, .x = x, .row = work, .error = INFINITY};
  k.last = k.row + LEVELS * b->size;
  k.state = k.last + LEVELS * b->size;
  k.image = k.state + b->size;
  k.best = k.image + b->size;
  ric_status status = run(&k, error);
  if (status == RIC_OK)
    memcpy(kappa, k.best, b->size * sizeof *kappa);
  free(work);
  return status;
}
