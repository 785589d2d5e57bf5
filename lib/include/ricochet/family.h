/* Families: branches of periodic motions along a parameter, with every special point named.
 *
 * The equations of shooting (shooting.h) are continued (continuation.h) along a number of the system, the period or
 * the energy. The impacts of a family are fixed. Where the motion stops being admissible, the family continues as
 * solutions of the same equations and reports where and why. At such a point the family with one contact more, or one
 * less, can be started.
 *
 * Special points, located on the branch:
 *
 *   fold               the family turns back
 *   branch_point       another family of the same kind crosses
 *   symmetry_breaking  a pair of multipliers of an even motion passes +1; motions that are not even branch off
 *   energy_extreme     the same without a branching family: the energy is extreme among motions of neighbouring periods
 *                      (dE/dT = 0)
 *   period_doubling    a multiplier passes -1
 *   torus              a pair of complex multipliers crosses the unit circle (Neimark-Sacker bifurcation); in even and
 *                      conservative motions two pairs collide on it
 *   resonance          a pair of multipliers of an even motion passes a third or fourth root of unity: motions of
 *                      three or four times the period branch off
 *   grazing            a grazing point: the motion touches an obstacle away from the impacts of the family, either one
 *                      that it does not hit or, once more, one that it hits
 *   impact_lost        the gap rate of an impact goes to zero and the impact becomes a grazing point: the gap has a
 *                      minimum there
 *   impulse_sign       the same with a maximum of the gap: the free motion would pass through the obstacle and the
 *                      impulse changes sign
 *   order              two consecutive impacts coincide
 *
 * Pairs of zeros within one step are missed; decrease `step_most` to find them. */
#ifndef RICOCHET_FAMILY_H
#define RICOCHET_FAMILY_H

#include "continuation.h"
#include "shooting.h"

RIC_BEGIN_DECLARATIONS

/** What is continued. */
typedef struct ric_family_problem {
  ric_system *system; /* borrowed; `set` changes its numbers. Several families may share it if they are used one at a
                         time; one may be followed inside the point callback of another */
  ric_shooting_problem motion; /* arrays are copied */
  /** Stores the parameters p [parameters] in the system (ric_system_set_lattice, ..., or the user's own data), and sets
   *  the given number (shooting.h) if it depends on them; on entry it holds `given`. Returns RIC_EINVAL for invalid
   *  values, RIC_ENUMERIC to request a shorter step. NULL: p[0] is the given number and there is no p[1]
   */
  ric_status (*set)(ric_system *system, const double *p, double *given, void *user, ric_error *error);
  void *user;
  size_t parameters; /* 1, or 2 for curves of special points in two parameters; p[1] is constant otherwise */
  double second;     /* value of p[1] */
  double given;      /* before `set` */
  size_t periods;    /* of the motion, in the one that `set` gives: a multiple of the forcing; 0: one */
} ric_family_problem;

typedef struct ric_family_options {
  ric_curve_options curve; /* newton_tol is 1e-12 by default; its poll is called, too */
  bool multipliers; /* default true: find them at every point, and the special points that follow from them; at most
                       RIC_FAMILY_NUMBERS numbers of a state */
  ric_multiplier_options judge;
} ric_family_options;

enum { RIC_FAMILY_NUMBERS = 400 };

RIC_API ric_family_options ric_family_options_default(void);

#define RIC_FAMILY_LIST(X)                                                                                             \
  X(RIC_FAMILY_REGULAR, "regular")                                                                                     \
  X(RIC_FAMILY_FOLD, "fold")                                                                                           \
  X(RIC_FAMILY_BRANCH_POINT, "branch_point")                                                                           \
  X(RIC_FAMILY_SYMMETRY_BREAKING, "symmetry_breaking")                                                                 \
  X(RIC_FAMILY_ENERGY_EXTREME, "energy_extreme")                                                                       \
  X(RIC_FAMILY_PERIOD_DOUBLING, "period_doubling")                                                                     \
  X(RIC_FAMILY_TORUS, "torus")                                                                                         \
  X(RIC_FAMILY_RESONANCE, "resonance")                                                                                 \
  X(RIC_FAMILY_GRAZING, "grazing")                                                                                     \
  X(RIC_FAMILY_IMPACT_LOST, "impact_lost")                                                                             \
  X(RIC_FAMILY_IMPULSE_SIGN, "impulse_sign")                                                                           \
  X(RIC_FAMILY_ORDER, "order")

typedef enum ric_family_kind {
#define X(name, text) name,
  RIC_FAMILY_LIST(X)
#undef X
      RIC_FAMILY_KINDS
} ric_family_kind;

/** Name of a kind, "fold". Never NULL. */
RIC_API const char *ric_family_kind_name(ric_family_kind kind);

/** A point of a family. Its pointers are valid during the callback. */
typedef struct ric_family_point {
  ric_family_kind kind;
  double parameter;
  size_t unknowns;
  const double *z;        /* [unknowns] shooting.h */
  const double *tangent;  /* [unknowns + 1] of the branch, in the direction of the continuation run */
  double given;           /* the given number there */
  const ric_orbit *orbit; /* with outcome, energy, clearance. What needs an integration, and the multipliers, may be one
                             Newton step old; the error is below newton_tol */
  const ric_multipliers *multipliers; /* NULL if not requested */
  size_t obstacle;                    /* of grazing, impact_lost, impulse_sign, order; SIZE_MAX */
  double time;                        /* the same, in [0, T); NaN */
  int order;                          /* of resonance: 3 or 4; 0 */
  double arclength, step;             /* continuation.h */
  int iterations;
} ric_family_point;

typedef struct ric_family ric_family;

/** @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL as ric_shooting_create and ric_curve_create; RIC_ELIMIT for multipliers of too large a state;
 *           RIC_ENOMEM. */
RIC_API ric_status ric_family_create(const ric_family_problem *problem, const ric_family_options *options,
                                     ric_family **family, ric_error *error);
RIC_API void ric_family_destroy(ric_family **family);

/** The shooting equations, at the parameter used last. */
RIC_API ric_shooting *ric_family_shooting(ric_family *family);

/** The motion at a parameter from a guess (ric_shooting_guess), by ric_shooting_solve.
 *  @param q, u, times  of the guess; u NULL if m = 0, times NULL if there are none
 *  @param period  of the guess
 *  @param z  [unknowns], set
 *  @param iterations  of Newton's method; may be NULL
 *  @returns as those two and `set`. */
RIC_API ric_status ric_family_start(ric_family *family, double parameter, const double *q, const double *u,
                                    const double *times, double period, double *z, int *iterations, ric_error *error);

/** Follows the family from a solution.
 *  @param z  [unknowns]; set to the first point
 *  @param tangent  as for ric_curve_follow: NULL, or the tangent of a point or from ric_family_switch
 *  @param point  called with every point in order; NULL for none. Non-zero ends the run
 *  @returns as ric_curve_follow. */
RIC_API ric_status ric_family_follow(ric_family *family, double *z, double parameter, const double *tangent,
                                     int (*point)(const ric_family_point *point, void *user), void *user,
                                     ric_curve_run *run, ric_error *error);

/** Tangent of the other family at a branch point, as ric_curve_switch. */
RIC_API ric_status ric_family_switch(ric_family *family, const double *z, double parameter, const double *tangent,
                                     double *other, ric_error *error);

/** A family that branches off another one, ready to be followed. */
typedef struct ric_family_junction {
  ric_family *family; /* to be destroyed by the caller */
  double *z;          /* [unknowns] */
  double *tangent;    /* [unknowns + 1], towards the side on which it exists */
  double parameter;
  int side;       /* sign of the parameter's change along it; 0: none to first order */
  int other_side; /* side on which the original family exists (is admissible); 0: neither or both */
} ric_family_junction;

RIC_API void ric_family_junction_clear(ric_family_junction *junction);

/** Crosses a grazing point: the family with the new contact added at a point of kind grazing, or with the vanishing
 *  impact removed at impact_lost.
 *  @param point  of this family, during its callback or kept by the caller with its arrays
 *  @returns RIC_EINVAL for other kinds, and for an impact of the only obstacle of an autonomous motion; RIC_ENUMERIC
 *           if the other family has no tangent; RIC_ENOMEM. */
RIC_API ric_status ric_family_cross(ric_family *family, const ric_family_point *point, ric_family_junction *junction,
                                    ric_error *error);

/** The family of twice the period that branches off at a period doubling; not for even motions.
 *  @returns RIC_EINVAL for other kinds; RIC_ENUMERIC, RIC_ENOMEM. */
RIC_API ric_status ric_family_double(ric_family *family, const ric_family_point *point, ric_family_junction *junction,
                                     ric_error *error);

/** A point of a curve in two parameters. */
typedef struct ric_family_curve_point {
  double parameter, second;
  const double *z; /* [unknowns] */
  double given;
  const ric_orbit *orbit;
  int iterations;
  size_t zero; /* index of the test function that vanishes there; SIZE_MAX: none */
} ric_family_curve_point;

/** Test functions along a curve; their zeros are located on it. */
typedef struct ric_family_curve_tests {
  size_t count;
  /** Values [count]; NaN: not defined there. May use the family's system, which holds the parameters of the point, and
   *  its shooting equations. Returns RIC_ENUMERIC to request a shorter step. */
  ric_status (*values)(const ric_family_curve_point *point, double *values, void *user, ric_error *error);
  void *user;
} ric_family_curve_tests;

/** Follows a fold, a period doubling, a grazing point or the loss of an impact in two parameters by pseudo-arclength
 *  continuation, from such a point. The parameter of the curve is the second one.
 *  @param options  of the curve, NULL for the defaults of the family
 *  @param tests  NULL for none; copied
 *  @param seen  called with every point; NULL for none. Non-zero ends the run
 *  @returns RIC_EINVAL for other kinds and problems with one parameter; as ric_curve_follow. */
RIC_API ric_status ric_family_trace(ric_family *family, const ric_family_point *point, const ric_curve_options *options,
                                    const ric_family_curve_tests *tests,
                                    int (*seen)(const ric_family_curve_point *point, void *user), void *user,
                                    ric_curve_run *run, ric_error *error);

RIC_END_DECLARATIONS

#endif
