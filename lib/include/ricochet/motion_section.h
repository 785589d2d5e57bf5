/* Poincare sections of motions: the return map from one crossing to the next, and its attractors.
 *
 * Stroboscopic section: the state (q, u), n + m numbers, at times phase T, (1 + phase) T, ... with the period T of
 * the forcing, or any other. Impact section: the state just after an impact on an obstacle, or on any, and the phase
 * time of the forcing, (q, u, t mod T): n + m + 1 numbers, or n + m without a period. Simultaneous impacts are one
 * crossing.
 *
 * Motions are integrated event by event and continue across stroboscopic times; states there are evaluated on the
 * segments. If a lattice or an M-C-K system is the same again after T, to rounding, time is reduced by whole periods
 * every 64 crossings, so that the phase of the forcing keeps its digits however long the motion is. Otherwise, also
 * with callbacks of the user, time increases, and its rounding with it. A result depends on the start, the options
 * and the system only, in every bit. A run to an intermediate state and a run from there agree with the whole one to
 * rounding. */
#ifndef RICOCHET_MOTION_SECTION_H
#define RICOCHET_MOTION_SECTION_H

#include "attractor.h"
#include "trajectory.h"

RIC_BEGIN_DECLARATIONS

typedef enum ric_section_kind { RIC_SECTION_STROBE, RIC_SECTION_IMPACT } ric_section_kind;

typedef struct ric_motion_section_options {
  ric_section_kind kind;
  double period;   /* T > 0 of the forcing; 0 on impact sections: none */
  double phase;    /* in [0, 1): stroboscopic times. Unused on impact sections */
  size_t obstacle; /* obstacle of an impact section; SIZE_MAX (default): any. A contact that closes by chatter counts
                      once */
  double wait;     /* impact section: a motion without an impact for this time fails with "no impact for ..."; > 0 and
                      finite. Default 1000 */
  ric_trajectory_options trajectory;
} ric_motion_section_options;

/** @param period  of the forcing */
RIC_API ric_motion_section_options ric_motion_section_options_default(double period);

typedef struct ric_motion_section ric_motion_section;

/** @param system  borrowed, must outlive it; its numbers may change between runs
 *  @param options  copied
 *  @returns RIC_EINVAL for options out of range, obstacles that do not exist, and as ric_trajectory_create; RIC_ENOMEM
 */
RIC_API ric_status ric_motion_section_create(const ric_system *system, const ric_motion_section_options *options,
                                             ric_motion_section **section, ric_error *error);
RIC_API void ric_motion_section_destroy(ric_motion_section **section);

/** Number of components of a state on the section. */
RIC_API size_t ric_motion_section_size(const ric_motion_section *section);

/** Sets another period, after a change of the frequency of the forcing.
 *  @returns RIC_EINVAL as ric_motion_section_create, and if exactly one of the old and the new period is 0 */
RIC_API ric_status ric_motion_section_set_period(ric_motion_section *section, double period, ric_error *error);

/** Runs to an attractor. `impacts` is per iterate: per period on stroboscopic sections. Exponents are those of the
 *  flow (lyapunov.h) over the `measure` iterates, times the mean time of an iterate. For autonomous systems, and on
 *  impact sections, one of them belongs to the direction of the flow. Tangent vectors are propagated from the last 64
 *  iterates of the transient on. If the motion grazes from then on, the exponents are NaN and the iterates continue
 *  without tangent vectors.
 *
 *  States within 1e-9 of the largest number count as equal, whatever the extent of the attractor: slow impacts
 *  amplify rounding that much. If a motion cannot be continued (an outcome of the run other than `completed`), the
 *  attractor is `failed`, with that outcome and its reason, or `diverged` if the state has blown up.
 *  @param options  NULL for the defaults
 *  @param attractor  with its start, a state in the form of the section. On impact sections any state, also one away
 *         from obstacles, with its time as the last number: the first iterate is its next impact
 *  @returns RIC_EINVAL for options out of range, more exponents than n + m, and starts below an obstacle; RIC_ENOMEM,
 *           RIC_ESTOPPED. Further runs with the same options allocate nothing */
RIC_API ric_status ric_motion_section_run(ric_motion_section *section, const ric_attractor_options *options,
                                          ric_attractor *attractor, ric_error *error);

RIC_END_DECLARATIONS

#endif
