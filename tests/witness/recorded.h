/* Runs of trajectories with their events kept, for tests of the impact room. */
#ifndef RICOCHET_TESTS_RECORDED_H
#define RICOCHET_TESTS_RECORDED_H

#include <ricochet/ricochet.h>

typedef struct recorded {
  ric_event *events;
  size_t count, capacity;
  ric_run run;
  double *q, *u; /* state reached */
  size_t coordinates, speeds;
} recorded;

/** Runs a system from time 0 to `end`; asserts that this works. @param options  NULL for the defaults */
recorded record(const ric_system *system, const ric_trajectory_options *options, const double *q, const double *u,
                double end);
void recorded_clear(recorded *r);

/** Number of events that make the speeds jump. */
size_t recorded_impacts(const recorded *r);

/** First event of a kind, NULL when there is none. */
const ric_event *recorded_first(const recorded *r, ric_event_kind kind);

/** Asserts that a run's rests and releases are those of a witness that has followed more impacts, at the same times
 *  within `tolerance`. @returns how many were compared */
size_t recorded_rests_agree(const recorded *r, const recorded *witness, double tolerance);

/** Largest difference of the states reached. */
double recorded_difference(const recorded *a, const recorded *b);

/** How much a small difference at the start can have grown at `end`: the sum, over all coordinates and speeds, of the
 *  largest difference of the states reached by each alone, at least 1. */
double growth_of(const ric_system *system, const double *q, const double *u, double end);

/** A system of a lattice; asserts that it can be made. */
ric_system *lattice_system(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count);

/** Three masses that share inertia, on springs and dampers, pushed harmonically. */
ric_system *coupled_masses(const ric_obstacle *obstacles, size_t count);

/** A particle under gravity 1 over a floor at 0. */
ric_system *falling_ball(double restitution);

#endif
