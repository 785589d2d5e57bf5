/* Windows of a parameter in which a periodic motion is stable.
 *
 * A motion found on a stroboscopic attractor is refined by shooting. It is then followed along the parameter in both
 * directions (family.h) to where it loses stability or admissibility. The edges are special points of the family,
 * located on the motion itself: on the attractor transients near the edges are arbitrarily long. */
#ifndef RICOCHET_MOTION_WINDOW_H
#define RICOCHET_MOTION_WINDOW_H

#include "family.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_motion_edge {
  ric_family_kind kind; /* what ends the window; RIC_FAMILY_REGULAR: nothing up to the given bound, or up to p if the
                           family could not be continued further: `reason` says why */
  double p;
  char reason[128]; /* "" unless the family ended before the bound, or the steps were too long to exclude an earlier
                       edge: multipliers are infinite where an impact is lost */
} ric_motion_edge;

typedef struct ric_motion_window {
  size_t periods;            /* of the forcing */
  size_t impacts;            /* in all of them */
  double p;                  /* at which the continuation started */
  bool stable;               /* there */
  ric_complex largest;       /* multiplier there */
  ric_motion_edge low, high; /* low.p < p < high.p */
} ric_motion_window;

/** @param problem  of forced motions, along its first parameter, with the period of the forcing as the given number.
 *         The sequence of its motion and `periods` are ignored: they follow from the motion
 *  @param periods  of the forcing, after which the motion repeats
 *  @param p  parameter at which it was found
 *  @param low, high  bounds, low < p < high
 *  @param t, q, u  its state on the attractor at time t, not at an impact; u NULL if m = 0
 *  @param options  of the continuation runs, with lengths relative to p; NULL: the defaults, with first steps of p /
 *         1000 and special points located to 1e-12 of p. Bounds and direction are ignored
 *  @returns RIC_EINVAL for motions of other kinds, parameters out of order, and a motion that repeats before its
 *           period; RIC_ENUMERIC if no periodic motion is found near the state, if it is not stable or not
 *           admissible, and for motions with chatter or sticking; as ric_family_create, ric_family_follow */
RIC_API ric_status ric_motion_window_find(const ric_family_problem *problem, size_t periods, double p, double low,
                                          double high, double t, const double *q, const double *u,
                                          const ric_family_options *options, ric_motion_window *window,
                                          ric_error *error);

RIC_END_DECLARATIONS

#endif
