/* Kinds `diagram` and `basin`: attractors at every grid point. What their files share. */
#ifndef RICOCHET_APP_DIAGRAM_H
#define RICOCHET_APP_DIAGRAM_H

#include "kind/family/family_task.h"
#include "kind/kind.h"

/* --- beyond.c --- */

/* Diagrams beyond grazing: the grazing point of the family of a study, and the attractors that its return map predicts.
 */

typedef struct beyond {
  const study *study;
  family_task task;
  double *swept;    /* [sweeps] values for which the grazing point below was found */
  bool known;       /* whether a grazing point has been sought */
  ric_error error;  /* why there is no grazing point; status RIC_OK if there is one */
  double parameter; /* of the study, at the grazing point */
  double slope;     /* derivative of the gap's minimum by the parameter */
  double period;    /* of the motion */
  ric_grazing grazing;
  ric_grazing_map map; /* on the section of the diagram */
} beyond;

/** @param b  beyond_clear also after a refusal  @returns 0, or EXIT_RUN without memory */
int beyond_init(beyond *b, const study *s, ric_poll poll, message *why);
void beyond_clear(beyond *b);

/** Finds the grazing point of the family of the current values; keeps that of the last call if only grazing.beyond has
 *  changed.
 *  @returns as grazing_find and ric_grazing_section; RIC_ENUMERIC without a grazing point */
ric_status beyond_find(beyond *b, const study_values *v, ric_error *error);

/** The parameter of the current values, and d of the map there. */
double beyond_parameter(const beyond *b, const study_values *v);
double beyond_d(const beyond *b, const study_values *v);

/** State on the section of the periodic motion without the obstacle, at a parameter.
 *  @param x  [size of the map] set  @returns as ric_family_start */
ric_status beyond_motion(beyond *b, const study_values *v, double parameter, double *x, ric_error *error);

/** Runs the map to its attractor there, from the periodic motion.
 *  @param attractor  with its arrays; its state is that of the map, the periodic motion at 0
 *  @returns as ric_map_runner_run */
ric_status beyond_run(const beyond *b, const study_values *v, const ric_attractor_options *options,
                      ric_attractor *attractor, ric_error *error);

/* --- iterated.c --- */

/* What studies of kinds `diagram` and `basin` iterate: a map, or the crossings of a motion with a section.
 *
 * Several maps are iterated at once, side by side in SIMD lanes; motions run one by one. Results do not depend on which
 * tasks run together. */

/** Numbers of a state that such a study iterates: of the map, or of the section. */
size_t diagram_state_size(const study *s);
/** Index of the observed one. */
size_t diagram_observed(const study *s);
/** Whether it is a diagram with grazing.beyond. */
bool diagram_is_beyond(const study *s);
/** Whether windows along its last sweep are to be listed. */
bool diagram_has_windows(const study *s);

/** A task of a map, ready to run. */
typedef struct iterated_map {
  ric_grazing_map map;
  double d;
  ric_attractor_options options;
  ric_error refused; /* why it cannot be run; status RIC_OK if it can */
} iterated_map;

typedef struct iterated {
  const study *study;
  study_values *values; /* the owner sets their task */
  ric_poll poll;
  size_t size;  /* numbers of a state */
  size_t slots; /* most tasks that run at once */
  /* of maps */
  iterated_map *maps;         /* [slots] */
  ric_map_lanes lanes;        /* the fastest variant here */
  ric_map_runner *runner;     /* of the options below; NULL before the first run */
  ric_attractor_options made; /* of the runner */
  /* of motions */
  lattice_model model;
  ric_motion_section_options section;
  ric_attractor_options options;
  ric_error refused; /* why the task cannot be run; status RIC_OK if it can */
  beyond *beyond;    /* of studies with grazing.beyond, else NULL */
} iterated;

/** Most tasks that run at once. */
size_t iterated_slots(const study *s);

/** Its memory in bytes. */
double iterated_bytes(const study *s, const study_values *v);

/** @param it  iterated_clear also after a refusal  @returns 0, or EXIT_RUN without memory */
int iterated_init(iterated *it, const study *s, ric_poll poll, message *why);
void iterated_clear(iterated *it);

/** Iterates over which impacts and exponents of the current task are averaged. */
size_t iterated_measured(const iterated *it);

/** Reads the current task into a slot, with its start.
 *  @param z  [size] set */
void iterated_take(iterated *it, size_t slot, double *z);

/** Reads the lattice of the current values; with grazing.beyond, at the parameter that follows from it.
 *  @returns as beyond_find */
ric_status iterated_read_model(iterated *it, ric_error *error);

/** Period of the force of a lattice; 0 where it has none. */
double iterated_period(const lattice_model *model);

/** Runs the first `count` slots to their attractors, whose arrays and starts the caller has set. A slot that cannot be
 *  run gets the outcome `failed` with its reason.
 *  @returns RIC_OK, RIC_ESTOPPED */
ric_status iterated_run(iterated *it, size_t count, ric_attractor *attractors);

/* --- rows and tables --- */

enum { DIAGRAM_REASON_BYTES = 128 };

/** The columns of their tables (kind.h). */
extern const column_list diagram_lists[], basin_lists[], diagram_window_lists[], basin_attractor_lists[];

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

/** A row of zeros, and the attractor that will be stored in it: its arrays are those of the row, if it has them.
 *  @returns RIC_OK or RIC_ESTOPPED */
ric_status diagram_begin_row(const table *layout, ric_poll stop, unsigned char *bytes, diagram_row *row,
                             ric_attractor *attractor);

/** Stores the attractor in the row, which borrows its arrays. */
void diagram_put_row(diagram_row *row, const ric_attractor *attractor);

/** The table of windows along the last sweep (kind.h). */
int diagram_windows(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                    message *why);

/** The tables of the attractors of a basin, and of the attractor to which each task converges. */
int basin_attractors(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                     message *why);

#endif
