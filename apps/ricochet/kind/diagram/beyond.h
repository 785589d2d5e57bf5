/* Diagrams beyond grazing: where the family of a study grazes, and what its return map says of the attractors there. */
#ifndef RICOCHET_APP_BEYOND_H
#define RICOCHET_APP_BEYOND_H

#include "kind/family/family_task.h"

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

#endif
