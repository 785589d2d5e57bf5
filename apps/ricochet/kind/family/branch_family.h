/* The family of motions that a study follows, for the values of one task. */
#ifndef RICOCHET_APP_BRANCH_FAMILY_H
#define RICOCHET_APP_BRANCH_FAMILY_H

#include <stdbool.h>

#include "model/lattice_model.h"

typedef struct branch_family {
  study_values *values;                     /* borrowed; what is followed moves in them */
  const study_parameter *followed, *traced; /* the second one is NULL without curves */
  ric_poll poll;
  bool log;         /* the curve's parameter is the logarithm */
  bool multipliers; /* of its points are found: as the study says, or the caller before it opens the family */
  lattice_model model;
  ric_system *system;
  size_t *hits;  /* obstacles of orbit.at_start, at_half and sequence, one list after the other */
  double *times; /* of the sequence */
  ric_family *family;
  ric_shooting *first; /* of the motion at whose energy the branch starts; NULL where the study says where it does */
} branch_family;

/** Makes room for the values. @returns 0, or -1 when out of memory. */
int branch_family_init(branch_family *b, const study *s, study_values *v);
void branch_family_clear(branch_family *b);

/** The system of the present task, and its family, at the start of the branch; where the study leaves the start to the
 *  motion of the period, the equations of that one in place of the family.
 *  @returns as ric_family_create, RIC_EINVAL for impacts without an obstacle */
ric_status branch_family_open(branch_family *b, ric_poll poll, ric_error *error);
/** The family, at the energy of that motion.
 *  @param rise  sign of the energy's change with which it sets out; 0: towards branch.to
 *  @returns as ric_family_create, RIC_EINVAL for one that has no logarithm or lies outside the bounds of the study */
ric_status branch_family_begin(branch_family *b, double energy, int rise, ric_error *error);
/** Destroys them. */
void branch_family_close(branch_family *b);

/** The task's motions with the period given, as problems on its obstacles; arrays are those of the family.
 *  @param impacts  with those of the study; else, as with Hertz contacts, without any */
ric_shooting_problem branch_family_motion(const branch_family *b, bool impacts);

/** The curve's parameter for a value of the study's, and back. */
double branch_family_parameter(const branch_family *b, double value);
double branch_family_value(const branch_family *b, double parameter);

/** Whether nothing is given but the energy; then the period is a guess. */
bool branch_family_gives_energy(const study_values *v);
/** The period that the values say: of the force, or orbit.period. */
double branch_family_period(const study_values *v);

/** How a curve in two parameters is followed. @param direction  in which the second one moves first, +1 or -1 */
ric_curve_options branch_family_curve_options(const branch_family *b, int direction);

/** Bytes that a rank computes with. */
double branch_family_bytes(const study_values *v);

#endif
