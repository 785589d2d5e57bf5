/* Sections of motions: the map from one crossing to the next, and its attractors.
 *
 * Stroboscopic: the state (q, u), n + m numbers, at times phase T, (1 + phase) T, ... with the period T of the forcing,
 * or any other. At impacts: the state just after an impact of an obstacle, or of any, and where the forcing then is,
 * (q, u, t mod T): n + m + 1 numbers; without a period n + m. Impacts at one time are one crossing.
 *
 * Motions are event-driven and go on across stroboscopic times, where states are read off their segments. Where a
 * lattice or an M-C-K system is the same again after T, to rounding, the clock goes back by whole periods every 64
 * crossings: the phase of its forcing keeps its digits however long the motion is. Elsewhere, with users' callbacks
 * too, time goes on, and its rounding with it. A result follows from the start, the options and the system alone, to
 * the bit; a run to the middle and one on from there agree with it to rounding. */
#ifndef RICOCHET_MOTION_SECTION_H
#define RICOCHET_MOTION_SECTION_H

#include "attractor.h"
#include "trajectory.h"

RIC_BEGIN_DECLARATIONS

typedef enum ric_section_kind { RIC_SECTION_STROBE, RIC_SECTION_IMPACT } ric_section_kind;

typedef struct ric_motion_section_options {
  ric_section_kind kind;
  double period;   /* T > 0 of the forcing; 0 at impacts: none */
  double phase;    /* in [0, 1): stroboscopic times. Without meaning at impacts */
  size_t obstacle; /* whose impacts; SIZE_MAX (default): of any. A closing contact that chatters counts once */
  double wait;     /* at impacts: a motion without one for this time has failed, "no impact for ...", > 0; INFINITY is
                      not allowed. Default 1000 */
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

/** Numbers of a state on the section. */
RIC_API size_t ric_motion_section_size(const ric_motion_section *section);

/** Sets another period (the forcing's frequency has changed).
 *  @returns RIC_EINVAL as ric_motion_section_create, and for one where there was none, or the other way round */
RIC_API ric_status ric_motion_section_set_period(ric_motion_section *section, double period, ric_error *error);

/** Runs to an attractor. `impacts` is per iterate: per period of stroboscopic sections. Exponents are those of the flow
 *  (lyapunov.h) over the `measure` iterates, times the mean time of an iterate: one along the flow is among those of
 *  autonomous systems and of sections at impacts. Tangent vectors are carried from the last 64 iterates of the
 * transient on; a motion that grazes then has no exponents: NaN, and the iterates go on without. States that return
 * within 1e-9 of the largest number have returned, whatever the extent of the attractor: slow impacts make so much of
 * rounding. Where a motion cannot go on (a run's outcome other than `completed`), the attractor has failed, with that
 * outcome and its reason, or diverged where the state has blown up.
 *  @param attractor  with its start, a state of the section's form; at impacts any state, also one away from obstacles,
 *                    with its time as the last number: the first iterate is its next impact
 *  @returns RIC_EINVAL for options out of range, more exponents than n + m, and starts below an obstacle; RIC_ENOMEM,
 *           RIC_ESTOPPED. Runs with options as before take no memory */
RIC_API ric_status ric_motion_section_run(ric_motion_section *section, const ric_attractor_options *options,
                                          ric_attractor *attractor, ric_error *error);

RIC_END_DECLARATIONS

#endif
