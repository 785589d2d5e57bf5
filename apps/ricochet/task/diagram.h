/* Kinds `diagram` and `basin`: attractors at every grid point. What their files share. */
#ifndef RICOCHET_APP_DIAGRAM_H
#define RICOCHET_APP_DIAGRAM_H

#include "iterated.h"
#include "kind.h"

enum { DIAGRAM_REASON_BYTES = 128 };

/** The rows of a study of either kind. */
void diagram_lay_out(const study *s, const study_values *v, table *rows);

/** Bytes of a row. */
double diagram_row_bytes(const study *s, const study_values *v);

/** An attractor that is to be put into a row: its arrays are those of the row, and of the caller where the row has
 * none.
 *  @param z  [size] @param exponents  [of the study] */
ric_attractor diagram_begin_row(const table *rows, unsigned char *row, double *z, double *exponents);

/** Puts it there. */
void diagram_put_row(const table *rows, unsigned char *row, const ric_attractor *attractor);

/** The table of windows along the last sweep (kind.h). */
int diagram_windows(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                    message *why);

/** The tables of the attractors of a basin, and of which one each task comes to. */
int basin_attractors(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                     message *why);

#endif
