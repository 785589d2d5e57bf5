/* Gaps of an orbit over its half period by dense sampling of the modal motion: the witness of certified clearances. */
#ifndef RICOCHET_TESTS_SAMPLED_GAPS_H
#define RICOCHET_TESTS_SAMPLED_GAPS_H

#include "witness/modal_motion.h"
#include "witness/solved_orbit.h"

typedef struct sampled_gap {
  double gap, time;
  size_t particle;
} sampled_gap;

/** Smallest sampled gap of the free particles with a floor, at `samples` + 1 times from 0 to T/2; infinite if none. */
sampled_gap sampled_clearance(const solved_orbit *x, modal_motion *motion, size_t samples);

/** Smallest sampled gap of any particle from time `low` to `high`, impacting ones included. */
sampled_gap sampled_any(const solved_orbit *x, modal_motion *motion, double low, double high, size_t samples);

/** The minimum near a sampled one, by bisection on the velocity, within a sampling step of it. */
sampled_gap refined_gap(const solved_orbit *x, const modal_motion *motion, sampled_gap near, double step);

#endif
