/* The bypass map of one obstacle: internal to the room. */
#ifndef RICOCHET_BYPASS_PARTS_H
#define RICOCHET_BYPASS_PARTS_H

#include "gap_search.h"
#include "impact/impact_law.h"
#include "leap.h"
#include "local.h"
#include "shooting/arc_runner.h"

struct ric_bypass {
  ric_system *system;
  size_t obstacle, size; /* n + m */
  double reach;
  arc_runner runner;
  bool leaps; /* short ways are not for the flow to move */
  leap leap;
  gap_search search;
  impact_solver law;
  double *x, *rates; /* [n + m] a state on the way; rates of change */
  double time;       /* of x */
};

#endif
