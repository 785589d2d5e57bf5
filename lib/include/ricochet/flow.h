/* Flows: numerical integration of a system between contacts, with dense output as segments.
 *
 * A flow holds a time and a state and advances them in steps. A step is a polynomial per coordinate on its interval
 * (segment.h). It consists of one piece or, for long lattices, of several pieces that cover successive particles and
 * are computed on request. Contact detection evaluates the pieces and then accepts the step or a part of it:
 *
 *   ric_flow_start(flow, t, q, u, &error);
 *   while (ric_flow_time(flow) < end) {
 *     ric_flow_step(flow, end, &error);
 *     for (size_t i = 0; i < ric_flow_pieces(flow); i++) { ric_segment s = ric_flow_piece(flow, i); ... }
 *     ric_flow_accept(flow, 1);
 *   }
 *
 * There are two methods. `taylor`: Taylor series of lattices and M-C-K systems by recurrence, order and step from the
 * tolerance. `cvodes`: SUNDIALS CVODES with Adams formulas, for every system; its local polynomial is the segment. A
 * flow contains no contact law: trajectories (trajectory.h) tell it which contacts stick and which Hertz contacts are
 * pressed. */
#ifndef RICOCHET_FLOW_H
#define RICOCHET_FLOW_H

#include <stddef.h>

#include "segment.h"
#include "system.h"

RIC_BEGIN_DECLARATIONS

typedef enum ric_flow_method {
  RIC_FLOW_AUTO,   /* taylor where there is one, else cvodes */
  RIC_FLOW_TAYLOR, /* lattices and M-C-K systems */
  RIC_FLOW_CVODES
} ric_flow_method;

typedef struct ric_flow_options {
  ric_flow_method method; /* default auto */
  double tolerance;       /* local error of a step relative to the size of the state; 1e-16 for taylor, 1e-12 for
                             cvodes (0, the default, chooses these); in [1e-17, 1e-2] and [1e-14, 1e-2]. For cvodes
                             both in root mean square over (q, u); a state smaller than 1e-3 counts as 1e-3 */
  int order;              /* taylor: degree of the segments, 4 to 30; 0 (default): from the tolerance */
  double step; /* taylor: length of every step, or an upper bound while a Hertz contact is pressed; 0 (default): from
                  the tolerance */
  double longest_step; /* default INFINITY */
} ric_flow_options;

RIC_API ric_flow_options ric_flow_options_default(void);

typedef struct ric_flow ric_flow;

/** @param system  borrowed, must outlive the flow
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for options out of range and for taylor of a user system; RIC_ENOMEM. */
RIC_API ric_status ric_flow_create(const ric_system *system, const ric_flow_options *options, ric_flow **flow,
                                   ric_error *error);
RIC_API void ric_flow_destroy(ric_flow **flow);

/** Sets time and state. Discards all history, and reads the system's numbers again if they have changed (system.h):
 *  new numbers of the same structure cost O(n) and no memory; new nonlinear, damping or forcing terms allocate.
 *  @param q, u  [n], [m], copied; finite, else RIC_EINVAL; u NULL if m = 0
 *  @returns RIC_ENOMEM. */
RIC_API ric_status ric_flow_start(ric_flow *flow, double t, const double *q, const double *u, ric_error *error);

/** Makes a step from the current state towards `stop` and not beyond it, backwards if stop lies before the current
 *  time.
 *  @returns RIC_EINVAL if stop equals the current time, and for a system that has changed since the start;
 *           RIC_ENUMERIC if the motion blows up or the integrator fails; RIC_ECALLBACK. Time and state are then those
 *           before the step. */
RIC_API ric_status ric_flow_step(ric_flow *flow, double stop, ric_error *error);

/** Number of pieces of the step, and one of them; its coefficients are valid until the next call for a piece. */
RIC_API size_t ric_flow_pieces(const ric_flow *flow);
RIC_API ric_segment ric_flow_piece(ric_flow *flow, size_t index);

/** Moves time and state to position x of the step, 0 <= x <= 1, and discards the step. */
RIC_API void ric_flow_accept(ric_flow *flow, double x);

RIC_API double ric_flow_time(const ric_flow *flow);
RIC_API double ric_flow_step_end(const ric_flow *flow); /* time at the end of the step */
RIC_API const double *ric_flow_q(const ric_flow *flow); /* [n], valid until the next step, accept or start */
RIC_API const double *ric_flow_u(const ric_flow *flow); /* [m] */

/** Sets tangent vectors, which are propagated with the state from now on. For a state x(t; p) that depends on
 *  parameters p they are the columns of dx/dp. They satisfy the variational equation with contacts in their present
 *  states; trajectories apply the jumps at impacts. The Taylor flow propagates them by the recurrence of the state,
 *  O(n) per column and step on a lattice; CVODES by its forward sensitivity analysis, at the tolerance of the flow.
 *  ric_flow_start removes them; the same number of vectors afterwards allocates nothing.
 *  @param dq, du  [n][columns], [m][columns] row-major, copied; du NULL if m = 0; columns 0 removes the vectors
 *  @returns RIC_EINVAL for values that are not finite and for a system that has changed since the start; RIC_ENOMEM. */
RIC_API ric_status ric_flow_carry(ric_flow *flow, size_t columns, const double *dq, const double *du, ric_error *error);
RIC_API size_t ric_flow_columns(const ric_flow *flow);
RIC_API const double *ric_flow_dq(const ric_flow *flow); /* [n][columns], valid until the next accept, carry or start */
RIC_API const double *ric_flow_du(const ric_flow *flow); /* [m][columns] */

/** Work done since the flow was created. */
typedef struct ric_flow_counts {
  unsigned long long steps;
  unsigned long long force_evaluations; /* calls of F, or of M and f; taylor: one per step */
  unsigned long long starts;
} ric_flow_counts;
RIC_API ric_flow_counts ric_flow_counted(const ric_flow *flow);

RIC_END_DECLARATIONS

#endif
