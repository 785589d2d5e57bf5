/* The outcome of an orbit and its reason in words, however the orbit was found. Internal to the library. */
#ifndef RICOCHET_ADMISSIBILITY_H
#define RICOCHET_ADMISSIBILITY_H

#include "impact/gap_watch.h"
#include "ricochet/orbit.h"

/** What obstacles are called: "particle 3 passes its wall", "the motion passes obstacle 3". */
typedef struct obstacle_names {
  const char *noun;              /* of coordinates; NULL: obstacles have numbers only */
  const ric_obstacle *obstacles; /* [count] at coordinates; NULL with a noun: floors, with the numbers of particles */
  size_t count;
} obstacle_names;

obstacle_names obstacle_names_of(const ric_system *system);

/** What the outcome follows from, besides the impacts of the orbit. */
typedef struct orbit_facts {
  obstacle_names names;
  const gap_watch *gaps;
  double slow; /* gap rates whose size is below it count as zero */
  bool out_of_order;
} orbit_facts;

/** Sets the clearance: the smallest gap of what the orbit does not hit. */
void admissibility_clearance(const orbit_facts *f, ric_orbit *orbit);

/** Sets the outcome of an orbit that satisfies its equations: `admissible`; `inadmissible`, with what is violated first
 *  in the period; `grazing`, with what is zero.
 *  @param orbit  its period and impacts are read */
void admissibility_find(const orbit_facts *f, ric_orbit *orbit);

/** Adds to a reason what makes the orbit inadmissible, if anything does: for outcomes that leave that open. */
void admissibility_add_violation(const orbit_facts *f, ric_orbit *orbit);

/** Makes it `failed`: a residual is larger than allowed. */
void admissibility_violated(ric_orbit *orbit, double residual, double allowed);

/** Makes it `grazing`, a linear mode that reaches the obstacles without impulses, or `resonant`, a mode that vanishes
 * at all contacts; sets the mode. */
void admissibility_resonant(ric_orbit *orbit, bool carried, size_t mode, unsigned harmonic);

/** Text of the first kind of resonance, and of a gap that is zero. */
void admissibility_write_mode(char *text, size_t bytes, size_t mode, double harmonic);
void admissibility_write_grazing(char *text, size_t bytes, const obstacle_names *names, const gap_found *gap);

/** Makes an orbit without a state: NaN everywhere, with this outcome. The reason is the caller's. */
void admissibility_without_state(ric_orbit *orbit, ric_outcome outcome);

#endif
