/* The determinant whose zeros are the multipliers, in O(n m) memory: internal to the room.
 *
 * A solution of the variational equation with x(t + T) = mu x(t) is free between impacts; at each impact its
 * displacement jumps by some x_k and its velocity by some p_k. Modes respond to unit jumps that repeat with factors mu
 * as
 *
 *   g(t) = (sin w(T - t) + mu sin w t) / (2 w (alpha - cos wT)),   alpha = (mu + 1/mu) / 2,   0 <= t <= T,
 *
 * and by the saltation matrix the mean displacement at the impact is 0 and the mean velocity is -s_k x_k / 4. These are
 * 2m equations for 2m jumps, with the matrix N(mu) of sums over modes, and
 *
 *   f(mu) = (-4)^m det N(mu) = prod_i (alpha - alpha_i) / prod_j (alpha - cos w_j T) = det(I - Y^T (mu - D)^-1 D X)
 *
 * (orbit_multipliers.h). With the impacts at T/2 scaled by sqrt(mu), f is a function of alpha alone. The variable here
 * is zeta = log mu, and alpha - 1 = 2 sinh^2(zeta / 2) has no cancellation.
 *
 * The motion along the orbit is a zero for any orbit, alpha = 1 with x_k = p_k of the orbit. N times it has the factor
 * alpha - 1, which is removed analytically: g(mu) = f(mu) / (alpha - 1) is computed without cancellation and used near
 * 1.
 *
 * On the circle f is the determinant of a real symmetric matrix H; the number of its negative eigenvalues counts
 * multipliers (determinant.h). */
#ifndef RICOCHET_SECULAR_H
#define RICOCHET_SECULAR_H

#include "numeric/complex_number.h"

#include <gsl/gsl_eigen.h>

#include "reduced.h"

/** A free mode on the circle: mu = exp(+- i angle). */
typedef struct secular_pole {
  double angle;  /* in [0, pi] */
  int signature; /* sign of sin wT: Krein signature, the direction in which the multipliers move as the frequency
                    increases */
  bool hidden;   /* its displacement vanishes at all impacts: a multiplier of the orbit, too, and no pole of f */
} secular_pole;

/** Coefficients of the sums over modes: responses at the same half of the period, at the other one, and of the
 *  derivative by alpha along the orbit. Arrays [visible]. */
typedef struct secular_modes {
  size_t visible;                      /* modes that do not vanish at all impacts */
  double *below_one, *above_minus_one; /* 1 - cos wT, 1 + cos wT */
  double *same_position, *same_speed;
  double *other_position, *other_mean, *other_speed;
  double *along_start, *along_half, *along_start_beta, *along_half_beta;
  double *re, *im; /* work: 1 / (alpha - cos wT) */
  double *shape;   /* [m][seen] */
} secular_modes;

typedef struct secular {
  size_t particles, impacts;
  const orbit_impact *impact; /* [m], borrowed */
  size_t largest;             /* impact with the largest impulse: its column is the one replaced */
  secular_pole *poles;        /* [n], by angle */
  secular_modes modes;
  double *store;
  size_t capacity, pole_capacity, impact_capacity;
  double complex *position, *mean, *speed; /* [m][m] sums at the last zeta */
  double complex *along;                   /* [m] */
  double complex *matrix;                  /* N [2m][2m] */
  gsl_matrix *symmetric;                   /* H [2m][2m] */
  gsl_vector *eigenvalues;
  gsl_eigen_symm_workspace *work;
  size_t evaluations;
  ric_poll poll; /* called at every evaluation */
  bool stopped;  /* the callback has stopped the computation: later results are undefined */
} secular;

void secular_clear(secular *s);

/** Sets up the modes for an orbit; zeroed once, keeps its memory. @param impacts  borrowed until the next call */
ric_status secular_prepare(secular *s, const ric_chain *chain, const orbit_impacts *impacts, double period,
                           ric_error *error);

/** log g(exp zeta); the imaginary part up to multiples of 2 pi. O(n m^2). */
double complex secular_log(secular *s, double complex zeta);

/** Number of negative eigenvalues of H at mu = exp(i angle), 0 <= angle < pi; at 0 the limit from above. O(n m^2). */
size_t secular_negative(secular *s, double angle);

/** Bytes that it holds. */
double secular_bytes(const secular *s);

#endif
