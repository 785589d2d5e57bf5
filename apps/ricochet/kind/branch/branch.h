/* kind: branch, for its own sources: the columns of its tables. */
#ifndef RICOCHET_APP_BRANCH_H
#define RICOCHET_APP_BRANCH_H

#include "kind/family/curve_trace.h"

/** Ragged tables of a branch: its points, its special points, the impacts of these (and of points whose states are
 *  stored), its segments; with `branch.trace` the points of curves and how these ended. */
enum {
  BRANCH_POINTS,
  BRANCH_SPECIAL,
  BRANCH_IMPACTS,
  BRANCH_SEGMENTS,
  BRANCH_TAILS,
  BRANCH_CURVES = BRANCH_TAILS,
  BRANCH_CURVE_ENDS,
  BRANCH_TAILS_WITH_CURVES
};

/** A row: how the first segment ended, and the work of all segments. */
typedef struct branch_row {
  int outcome;
  const char *reason;
  long long points, segments, iterations, jacobians;
} branch_row;

/** Records of the ragged tables: the members that their columns name. Histories and multipliers point into the record.
 */
typedef struct branch_point {
  long long segment;
  double parameter;
  int outcome;
  double energy, period, amplitude, multiplier_max;
  int stable;
  double clearance, arclength;
  long long iterations;
  double residual;
  const double *q, *v;
  double *history_q, *history_v;
  ric_complex *multipliers;
} branch_point;

typedef struct branch_special {
  int kind;
  long long segment;
  double parameter;
  long long point, obstacle, particle;
  double time;
  long long order;
  double period, energy, amplitude, clearance, multiplier_max, arclength;
  const double *q, *v;
} branch_special;

typedef struct branch_impact {
  long long point, special;
  double time;
  long long particle;
  int side;
  double gap_rate, impulse;
} branch_impact;

typedef struct branch_segment {
  int origin;
  long long special;
  int outcome;
  const char *reason;
  long long impacts, missed;
} branch_segment;

/** A point of a curve of a branch. */
typedef struct branch_curve_point {
  curve_point common;
  double energy;
  int outcome;
  long long iterations;
} branch_curve_point;

/** The columns of its tables (kind.h). */
extern const column_list branch_lists[];

/** Lays out the row and the ragged tables.
 *  @param followed  name of the parameter, borrowed; the columns of its values bear it
 *  @param traced  that of the second one, borrowed; NULL without curves */
void branch_lay_out(const study_values *v, const char *followed, const char *traced, kind_plan *plan);

/** Whether a study of kind `branch` starts from a result. */
bool branch_restarts(const study *s);
/** Replaces it by the complete study (kind.h). */
int branch_resolve(study **s, const study_source *from, message *why);

#endif
