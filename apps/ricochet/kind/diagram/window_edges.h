/* The edges of the window of a periodic attractor along the last sweep, located on its cycle. */
#ifndef RICOCHET_APP_WINDOW_EDGES_H
#define RICOCHET_APP_WINDOW_EDGES_H

#include "iterated.h"

/** A window. Numbers are NaN where its edges are not located. */
typedef struct window_edges {
  bool located;
  double low, high;
  int low_kind, high_kind;  /* words of window_edge_names */
  size_t impacts;           /* per cycle */
  ric_complex multiplier;   /* largest one where it was followed from */
  double map_low, map_high; /* the closed form of the map, with one impact: along model.d exact, along grazing.beyond to
                               leading order; NaN for all others */
  char reason[128];         /* why they are not located; "" where they are */
} window_edges;

/** Names of what ends a window, of maps or of motions. @param count  set */
const char *const *window_edge_names(const study *s, size_t *count);

/** @param it  at the task to which the cycle belongs; its last sweep moves
 *  @param p  value of the last sweep there  @param low, high  how far edges are looked for, around p
 *  @param z  [size] a state of the attractor
 *  @returns RIC_OK, also without edges; RIC_ESTOPPED */
ric_status window_edges_find(iterated *it, size_t period, double p, double low, double high, const double *z,
                             window_edges *edges);

#endif
