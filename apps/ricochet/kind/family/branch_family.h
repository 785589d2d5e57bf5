/* The family of motions that a study continues, for the values of one task. */
#ifndef RICOCHET_APP_BRANCH_FAMILY_H
#define RICOCHET_APP_BRANCH_FAMILY_H

#include <stdbool.h>

#include "model/lattice_model.h"

typedef struct branch_family {
  study_values *values;                     /* borrowed; the continuation parameters are set in them */
  const study_parameter *followed, *traced; /* the second one is NULL without curves */
  ric_poll poll;
  bool log;         /* the curve's parameter is the logarithm */
  bool multipliers; /* whether those of its points are computed; from the study, or set by the caller before the family
                       is opened */
  lattice_model model;
  ric_system *system;
  size_t *hits;  /* obstacles of orbit.at_start, at_half and sequence, one list after the other */
  double *times; /* of the sequence */
  ric_family *family;
  ric_shooting *first; /* of the motion whose energy is the start of the branch; NULL if the study gives the start */
} branch_family;

/** Allocates. @returns 0, or -1 when out of memory. */
int branch_family_init(branch_family *b, const study *s, study_values *v);
void branch_family_clear(branch_family *b);

/** Opens the system of the current task and its family, at the start of the branch. If the start is the energy of the
 *  motion with the given period, it opens the equations of that motion instead; branch_family_begin follows.
 *  @returns as ric_family_create, RIC_EINVAL for impacts without an obstacle */
ric_status branch_family_open(branch_family *b, ric_poll poll, ric_error *error);
/** Opens the family at the energy of that motion.
 *  @param rise  sign of the energy's change in the first step; 0: towards branch.to
 *  @returns as ric_family_create, RIC_EINVAL for an energy without a logarithm or outside the bounds of the study */
ric_status branch_family_begin(branch_family *b, double energy, int rise, ric_error *error);
/** Destroys them. */
void branch_family_close(branch_family *b);

/** The problem of the task's motion with given period; arrays are borrowed from the family.
 *  @param impacts  whether it has the impacts of the study; motions with Hertz contacts have none */
ric_shooting_problem branch_family_motion(const branch_family *b, bool impacts);

/** The curve's parameter for a value of the study's, and back. */
double branch_family_parameter(const branch_family *b, double value);
double branch_family_value(const branch_family *b, double parameter);

/** Whether the study gives the energy; the period is a guess then. */
bool branch_family_gives_energy(const study_values *v);
/** The period that the values give: that of the force, or orbit.period. */
double branch_family_period(const study_values *v);

/** Options of a curve in two parameters. @param direction  of the second one in the first step, +1 or -1 */
ric_curve_options branch_family_curve_options(const branch_family *b, int direction);

/** Working memory of a rank in bytes. */
double branch_family_bytes(const study_values *v);

#endif
