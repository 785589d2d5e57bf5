/* Families: periodic motions along a parameter, with every special point named.
 *
 * The equations of shooting (shooting.h) are continued (continuation.h) along a number of the system, or along the
 * period or the energy. A family knows its impacts: it is followed on where it stops being admissible, as solutions of
 * the same equations, and says where and why; at such a point the family with a contact more, or less, can be gone over
 * to.
 *
 * Special points, located on the curve:
 *
 *   fold               the family turns back
 *   branch_point       another family of the same kind crosses
 *   symmetry_breaking  a pair of multipliers of an even motion passes +1 by motions that are not even
 *   energy_extreme     the same where no family branches: among motions of neighbouring periods the energy of this
 *                      one is extreme (dE/dT = 0)
 *   period_doubling    a multiplier passes -1
 *   torus              a pair of complex multipliers leaves the circle or comes back; of even and conservative
 *                      motions two pairs meet there
 *   resonance          a pair of multipliers of an even motion passes a third or fourth root of unity: motions of
 *                      three or four times the period branch off
 *   grazing            an obstacle is touched away from the impacts of the family: one that it does not hit, or
 *                      again one that it hits
 *   impact_lost        an impact becomes a touch: its gap rate goes to zero, and the gap is smallest there
 *   impulse_sign       the same where the free motion would go through the obstacle: the impulse changes its sign
 *   order              two impacts that follow each other come to one time
 *
 * Zeros that come in pairs within one step are not seen; `step_most` is the user's means against it. */
#ifndef RICOCHET_FAMILY_H
#define RICOCHET_FAMILY_H

#include "continuation.h"
#include "shooting.h"

RIC_BEGIN_DECLARATIONS

/** What is continued. */
typedef struct ric_family_problem {
  ric_system *system; /* borrowed; `set` changes its numbers. Several families may share it, one at a time: also
                         one that is followed while a point of another is looked at */
  ric_shooting_problem motion; /* arrays are copied */
  /** Puts the parameters p [parameters] into the system (ric_system_set_lattice, ..., or the user's own data) and sets
   *  the given number (shooting.h) where it depends on them; it holds `given` before. Returns RIC_EINVAL for values
   * that make no sense, RIC_ENUMERIC to have shorter steps tried. NULL: p[0] is the given number, and there is no p[1]
   */
  ric_status (*set)(ric_system *system, const double *p, double *given, void *user, ric_error *error);
  void *user;
  size_t parameters; /* 1, or 2 for curves of special points in two parameters; p[1] stays otherwise */
  double second;     /* value of p[1] */
  double given;      /* before `set` */
  size_t periods;    /* of the motion, in the one that `set` gives: a multiple of the forcing; 0: one */
} ric_family_problem;

typedef struct ric_family_options {
  ric_curve_options curve; /* its newton_tol is 1e-12 by default, its poll asked too */
  bool multipliers;        /* default true: find them at every point, and the special points that they tell; at
                              most RIC_FAMILY_NUMBERS numbers of a state */
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

/** A point of a family. What it points to is valid during the callback. */
typedef struct ric_family_point {
  ric_family_kind kind;
  double parameter;
  size_t unknowns;
  const double *z;                    /* [unknowns] shooting.h */
  const double *tangent;              /* [unknowns + 1] of the curve, in the direction of the walk */
  double given;                       /* the given number there */
  const ric_orbit *orbit;             /* with outcome, energy, clearance; what needs a run, and the multipliers, may be
                                         those of the motion before the last correction, which newton_tol bounds */
  const ric_multipliers *multipliers; /* NULL when they are not wanted */
  size_t obstacle;                    /* of grazing, impact_lost, impulse_sign, order; SIZE_MAX */
  double time;                        /* the same, in [0, T); NaN */
  int order;                          /* of resonance: 3 or 4; 0 */
  double arclength, step;             /* continuation.h */
  int iterations;
} ric_family_point;

typedef struct ric_family ric_family;

/** @returns RIC_EINVAL as ric_shooting_create and ric_curve_create; RIC_ELIMIT for multipliers of too large a state;
 *           RIC_ENOMEM. */
RIC_API ric_status ric_family_create(const ric_family_problem *problem, const ric_family_options *options,
                                     ric_family **family, ric_error *error);
RIC_API void ric_family_destroy(ric_family **family);

/** The equations, at the parameter used last. */
RIC_API ric_shooting *ric_family_shooting(ric_family *family);

/** The motion at a parameter from a guess (ric_shooting_guess), by ric_shooting_solve.
 *  @param period  of the guess
 *  @param z  [unknowns], set
 *  @param iterations  of Newton's method; may be NULL
 *  @returns as those two and `set`. */
RIC_API ric_status ric_family_start(ric_family *family, double parameter, const double *q, const double *u,
                                    const double *times, double period, double *z, int *iterations, ric_error *error);

/** Follows the family from a solution.
 *  @param z  [unknowns]; set to the first point
 *  @param tangent  as ric_curve_follow: NULL, or of ric_family_switch, of a point
 *  @param point  sees every point in order; NULL for none. Non-zero ends the walk
 *  @returns as ric_curve_follow. */
RIC_API ric_status ric_family_follow(ric_family *family, double *z, double parameter, const double *tangent,
                                     int (*point)(const ric_family_point *point, void *user), void *user,
                                     ric_curve_run *run, ric_error *error);

/** The other branch through a branch point: its tangent, as ric_curve_switch. */
RIC_API ric_status ric_family_switch(ric_family *family, const double *z, double parameter, const double *tangent,
                                     double *other, ric_error *error);

/** A family that meets another one, ready to be followed. */
typedef struct ric_family_junction {
  ric_family *family; /* to be destroyed by the caller */
  double *z;          /* [unknowns] */
  double *tangent;    /* [unknowns + 1], into the side where it exists */
  double parameter;
  int side;       /* sign of the parameter's change there, 0: none to first order */
  int other_side; /* where the family that was left exists (is admissible); 0: neither, or both */
} ric_family_junction;

RIC_API void ric_family_junction_clear(ric_family_junction *junction);

/** The family with the contact added that appears at a grazing point, or with the impact removed that disappears
 *  (impact_lost).
 *  @param point  of this family, during its callback or kept by the caller with its arrays
 *  @returns RIC_EINVAL for other kinds, and an impact of the only obstacle of an autonomous motion; RIC_ENUMERIC where
 * the other family has no tangent; RIC_ENOMEM. */
RIC_API ric_status ric_family_cross(ric_family *family, const ric_family_point *point, ric_family_junction *junction,
                                    ric_error *error);

/** The family of twice the period that branches off at a period doubling; not of even motions.
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
  size_t zero; /* test function that vanishes there; SIZE_MAX: none */
} ric_family_curve_point;

/** Functions of the points of a curve, whose zeros are located on it. */
typedef struct ric_family_curve_tests {
  size_t count;
  /** Values [count]; NaN: not defined there. May look at the family's system, which has the point's parameters, and run
   *  its shooting. Returns RIC_ENUMERIC to have a shorter step tried. */
  ric_status (*values)(const ric_family_curve_point *point, double *values, void *user, ric_error *error);
  void *user;
} ric_family_curve_tests;

/** Follows a fold, a period doubling, a grazing point or the loss of an impact in two parameters, from a point that is
 *  one, by pseudo-arclength. The curve's parameter is the second one.
 *  @param options  of the curve, NULL for the defaults of the family
 *  @param tests  NULL for none; copied
 *  @returns RIC_EINVAL for other kinds and problems with one parameter; as ric_curve_follow. */
RIC_API ric_status ric_family_trace(ric_family *family, const ric_family_point *point, const ric_curve_options *options,
                                    const ric_family_curve_tests *tests,
                                    int (*seen)(const ric_family_curve_point *point, void *user), void *user,
                                    ric_curve_run *run, ric_error *error);

RIC_END_DECLARATIONS

#endif
