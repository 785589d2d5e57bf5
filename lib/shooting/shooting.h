/* Shooting: its options and workspace, the solution by Newton's method, and states of a motion. Internal to the
 * library. */
#ifndef RICOCHET_INTERNAL_SHOOTING_H
#define RICOCHET_INTERNAL_SHOOTING_H

#include <gsl/gsl_linalg.h>

#include "arcs.h"
#include "floquet/multipliers.h"
#include "impact/gap_watch.h"
#include "impact/saltation.h"

/* The equations of shooting, for the files that share them. */

struct ric_shooting {
  ric_system *system; /* borrowed */
  arc_plan arcs;
  arc_runner runner;
  impact_solver law;
  tangent_jump jump;
  bool forced; /* the forces depend on time */
  double grazing_tol;
  bool out_of_order; /* impacts of the motion evaluated last */
  ric_poll poll;
  size_t columns;   /* most numbers of a first state, c */
  double *x;        /* [n + m] state along a piece */
  double *rates;    /* [n + m] */
  double *contact;  /* [2][m] gradient of a gap, and velocities by a unit impulse along it */
  double *vectors;  /* [n + m][c + 1] tangent vectors along a piece; the spectrum has an array with more columns */
  double *ends;     /* [n + m][c + 2] derivatives of the end of a piece: by the numbers of its first state, and by the
                       times at which its arc begins and ends */
  double *gap_row;  /* [c + 2] the same derivatives of a gap */
  double *time_row; /* [c + 2] the same derivatives of the time at the end of the piece */
  double *gradient; /* [n + m] of the energy at the first state */
  double *phase_at; /* [n + m] the phase condition: <phase_along, x - phase_at> = 0 */
  double *phase_along;
  double *residual;                   /* [unknowns] residual of a solution */
  double *block;                      /* owns all of them */
  system_gaps gaps;                   /* without a system until an orbit is computed */
  struct shooting_spectrum *spectrum; /* NULL until multipliers are computed */
};

static inline bool shooting_is_even(const ric_shooting *s) {
  return s->arcs.kind == RIC_MOTION_EVEN;
}

/** Results for the end of a piece: its state; also derivatives by the unknowns in the first state; also by the whole
 *  first state. */
typedef enum piece_output { OUTPUT_STATE, OUTPUT_DERIVATIVES, OUTPUT_WHOLE } piece_output;

/** A piece of a motion that is integrated. */
typedef struct piece_run {
  const arc_piece *piece;
  double begin, end;    /* times */
  size_t first_numbers; /* of its first state */
  piece_output output;
  double *vectors; /* [n + m][columns] tangent vectors: of the first numbers, of the first time if it is variable, of
                    * the others */
  size_t columns;
} piece_run;

/** Sets s->x to the first state of a piece and returns the data of its run. @param output  OUTPUT_WHOLE with a spectrum
 *  only */
piece_run shooting_begin(ric_shooting *s, size_t piece, const double *z, double period, piece_output output);

/** Integrates s->x to the end of the piece, and sets s->ends and the tangent vectors.
 *  @param watcher  may be NULL */
ric_status shooting_move(ric_shooting *s, const piece_run *run, const arc_watch *watcher, ric_error *error);

/** Column of the tangent vectors for a row of the first state; NO_UNKNOWN where there is none. */
size_t shooting_column(const ric_shooting *s, const piece_run *run, size_t row);

/** Applies the impact at the end of the piece to s->x and s->ends. */
ric_status shooting_hit(ric_shooting *s, const piece_run *run, ric_error *error);

/** Energy of a first state x [n + m], and its gradient in s->gradient; x is changed and restored. */
ric_status shooting_energy(ric_shooting *s, double *x, double *energy, ric_error *error);

/** Called with the pieces of a motion while the equations are evaluated; functions may be NULL. */
typedef struct shooting_observer {
  ric_status (*begins)(const piece_run *run, void *user, ric_error *error);
  void (*segment)(const ric_segment *piece, double end, void *user);
  ric_status (*ends)(const piece_run *run, void *user, ric_error *error); /* at s->x, before the impact there */
  bool whole; /* tangent vectors of the whole state are needed */
  void *user;
} shooting_observer;

/** As ric_shooting_residual. @param observer  may be NULL */
ric_status shooting_evaluate(ric_shooting *shooting, const double *z, double given, double *F, double *J,
                             double *F_given, const shooting_observer *observer, ric_error *error);

/** Sets the period. @returns RIC_ENUMERIC unless z are numbers and the period is positive. */
ric_status shooting_period(const ric_shooting *s, const double *z, double given, double *period, ric_error *error);

/* Orbit and multipliers of a motion from one integration, together with its equations. */

/** What is computed: numbers of the orbit and its gaps; the matrix of its multipliers. */
typedef enum shooting_parts { EXAMINE_ORBIT = 1, EXAMINE_SPECTRUM = 2 } shooting_parts;

/** Evaluates the equations, and the orbit and the matrix by the same integration.
 *  @param what  sum of shooting_parts
 *  @param F, J, F_given  as ric_shooting_residual; F may be NULL
 *  @param orbit  with EXAMINE_ORBIT: impacts, state at T/2 and residual are set; s->gaps.watch has the gaps
 *  @returns as ric_shooting_residual, RIC_ENOMEM. */
ric_status shooting_examine(ric_shooting *s, const double *z, double given, int what, double *F, double *J,
                            double *F_given, ric_orbit *orbit, ric_error *error);

/** First state, period, energy and verdict of the orbit of the last shooting_examine.
 *  @param z  of the orbit, or of a later correction of it that is smaller than the accuracy of the orbit */
ric_status shooting_verdict(ric_shooting *s, const double *z, double given, ric_orbit *orbit, ric_error *error);

/* Multipliers of motions found by shooting.
 *
 * Even motions. Half a period G, from the middle of the impacts at t = 0 to the middle of those at T/2, is
 * symplectic. In coordinates (s, a), states that time reversal keeps and states that it negates (displacements and
 * momenta of coordinates at rest; momenta and minus displacements of those that are hit),
 *
 *   G = | A  B |     M = (R G^-1 R) G,    W = 1 + 2 B^T C,
 *       | C  D |
 *
 * with W the n x n block of multipliers.h. C is the Jacobian of shooting. Each of the four blocks is singular where
 * a pair of multipliers meets: C at +1 in the family (folds, branch points), B at +1 out of it (symmetry breaking),
 * A and D at -1. The tangent of the motion itself is in the kernel of B when the forces do not depend on time; the
 * determinant excludes it.
 *
 * All others: the eigenvalues of M, from the tangent vectors of the arcs and saltation matrices. */

typedef struct shooting_spectrum {
  size_t size;          /* n + m */
  double *matrix;       /* [n + m][n + m] G or M up to the last piece */
  double *product;      /* the same, scratch */
  double *vectors;      /* [n + m][n + m + 1] tangent vectors along a piece */
  double *after;        /* [n + m] state after an impact */
  double *start, *half; /* [n + m] rates (s, a) at 0 and T/2; of even motions */
  even_spectrum even;
  multiplier_work work; /* of motions that are not even */
  gsl_matrix *bordered; /* [n + 1][n + 1], or [n + m][n + m] */
  gsl_permutation *order;
  double *tau;            /* [2][n + 1] or [2][n + m] */
  tangent_jump jump;      /* for n + m columns */
  unsigned char *contact; /* [obstacles] all open, or pressed if compliant */
  bool grazing;           /* an impact is too slow for a derivative */
  size_t obstacle;        /* its obstacle */
} shooting_spectrum;

/** Makes s->spectrum unless there is one. @returns RIC_ENOMEM */
ric_status shooting_spectrum_reserve(ric_shooting *s, ric_error *error);
void shooting_spectrum_destroy(shooting_spectrum **spectrum);

/** For an observer with tangent vectors of the whole state: at the first state s->x, and at the end of every piece,
 *  before the impact there. Leaves G or M in s->spectrum->matrix; or sets `grazing`. */
ric_status shooting_spectrum_begin(ric_shooting *s, ric_error *error);
ric_status shooting_spectrum_pass(ric_shooting *s, const piece_run *run, ric_error *error);

/** The multipliers of s->spectrum->matrix. @param m  initialised for n + m */
ric_status shooting_multipliers(ric_shooting *s, const ric_multiplier_options *options, ric_multipliers *m,
                                ric_error *error);

/** Test functions, smooth along a family, with simple zeros; NaN where there are none. */
typedef struct spectrum_tests {
  double minus_one[2]; /* multipliers -1: determinants of A and D; of M + 1, and NaN */
  double breaking;     /* even motions: the determinant of B, without the tangent of the motion */
  double energy;       /* even motions without forcing: dE/dT, as the bordered determinant of C */
} spectrum_tests;

/** Those of s->spectrum->matrix. */
spectrum_tests shooting_spectrum_tests(ric_shooting *s);

#endif
