/* Curves in two parameters through a special point of a family: both ways, within the bounds of the study, and how each
 * way ended. */
#ifndef RICOCHET_APP_CURVE_TRACE_H
#define RICOCHET_APP_CURVE_TRACE_H

#include "family_task.h"
#include "kind/kind.h"

/** Outcomes of what is followed: how its curve ended, and that it never began. */
enum { CURVE_FAILED_START = RIC_CURVE_ENDS, CURVE_REFUSED, CURVE_OUTCOMES };
extern const char *const curve_outcome_names[CURVE_OUTCOMES];

enum { CURVE_REASON_BYTES = 256 };

/** A point of a curve. What a kind has besides stands behind it in the kind's own struct. */
typedef struct curve_point {
  long long special, part;
  double parameter, second, period;
} curve_point;

/** The end of a curve. */
typedef struct curve_end {
  long long special, part;
  int outcome;
  const char *reason;
  long long points;
} curve_end;

/** A curve that is being followed. The caller sets what is above the line. */
typedef struct curve_trace {
  const branch_family *b;
  const table *layout, *end_layout; /* of its points, and of its ends */
  records *points, *ends;
  long long special; /* special point of the task that it goes through */
  /* --- */
  unsigned long long iterations, jacobians; /* of both ways */
  int part;                                 /* 0: first towards larger values of the second parameter, 1: the other */
  uint64_t count;                           /* points of this way */
  char reason[CURVE_REASON_BYTES];          /* that the first parameter has ended it; "" */
  ric_status status;                        /* of the points: RIC_OK or RIC_ENOMEM */
} curve_trace;

/** The columns of points and of ends. The first one of both is the special point that a curve goes through, which kinds
 *  without special points leave out. */
enum { CURVE_POINT_COLUMNS = 5, CURVE_END_COLUMNS = 5 };
extern const column curve_point_columns[CURVE_POINT_COLUMNS], curve_end_columns[CURVE_END_COLUMNS];

/** Lists of a kind's curves: points, what the kind has of them besides, ends; and their two tables, points and ends. */
enum { CURVE_LISTS = 3, CURVE_TAILS = 2 };

/** Long names of their offsets. */
#define CURVE_POINTS_MEANING "points of a task's curves: from its offset up to the next"
#define CURVE_ENDS_MEANING   "ends of a task's curves: from its offset up to the next"

/** Lays out both tables.
 *  @param followed  name of the parameter, borrowed; @param traced  that of the second one, borrowed
 *  @param axes  [axis_count] of the kind's own columns */
void curve_trace_lay_out(const column_list lists[CURVE_LISTS], const char *followed, const char *traced,
                         const table_axis *axes, size_t axis_count, tail tails[CURVE_TAILS]);

/** Adds a point, unless the first parameter leaves its bounds or there is no memory.
 *  @param point  the kind's struct of a point, its own members set; those of curve_point are set here, from the
 *                parameter of the family, the second one, and the period
 *  @returns 0, or 1 when the curve ends here */
int curve_trace_add(curve_trace *t, double parameter, double second, double period, curve_point *point);

/** Follows the library's curve; `run` as it sets it. */
typedef ric_status (*curve_way)(curve_trace *t, const ric_curve_options *options, void *user, ric_curve_run *run,
                                ric_error *error);

/** Follows the curve in both directions, or in one if it closes.
 *  @returns RIC_OK, also for a curve that does not begin; RIC_ESTOPPED; RIC_ENOMEM */
ric_status curve_trace_follow(curve_trace *t, curve_way way, void *user);

#endif
