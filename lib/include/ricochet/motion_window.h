/* Windows of a parameter in which a periodic motion attracts.
 *
 * A motion found on a stroboscopic attractor is made exact by shooting and followed along the parameter in both
 * directions (family.h) to where it stops being stable or admissible: its edges are special points of the family,
 * located on the motion and not on the attractor, near whose edges transients are arbitrarily long. */
#ifndef RICOCHET_MOTION_WINDOW_H
#define RICOCHET_MOTION_WINDOW_H

#include "family.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_motion_edge {
  ric_family_kind kind; /* what ends the window; RIC_FAMILY_REGULAR: nothing up to the bound that was given, or, where
                           the family could not be followed further, up to p: `reason` says why */
  double p;
  char reason[128]; /* "" unless the family ended on the way, or nothing but shorter steps than were tried can tell
                       whether the window ends before: where an impact is lost multipliers are infinite */
} ric_motion_edge;

typedef struct ric_motion_window {
  size_t periods;            /* of the forcing */
  size_t impacts;            /* in all of them */
  double p;                  /* from which it was followed */
  bool stable;               /* there */
  ric_complex largest;       /* multiplier there */
  ric_motion_edge low, high; /* low.p < p < high.p */
} ric_motion_window;

/** @param problem  of forced motions, along its first parameter, with the period of the forcing as the given number;
 * its motion's sequence and `periods` are not looked at: they follow from the motion
 *  @param periods  of the forcing, after which the motion repeats
 *  @param p  parameter at which it was found
 *  @param low, high  bounds, low < p < high
 *  @param t, q, u  its state on the attractor at time t, not at an impact
 *  @param options  of the walk, whose lengths are in parts of p; NULL: the defaults, with first steps of a thousandth
 * of p, and special points located to 1e-12 of it. Bounds and direction are not looked at
 *  @returns RIC_EINVAL for motions of other kinds, parameters out of order, and a motion that repeats before its
 *           period; RIC_ENUMERIC where no periodic motion is found near the state, or it is not stable or not
 *           admissible, and for motions that chatter or rest; as ric_family_create, ric_family_follow */
RIC_API ric_status ric_motion_window_find(const ric_family_problem *problem, size_t periods, double p, double low,
                                          double high, double t, const double *q, const double *u,
                                          const ric_family_options *options, ric_motion_window *window,
                                          ric_error *error);

RIC_END_DECLARATIONS

#endif
