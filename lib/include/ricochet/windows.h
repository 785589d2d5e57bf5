/* Windows of a diagram: the intervals of a parameter p in which the attractor keeps its period.
 *
 * A line is a sequence of parameters with the attractor that a run has reached at each (attractor.h). Consecutive
 * points whose attractors have the same period and number of impacts per period form a window. Its edges are found in
 * two ways:
 *
 *   on the attractor  runs bisect the interval between the last point inside and the first one outside: a bracket.
 *                     Transients near an edge are arbitrarily long, so a bracket only shows where runs of this length
 *                     change;
 *   on the cycle      the cycle is computed and continued to the special point at which it loses stability or
 *                     admissibility (cycle_window.h, motion_window.h). That edge is exact.
 *
 * Near a flip convergence is slow: a run finds no period, or twice the period. The window located on the cycle decides:
 * consecutive points inside a located window, with its period or a multiple of it, are no window of their own. [FN97]
 * section 6. */
#ifndef RICOCHET_WINDOWS_H
#define RICOCHET_WINDOWS_H

#include <stdint.h>

#include "attractor.h"
#include "cycle_window.h"
#include "motion_window.h"

RIC_BEGIN_DECLARATIONS

/** A window. */
typedef struct ric_window {
  size_t first, last; /* points of the line in it */
  size_t point;       /* the one in the middle, from which the cycle is followed */
  size_t period;
  int64_t impacts;                  /* in a period, of the cycle; -1: not located */
  double low_outside, low_inside;   /* bracket of the lower edge on the attractor; outside NaN: the line ends inside */
  double high_inside, high_outside; /* of the upper one */
  /* On the cycle: */
  bool located;
  double low, high;        /* NaN: not located */
  int low_kind, high_kind; /* what ends it: ric_grazing_edge_kind of cycles of maps, ric_family_kind of motions; -1 */
  ric_complex largest;     /* multiplier at the point, NaN: not located */
  char reason[128];        /* why it is not located, or one of its edges not by a special point; "" */
} ric_window;

/** A line of attractors. Arrays and functions are borrowed. */
typedef struct ric_window_line {
  size_t points;
  const double *p;                 /* [points] increasing or decreasing */
  const ric_attractor *attractors; /* [points] of which kind, period, impacts and z [size], the end of the run, count */
  size_t size;                     /* numbers of a state */
  size_t measured;                 /* iterates over which `impacts` is averaged (ric_attractor_options) */
  bool follow; /* each run started from the end of the previous one: runs that bracket an edge do the same */
  /** Runs to the attractor at a parameter, with the options of the line.
   *  @param start  [size]; NULL: the start of runs that do not follow each other
   *  @param attractor  set; its z [size] to the end of the run; its other arrays are NULL
   *  @returns a status other than RIC_OK to end the search with it */
  ric_status (*run)(double p, const double *start, ric_attractor *attractor, void *user, ric_error *error);
  /** Locates the edges of a window on the cycle: ric_window_locate_cycle or _motion, say.
   *  @param z  [size] a state on the attractor at the point of the window
   *  @param low, high  bounds of the search for edges
   *  @param window  on entry the fields above `On the cycle`, except impacts, are set; sets impacts and those below,
   *                 except located
   *  @returns RIC_ESTOPPED or RIC_ENOMEM to end the search with it; others leave the window not located, with the
   *           message as the reason */
  ric_status (*locate)(const double *z, double low, double high, ric_window *window, void *user, ric_error *error);
  void *user;
} ric_window_line;

/** Windows, in the order of the line. */
typedef struct ric_windows {
  ric_window *windows; /* [count] */
  size_t count;
} ric_windows;

/** Finds the windows of a line. The search for edges on the cycle goes up to ten times beyond the line; where the line
 *  contains zero, up to its length beyond it.
 *  @param found  set; to be cleared by the caller after success. An edge is bracketed to a hundredth of the parameter,
 *                or 1e-9 of the distance of the two points of the line
 *  @returns RIC_EINVAL for a line without points; what `run` and `locate` return; RIC_ENOMEM */
RIC_API ric_status ric_windows_find(const ric_window_line *line, ric_windows *found, ric_error *error);
RIC_API void ric_windows_clear(ric_windows *windows);

/** Edges on a cycle of a map.
 *  @param p  parameter of the window's point
 *  @param z, low, high, window  as `locate`
 *  @returns as ric_cycle_find and ric_cycle_window_find */
RIC_API ric_status ric_window_locate_cycle(const ric_map_line *maps, double p, const double *z, double low, double high,
                                           ric_poll poll, ric_window *window, ric_error *error);

/** Edges on a periodic motion of a stroboscopic section.
 *  @param problem  as ric_motion_window_find
 *  @param p  parameter of the window's point
 *  @param t  time at which z = (q, u) is its state
 *  @returns as ric_motion_window_find */
RIC_API ric_status ric_window_locate_motion(const ric_family_problem *problem, double p, double t, const double *z,
                                            double low, double high, ric_window *window, ric_error *error);

RIC_END_DECLARATIONS

#endif
