/* The state of a task that continues a family (kinds `branch` and `grazing`): its values, its family and its start. */
#ifndef RICOCHET_APP_FAMILY_TASK_H
#define RICOCHET_APP_FAMILY_TASK_H

#include "branch_family.h"

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

/** Opens the family of the current values. @returns as branch_family_open */
ric_status family_task_open(family_task *task, ric_error *error);
/** Finds the first guess (guess.h), and the energy at which the family starts if the study does not give it. The guess
 *  is the state of the section `start`, or of orbit.excited, orbit.mode, orbit.at_start and at_half;
 *  else rest.
 *  @returns as the functions of guess.h and branch_family_begin */
ric_status family_task_begin(family_task *task, ric_error *error);
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
