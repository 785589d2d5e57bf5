/* The state of a task that continues a family (kinds `branch` and `grazing`): its values, its family and its start. */
#ifndef RICOCHET_APP_FAMILY_TASK_H
#define RICOCHET_APP_FAMILY_TASK_H

#include <stdbool.h>

#include "model/lattice_model.h"

/** The family of motions that a study follows, for the values of one task. */
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

/** The curve's parameter for a value of the study's, and back. */
double branch_family_parameter(const branch_family *b, double value);
double branch_family_value(const branch_family *b, double parameter);

/** How a curve in two parameters is followed. @param direction  in which the second one moves first, +1 or -1 */
ric_curve_options branch_family_curve_options(const branch_family *b, int direction);

typedef struct family_task {
  study_values *values;
  ric_poll poll;
  branch_family family;
  ric_guess guess; /* first guess of the current task */
  bool from_state; /* whether the study gives an initial state */
} family_task;

/** @param task  family_task_clear also after a refusal  @returns 0, or EXIT_RUN without memory */
int family_task_init(family_task *task, const study *s, ric_poll poll, message *why);
void family_task_clear(family_task *task);

/** Makes the system of the present values and its family, at the start of the branch; where the study leaves the start
 *  to the motion of the period, the equations of that one in place of the family.
 *  @returns what the library refuses: as ric_family_create, RIC_EINVAL for impacts without an obstacle */
ric_status family_task_open(family_task *task, ric_error *error);
/** Finds the first guess (guess.h), and the energy at which the family starts if the study does not give it. The guess
 *  is the state of the section `start`, or of orbit.excited, orbit.mode, orbit.at_start and at_half;
 *  else rest.
 *  @returns as the functions of guess.h and ric_family_create; RIC_EINVAL for an energy that has no logarithm or lies
 *           outside the bounds of the study */
ric_status family_task_begin(family_task *task, ric_error *error);
/** Destroys the system, the family and the equations. */
void family_task_close(family_task *task);
/** Solves the equations of the family for the motion at its start.
 *  @param z  [unknowns], set  @param parameter  the family's own at the start, set  @param iterations  may be NULL
 *  @returns as ric_family_start */
ric_status family_task_solve(const family_task *task, double *z, double *parameter, int *iterations, ric_error *error);

/** Refuses a study of one task if the library refuses that task, so that no result is written for it.
 *  @returns 0 or EXIT_USAGE */
int family_task_check(const study *s, message *why);

/** Working memory of a rank in bytes. */
double family_task_bytes(const study_values *v);

#endif
