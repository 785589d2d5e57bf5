/* kind: trajectory, for its own sources: the columns of its tables. */
#ifndef RICOCHET_APP_TRAJECTORY_H
#define RICOCHET_APP_TRAJECTORY_H

#include "kind.h"

/** What a system with a floor and a wall per particle, its flow and its trajectory take per particle at most: about 140
 *  bytes with rigid floors (ricochet_bench motion_1000000), 130 more per compliant obstacle. */
enum { TRAJECTORY_PARTICLE_BYTES = 512 };

/** Tails of a trajectory. */
enum { TAIL_IMPACTS, TAIL_EVENTS, TRAJECTORY_TAILS };

/** Outcomes: those of a run, and of tasks without one. */
enum { TRAJECTORY_NO_ORBIT = RIC_RUN_OUTCOMES, TRAJECTORY_REFUSED, TRAJECTORY_OUTCOMES };

/** Bytes of a row, as a number that cannot overflow. */
double trajectory_row_bytes(double particles, double samples);

/** Lays out the row and the tails. */
void trajectory_lay_out(size_t particles, size_t samples, kind_plan *plan);

/** Writes an event into a record of the tail. @param side  of its obstacle, +1 floor, -1 wall */
void trajectory_put_event(const table *t, const ric_event *event, int side, unsigned char *record);

#endif
