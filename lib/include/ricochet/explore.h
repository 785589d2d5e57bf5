/* Exploring: a family of periodic motions, and the families that branch off from it, one after the other.
 *
 * A family is followed in segments. The first one starts at a solution. Special points of a segment where other
 * families begin add segments to a queue:
 *
 *   grazing, impact_lost   (`cross`) the family with one contact more, or less, towards the side where it exists
 *   branch_point           (`branches`) both halves of the other branch of the same equations
 *   period_doubling        (`branches`) the family of twice the period; not for even motions, of which both halves
 *                          would change
 *
 * Each segment is a continuation run of its own (family.h), within the bounds and with the options of the first family,
 * until the queue is empty or the largest number of segments has been followed. Two families detect their common point
 * from either side: only the first detection adds a segment. A family that cannot be created or started is a segment
 * with a reason. */
#ifndef RICOCHET_EXPLORE_H
#define RICOCHET_EXPLORE_H

#include "family.h"

RIC_BEGIN_DECLARATIONS

#define RIC_EXPLORE_ORIGIN_LIST(X)                                                                                     \
  X(RIC_EXPLORE_START, "start")                                                                                        \
  X(RIC_EXPLORE_GRAZING, "grazing")                                                                                    \
  X(RIC_EXPLORE_IMPACT_LOST, "impact_lost")                                                                            \
  X(RIC_EXPLORE_BRANCH_POINT, "branch_point")                                                                          \
  X(RIC_EXPLORE_PERIOD_DOUBLING, "period_doubling")

/** Where a segment begins. */
typedef enum ric_explore_origin {
#define X(name, text) name,
  RIC_EXPLORE_ORIGIN_LIST(X)
#undef X
      RIC_EXPLORE_ORIGINS
} ric_explore_origin;

/** Its name, "grazing". Never NULL. */
RIC_API const char *ric_explore_origin_name(ric_explore_origin origin);

typedef struct ric_explore_options {
  bool cross;            /* default false */
  bool branches;         /* default false */
  size_t segments;       /* largest number, >= 1, the first one included; default 16 */
  double same_point_tol; /* 1e-6: two special points are one where families meet if parameter, period and energy agree
                            to this, relative to 1 + their size: special points are located to 1e-10 on either side,
                            and families start with steps of 1e-3 */
} ric_explore_options;

RIC_API ric_explore_options ric_explore_options_default(void);

/** A segment. Valid during the callback. */
typedef struct ric_explore_segment {
  size_t index; /* from 0, in the order in which they are followed */
  ric_explore_origin origin;
  size_t special;     /* the special point at which it begins, counted from 0 over all segments; SIZE_MAX: the start */
  ric_family *family; /* NULL if it could not be created */
  /* Known when it has ended: */
  ric_status status;  /* RIC_OK; otherwise the segment has no points or failed, and the reason says why */
  const char *reason; /* "" if the end of the run needs no explanation */
  ric_curve_run run;  /* zeros if it was not started */
} ric_explore_segment;

/** Callbacks of the caller; a non-zero return value ends the exploration, which is no error. Functions may be NULL. */
typedef struct ric_explore_visitor {
  /** Every point of a segment in order, as ric_family_follow; `reason` and `run` of the segment are not known yet. The
   *  family's special points may be traced in two parameters here. */
  int (*point)(const ric_explore_segment *segment, const ric_family_point *point, void *user);
  /** The segment has ended; not called for one that the visitor has ended. */
  int (*end)(const ric_explore_segment *segment, void *user);
  void *user;
} ric_explore_visitor;

/** Explores from a solution.
 *  @param family  borrowed; its system is changed by the families that are followed
 *  @param z  [unknowns] solution at the parameter, as ric_family_follow; copied
 *  @param options  NULL for the defaults
 *  @returns RIC_OK for every end of segments; RIC_EINVAL for options out of range; RIC_ESTOPPED; RIC_ENOMEM */
RIC_API ric_status ric_family_explore(ric_family *family, const double *z, double parameter,
                                      const ric_explore_options *options, const ric_explore_visitor *visitor,
                                      ric_error *error);

RIC_END_DECLARATIONS

#endif
