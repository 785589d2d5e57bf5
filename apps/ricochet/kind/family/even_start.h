/* Even motions of a study's lattice with given impacts, from that of its linear part on.
 *
 * The motion of the linear part is the solution of linear equations: Newton's method finds it from rest. With the
 * nonlinear terms times a factor that grows from 0 to 1 it becomes that of the lattice. The period stays: where the
 * nonlinear terms change the periods that the motions of a family have, it may turn back before (a fold in the factor).
 * Newton's method from the motion of the linear part would then fail, or find a motion of some other family. */
#ifndef RICOCHET_APP_EVEN_START_H
#define RICOCHET_APP_EVEN_START_H

#include "model/lattice_model.h"

typedef struct even_start {
  const lattice_model *model; /* borrowed */
  ric_system *system;         /* the lattice, its obstacles rigid */
  ric_family *family;         /* along the factor */
  double period;
  double factor; /* how far it has come, of the nonlinear terms */
  double *z;     /* [particles] solution: displacements, but speeds of particles that are hit at t = 0 */
} even_start;

/** Finds the motion of the linear part.
 *  @param motion  even, with impacts at t = 0 and T/2 only
 *  @returns RIC_EINVAL where there is no such motion; as ric_family_create; cleared by even_start_clear in any case */
ric_status even_start_begin(even_start *e, const lattice_model *model, const ric_shooting_problem *motion,
                            double period, ric_error *error);
/** Goes on to all nonlinear terms. @returns RIC_ENUMERIC where it does not come there, with the factor at which the
 *  family turns back */
ric_status even_start_continue(even_start *e, ric_error *error);
void even_start_clear(even_start *e);

#endif
