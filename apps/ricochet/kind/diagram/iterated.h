/* What studies of kinds `diagram` and `basin` iterate: a map, or the crossings of a motion with a section.
 *
 * Several maps are iterated at once, side by side in SIMD lanes; motions run one by one. Results do not depend on which
 * tasks run together. */
#ifndef RICOCHET_APP_ITERATED_H
#define RICOCHET_APP_ITERATED_H

#include "beyond.h"

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

#endif
