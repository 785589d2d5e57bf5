/* Diagrams beyond grazing: the grazing point of the family of a study, and the attractors that its return map predicts.
 */
#ifndef RICOCHET_APP_BEYOND_H
#define RICOCHET_APP_BEYOND_H

#include "kind/family/family_task.h"

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

#endif
