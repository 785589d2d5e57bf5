/* Cycles of maps with impacts, and the windows of a parameter in which they are stable.
 *
 * A cycle of period n is continued with fixed itinerary: which of its iterates have an impact. Along a parameter p
 * Newton's method solves f^n(z; p) = z for that itinerary. An edge of the window is where
 *
 *   border   an iterate reaches the border, eta z = d (border collision): the itinerary changes there,
 *   flip     a multiplier is -1 (period doubling),
 *   fold     a multiplier is +1: the cycle turns back, or another one crosses it; also where a cycle is born by the
 *            flip of a cycle of half its period,
 *   complex  a pair of complex multipliers leaves the unit circle (Neimark-Sacker bifurcation).
 *
 * Edges are located on the cycle, not on the attractor: near an edge transients are arbitrarily long. If several
 * occur at one place, border takes precedence. The unknowns contain y = sqrt(d - eta z) of each impact; in these the
 * equations are smooth through the border. For one-impact cycles along d ric_grazing_window_find gives the same edges
 * in closed form. */
#ifndef RICOCHET_CYCLE_WINDOW_H
#define RICOCHET_CYCLE_WINDOW_H

#include "attractor.h"

RIC_BEGIN_DECLARATIONS

/** Maps along a parameter. */
typedef struct ric_map_line {
  size_t size;
  /** Sets the map's arrays and stretch, and d, as smooth functions of p. The map is initialised for the size and holds
   *  what the last call set. Returns RIC_EINVAL or RIC_ENUMERIC for a p without a map. It is called for p within the
   *  bounds and slightly beyond them, where a failure is harmless. */
  ric_status (*at)(double p, ric_grazing_map *map, double *d, void *user, ric_error *error);
  void *user;
} ric_map_line;

typedef struct ric_cycle_edge {
  ric_grazing_edge_kind kind; /* border, flip, fold, complex; open: none up to the given bound */
  double p;
  size_t iterate; /* of border: index 0 .. n-1, counted from the given state */
} ric_cycle_edge;

typedef struct ric_cycle_window {
  size_t period;
  size_t impacts;           /* of the cycle */
  double p;                 /* from which the cycle was continued */
  bool stable;              /* there */
  ric_complex largest;      /* multiplier there; infinite where an impact is at the border */
  ric_cycle_edge low, high; /* low.p < p < high.p */
} ric_cycle_window;

/** The cycle at p, by Newton's method from a guess.
 *  @param z  [size] guess of one of its states, which determines the itinerary; set to the solution
 *  @param window  set except for its edges
 *  @returns RIC_EINVAL for periods outside 1 .. 10000 and as ric_grazing_map_check; RIC_ENUMERIC if Newton's method
 *           does not converge, or converges to a cycle of another itinerary; RIC_EINVAL for a cycle that repeats before
 *           its period; RIC_ELIMIT for more than 500 unknowns: one per impact and the numbers of its states, of which
 *           there are several when powers of L grow; RIC_ENOMEM */
RIC_API ric_status ric_cycle_find(const ric_map_line *line, double p, size_t period, double *z,
                                  ric_cycle_window *window, ric_error *error);

/** Its window: the nearest edges on both sides of p within [low, high]. Edges are accurate to 1e-12, relative, or to
 *  rounding; fold edges to 1e-9.
 *  @param step  first step in p, relative to |p| (absolute where p = 0), > 0; 0: 1e-3. Steps adapt
 *  @param z  [size] a state of the cycle, of ric_cycle_find
 *  @returns as ric_cycle_find; RIC_EINVAL for a cycle that is not stable, low >= p, high <= p; RIC_ENUMERIC if the
 *           cycle cannot be continued to an edge or a bound, for example because there is no map; RIC_ESTOPPED */
RIC_API ric_status ric_cycle_window_find(const ric_map_line *line, double p, size_t period, double low, double high,
                                         double step, double *z, ric_poll poll, ric_cycle_window *window,
                                         ric_error *error);

RIC_END_DECLARATIONS

#endif
