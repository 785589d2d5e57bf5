/* Crossings of a motion with a section, some at a time: internal to the room.
 *
 * Stroboscopic states are read off the segments of the motion, so that steps go on across them; impacts come from the
 * events. Every CROSSINGS_MOST crossings, or where a caller asks for fewer, the run ends. There the clock goes back by
 * whole periods where the system says that its forces repeat after one: the phase of the forcing has the digits of a
 * time below CROSSINGS_MOST periods, however long the motion is. What is found follows from the start, the options and
 * the numbers asked for. */
#ifndef RICOCHET_CROSSINGS_H
#define RICOCHET_CROSSINGS_H

#include "floquet/lyapunov_course.h"
#include "ricochet/motion_section.h"

enum { CROSSINGS_MOST = 64 };

typedef struct crossings {
  ric_motion_section_options options;
  const ric_system *system;
  ric_trajectory *trajectory;
  lyapunov_course *course; /* NULL: no tangent vectors. Set to NULL when they are lost */
  size_t n, m, size;       /* of a state on the section */
  double *store;           /* all arrays */
  double *states;          /* [found][size] those of the last call, CROSSINGS_MOST at most */
  size_t found;
  unsigned long long impacts; /* of all obstacles, since the caller set it */

  ric_sampler sampler;
  double *times; /* [CROSSINGS_MOST] of stroboscopic crossings */
  size_t wanted; /* impacts */
  size_t done;   /* periods on the clock at the start of a call */
  bool pending;  /* the state after an impact is yet to be read */
  double last;   /* time of the last impact, or of the start */
} crossings;

/** @param options  in range */
ric_status crossings_init(crossings *c, const ric_system *system, const ric_motion_section_options *options,
                          ric_error *error);
void crossings_clear(crossings *c);

/** Starts a motion at a state of the section's form. @returns as ric_trajectory_start */
ric_status crossings_start(crossings *c, const double *z, ric_error *error);

/** The next crossings.
 *  @param count  1 to CROSSINGS_MOST
 *  @param run  outcome and reason; `completed` when all were found
 *  @returns as ric_trajectory_run */
ric_status crossings_next(crossings *c, size_t count, ric_run *run, ric_error *error);

#endif
