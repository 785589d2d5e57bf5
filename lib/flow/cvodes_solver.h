/* SUNDIALS CVODES behind a few calls: the one place that knows its interface.
 *
 * Adams' formulas of orders 1 to 12 with variable steps; the implicit equations by fixed-point iteration. The local
 * error of a step, in root mean square over the numbers of a state, is kept below `tolerance` times the size of the
 * state, itself in root mean square. Functions return NULL or what went wrong as a static text. */
#ifndef RICOCHET_CVODES_SOLVER_H
#define RICOCHET_CVODES_SOLVER_H

#include <stdbool.h>

#include <cvodes/cvodes.h>

#include "ricochet/status.h"

enum { CVODES_ORDER = 12 };

/** Tangent vectors in CVODES' forward sensitivity analysis (staggered, under the error control of the state). */
typedef struct cvodes_tangents {
  size_t columns;   /* there is room for, and CVODES knows of; 0: none */
  bool carried;     /* they take part */
  N_Vector *vector; /* [columns] */
  SUNNonlinearSolver iteration;
  double *absolute;     /* [columns] tolerances */
  double **d, **d_rate; /* [columns] the numbers of vectors, for the callback */
} cvodes_tangents;

typedef struct cvodes_solver {
  SUNContext context;
  void *memory;
  SUNNonlinearSolver iteration;
  N_Vector y, row;
  size_t size;
  double
      origin; /* of the time that CVODES sees: that of the last restart, so that early steps are not lost in rounding */
  double begin, end; /* of the last step, from the origin */
  double tolerance;
  /** Rates of the state [size]. */
  const char *(*rate)(void *user, double t, const double *y, double *y_rate);
  /** Rates of the tangent vectors d [columns][size] at a state. */
  const char *(*tangent_rate)(void *user, double t, const double *y, double *const *d, double *const *d_rate);
  void *user;
  cvodes_tangents tangents;
  const char *trouble; /* of the last call of `rate` that failed, and when */
  double trouble_time;
} cvodes_solver;

ric_status cvodes_solver_init(cvodes_solver *s, double longest_step, ric_error *error);
void cvodes_solver_clear(cvodes_solver *s);

/** The state [size]; written before a restart, read after a step. */
double *cvodes_solver_state(const cvodes_solver *s);

/** Makes room for tangent vectors; 0: none any more, whose room stays for as many again. A restart must follow. */
ric_status cvodes_solver_carry(cvodes_solver *s, size_t columns, ric_error *error);
void cvodes_tangents_clear(cvodes_solver *s);

/** Tangent vector [size]; written before a restart, read after cvodes_tangents_at. */
double *cvodes_solver_tangent(const cvodes_solver *s, size_t column);

/** Tells CVODES of the tangent vectors, after a restart. */
const char *cvodes_tangents_restart(cvodes_solver *s);

/** Sets the tangent vectors to those at a position of the last step, 0 <= x <= 1. */
const char *cvodes_tangents_at(cvodes_solver *s, double x);

/** Forgets the history. */
const char *cvodes_solver_restart(cvodes_solver *s, double t);

/** One step towards `stop`, and not beyond. @param t  set to the time after it; `stop` itself when it was reached */
const char *cvodes_solver_step(cvodes_solver *s, double stop, double *t);

/** Length of the last step and of the next one that is planned, the larger of the two, >= 0. */
double cvodes_solver_span(const cvodes_solver *s);

/** The state on the last step as a polynomial in [0, 1], coef [CVODES_ORDER + 1][size]; its degree, -1 when there is
 *  none. */
int cvodes_solver_polynomial(cvodes_solver *s, double *coef);

#endif
