/* Kinds `diagram` and `basin`: attractors at every grid point. What their files share. */
#ifndef RICOCHET_APP_DIAGRAM_H
#define RICOCHET_APP_DIAGRAM_H

#include "kind/family/family_task.h"
#include "kind/kind.h"

/* --- beyond.c --- */

/* Diagrams beyond grazing: where the family of a study grazes, and what its return map says of the attractors there. */

typedef struct beyond {
  const study *study;
  family_task task;
  double *swept;    /* [sweeps] values for which the grazing below was found */
  bool known;       /* whether it is that of any values */
  ric_error error;  /* why there is none; its status is RIC_OK where there is one */
  double parameter; /* of the study, at grazing */
  double slope;     /* by how much the gap's minimum changes with it */
  double period;    /* of the motion */
  ric_grazing grazing;
  ric_grazing_map map; /* on the section of the diagram */
} beyond;

/** @param b  beyond_clear also after a refusal  @returns 0, or EXIT_RUN without memory */
int beyond_init(beyond *b, const study *s, ric_poll poll, message *why);
void beyond_clear(beyond *b);

/** Finds where the family of the present values grazes; where they differ in grazing.beyond only from those of the last
 *  call, that is known.
 *  @returns as grazing_find and ric_grazing_section; RIC_ENUMERIC without a grazing point */
ric_status beyond_find(beyond *b, const study_values *v, ric_error *error);

/** Where the present values stand: the parameter, and d of the map. */
double beyond_parameter(const beyond *b, const study_values *v);
double beyond_d(const beyond *b, const study_values *v);

/** State on the section, at a parameter, of the periodic motion as it would be without the obstacle.
 *  @param x  [size of the map] set  @returns as ric_family_start */
ric_status beyond_motion(beyond *b, const study_values *v, double parameter, double *x, ric_error *error);

/** The attractor that the map has there, from the periodic motion.
 *  @param attractor  with its arrays; its state is that of the map, the periodic motion at 0
 *  @returns as ric_map_runner_run */
ric_status beyond_run(const beyond *b, const study_values *v, const ric_attractor_options *options,
                      ric_attractor *attractor, ric_error *error);

/* --- iterated.c --- */

/* What studies of kinds `diagram` and `basin` iterate: a map, or the crossings of a motion with a section.
 *
 * Maps go to their attractors several at once, side by side in vector lanes; motions one by one. What comes out does
 * not depend on how tasks are put together. */

/** Numbers of a state that such a study iterates: of the map, or of the section. */
size_t diagram_state_size(const study *s);
/** Which of them is observed. */
size_t diagram_observed(const study *s);
/** Whether it is a diagram that looks for grazing first, and says how far beyond it stands. */
bool diagram_is_beyond(const study *s);
/** Whether windows along its last sweep are to be listed. */
bool diagram_has_windows(const study *s);

/** A task that waits to be run, of a map. */
typedef struct iterated_map {
  ric_grazing_map map;
  double d;
  ric_attractor_options options;
  ric_error refused; /* why it cannot be run; its status is RIC_OK where it can */
} iterated_map;

typedef struct iterated {
  const study *study;
  study_values *values; /* whose present task is taken; moved by the owner */
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
  ric_error refused; /* why the task cannot be run; its status is RIC_OK where it can */
  beyond *beyond;    /* of studies that stand beyond a grazing point, else NULL */
} iterated;

/** Most tasks that run at once. */
size_t iterated_slots(const study *s);

/** Bytes that it takes. */
double iterated_bytes(const study *s, const study_values *v);

/** @param it  iterated_clear also after a refusal  @returns 0, or EXIT_RUN without memory */
int iterated_init(iterated *it, const study *s, ric_poll poll, message *why);
void iterated_clear(iterated *it);

/** Iterates over which impacts and exponents of the present task are averaged. */
size_t iterated_measured(const iterated *it);

/** Takes the present task as the one of a slot, with its start.
 *  @param z  [size] set */
void iterated_take(iterated *it, size_t slot, double *z);

/** Reads the lattice of the present values: beyond grazing, at the parameter where they stand.
 *  @returns as beyond_find */
ric_status iterated_read_model(iterated *it, ric_error *error);

/** Period of the force of a lattice; 0 where it has none. */
double iterated_period(const lattice_model *model);

/** Runs the first `count` slots to their attractors, whose arrays and starts the caller has set. What cannot be run has
 *  failed, with the reason.
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

/** A row of zeros, and the attractor that is to be put into it: its arrays are those of the row, where it has them. */
diagram_row diagram_begin_row(const table *rows, unsigned char *row, ric_attractor *attractor);

/** Says it of the row, which borrows its arrays. */
void diagram_put_row(diagram_row *row, const ric_attractor *attractor);

/** The table of windows along the last sweep (kind.h). */
int diagram_windows(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                    message *why);

/** The tables of the attractors of a basin, and of which one each task comes to. */
int basin_attractors(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                     message *why);

#endif
