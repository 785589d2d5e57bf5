/* kind: grazing, for its own sources: the columns of its tables, and the steps of a task. */
#ifndef RICOCHET_APP_GRAZING_H
#define RICOCHET_APP_GRAZING_H

#include "kind/family/curve_trace.h"
#include "kind/kind.h"

/** Ragged tables of studies with `branch.trace`: the points of curves and how these ended. */
enum { GRAZING_CURVES, GRAZING_CURVE_ENDS, GRAZING_TAILS };

#define GRAZING_OUTCOME_LIST(X)                                                                                        \
  X(GRAZING_FOUND, "grazing")                                                                                          \
  X(GRAZING_NONE, "none")             /* the family ended without a grazing point */                                   \
  X(GRAZING_DEGENERATE, "degenerate") /* a grazing point that the theory does not cover */                             \
  X(GRAZING_FAILED, "failed")         /* the family, or what follows from its grazing point, cannot be computed */     \
  X(GRAZING_FAILED_START, "failed_start")                                                                              \
  X(GRAZING_REFUSED, "refused")

typedef enum grazing_outcome {
#define X(name, text) name,
  GRAZING_OUTCOME_LIST(X)
#undef X
      GRAZING_OUTCOMES
} grazing_outcome;

enum { GRAZING_REASON_BYTES = 256 };

/** A point of a curve of grazing points. */
typedef struct grazing_curve_point {
  curve_point common;
  double phase, A_g;
  int verdict;
  long long first_negative;
  ric_complex multiplier;
  const double *coefficient;
  long long change;
} grazing_curve_point;

/** Numbers of the section's coordinates. */
double grazing_coordinates(const study_values *v);

/** The columns of its tables (kind.h). */
extern const column_list grazing_lists[];

/** Lays out the row and the ragged tables.
 *  @param followed  name of the parameter, borrowed; @param traced  that of the second one, borrowed; NULL without
 *                   curves */
void grazing_lay_out(const study_values *v, const char *followed, const char *traced, kind_plan *plan);

/** A row: the members that its columns name. Members with several values point into the row. */
typedef struct grazing_row {
  int outcome;
  const char *reason;
  double parameter, period, time, phase;
  long long obstacle, particle;
  int side;
  double slope, A_g, restitution;
  int verdict;
  const char *verdict_reason;
  int regime;
  long long first_negative, first_zero, settled;
  ric_complex multiplier;
  double second, alpha, stretch;
  double *coefficient, *departure;
  const double *eta, *xi, *kappa, *L;
  ric_complex *multipliers;
  const double *q, *v;
  int64_t *window_period;
  unsigned char *window_exists;
  double *window_low, *window_high, *window_low_d, *window_high_d;
  unsigned char *window_low_kind, *window_high_kind;
  double *predicted_border_d, *predicted_flip_d;
} grazing_row;

/** Fills a row with missing values: NaN, -1, `none`. @returns its struct */
grazing_row grazing_clear_row(const table *t, unsigned char *row);

/** The state of a task. */
typedef struct grazing_task {
  branch_family *b;
  const kind_plan *plan;
  unsigned char *row; /* its bytes */
  grazing_row found;  /* its values */
  grazing_outcome outcome;
  char reason[GRAZING_REASON_BYTES];
  ric_grazing grazing; /* initialised, and set by grazing_find */
} grazing_task;

/** Sets the outcome with the reason of an error.
 *  @returns RIC_OK; RIC_ESTOPPED and RIC_ENOMEM are returned without an outcome */
ric_status grazing_end(grazing_task *task, grazing_outcome outcome, ric_status status, const ric_error *error);

/** Continues the family from its start to its first grazing point, and writes that into the row.
 *  @param z  [unknowns] changed
 *  @returns RIC_OK, also if there is none (see the outcome); RIC_ESTOPPED, RIC_ENOMEM */
ric_status grazing_find(grazing_task *task, double *z, double parameter);

/** Writes the coefficients on the study's section, the verdict and the windows into the row. @returns as above */
ric_status grazing_judge(grazing_task *task);

/** Continues the grazing point in two parameters and adds the points to the ragged tables. @returns as above */
ric_status grazing_trace(grazing_task *task, records *tails);

/** What `show` says of a result (kind.h). */
result_card grazing_show;

#endif
