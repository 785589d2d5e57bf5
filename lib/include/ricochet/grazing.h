/* Grazing periodic motions: where a family reaches a grazing point, and the coefficients of the return map there.
 *
 * Along a parameter a periodic motion, without impacts or with transversal ones of its own, begins to touch an
 * obstacle: a grazing bifurcation. ric_grazing_find follows the motion there and refines the parameter to rounding.
 * ric_grazing_section gives L, eta, xi and kappa of [FN97] (5.5)-(5.8) on any Poincare section, for the criterion
 * (grazing_criterion.h) and the return map (grazing_map.h):
 *
 *   eta' = eta DPhi_t1 V,   xi' = W DPhi_t2 xi,   L' = W DPhi_T V,
 *
 * with t1 from the section to the grazing point, t2 = T - t1, the coordinate vectors V of the section and the
 * projection W = 1 - F sigma^T / (sigma F) onto it along the flow. Impacts on the way enter by their saltation
 * matrices. kappa is that of the discontinuity mapping (bypass.h) transported to the section in the same way,
 * including the second-order term of the flow. The map then omits terms of third order in y.
 *
 * A state on the section is (x, t), n + m + 1 numbers, for forced motions, and x, n + m numbers, for all others. The
 * section has one coordinate less. */
#ifndef RICOCHET_GRAZING_H
#define RICOCHET_GRAZING_H

#include "bypass.h"
#include "family.h"
#include "grazing_criterion.h"

RIC_BEGIN_DECLARATIONS

/** A grazing periodic motion. Owned by the caller: ric_grazing_init, ric_grazing_clear. */
typedef struct ric_grazing {
  double parameter, second; /* the second one only for families with two parameters */
  double given;             /* the given number (shooting.h) there */
  double period;
  double time;  /* of the grazing point, in [0, T) */
  double phase; /* time / period */
  double slope; /* derivative of the minimum of the gap by the parameter: d = -slope (p - parameter) to first order. NaN
                   if not requested */
  size_t numbers;          /* n + m */
  double *x;               /* [n + m] state at the grazing point */
  ric_grazing_local local; /* obstacle, A_g, eta, xi at the grazing point */
  size_t unknowns;
  double *z; /* [unknowns] of shooting */
} ric_grazing;

RIC_API ric_status ric_grazing_init(ric_grazing *grazing, const ric_shooting *shooting, ric_error *error);
RIC_API void ric_grazing_clear(ric_grazing *grazing);

/** Tolerances, relative to the variation of the grazing gap along the motion. */
typedef struct ric_grazing_options {
  double touch_tol; /* 1e-6: another minimum of a gap within it of zero is a second grazing point; at most 0.01 in units
                       of the gap */
  double degenerate;  /* 1e-6: A_g T^2 below it is `A_g near zero` */
  double transversal; /* 1e-6: an impact of the motion whose gap rate times T is below it is a second grazing point */
} ric_grazing_options;

RIC_API ric_grazing_options ric_grazing_options_default(void);

/** Follows a family from a solution to its first grazing point and refines that point: the minimum of the gap is zero
 *  to rounding.
 *  @param family  of motions that are not even; its options control the continuation run: direction and bounds
 *  @param z  [unknowns] solution at `parameter`; changed
 *  @param options  NULL for the defaults
 *  @param grazing  initialised for the family's shooting; set, with its slope
 *  @returns RIC_EINVAL for even motions and options out of range; RIC_ENUMERIC if the run finds no grazing point,
 *           with how far it got and why it ended, and for degenerate points by name: A_g near zero, two grazing
 *           points at once, an impact that is not transversal; as ric_family_follow. `grazing` is undefined then. */
RIC_API ric_status ric_grazing_find(ric_family *family, double *z, double parameter, const ric_grazing_options *options,
                                    ric_grazing *grazing, ric_error *error);

#define RIC_GRAZING_SEARCH_LIST(X)                                                                                     \
  X(RIC_GRAZING_SEARCH_FOUND, "found")                                                                                 \
  X(RIC_GRAZING_SEARCH_NONE, "none")                 /* the family ended without a grazing point */                    \
  X(RIC_GRAZING_SEARCH_DEGENERATE, "degenerate")     /* a grazing point that the theory excludes */                    \
  X(RIC_GRAZING_SEARCH_FAILED, "failed")             /* the family, or its grazing point, cannot be computed */        \
  X(RIC_GRAZING_SEARCH_FAILED_START, "failed_start") /* the family cannot be started */

typedef enum ric_grazing_search_outcome {
#define X(name, text) name,
  RIC_GRAZING_SEARCH_LIST(X)
#undef X
      RIC_GRAZING_SEARCH_OUTCOMES
} ric_grazing_search_outcome;

/** The result of a search along a family. */
typedef struct ric_grazing_search {
  ric_grazing_search_outcome outcome;
  char reason[256]; /* "" when found */
  double reached;   /* last parameter of the family */
  bool ended;       /* the family has ended without grazing: the run says how */
  ric_curve_run run;
  /* The grazing point located by the family, degenerate or not; NaN and SIZE_MAX without one: */
  double parameter, period, time;
  size_t obstacle;
} ric_grazing_search;

/** Follows a family from a solution to its first grazing point at which the motion passes through no obstacle
 *  elsewhere. Unlike ric_grazing_find it ignores grazing points of inadmissible motions and reports an outcome instead
 *  of an error.
 *  @param options  NULL for the defaults
 *  @param grazing  set if found; otherwise undefined
 *  @returns RIC_OK with an outcome; RIC_EINVAL for even motions and options out of range; RIC_ESTOPPED, RIC_ENOMEM */
RIC_API ric_status ric_grazing_search_along(ric_family *family, double *z, double parameter,
                                            const ric_grazing_options *options, ric_grazing_search *search,
                                            ric_grazing *grazing, ric_error *error);

/** The same from a motion that grazes already, or nearly: a special point of kind `grazing`, or a point of a curve in
 *  two parameters.
 *  @param z  [unknowns]
 *  @param obstacle, time  of the grazing point: the minimum of the gap nearest to this time is used
 *  @param options  NULL for the defaults
 *  @returns as ric_grazing_find */
RIC_API ric_status ric_grazing_take(ric_family *family, const double *z, double parameter, size_t obstacle, double time,
                                    const ric_grazing_options *options, ric_grazing *grazing, ric_error *error);

/** A Poincare section through the motion. */
typedef struct ric_grazing_plane {
  double time;          /* at which the motion crosses it, in [0, T) */
  const double *normal; /* sigma: [n + m + 1] in (x, t) for forced motions, [n + m] for all others. NULL: stroboscopic
                           (t constant) for forced motions, normal to the flow for all others */
} ric_grazing_plane;

/** Number of coordinates of a section: the size of the map on it. */
RIC_API size_t ric_grazing_coordinates(const ric_grazing *grazing, const ric_shooting *shooting);

/** The coefficients on a section: L, eta, xi at d = 0, and kappa.
 *  @param family  with its system in the state at grazing (ric_grazing_find and _take leave it so)
 *  @param plane  NULL: stroboscopic, or normal to the flow, at t = 0; at the grazing point if the motion has an
 *         impact at t = 0
 *  @param map  initialised for ric_grazing_coordinates
 *  @param basis  [coordinates][numbers of the section's state], set to the orthonormal vectors V^T of the
 *         coordinates: unit vectors on stroboscopic sections; may be NULL
 *  @returns RIC_EINVAL for a plane that the motion does not cross, or crosses at an impact, and for systems with
 *           compliant obstacles, as ric_bypass_create; RIC_ENUMERIC if neighbouring motions, however close, have
 *           other impacts or miss the section; as ric_shooting_transfer. */
RIC_API ric_status ric_grazing_section(ric_family *family, const ric_grazing *grazing, const ric_grazing_plane *plane,
                                       ric_grazing_map *map, double *basis, ric_error *error);

/** A point of a curve of grazing motions. Its pointers are valid during the callback. */
typedef struct ric_grazing_curve_point {
  const ric_grazing *grazing; /* with both parameters; the slope is NaN */
  const ric_grazing_criterion *criterion;
  const double *coefficients; /* [count] c_0, c_1, ... */
  size_t count;
  size_t zero; /* i of the c_i that changes sign there: the verdict may change; SIZE_MAX: none */
} ric_grazing_curve_point;

/** Follows a grazing point in two parameters and evaluates the criterion along the curve. Zeros of c_0, c_1, ... are
 *  located on it.
 *  @param family  with two parameters
 *  @param from  a grazing motion of it
 *  @param options  of the curve, whose parameter is the second one; NULL for those of the family
 *  @param count  of coefficients, at most RIC_GRAZING_CURVE_COEFFICIENTS
 *  @param seen  called with every point, NULL for none; non-zero ends the run. If no verdict can be computed at a step,
 *         because the gap has no minimum or eigenvalues fail, the run ends and gives the reason
 *  @returns as ric_family_trace, and as ric_grazing_section and ric_grazing_criterion_find if they fail at a point
 *           that is to be passed to `seen`; RIC_EINVAL. */
RIC_API ric_status ric_grazing_trace(ric_family *family, const ric_grazing *from, const ric_curve_options *options,
                                     size_t count, int (*seen)(const ric_grazing_curve_point *point, void *user),
                                     void *user, ric_curve_run *run, ric_error *error);

enum { RIC_GRAZING_CURVE_COEFFICIENTS = 64 };

RIC_END_DECLARATIONS

#endif
