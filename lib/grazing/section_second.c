/* kappa on a section.
 *
 * Behind grazing by y^2, at x* - y^2 n with eta n = 1, the bypass map and the motion from the touch to the section add
 * to what the motion would do without them
 *
 *   s y xi' + y^2 kappa' + O(y^3):
 *
 * kappa of the bypass map, and what the motion after it makes of the square of s y xi, where it is nonlinear, where
 * impacts follow and where the section is crossed at another time. All of it is in the motion itself; kappa' is its
 * limit for vanishing y. Any n will do: its choice is of the order of y |x - x*|. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "section.h"

enum { TRIALS = 5, MOST_APPROACHES = 4, MOST_CROSSINGS = 20 };

/* The largest y, over the root of A_g (T / 2 pi)^2, a size of the gap's changes; halved for extrapolation. */
static const double largest_y = 0.05;

/* Steps onto the section below this part of the period are rounding when they no longer shrink. */
static const double crossing_tol = 1e-11;

static const double two_pi = 6.283185307179586;

typedef struct second {
  const section *k;
  const ric_grazing_map *map;
  ric_bypass *bypass;
  ric_trajectory *trajectory;
  ric_flow *flow;       /* onto the section */
  double *x, *home;     /* [numbers] a state; the motion on the section */
  double *difference;   /* [state] */
  double *normal;       /* [numbers] n */
  double *smooth;       /* [size] what -n y^2 becomes without impacts, over y^2 */
  double *table, *rate; /* [TRIALS][size]; [numbers] */
  double *block;
} second;

static double *take(double **store, size_t count) {
  double *taken = *store;
  *store += count;
  return taken;
}

static ric_status open(second *w, ric_error *error) {
  const section *k = w->k;
  const size_t n = k->numbers, size = k->size;
  ric_system *system = k->f->problem.system;
  const ric_flow_options flow = k->f->problem.motion.flow;
  ric_trajectory_options motion = ric_trajectory_options_default();
  ric_bypass_options bypass = ric_bypass_options_default();
  double *store = w->block = calloc(4 * n + k->state + (1 + TRIALS) * size, sizeof *store);
  if (!store)
    return ric_fail(error, RIC_ENOMEM, "no memory for motions of %zu numbers", n);
  w->x = take(&store, n);
  w->home = take(&store, n);
  w->normal = take(&store, n);
  w->rate = take(&store, n);
  w->difference = take(&store, k->state);
  w->smooth = take(&store, size);
  w->table = take(&store, TRIALS * size);
  motion.flow = bypass.flow = flow;
  motion.pass_rigid = k->f->impacts == 0; /* then a section just behind the touch is none too late */
  motion.poll = k->f->problem.motion.poll;
  bypass.reach = k->g->period / 4;
  RIC_TRY(ric_bypass_create(system, k->g->local.obstacle, &bypass, &w->bypass, error));
  RIC_TRY(ric_flow_create(system, &flow, &w->flow, error));
  return ric_trajectory_create(system, &motion, &w->trajectory, error);
}

static void close(second *w) {
  ric_bypass_destroy(&w->bypass);
  ric_flow_destroy(&w->flow);
  ric_trajectory_destroy(&w->trajectory);
  free(w->block);
}

/* Sets `home`, n, and where n goes. */
static ric_status begin(second *w, ric_error *error) {
  const section *k = w->k;
  const ric_grazing *g = k->g;
  const size_t n = k->numbers;
  double square = 0;
  RIC_TRY(ric_shooting_transfer(k->f->shooting, g->z, g->given, k->time, k->time, w->home, NULL, error));
  for (size_t i = 0; i < n; i++)
    square += g->local.eta[i] * g->local.eta[i];
  for (size_t i = 0; i < n; i++)
    w->normal[i] = g->local.eta[i] / square;
  memset(w->difference, 0, k->state * sizeof *w->difference);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      w->difference[i] -= k->matrix[i * n + j] * w->normal[j];
  section_project(k, w->difference, w->smooth);
  return RIC_OK;
}

/* --- onto the section
 * ------------------------------------------------------------------------------------------------- */

/* How far the state w->x at a time is from the motion on the section a period later, and the time in which the flow
 * would bring it onto the section, to first order. */
static ric_status look(second *w, double t, double *ahead, ric_error *error) {
  const section *k = w->k;
  const size_t n = k->f->problem.system->coordinates;
  double distance = 0, speed = 0;
  RIC_TRY(ric_system_rate(k->f->problem.system, t, w->x, w->x + n, w->rate, w->rate + n, error));
  for (size_t i = 0; i < k->numbers; i++) {
    w->difference[i] = w->x[i] - w->home[i];
    distance += k->normal[i] * w->difference[i];
    speed += k->normal[i] * w->rate[i];
  }
  if (k->forced) {
    w->difference[k->numbers] = t - (k->time + k->g->period);
    distance += k->normal[k->numbers] * w->difference[k->numbers];
    speed += k->normal[k->numbers];
  }
  *ahead = -distance / speed;
  return RIC_OK;
}

static ric_status flow_to(second *w, double t, double end, ric_error *error) {
  const size_t n = w->k->f->problem.system->coordinates, m = w->k->numbers - n;
  RIC_TRY(ric_flow_start(w->flow, t, w->x, w->x + n, error));
  while (ric_flow_time(w->flow) != end) {
    RIC_TRY(ric_flow_step(w->flow, end, error));
    ric_flow_accept(w->flow, 1);
  }
  memcpy(w->x, ric_flow_q(w->flow), n * sizeof *w->x);
  if (m > 0)
    memcpy(w->x + n, ric_flow_u(w->flow), m * sizeof *w->x);
  return RIC_OK;
}

/* Moves the state onto the section; its difference from the motion is set then. */
static ric_status cross(second *w, double t, ric_error *error) {
  double ahead, before = INFINITY;
  for (int i = 0; i < MOST_CROSSINGS; i++) {
    RIC_TRY(look(w, t, &ahead, error));
    const double size = fabs(ahead);
    if (t + ahead == t || (size <= crossing_tol * w->k->g->period && size > before / 2))
      return RIC_OK;
    RIC_TRY(flow_to(w, t, t + ahead, error));
    t += ahead;
    before = size;
  }
  return ric_fail(error, RIC_ENUMERIC, "the section is not met near t = %g", t);
}

/* --- the limit
 * -------------------------------------------------------------------------------------------------------- */

/* (s y xi + y^2 kappa + ... - s y xi) / y^2 into a row [size]. */
static ric_status try(second *w, double y, double *row, ric_error *error) {
  const section *k = w->k;
  const ric_grazing *g = k->g;
  const size_t n = k->f->problem.system->coordinates;
  const double end = k->touch + k->time + g->period - k->touch;
  ric_run run;
  for (size_t i = 0; i < k->numbers; i++)
    w->x[i] = g->x[i] - y * y * w->normal[i];
  RIC_TRY(ric_bypass_map(w->bypass, k->touch, w->x, w->x, NULL, error));
  RIC_TRY(ric_trajectory_start(w->trajectory, k->touch, w->x, w->x + n, error));
  RIC_TRY(ric_trajectory_run(w->trajectory, end, NULL, &run, error));
  if (run.outcome != RIC_RUN_COMPLETED)
    return ric_fail(error, RIC_ENUMERIC, "beside the grazing motion: %s at t = %g: %s",
                    ric_run_outcome_name(run.outcome), run.time, run.reason);
  memcpy(w->x, ric_trajectory_q(w->trajectory), n * sizeof *w->x);
  if (k->numbers > n)
    memcpy(w->x + n, ric_trajectory_u(w->trajectory), (k->numbers - n) * sizeof *w->x);
  RIC_TRY(cross(w, end, error));
  for (size_t j = 0; j < k->size; j++) {
    double along = 0;
    for (size_t i = 0; i < k->state; i++)
      along += k->basis[j * k->state + i] * w->difference[i];
    row[j] = (along / y - w->map->stretch * w->map->xi[j]) / y - w->smooth[j];
  }
  return RIC_OK;
}

/* By Neville's scheme, from a largest y. */
static ric_status extrapolate(second *w, double most, double *kappa, ric_error *error) {
  const size_t size = w->k->size;
  for (int i = 0; i < TRIALS; i++)
    RIC_TRY(try(w, ldexp(most, -i), w->table + (size_t)i * size, error));
  for (int order = 1; order < TRIALS; order++)
    for (int i = TRIALS - 1; i >= order; i--)
      for (size_t j = 0; j < size; j++) {
        double *fine = w->table + (size_t)i * size + j, coarse = *(fine - size);
        *fine += (*fine - coarse) / (ldexp(1, order) - 1);
      }
  memcpy(kappa, w->table + (TRIALS - 1) * size, size * sizeof *kappa);
  return RIC_OK;
}

/* Motions that start too far from grazing may miss the section, or meet the obstacle again: then from nearer. */
static ric_status approach(second *w, double *kappa, ric_error *error) {
  double most = largest_y * sqrt(w->k->g->local.acceleration) * w->k->g->period / two_pi;
  ric_status status = extrapolate(w, most, kappa, error);
  for (int i = 0; status == RIC_ENUMERIC && i < MOST_APPROACHES; i++)
    status = extrapolate(w, most /= 4, kappa, error);
  return status;
}

ric_status section_second(const section *k, ric_grazing_map *map, ric_error *error) {
  second w = {.k = k, .map = map};
  ric_status status = open(&w, error);
  if (status == RIC_OK)
    status = begin(&w, error);
  if (status == RIC_OK)
    status = approach(&w, map->kappa, error);
  close(&w);
  return status;
}
