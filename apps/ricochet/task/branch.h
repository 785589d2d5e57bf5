/* kind: branch, for its own sources: the columns of its tables. */
#ifndef RICOCHET_APP_BRANCH_H
#define RICOCHET_APP_BRANCH_H

#include "kind.h"

/** Tails of a branch: its points, its special points, the impacts of these (and of points whose states are stored), its
 * segments; where the study asks for curves in two parameters, their points and how they ended. */
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

/** Outcomes of a segment: how its curve ended, and that it never began. */
enum { BRANCH_FAILED_START = RIC_CURVE_ENDS, BRANCH_REFUSED, BRANCH_OUTCOMES };

/** Their words; also of the ends of curves in two parameters. */
extern const char *const branch_outcome_names[BRANCH_OUTCOMES];

/** Where a segment comes from; beyond the start, a special point of an earlier one. */
typedef enum branch_origin {
  BRANCH_FROM_START,
  BRANCH_FROM_GRAZING,
  BRANCH_FROM_IMPACT_LOST,
  BRANCH_FROM_BRANCH_POINT,
  BRANCH_FROM_PERIOD_DOUBLING,
  BRANCH_ORIGINS
} branch_origin;

enum { BRANCH_REASON_BYTES = 256 };

/** Lays out the row and the tails.
 *  @param followed  name of the parameter, borrowed; the columns of its values bear it
 *  @param traced  that of the second one, borrowed; NULL without curves */
void branch_lay_out(const study_values *v, const char *followed, const char *traced, kind_plan *plan);

/** Writes a point of a segment, or a special one, into its record.
 *  @param value  of the parameter
 *  @param amplitude  ric_shooting_amplitude */
void branch_put_point(const table *t, const ric_family_point *point, double value, double amplitude, size_t segment,
                      unsigned char *record);
/** @param before  number of points of the task up to it; @param particle  that it concerns, -1 for none */
void branch_put_special(const table *t, const ric_family_point *point, double value, double amplitude, size_t segment,
                        uint64_t before, long long particle, unsigned char *record);

/** Writes what is of this kind alone of a point of a curve into its record (curve_trace.h). */
void branch_put_curve_point(const table *t, const ric_family_curve_point *point, unsigned char *record);

#endif
