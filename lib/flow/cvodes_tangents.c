/* Tangent vectors by the forward sensitivity analysis of CVODES. */
#include <math.h>
#include <stdlib.h>

#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "cvodes_solver.h"

void cvodes_tangents_clear(cvodes_solver *s) {
  cvodes_tangents *d = &s->tangents;
  if (d->columns > 0)
    CVodeSensFree(s->memory);
  if (d->iteration)
    SUNNonlinSolFree(d->iteration);
  if (d->vector)
    N_VDestroyVectorArray(d->vector, (int)d->columns);
  free(d->absolute);
  free(d->d);
  *d = (cvodes_tangents){0};
}

double *cvodes_solver_tangent(const cvodes_solver *s, size_t column) {
  return N_VGetArrayPointer(s->tangents.vector[column]);
}

static int rates(int count, sunrealtype t, N_Vector y, N_Vector y_rate, N_Vector *d, N_Vector *d_rate, void *user,
                 N_Vector work, N_Vector more_work) {
  cvodes_solver *s = user;
  (void)y_rate, (void)work, (void)more_work;
  if (s->trouble)
    return -1;
  for (int k = 0; k < count; k++) {
    s->tangents.d[k] = N_VGetArrayPointer(d[k]);
    s->tangents.d_rate[k] = N_VGetArrayPointer(d_rate[k]);
  }
  s->trouble = s->tangent_rate(s->user, s->origin + t, N_VGetArrayPointer(y), s->tangents.d, s->tangents.d_rate);
  s->trouble_time = s->origin + t;
  return s->trouble ? -1 : 0;
}

static ric_status allocate(cvodes_solver *s, size_t columns, ric_error *error) {
  cvodes_tangents *d = &s->tangents;
  d->vector = columns < 1u << 20 ? N_VCloneVectorArray((int)columns, s->y) : NULL;
  d->absolute = malloc(columns * sizeof *d->absolute);
  d->d = malloc(2 * columns * sizeof *d->d);
  d->d_rate = d->d + columns;
  d->columns = d->vector ? columns : 0;
  if (d->vector && d->absolute && d->d)
    return RIC_OK;
  cvodes_tangents_clear(s);
  return ric_fail(error, RIC_ENOMEM, "no memory for CVODES with %zu tangent vectors", columns);
}

static int set_up(cvodes_solver *s) {
  cvodes_tangents *d = &s->tangents;
  for (size_t k = 0; k < d->columns; k++)
    N_VConst(0, d->vector[k]);
  if (CVodeSensInit(s->memory, (int)d->columns, CV_STAGGERED, rates, d->vector) ||
      CVodeSetSensErrCon(s->memory, SUNTRUE))
    return -1;
  d->iteration = SUNNonlinSol_FixedPointSens((int)d->columns, s->y, 0, s->context);
  return d->iteration ? CVodeSetNonlinearSolverSensStg(s->memory, d->iteration) : -1;
}

ric_status cvodes_solver_carry(cvodes_solver *s, size_t columns, ric_error *error) {
  s->tangents.carried = columns > 0;
  if (columns == 0 && s->tangents.columns > 0)
    CVodeSensToggleOff(s->memory); /* the next restart with them turns them on */
  if (columns == 0 || columns == s->tangents.columns)
    return RIC_OK;
  cvodes_tangents_clear(s);
  RIC_TRY(allocate(s, columns, error));
  s->tangents.carried = true;
  if (set_up(s) == 0)
    return RIC_OK;
  cvodes_tangents_clear(s);
  return ric_fail(error, RIC_ENOMEM, "no memory for CVODES with %zu tangent vectors", columns);
}

const char *cvodes_tangents_restart(cvodes_solver *s) {
  cvodes_tangents *d = &s->tangents;
  for (size_t k = 0; k < d->columns; k++)
    d->absolute[k] = s->tolerance * fmax(N_VMaxNorm(d->vector[k]), 1e-290);
  int failed = CVodeSensReInit(s->memory, CV_STAGGERED, d->vector);
  failed = failed || CVodeSensSStolerances(s->memory, s->tolerance, d->absolute);
  return failed ? "CVODES refuses to start with tangent vectors" : NULL;
}

const char *cvodes_tangents_at(cvodes_solver *s, double x) {
  double t = x == 1 ? s->end : s->begin + x * (s->end - s->begin);
  return CVodeGetSensDky(s->memory, t, 0, s->tangents.vector) ? "CVODES gives no tangent vectors for its step" : NULL;
}
