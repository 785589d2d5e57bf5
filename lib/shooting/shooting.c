#include "ricochet/shooting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/largest.h"
#include "numeric/path_derivative.h"
#include "shooting_gaps.h"
#include "shooting_spectrum.h"

static const double default_grazing_tol = 1e-10;

/* Step of differences of the energy, whose scales are taken to be one: errors of 1e-12. */
static const double energy_step = 1e-3;

static ric_status check_system(const ric_system *s, const ric_shooting_problem *p, ric_error *error) {
  if (!s->model->energy && (p->energy_given || p->kind == RIC_MOTION_CONSERVATIVE))
    return ric_fail(error, RIC_EINVAL, "a conservative motion needs the energy of its system");
  if (!(p->grazing_tol >= 0 && p->grazing_tol < 1e-2))
    return ric_fail(error, RIC_EINVAL, "grazing_tol = %g, expected 0 to 1e-2", p->grazing_tol);
  bool conserves = p->kind == RIC_MOTION_EVEN || p->kind == RIC_MOTION_CONSERVATIVE;
  for (size_t j = 0; conserves && s->obstacles && j < s->obstacle_count; j++)
    if (s->obstacles[j].stiffness == INFINITY && s->obstacles[j].restitution != 1)
      return ric_fail(error, RIC_EINVAL, "restitution = %g of obstacle %zu, expected 1: impacts may not take energy",
                      s->obstacles[j].restitution, j);
  return RIC_OK;
}

static double *take(double **store, size_t count) {
  double *taken = *store;
  *store += count;
  return taken;
}

static ric_status allocate(ric_shooting *s, ric_error *error) {
  size_t size = s->arcs.size, c = s->arcs.count > 1 ? size : arcs_first_numbers(&s->arcs);
  s->columns = c;
  if (c < SIZE_MAX / 64 / size)
    s->block =
        calloc(size * (2 * c + 3) + 2 * (c + 2) + 5 * size + 2 * s->arcs.speeds + s->arcs.unknowns, sizeof *s->block);
  if (!s->block)
    return ric_fail(error, RIC_ENOMEM, "no memory for the tangent vectors of %zu numbers", size);
  double *store = s->block;
  s->carried = take(&store, size * (c + 1));
  s->ends = take(&store, size * (c + 2));
  s->gap_row = take(&store, c + 2);
  s->in_time = take(&store, c + 2);
  s->x = take(&store, size);
  s->rates = take(&store, size);
  s->gradient = take(&store, size);
  s->phase_at = take(&store, size);
  s->phase_along = take(&store, size);
  s->contact = take(&store, 2 * s->arcs.speeds);
  s->residual = take(&store, s->arcs.unknowns);
  return RIC_OK;
}

static ric_status build(ric_shooting *s, const ric_shooting_problem *p, ric_error *error) {
  RIC_TRY(arcs_init(&s->arcs, s->system, p, error));
  RIC_TRY(check_system(s->system, p, error));
  RIC_TRY(allocate(s, error));
  RIC_TRY(arc_runner_init(&s->runner, s->system, &p->flow, p->poll, error));
  RIC_TRY(impact_solver_init(&s->law, s->system, error));
  return tangent_jump_init(&s->jump, s->system, &s->law, s->columns + 2, error);
}

ric_status ric_shooting_create(ric_system *system, const ric_shooting_problem *problem, ric_shooting **shooting,
                               ric_error *error) {
  ric_shooting *s = calloc(1, sizeof *s);
  *shooting = NULL;
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a shooting problem");
  s->system = system;
  s->poll = problem->poll;
  s->grazing_tol = problem->grazing_tol > 0 ? problem->grazing_tol : default_grazing_tol;
  /* Even motions may be forced; it matters where a piece begins at a time that moves. */
  s->forced = problem->kind == RIC_MOTION_FORCED || problem->kind == RIC_MOTION_EVEN;
  ric_status status = build(s, problem, error);
  if (status == RIC_OK)
    *shooting = s;
  else
    ric_shooting_destroy(&s);
  return status;
}

void ric_shooting_destroy(ric_shooting **shooting) {
  if (!shooting || !*shooting)
    return;
  ric_shooting *s = *shooting;
  shooting_gaps_destroy(&s->gaps);
  shooting_spectrum_destroy(&s->spectrum);
  tangent_jump_clear(&s->jump);
  impact_solver_clear(&s->law);
  arc_runner_clear(&s->runner);
  arcs_clear(&s->arcs);
  free(s->block);
  free(s);
  *shooting = NULL;
}

size_t ric_shooting_unknowns(const ric_shooting *shooting) {
  return shooting->arcs.unknowns;
}

size_t ric_shooting_impacts(const ric_shooting *shooting) {
  const arc_plan *a = &shooting->arcs;
  return a->start_count + a->half_count + (a->kind == RIC_MOTION_EVEN ? 2 : 1) * a->sequence_count;
}

ric_flow_counts ric_shooting_counted(const ric_shooting *shooting) {
  return ric_flow_counted(arc_runner_flow(&shooting->runner));
}

/* --- energy ------------------------------------------------------------------------------------------------------- */

/* States along one coordinate or speed. */
typedef struct energy_line {
  ric_shooting *s;
  double *x;
  size_t along;
} energy_line;

static const char *energy_on_line(void *path, double step, double *value) {
  const energy_line *l = path;
  const ric_system *system = l->s->system;
  double kept = l->x[l->along];
  l->x[l->along] = kept + step;
  const char *trouble = system->model->energy(system, 0, l->x, l->x + system->coordinates, value);
  l->x[l->along] = kept;
  return trouble;
}

ric_status shooting_energy(ric_shooting *s, double *x, double *energy, ric_error *error) {
  energy_line line = {.s = s, .x = x};
  const char *trouble = energy_on_line(&line, 0, energy);
  for (; !trouble && line.along < s->arcs.size; line.along++)
    trouble = path_derivative(energy_on_line, &line, energy_step, 1, &s->gradient[line.along], NULL);
  return trouble ? ric_fail(error, RIC_ECALLBACK, "the energy could not be evaluated: %s", trouble) : RIC_OK;
}

/* --- guess -------------------------------------------------------------------------------------------------------- */

static ric_status check_times(const ric_shooting *s, const double *times, double period, ric_error *error) {
  bool even = s->arcs.kind == RIC_MOTION_EVEN;
  if (!(period > 0 && period < INFINITY))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected > 0", period);
  for (size_t k = 0; k < s->arcs.sequence_count; k++) {
    double least = k > 0 ? times[k - 1] : even ? 0 : -INFINITY;
    double most = even ? period / 2 : k > 0 ? times[0] + period : INFINITY;
    if (!(times[k] >= least && times[k] <= most))
      return ric_fail(error, RIC_EINVAL, "times[%zu] = %g, expected %g to %g", k, times[k], least, most);
  }
  return RIC_OK;
}

static void guess_numbers(const ric_shooting *s, const double *q, const double *u, const double *times, double period,
                          double *z) {
  const arc_plan *a = &s->arcs;
  size_t n = a->coordinates;
  memset(z, 0, a->unknowns * sizeof *z);
  for (size_t i = 0; i < n; i++)
    z[i] = a->kind == RIC_MOTION_EVEN && a->at_start[i] != NO_UNKNOWN ? u[i] : q[i];
  for (size_t i = 0; a->kind != RIC_MOTION_EVEN && i < a->speeds; i++)
    z[n + i] = u[i];
  double origin = a->sequence_count > 0 && a->impacts[0].index == NO_UNKNOWN ? times[0] : 0;
  for (size_t k = 0; k < a->sequence_count; k++)
    if (a->impacts[k].index != NO_UNKNOWN)
      z[a->impacts[k].index] = times[k] - origin;
  if (a->period != NO_UNKNOWN)
    z[a->period] = period;
}

/* The phase condition: no motion along the present rates. */
static ric_status set_phase(ric_shooting *s, const double *z, ric_error *error) {
  size_t n = s->arcs.coordinates;
  if (s->arcs.phase_row == NO_UNKNOWN)
    return RIC_OK;
  memcpy(s->phase_at, z, s->arcs.size * sizeof *z);
  RIC_TRY(ric_system_rate(s->system, 0, z, z + n, s->phase_along, s->phase_along + n, error));
  double size = largest(s->phase_along, s->arcs.size);
  if (!(size > 0))
    return ric_fail(error, RIC_EINVAL, "the guess is a state of rest: it has no phase");
  for (size_t i = 0; i < s->arcs.size; i++)
    s->phase_along[i] /= size;
  return RIC_OK;
}

ric_status ric_shooting_guess(ric_shooting *s, const double *q, const double *u, const double *times, double period,
                              double *z, ric_error *error) {
  RIC_TRY(check_times(s, times, period, error));
  guess_numbers(s, q, u, times, period, z);
  RIC_TRY(set_phase(s, z, error));
  for (size_t k = 0; k + 1 < s->arcs.count; k++) {
    piece_run run = shooting_begin(s, k, z, period, WISH_STATE);
    RIC_TRY(shooting_move(s, &run, NULL, error));
    if (run.piece->how == PIECE_IMPACT)
      RIC_TRY(shooting_hit(s, &run, error));
    memcpy(z + (run.piece + 1)->state, s->x, s->arcs.size * sizeof *z);
  }
  return RIC_OK;
}
