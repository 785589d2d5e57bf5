/* Shooting: its options and workspace, the solution by Newton's method, and states of a motion. */
#include "shooting.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/required.h"
#include "numeric/vector.h"
#include "numeric/newton.h"
#include "numeric/number_block.h"
#include "numeric/path_derivative.h"
#include "ricochet/shooting.h"

/* States of a motion at times of its period. */

/* Times nearer than this to the end of a segment, over the period, belong to that segment: to the state before an
 * impact. */
static const double end_tol = 1e-12;

typedef struct sampling {
  const ric_shooting *s;
  double first, step, slack; /* times */
  size_t count;              /* of those that are integrated: half of an even motion */
  double *q, *v;             /* [all][n], [all][m] */
} sampling;

static ric_status copy_first_state(const piece_run *run, void *user, ric_error *error) {
  sampling *p = user;
  size_t n = p->s->arcs.coordinates;
  (void)error;
  if (run->piece != p->s->arcs.pieces)
    return RIC_OK;
  p->first = run->begin;
  memcpy(p->q, p->s->x, n * sizeof *p->q);
  if (p->s->arcs.speeds > 0) /* v may be NULL */
    memcpy(p->v, p->s->x + n, p->s->arcs.speeds * sizeof *p->v);
  return RIC_OK;
}

/* The index of the first sample after a time; samples within rounding of it count as not after it. */
static size_t first_after(const sampling *p, double time) {
  double k = floor((time + p->slack - p->first) / p->step) + 1;
  return k < 1 ? 1 : k < (double)p->count ? (size_t)k : p->count;
}

static void sample_segment(const ric_segment *piece, double end, void *user) {
  sampling *p = user;
  size_t n = p->s->arcs.coordinates, m = p->s->arcs.speeds;
  size_t last = first_after(p, piece->start + end * piece->length);
  for (size_t k = first_after(p, piece->start); k < last; k++) {
    double x = (p->first + (double)k * p->step - piece->start) / piece->length;
    ric_segment_state(piece, fmax(0, fmin(x, end)), p->q + k * n + piece->first,
                      m > 0 ? p->v + k * m + piece->first : NULL);
  }
}

/* The second half of an even motion is the first one reversed. */
static void mirror(const sampling *p, size_t count) {
  size_t n = p->s->arcs.coordinates;
  for (size_t k = p->count; k < count; k++)
    for (size_t i = 0; i < n; i++) {
      p->q[k * n + i] = p->q[(count - 1 - k) * n + i];
      p->v[k * n + i] = -p->v[(count - 1 - k) * n + i];
    }
}

/* States at the first time of the motion and every `step` after it, in the part that is integrated. */
static ric_status sample(ric_shooting *s, const double *z, double given, sampling *p, size_t count, ric_error *error) {
  const shooting_observer observer = {.begins = copy_first_state, .segment = sample_segment, .user = p};
  for (size_t k = 0; k < count * s->arcs.coordinates; k++)
    p->q[k] = NAN;
  for (size_t k = 0; k < count * s->arcs.speeds; k++)
    p->v[k] = NAN;
  return shooting_evaluate(s, z, given, s->residual, NULL, NULL, &observer, error);
}

ric_status ric_shooting_states(ric_shooting *s, const double *z, double given, size_t count, double *q, double *v,
                               ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"z", z}, {"q", q});
  REQUIRE(error, {"v", unless_empty(s->system->speeds, v)});
  bool even = s->arcs.kind == RIC_MOTION_EVEN;
  double period;
  if (count < 2 || count > SIZE_MAX / 64 / s->arcs.size)
    return ric_fail(error, RIC_EINVAL, "count = %zu, expected at least 2 states, and no more than memory holds", count);
  RIC_TRY(shooting_period(s, z, given, &period, error));
  sampling p = {.s = s,
                .step = period / (double)(count - 1),
                .slack = end_tol * period,
                .count = even ? (count + 1) / 2 : count,
                .q = q,
                .v = v};
  RIC_TRY(sample(s, z, given, &p, count, error));
  if (even)
    mirror(&p, count);
  return RIC_OK;
}

/* Verification, from a start within the longest time between impacts. */

/* Position of the start within that time: not its middle, a turning point of symmetric motions. */
static const double start_part = 0.25;

/* Time from `from` to the next impact, 0 < it <= T. */
static double until_impact(const ric_orbit *o, double from) {
  double least = o->period;
  for (size_t k = 0; k < o->impacts; k++) {
    double late = fmod(o->impact_time[k] - from, o->period);
    least = fmin(least, late <= 0 ? late + o->period : late);
  }
  return least;
}

static double time_between_impacts(const ric_orbit *o) {
  double longest = o->impacts > 0 ? 0 : o->period, after = 0;
  for (size_t k = 0; k < o->impacts; k++) {
    double until = until_impact(o, o->impact_time[k]);
    if (until > longest) {
      longest = until;
      after = o->impact_time[k];
    }
  }
  return after + start_part * longest;
}

/* @param states  [2][n + m] q at both times, v at both */
static ric_status verify(ric_shooting *s, const double *z, double given, const ric_orbit *orbit, double *states,
                         const ric_verify_options *options, ric_verification *verification, ric_error *error) {
  size_t n = s->arcs.coordinates;
  double period = orbit->period, first = shooting_begin(s, 0, z, period, OUTPUT_STATE).begin;
  double late = fmod(time_between_impacts(orbit) - first, period);
  late += late < 0 ? period : 0;
  if (shooting_is_even(s)) /* the second half is the first one reversed: it has no impact there either */
    late = fmin(late, period - late);
  sampling p = {.s = s, .step = late, .slack = end_tol * period, .count = 2, .q = states, .v = states + 2 * n};
  RIC_TRY(sample(s, z, given, &p, 2, error));
  return ric_verify(s->system, orbit, first + late, p.q + n, p.v + s->arcs.speeds, options, verification, error);
}

ric_status ric_shooting_verify(ric_shooting *s, const double *z, double given, const ric_orbit *orbit,
                               const ric_verify_options *options, ric_verification *verification, ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"z", z}, {"orbit", orbit}, {"verification", verification});
  *verification = (ric_verification){.result = RIC_NOT_RUN, .closure_error = NAN};
  if (orbit->outcome != RIC_ADMISSIBLE) {
    snprintf(verification->reason, sizeof verification->reason, "the orbit is not admissible");
    return RIC_OK;
  }
  double *states = malloc(2 * s->arcs.size * sizeof *states);
  ric_status status = states ? verify(s, z, given, orbit, states, options, verification, error)
                             : ric_fail(error, RIC_ENOMEM, "no memory for states of %zu numbers", s->arcs.size);
  free(states);
  return status;
}

/* Solving F(z) = 0 from a guess. */

static const double default_tolerance = 1e-13;

/* If the ends of a conservative motion differ by more than this, relative to 1 + the largest unknown, it is not
 * closed. */
static const double lambda_tol = 1e-6;

/* Newton's method tries states of any size, and fast motions need very many steps: a motion is given up that takes
 * STEPS_GROW times the steps of the guess, plus STEPS_MORE. */
enum { STEPS_GROW = 50, STEPS_MORE = 1000 };

typedef struct search {
  ric_shooting *s;
  double given;
  unsigned long long most_steps; /* of a motion; 0 before the first */
} search;

static ric_status shooting_residual(const double *z, double *F, double *J, void *user, ric_error *error) {
  search *k = user;
  arc_runner *runner = &k->s->runner;
  unsigned long long before = ric_flow_counted(arc_runner_flow(runner)).steps;
  if (J) /* at a point whose residual is known */
    return ric_shooting_residual(k->s, z, k->given, F, J, NULL, error);
  runner->last_step = k->most_steps ? before + k->most_steps : 0;
  ric_status status = ric_shooting_residual(k->s, z, k->given, F, NULL, NULL, error);
  runner->last_step = 0;
  if (k->most_steps == 0)
    k->most_steps = STEPS_GROW * (ric_flow_counted(arc_runner_flow(runner)).steps - before) + STEPS_MORE;
  return status;
}

/* E(x - lambda grad E) = E(x) has other solutions than lambda = 0: those motions are not closed. */
static ric_status check_lambda(const ric_shooting *s, const double *z, ric_error *error) {
  size_t index = s->arcs.lambda;
  double added = index == NO_UNKNOWN ? 0 : fabs(z[index]) * largest(s->gradient, s->arcs.size);
  if (added <= lambda_tol * (1 + largest(z, s->arcs.unknowns)))
    return RIC_OK;
  return ric_fail(
      error, RIC_ENUMERIC,
      "shooting converges to a motion that is not closed: its ends differ by %.3g along the gradient of the energy",
      added);
}

ric_status ric_shooting_solve(ric_shooting *s, double *z, double given, double tolerance, int *iterations,
                              ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"z", z});
  int count = 0;
  double tol = tolerance == 0 ? default_tolerance : tolerance;
  search k = {.s = s, .given = given};
  const newton_problem problem = {
      .name = "shooting", .unknowns = s->arcs.unknowns, .residual = shooting_residual, .user = &k};
  if (!(tol > 0 && tol < 1))
    return ric_fail(error, RIC_EINVAL, "tolerance = %g, expected 0 to 1", tolerance);
  ric_status status = newton_solve(&problem, z, tol, &count, error);
  if (status == RIC_OK)
    status = check_lambda(s, z, error);
  if (iterations)
    *iterations = count;
  return status;
}

static const double default_grazing_tol = 1e-10;

/* Step of differences of the energy, for scales of order one: errors of 1e-12. */
static const double energy_step = 1e-3;

static ric_status check_system(const ric_system *s, const ric_shooting_problem *p, ric_error *error) {
  if (!s->model->energy && (p->energy_given || p->kind == RIC_MOTION_CONSERVATIVE))
    return ric_fail(error, RIC_EINVAL, "a conservative motion needs the energy of its system");
  if (!(p->grazing_tol >= 0 && p->grazing_tol < 1e-2))
    return ric_fail(error, RIC_EINVAL, "grazing_tol = %g, expected 0 to 1e-2", p->grazing_tol);
  bool conserves = p->kind == RIC_MOTION_EVEN || p->kind == RIC_MOTION_CONSERVATIVE;
  for (size_t j = 0; conserves && s->obstacles && j < s->obstacle_count; j++)
    if (s->obstacles[j].stiffness == INFINITY && s->obstacles[j].restitution != 1)
      return ric_fail(error, RIC_EINVAL,
                      "restitution = %g of obstacle %zu, expected 1: impacts must conserve the energy",
                      s->obstacles[j].restitution, j);
  return RIC_OK;
}

static ric_status allocate_shooting(ric_shooting *s, ric_error *error) {
  size_t size = s->arcs.size, c = s->arcs.count > 1 ? size : arcs_first_numbers(&s->arcs);
  s->columns = c;
  if (c < SIZE_MAX / 64 / size)
    s->block =
        calloc(size * (2 * c + 3) + 2 * (c + 2) + 5 * size + 2 * s->arcs.speeds + s->arcs.unknowns, sizeof *s->block);
  if (!s->block)
    return ric_fail(error, RIC_ENOMEM, "no memory for the tangent vectors of %zu numbers", size);
  double *store = s->block;
  s->vectors = number_store_take(&store, size * (c + 1));
  s->ends = number_store_take(&store, size * (c + 2));
  s->gap_row = number_store_take(&store, c + 2);
  s->time_row = number_store_take(&store, c + 2);
  s->x = number_store_take(&store, size);
  s->rates = number_store_take(&store, size);
  s->gradient = number_store_take(&store, size);
  s->phase_at = number_store_take(&store, size);
  s->phase_along = number_store_take(&store, size);
  s->contact = number_store_take(&store, 2 * s->arcs.speeds);
  s->residual = number_store_take(&store, s->arcs.unknowns);
  return RIC_OK;
}

static ric_status build_shooting(ric_shooting *s, const ric_shooting_problem *p, ric_error *error) {
  RIC_TRY(arcs_init(&s->arcs, s->system, p, error));
  RIC_TRY(check_system(s->system, p, error));
  RIC_TRY(allocate_shooting(s, error));
  RIC_TRY(arc_runner_init(&s->runner, s->system, &p->flow, p->poll, error));
  RIC_TRY(impact_solver_init(&s->law, s->system, error));
  return tangent_jump_init(&s->jump, s->system, &s->law, s->columns + 2, error);
}

void ric_shooting_destroy(ric_shooting **shooting) {
  if (!shooting || !*shooting)
    return;
  ric_shooting *s = *shooting;
  system_gaps_clear(&s->gaps);
  shooting_spectrum_destroy(&s->spectrum);
  tangent_jump_clear(&s->jump);
  impact_solver_clear(&s->law);
  arc_runner_clear(&s->runner);
  arcs_clear(&s->arcs);
  free(s->block);
  free(s);
  *shooting = NULL;
}

ric_status ric_shooting_create(ric_system *system, const ric_shooting_problem *problem, ric_shooting **shooting,
                               ric_error *error) {
  REQUIRE(error, {"system", system}, {"problem", problem}, {"shooting", shooting});
  REQUIRE(error, {"at_start", unless_empty(problem->start_count, problem->at_start)},
          {"at_half", unless_empty(problem->half_count, problem->at_half)},
          {"sequence", unless_empty(problem->count, problem->sequence)});
  ric_shooting *s = calloc(1, sizeof *s);
  *shooting = NULL;
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a shooting problem");
  s->system = system;
  s->poll = problem->poll;
  s->grazing_tol = problem->grazing_tol > 0 ? problem->grazing_tol : default_grazing_tol;
  /* Even motions may be forced: then it matters at which time a piece begins. */
  s->forced = problem->kind == RIC_MOTION_FORCED || problem->kind == RIC_MOTION_EVEN;
  ric_status status = build_shooting(s, problem, error);
  if (status == RIC_OK)
    *shooting = s;
  else
    ric_shooting_destroy(&s);
  return status;
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

/* Energy along one coordinate or speed. */
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

/* The phase condition: no change of the state along the rates of the guess. */
static ric_status set_phase(ric_shooting *s, const double *z, ric_error *error) {
  size_t n = s->arcs.coordinates;
  if (s->arcs.phase_row == NO_UNKNOWN)
    return RIC_OK;
  memcpy(s->phase_at, z, s->arcs.size * sizeof *z);
  RIC_TRY(ric_system_rate(s->system, 0, z, z + n, s->phase_along, s->phase_along + n, error));
  double size = largest(s->phase_along, s->arcs.size);
  if (!(size > 0))
    return ric_fail(error, RIC_EINVAL, "the guess is a state of rest, expected a motion: a state of rest has no phase");
  for (size_t i = 0; i < s->arcs.size; i++)
    s->phase_along[i] /= size;
  return RIC_OK;
}

ric_status ric_shooting_guess(ric_shooting *s, const double *q, const double *u, const double *times, double period,
                              double *z, ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"q", q}, {"z", z});
  REQUIRE(error, {"u", unless_empty(s->system->speeds, u)}, {"times", unless_empty(s->arcs.sequence_count, times)});
  RIC_TRY(check_times(s, times, period, error));
  guess_numbers(s, q, u, times, period, z);
  RIC_TRY(set_phase(s, z, error));
  for (size_t k = 0; k + 1 < s->arcs.count; k++) {
    piece_run run = shooting_begin(s, k, z, period, OUTPUT_STATE);
    RIC_TRY(shooting_move(s, &run, NULL, error));
    if (run.piece->how == PIECE_IMPACT)
      RIC_TRY(shooting_hit(s, &run, error));
    memcpy(z + (run.piece + 1)->state, s->x, s->arcs.size * sizeof *z);
  }
  return RIC_OK;
}
