/* Runs of trajectories with their events stored, for tests. */
#ifndef RICOCHET_TESTS_RECORDED_RUN_H
#define RICOCHET_TESTS_RECORDED_RUN_H

#include <ricochet/ricochet.h>

typedef struct recorded_run {
  ric_event *events;
  size_t count, capacity;
  ric_run run;
  double *q, *u; /* state reached */
  size_t coordinates, speeds;
} recorded_run;

/** Runs a system from time 0 to `end`; asserts success. @param options  NULL for the defaults */
recorded_run record_run(const ric_system *system, const ric_trajectory_options *options, const double *q,
                        const double *u, double end);
void recorded_run_clear(recorded_run *r);

/** Number of events with a jump of the speeds. */
size_t recorded_run_impacts(const recorded_run *r);

/** First event of a kind, NULL if there is none. */
const ric_event *recorded_run_first(const recorded_run *r, ric_event_kind kind);

/** Asserts that rests and releases of a run agree with those of a witness that follows more impacts, in time within
 *  `tolerance`. @returns the number compared */
size_t recorded_runs_stick_alike(const recorded_run *r, const recorded_run *witness, double tolerance);

/** Largest difference of the states reached. */
double recorded_runs_difference(const recorded_run *a, const recorded_run *b);

/** Growth of a small initial difference until `end`: the sum, over all coordinates and speeds, of the largest
 *  difference of the final states caused by each, at least 1. */
double growth_of(const ric_system *system, const double *q, const double *u, double end);

/** A system of a lattice; asserts success. */
ric_system *lattice_system(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count);

/** Three masses that share inertia, on springs and dampers, pushed harmonically. */
ric_system *coupled_masses(const ric_obstacle *obstacles, size_t count);

/** A particle under gravity 1 over a floor at 0. */
ric_system *falling_ball(double restitution);

#endif
