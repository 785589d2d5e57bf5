/* Cycles of maps with impacts, and the windows of a parameter in which they attract.
 *
 * A cycle of period n is followed with its itinerary fixed: which of its iterates have an impact. Along a parameter p
 * the equations f^n(z; p) = z of that itinerary are solved by Newton's method, and an edge of the window is where
 *
 *   border   an iterate comes to the border, eta z = d: the itinerary changes there,
 *   flip     a multiplier is -1,      fold   a multiplier is +1, where the cycle turns back or another crosses it;
 *            also where a cycle is born by the flip of one of half its period,
 *   complex  a pair of complex multipliers leaves the circle,
 *
 * located on the cycle, not on the attractor: near an edge transients are arbitrarily long. Where several come to one
 * place, border is told before the others. With y = sqrt(d - eta z) of impacts as unknowns the equations are smooth
 * through the border. Of one-impact cycles along d ric_grazing_window_find has the same edges in closed form. */
#ifndef RICOCHET_CYCLE_WINDOW_H
#define RICOCHET_CYCLE_WINDOW_H

#include "attractor.h"

RIC_BEGIN_DECLARATIONS

/** Maps along a parameter. */
typedef struct ric_map_line {
  size_t size;
  /** Sets the map's arrays and stretch (it is initialised for the size, and holds what the last call set) and d, all
   *  smooth in p. Returns RIC_EINVAL or RIC_ENUMERIC for a p that makes no map. It is asked for p within the bounds
   *  and a little beyond them, where a refusal does no harm. */
  ric_status (*at)(double p, ric_grazing_map *map, double *d, void *user, ric_error *error);
  void *user;
} ric_map_line;

typedef struct ric_cycle_edge {
  ric_grazing_edge_kind kind; /* border, flip, fold, complex; open: none up to the limit that was given */
  double p;
  size_t iterate; /* of border: which, 0 .. n-1, counted from the state that was given */
} ric_cycle_edge;

typedef struct ric_cycle_window {
  size_t period;
  size_t impacts;           /* of the cycle */
  double p;                 /* from which it was followed */
  bool stable;              /* there */
  ric_complex largest;      /* multiplier there; infinite where an impact is at the border */
  ric_cycle_edge low, high; /* low.p < p < high.p */
} ric_cycle_window;

/** The cycle at p, by Newton's method from a guess.
 *  @param z  [size] guess of one of its states, from which the itinerary is taken; set
 *  @param window  set but for its edges
 *  @returns RIC_EINVAL for periods out of 1 .. 10000 and as ric_grazing_map_check; RIC_ENUMERIC where Newton's method
 *           does not converge, or to a cycle of another itinerary; RIC_EINVAL for a cycle that repeats before its
 *           period; RIC_ELIMIT for more than 500 unknowns: impacts, and numbers of states, of which there are several
 *           where L grows; RIC_ENOMEM */
RIC_API ric_status ric_cycle_find(const ric_map_line *line, double p, size_t period, double *z,
                                  ric_cycle_window *window, ric_error *error);

/** Its window: the edges next to p in both directions, within [low, high]. Edges are relative to 1e-12 or as exact as
 *  rounding lets them be, fold edges to 1e-9.
 *  @param step  first step in p, relative to |p| (absolute where p = 0), > 0; 0: 1e-3. Steps adapt
 *  @param z  [size] a state of the cycle, of ric_cycle_find
 *  @returns as ric_cycle_find; RIC_EINVAL for a cycle that is not stable, low >= p, high <= p; RIC_ENUMERIC where the
 *           cycle cannot be followed to an edge or a bound, since there is no map, say; RIC_ESTOPPED */
RIC_API ric_status ric_cycle_window_find(const ric_map_line *line, double p, size_t period, double low, double high,
                                         double step, double *z, ric_poll poll, ric_cycle_window *window,
                                         ric_error *error);

RIC_END_DECLARATIONS

#endif
