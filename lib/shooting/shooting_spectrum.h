/* Multipliers of motions that shooting has found: internal to the room.
 *
 * Even motions. Half a period G, from the middle of the impacts at t = 0 to the middle of those at T/2, is symplectic.
 * In coordinates (s, a), states that time reversal leaves alone and those that it turns around (displacements and
 * momenta of coordinates at rest; momenta and minus displacements of those that are hit),
 *
 *   G = | A  B |     M = (R G^-1 R) G,    W = 1 + 2 B^T C,
 *       | C  D |
 *
 * with W the n x n block of even_spectrum.h. C is the Jacobian of shooting. Each of the four blocks is singular where a
 * pair of multipliers meets: C at +1 in the family (folds, branch points), B at +1 out of it (the orbit stops being
 * even), A and D at -1. The motion itself is in the kernel of B when time does not enter, which is taken out.
 *
 * All others: the eigenvalues of M, from the tangent vectors of the arcs and saltation. */
#ifndef RICOCHET_SHOOTING_SPECTRUM_H
#define RICOCHET_SHOOTING_SPECTRUM_H

#include <gsl/gsl_linalg.h>

#include "floquet/even_spectrum.h"
#include "floquet/multiplier_work.h"
#include "shooting_parts.h"

typedef struct shooting_spectrum {
  size_t size;          /* n + m */
  double *matrix;       /* [n + m][n + m] G or M, as far as it is known */
  double *product;      /* the same, scratch */
  double *carried;      /* [n + m][n + m + 1] tangent vectors along a piece */
  double *after;        /* [n + m] state after an impact */
  double *start, *half; /* [n + m] rates (s, a) there; of even motions */
  even_spectrum even;
  multiplier_work work; /* of motions that are not even */
  gsl_matrix *bordered; /* [n + 1][n + 1], or [n + m][n + m] */
  gsl_permutation *order;
  double *tau;            /* [2][n + 1] or [2][n + m] */
  tangent_jump jump;      /* for n + m columns */
  unsigned char *contact; /* [obstacles] all open, or pressed where they comply */
  bool grazing;           /* an impact is too slow for a derivative */
  size_t obstacle;        /* which */
} shooting_spectrum;

/** Makes s->spectrum; nothing when there is one. @returns RIC_ENOMEM */
ric_status shooting_spectrum_reserve(ric_shooting *s, ric_error *error);
void shooting_spectrum_destroy(shooting_spectrum **spectrum);

/** For an observer of a run that carries the whole state: at the first state s->x, and at the end of every piece,
 * before the impact there. Leaves G or M in s->spectrum->matrix; or `grazing`. */
ric_status shooting_spectrum_begin(ric_shooting *s, ric_error *error);
ric_status shooting_spectrum_pass(ric_shooting *s, const piece_run *run, ric_error *error);

/** Takes s->spectrum->matrix through the impact at the end of a piece, by its saltation, with s->x before it; or
 *  `grazing`. */
ric_status shooting_spectrum_jump(ric_shooting *s, const piece_run *run, ric_error *error);

/** Sets s->spectrum->matrix to the identity. */
void shooting_spectrum_identity(shooting_spectrum *spectrum);

/** The multipliers of the matrix found. @param m  initialised for n + m */
ric_status shooting_multipliers(ric_shooting *s, const ric_multiplier_options *options, ric_multipliers *m,
                                ric_error *error);

/** Test functions, smooth along a family, with simple zeros; NaN where there are none. */
typedef struct spectrum_tests {
  double minus_one[2]; /* multipliers -1: determinants of A and D; of M + 1, and NaN */
  double breaking;     /* even motions: the determinant of B, the motion taken out */
  double energy;       /* even motions without forcing: dE/dT, as the bordered determinant of C */
} spectrum_tests;

/** Those of the matrix found. */
spectrum_tests shooting_spectrum_tests(ric_shooting *s);

#endif
