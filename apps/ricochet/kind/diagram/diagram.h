/* Kinds `diagram` and `basin`: attractors at every grid point. What their files share. */
#ifndef RICOCHET_APP_DIAGRAM_H
#define RICOCHET_APP_DIAGRAM_H

#include "iterated.h"
#include "kind/kind.h"

enum { DIAGRAM_REASON_BYTES = 128 };

/** The rows of a study of either kind. */
void diagram_lay_out(const study *s, const study_values *v, table *rows);

/** A row: the members that its columns name. Iterates are filled in their places. */
typedef struct diagram_row {
  int outcome;
  const char *reason;
  long long attractor_period;
  double impacts, lyapunov;
  const double *exponents;
  double *values, *state;
  const double *end;
  double *lowest;
  /* of diagrams beyond grazing */
  double parameter, d;
  long long map_period;
  double map_impacts, map_lyapunov;
  double *map_values;
  double distance;
} diagram_row;

/** What `show` says of a result (kind.h). */
result_card diagram_show, basin_show;

/* Its keys (schema_choice). */
int diagram_complete(study *s, const document *d, message *why);
bool diagram_wants(const study *s, const document *d, study_key key);
int diagram_check(const study *s, const document *d, message *why);
int basin_check(const study *s, const document *d, message *why);

/** A row of zeros, and the attractor that will be stored in it: its arrays are those of the row, if it has them. */
diagram_row diagram_begin_row(const table *rows, unsigned char *row, ric_attractor *attractor);

/** Stores the attractor in the row, which borrows its arrays. */
void diagram_put_row(diagram_row *row, const ric_attractor *attractor);

/** The table of windows along the last sweep (kind.h). */
int diagram_windows(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                    message *why);

/** The tables of the attractors of a basin, and of the attractor to which each task converges. */
int basin_attractors(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                     message *why);

#endif
