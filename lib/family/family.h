/* A family, for the files of its room. */
#ifndef RICOCHET_INTERNAL_FAMILY_H
#define RICOCHET_INTERNAL_FAMILY_H

#include "ricochet/family.h"
#include "shooting/shooting.h"

/** Test functions: these, then the gap rates of the impacts, then the durations of the arcs between them. */
typedef enum family_test {
  TEST_MINUS_ONE,
  TEST_MINUS_ONE_TOO,
  TEST_BREAKING,
  TEST_ENERGY,
  TEST_TORUS,
  TEST_THIRD,
  TEST_FOURTH,
  TEST_FREE_GAP,
  TEST_OWN_GAP,
  TEST_IMPACTS
} family_test;

struct ric_family {
  ric_family_problem problem; /* its arrays are in `hits` */
  ric_family_options options;
  size_t *hits;
  ric_shooting *shooting;
  ric_curve *curve;
  size_t unknowns, impacts, tests; /* impacts with gap rates of their own */
  double at[2];                    /* parameters in the system; NaN: none yet */
  double given;                    /* with them */
  double *below, *above;           /* [unknowns] residuals at shifted parameters */
  ric_orbit orbit;                 /* of the motion evaluated last: */
  ric_multipliers multipliers;
  double *evaluated_z, evaluated_at[2]; /* [unknowns] the motion of the last run, and its parameters; NaN: none */
  bool complete;                        /* orbit, verdict and multipliers are complete */
  size_t coincide;                      /* pairs of multipliers that coincide at all points of this continuation run */
  double *block;
};

/** Puts parameters into the system. */
ric_status family_set(ric_family *f, double first, double second, ric_error *error);

/** Marks the numbers in the system as unknown: other code may have changed them. */
void family_forget(ric_family *f);

/** Evaluates a point again: its orbit is that of the family, which other motions have overwritten. */
void family_evaluate_again(ric_family *f, const ric_family_point *point);

/** F and its derivatives by z and by one of the parameters at f->at. */
ric_status family_residual(ric_family *f, const double *z, size_t by, double *F, double *J, double *F_p,
                           ric_error *error);

/** Integrates a motion once, for its orbit, its gaps and the matrix of its multipliers.
 *  @param F, J, F_given  from the same run, as ric_shooting_residual; may be NULL */
ric_status family_evaluate(ric_family *f, const double *z, double *F, double *J, double *F_given, ric_error *error);

/** Completes orbit, verdict and multipliers of a motion. It integrates only if the last run was along another
 *  motion, and does nothing if they are complete. */
ric_status family_complete(ric_family *f, const double *z, ric_error *error);

/** Test functions [tests] of the motion evaluated last. */
void family_tests(ric_family *f, const double *z, double *values);

/** Classifies a zero of a test function; RIC_FAMILY_REGULAR: no special point. Sets kind, obstacle, time and order. */
void family_classify_zero(ric_family *f, const double *z, size_t test, ric_family_point *point);

#endif
