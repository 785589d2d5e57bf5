/* kind: trajectory, for its own sources: the columns of its tables. */
#ifndef RICOCHET_APP_TRAJECTORY_H
#define RICOCHET_APP_TRAJECTORY_H

#include "kind/kind.h"

/** Upper bound of the memory of a system with a floor and a wall per particle, its flow and its trajectory: about 140
 *  bytes per particle with rigid floors (ricochet_bench motion_1000000), 130 more per compliant obstacle. */
enum { TRAJECTORY_PARTICLE_BYTES = 512 };

/** Ragged tables of a trajectory; that of the exponents exists if they are computed. */
enum { TAIL_IMPACTS, TAIL_EVENTS, TAIL_LYAPUNOV, TRAJECTORY_TAILS };

/** Outcomes: those of a run, and of tasks without one. */
enum { TRAJECTORY_NO_ORBIT = RIC_RUN_OUTCOMES, TRAJECTORY_REFUSED, TRAJECTORY_OUTCOMES };

/** A row: the members that its columns name. The sampler writes q and v into the row. */
typedef struct trajectory_row {
  int outcome;
  const char *reason;
  const double *t;
  double *q, *v;
  double time, energy_start, energy_end, impact_loss;
  long long steps, force_evaluations;
  double *lyapunov;
} trajectory_row;

/** A record of an impact or another event. */
typedef struct event_record {
  double time;
  long long particle;
  int side, kind;
  double gap_rate, impulse, depth, accumulation;
} event_record;

/** A record: the exponents up to a time. */
typedef struct lyapunov_record {
  double time;
  const double *history;
} lyapunov_record;

/** Sizes that determine those of rows and ragged tables. */
typedef struct trajectory_shape {
  double particles, samples, exponents; /* exponents: 0 if they are not computed */
} trajectory_shape;

trajectory_shape trajectory_shape_of(const study_values *v);

/** The columns of its tables (kind.h). */
extern const column_list trajectory_lists[];

/** Lays out the row and the ragged tables. */
void trajectory_lay_out(const trajectory_shape *shape, kind_plan *plan);

#endif
