/* The coefficients of the return map on a section, to first and second order. */
#include "grazing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/constants.h"
#include "numeric/number_block.h"
#include "numeric/required.h"
#include "numeric/vector.h"

/* kappa on a section.
 *
 * At x* - y^2 n with eta n = 1, a penetration of y^2, the discontinuity mapping and the motion from the grazing point
 * to the section add
 *
 *   s y xi' + y^2 kappa' + O(y^3):
 *
 * kappa of the discontinuity mapping, and the second-order term of the motion after it in s y xi, from nonlinearity,
 * further impacts and the changed time of crossing. The motion itself contains all of it; kappa' is its limit for
 * vanishing y. Any n can be used: its effect is of the order of y |x - x*|. */

enum { TRIALS = 7, MOST_APPROACHES = 4, MOST_CROSSINGS = 20 };

/* The largest y, relative to the root of A_g (T / 2 pi)^2, an estimate of the variation of the gap; halved for
 * extrapolation. */
static const double largest_y = 0.05;

/* Steps onto the section below this fraction of the period are rounding if they no longer shrink. */
static const double crossing_tol = 1e-11;

/* A motion whose crossing is later than this fraction of the period has missed the section. */
static const double farthest = 0.25;

typedef struct second {
  const section *k;
  const ric_grazing_map *map;
  ric_bypass *bypass;
  ric_trajectory *trajectory; /* NULL: the motion has no impacts */
  double *x, *home;           /* [numbers] a state; the motion on the section */
  double *difference;         /* [state] */
  double *normal;             /* [numbers] n */
  double *smooth;             /* [size] image of -n y^2 without impacts, divided by y^2 */
  double *rows, *rate;        /* [TRIALS][size] of Neville's scheme; [numbers] */
  double *best;               /* [size] kappa so far */
  size_t next, expected;      /* index of the expected next impact of the motion; number of expected impacts left */
  double *block;
} second;

static ric_status open(second *w, ric_error *error) {
  const section *k = w->k;
  const size_t n = k->numbers, size = k->size;
  ric_system *system = k->f->problem.system;
  const ric_flow_options flow = k->f->problem.motion.flow;
  ric_trajectory_options motion = ric_trajectory_options_default();
  ric_bypass_options bypass = ric_bypass_options_default();
  size_t used = 0;
  double *block = w->block = calloc(4 * n + k->state + (2 + TRIALS) * size, sizeof *block);
  if (!block)
    return ric_fail(error, RIC_ENOMEM, "no memory for motions of %zu numbers", n);
  w->x = number_block_take(block, &used, n);
  w->home = number_block_take(block, &used, n);
  w->normal = number_block_take(block, &used, n);
  w->rate = number_block_take(block, &used, n);
  w->difference = number_block_take(block, &used, k->state);
  w->smooth = number_block_take(block, &used, size);
  w->rows = number_block_take(block, &used, TRIALS * size);
  w->best = number_block_take(block, &used, size);
  motion.flow = bypass.flow = flow;
  motion.poll = k->f->problem.motion.poll;
  bypass.reach = k->g->period / 4;
  RIC_TRY(ric_bypass_create(system, k->g->local.obstacle, &bypass, &w->bypass, error));
  return k->f->impacts > 0 ? ric_trajectory_create(system, &motion, &w->trajectory, error) : RIC_OK;
}

static void close(second *w) {
  ric_bypass_destroy(&w->bypass);
  ric_trajectory_destroy(&w->trajectory);
  free(w->block);
}

/** Coordinates [size] of a difference [state] of the motion one period later, projected onto the section along the
 *  flow. */
/* Coordinates of a vector [state] projected onto the section along the flow. */
static void section_project(const section *k, const double *vector, double *z) {
  const double along = dot(k->normal, vector, k->state) / dot(k->normal, k->rates, k->state);
  for (size_t j = 0; j < k->size; j++) {
    const double *row = k->basis + j * k->state;
    z[j] = dot(row, vector, k->state) - along * dot(row, k->rates, k->state);
  }
}

/* Sets `home`, n, and the image of -n. */
static ric_status begin_second(second *w, ric_error *error) {
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

/* --- onto the section --- */

/* Difference of the state w->x at a time from the motion on the section one period later, and the time in which the
 * flow reaches the section, to first order. */
static ric_status measure_return(second *w, double t, double *ahead, ric_error *error) {
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

/* Integrates the free motion, forwards or backwards. */
static ric_status flow_to(second *w, double t, double end, ric_error *error) {
  return arc_runner_move(&w->k->f->shooting->runner, t, end, w->x, 0, NULL, NULL, error);
}

/* Moves the state onto the section and sets its difference from the motion. */
static ric_status cross(second *w, double t, ric_error *error) {
  double ahead, before = INFINITY;
  for (int i = 0; i < MOST_CROSSINGS; i++) {
    RIC_TRY(measure_return(w, t, &ahead, error));
    const double size = fabs(ahead);
    if (t + ahead == t || (size <= crossing_tol * w->k->g->period && size > before / 2))
      return RIC_OK;
    if (!(size <= farthest * w->k->g->period))
      break;
    RIC_TRY(flow_to(w, t, t + ahead, error));
    t += ahead;
    before = size;
  }
  return ric_fail(error, RIC_ENUMERIC, "the motion does not cross the section near t = %g", t);
}

/* --- the limit --- */

/* Time from the grazing point to the next impact of the motion with this index. */
static double time_to(const section *k, size_t which) {
  const double period = k->g->period;
  const double time = fmod(arcs_time(k->f->shooting->arcs.impacts[which], k->g->z, period) - k->grazing_time, period);
  return time < 0 ? time + period : time;
}

/* Number of impacts of the motion from the grazing point to the section, and the first of them. */
static size_t expect(const section *k, double duration, size_t *first) {
  size_t count = 0;
  *first = 0;
  for (size_t i = 0; i < k->f->shooting->arcs.sequence_count; i++) {
    count += time_to(k, i) <= duration;
    if (time_to(k, i) < time_to(k, *first))
      *first = i;
  }
  return count;
}

/* Ends a run after the last expected impact, and at an unexpected one. */
static int on_impact(const ric_event *e, void *user) {
  second *w = user;
  const arc_plan *arcs = &w->k->f->shooting->arcs;
  if (!ric_event_jumps(e))
    return 0;
  if (e->obstacle != arcs->sequence[w->next])
    return 1;
  w->next = (w->next + 1) % arcs->sequence_count;
  return --w->expected == 0;
}

/* From the grazing point through the impacts of the motion before the section; `time` is that of the last one, which
 * may be later than the crossing of the motion. */
static ric_status run_through_impacts(second *w, double end, double *time, ric_error *error) {
  const size_t n = w->k->f->problem.system->coordinates;
  const ric_observer observer = {.event = on_impact, .user = w};
  ric_run run;
  RIC_TRY(ric_trajectory_start(w->trajectory, *time, w->x, w->x + n, error));
  RIC_TRY(ric_trajectory_run(w->trajectory, end + farthest * w->k->g->period, &observer, &run, error));
  if (run.outcome != RIC_RUN_ENDED && run.outcome != RIC_RUN_COMPLETED)
    return ric_fail(error, RIC_ENUMERIC, "a motion near the grazing one: %s at t = %g: %s",
                    ric_run_outcome_name(run.outcome), run.time, run.reason);
  if (w->expected > 0)
    return ric_fail(error, RIC_ENUMERIC, "a motion near the grazing one has other impacts than it until t = %g",
                    run.time);
  memcpy(w->x, ric_trajectory_q(w->trajectory), n * sizeof *w->x);
  if (w->k->numbers > n)
    memcpy(w->x + n, ric_trajectory_u(w->trajectory), (w->k->numbers - n) * sizeof *w->x);
  *time = run.time;
  return RIC_OK;
}

/* From the grazing point onto the section. After the last impact the free motion is used, so that the grazing contact
 * of the next period, and impacts just behind the section, do not occur early. */
static ric_status run_on(second *w, ric_error *error) {
  const section *k = w->k;
  const double end = k->time + k->g->period;
  double time = k->grazing_time;
  w->expected = expect(k, end - k->grazing_time, &w->next);
  if (w->expected > 0)
    RIC_TRY(run_through_impacts(w, end, &time, error));
  RIC_TRY(flow_to(w, time, end, error));
  return cross(w, end, error);
}

/* (s y xi + y^2 kappa + ... - s y xi) / y^2 into a row [size]. y is that of the minimum of the gap found by the
 * discontinuity mapping: the gap of the grazing motion is zero only to rounding. */
static ric_status try(second *w, double depth, double *row, ric_error *error) {
  const section *k = w->k;
  ric_bypass_seen seen;
  for (size_t i = 0; i < k->numbers; i++)
    w->x[i] = k->g->x[i] - depth * w->normal[i];
  RIC_TRY(ric_bypass_map(w->bypass, k->grazing_time, w->x, w->x, &seen, error));
  if (!(seen.psi < 0))
    return ric_fail(error, RIC_ENUMERIC, "the gap is %.3g at a state %.3g beyond grazing, expected a negative gap",
                    seen.psi, depth);
  RIC_TRY(run_on(w, error));
  const double y = sqrt(-seen.psi);
  for (size_t j = 0; j < k->size; j++) {
    double along = -depth * w->smooth[j];
    for (size_t i = 0; i < k->state; i++)
      along += k->basis[j * k->state + i] * w->difference[i];
    row[j] = (along / y - w->map->stretch * w->map->xi[j]) / y;
  }
  return RIC_OK;
}

/* The next order of Neville's scheme, in place from the last row. The best entry is the one that differs least from the
 * coarser of the two entries it is computed from: beyond it rounding dominates. */
static void raise_order(second *w, int order, double *error) {
  const size_t size = w->k->size;
  for (size_t i = TRIALS - 1; i >= (size_t)order; i--) {
    double *fine = w->rows + i * size, most = 0;
    const double *coarse = fine - size;
    for (size_t j = 0; j < size; j++) {
      const double change = (fine[j] - coarse[j]) / (ldexp(1, order) - 1);
      most = fmax(most, fabs(fine[j] + change - coarse[j]));
      fine[j] += change;
    }
    if (most < *error) {
      *error = most;
      memcpy(w->best, fine, size * sizeof *fine);
    }
  }
}

/* Extrapolates from a given largest y. */
static ric_status extrapolate(second *w, double most, double *kappa, ric_error *error) {
  double change = INFINITY;
  for (int i = 0; i < TRIALS; i++)
    RIC_TRY(try(w, ldexp(most * most, -2 * i), w->rows + (size_t)i * w->k->size, error));
  for (int order = 1; order < TRIALS; order++)
    raise_order(w, order, &change);
  if (!(change < INFINITY))
    return ric_fail(error, RIC_ENUMERIC, "motions near the grazing one overflow before they return");
  memcpy(kappa, w->best, w->k->size * sizeof *kappa);
  return RIC_OK;
}

/* Motions that start too far from grazing may miss the section, or hit the obstacle again: then with a smaller y. */
static ric_status approach(second *w, double *kappa, ric_error *error) {
  double most = largest_y * sqrt(w->k->g->local.acceleration) * w->k->g->period / two_pi;
  ric_status status = extrapolate(w, most, kappa, error);
  for (int i = 0; status == RIC_ENUMERIC && i < MOST_APPROACHES; i++)
    status = extrapolate(w, most /= 4, kappa, error);
  return status;
}

/** kappa of the map; `matrix` is still the derivative from the grazing point to the section. */
static ric_status section_second(const section *k, ric_grazing_map *map, ric_error *error) {
  second w = {.k = k, .map = map};
  ric_status status = open(&w, error);
  if (status == RIC_OK)
    status = begin_second(&w, error);
  if (status == RIC_OK)
    status = approach(&w, map->kappa, error);
  close(&w);
  return status;
}

/* The coefficients of the return map on a section.
 *
 * Small differences (dx, dt) of a state and its time propagate along the motion as dx - F dt at one time: from time a
 * to b, with the derivative Y of the state at b by that at a,
 *
 *   (dx, dt) -> (Y (dx - F(a) dt) + F(b) dt, dt).
 *
 * Without forcing dt is omitted. */

/* Crossings at a smaller angle are rejected. */
static const double least_angle = 1e-8;

/* Sections closer than this to an impact, relative to the period, are at the impact. */
static const double impact_tol = 1e-9;

static bool is_forced(const ric_family *f) {
  return f->problem.motion.kind == RIC_MOTION_FORCED;
}

size_t ric_grazing_coordinates(const ric_grazing *g, const ric_shooting *s) {
  return s->arcs.kind == RIC_MOTION_FORCED ? g->numbers : g->numbers - 1;
}

static ric_status allocate_section(section *k, ric_error *error) {
  const size_t n = k->numbers, s = k->state;
  size_t used = 0;
  double *block = k->block = calloc(n * n + n + (4 + k->size) * s, sizeof *block);
  if (!block)
    return ric_fail(error, RIC_ENOMEM, "no memory for a section of %zu numbers", s);
  k->matrix = number_block_take(block, &used, n * n);
  k->x = number_block_take(block, &used, n);
  k->normal = number_block_take(block, &used, s);
  k->rates = number_block_take(block, &used, s);
  k->from = number_block_take(block, &used, s);
  k->goes = number_block_take(block, &used, s);
  k->basis = number_block_take(block, &used, k->size * s);
  return RIC_OK;
}

/* --- the section --- */

/* F at the state on the section. */
static ric_status read_rates(section *k, ric_error *error) {
  const ric_system *s = k->f->problem.system;
  const size_t n = s->coordinates;
  RIC_TRY(ric_shooting_transfer(k->f->shooting, k->g->z, k->g->given, k->time, k->time, k->x, NULL, error));
  RIC_TRY(ric_system_rate(s, k->time, k->x, k->x + n, k->rates, k->rates + n, error));
  if (k->forced)
    k->rates[k->numbers] = 1;
  return RIC_OK;
}

/* Largest speed at which a motion with rates of this size crosses the section. The rate of time, 1, has another unit
 * and is treated separately. */
static double fastest(const section *k) {
  const double *normal = k->normal, *rates = k->rates;
  const double still = sqrt(dot(normal, normal, k->numbers)), speed = sqrt(dot(rates, rates, k->numbers));
  return still * speed + (k->forced ? fabs(normal[k->numbers]) : 0);
}

static ric_status set_normal(section *k, const double *given, ric_error *error) {
  if (given)
    memcpy(k->normal, given, k->state * sizeof *given);
  else if (k->forced)
    k->normal[k->numbers] = 1;
  else
    memcpy(k->normal, k->rates, k->state * sizeof *k->rates);
  const double length = sqrt(dot(k->normal, k->normal, k->state));
  if (!(length > 0 && length < INFINITY))
    return ric_fail(error, RIC_EINVAL, "plane.normal of length %g, expected finite numbers, not all zero", length);
  for (size_t i = 0; i < k->state; i++)
    k->normal[i] /= length;
  const double angle = dot(k->normal, k->rates, k->state) / fastest(k);
  if (fabs(angle) > least_angle)
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL,
                  "plane.normal: the motion crosses the section at t = %g with the sine %.3g, expected more than %g",
                  k->time, angle, least_angle);
}

/* All but the last rows of the Householder reflection that maps the normal to the last unit vector: unit vectors for a
 * stroboscopic section. */
static void set_basis(section *k) {
  const size_t last = k->state - 1;
  const double sign =
      k->normal[last] < 0 ? -1 : 1; /* to plus or minus the unit vector on its side, so that v is not small */
  for (size_t j = 0; j < k->size; j++)
    for (size_t i = 0; i < k->state; i++) {
      const double vi = k->normal[i] + (i == last ? sign : 0), vj = k->normal[j];
      k->basis[j * k->state + i] = (i == j ? 1 : 0) - vi * vj / (1 + sign * k->normal[last]);
    }
}

/* --- the coefficients --- */

/* Accuracy of what is integrated along the motion, relative to the largest numbers on the way. */
static const double integrated_tol = 1e-12;

static double length(const double *x, size_t count) {
  return sqrt(dot(x, x, count));
}

static ric_status transfer(section *k, double from, double to, ric_error *error) {
  return ric_shooting_transfer(k->f->shooting, k->g->z, k->g->given, from, to, k->x, k->matrix, error);
}

/* A vector at the section, at one time. */
static void at_one_time(const section *k, const double *vector, double *x) {
  const double late = k->forced ? vector[k->numbers] : 0;
  for (size_t i = 0; i < k->numbers; i++)
    x[i] = vector[i] - late * k->rates[i];
}

static void multiply(const section *k, const double *x, double *y) {
  for (size_t i = 0; i < k->numbers; i++)
    y[i] = dot(k->matrix + i * k->numbers, x, k->numbers);
}

/* One period later the rates are those of the start. */
static ric_status set_L(section *k, double *L, ric_error *error) {
  RIC_TRY(transfer(k, k->time, k->time + k->g->period, error));
  for (size_t j = 0; j < k->size; j++) {
    const double *vector = k->basis + j * k->state, late = k->forced ? vector[k->numbers] : 0;
    at_one_time(k, vector, k->from);
    multiply(k, k->from, k->goes);
    for (size_t i = 0; k->forced && i < k->numbers; i++)
      k->goes[i] += late * k->rates[i];
    if (k->forced)
      k->goes[k->numbers] = late;
    section_project(k, k->goes, k->from);
    for (size_t i = 0; i < k->size; i++)
      L[i * k->size + j] = k->from[i];
  }
  return RIC_OK;
}

/* The minimum of the gap does not depend on its time: eta acts on differences at one time. */
static ric_status set_eta(section *k, ric_grazing_map *map, ric_error *error) {
  double *eta = map->eta;
  map->eta_error = 0;
  RIC_TRY(transfer(k, k->time, k->grazing_time, error));
  for (size_t j = 0; j < k->size; j++) {
    at_one_time(k, k->basis + j * k->state, k->from);
    multiply(k, k->from, k->goes);
    eta[j] = dot(k->g->local.eta, k->goes, k->numbers);
    map->eta_error = fmax(map->eta_error, integrated_tol * length(k->g->local.eta, k->numbers) *
                                              length(k->matrix, k->numbers * k->numbers) * length(k->from, k->numbers));
  }
  return RIC_OK;
}

/* Image on the section of what the discontinuity mapping adds at the grazing point. */
static void set_after(section *k, const double *added, double *z) {
  memset(k->goes, 0, k->state * sizeof *k->goes);
  multiply(k, added, k->goes);
  section_project(k, k->goes, z);
}

/* Sets all coefficients except kappa. */
static ric_status set_map(section *k, ric_grazing_map *map, ric_error *error) {
  const ric_grazing *g = k->g;
  RIC_TRY(set_L(k, map->L, error));
  RIC_TRY(set_eta(k, map, error));
  RIC_TRY(transfer(k, k->grazing_time, k->time + g->period, error));
  set_after(k, g->local.xi, map->xi);
  map->xi_error = integrated_tol * length(k->matrix, k->numbers * k->numbers) * length(g->local.xi, k->numbers) *
                  (1 + length(k->rates, k->state) / fabs(dot(k->normal, k->rates, k->state)));
  map->stretch = sqrt(2 * g->local.acceleration);
  return RIC_OK;
}

/* Whether neighbouring motions are on different sides of an impact there. */
static bool is_at_impact(const section *k, double time) {
  const arc_plan *arcs = &k->f->shooting->arcs;
  for (size_t i = 0; i < arcs->sequence_count; i++) {
    const double apart = remainder(time - arcs_time(arcs->impacts[i], k->g->z, k->g->period), k->g->period);
    if (fabs(apart) <= impact_tol * k->g->period)
      return true;
  }
  return false;
}

static ric_status check_map(const section *k, const ric_grazing_map *map, ric_error *error) {
  if (k->f->problem.motion.kind == RIC_MOTION_EVEN)
    return ric_fail(error, RIC_EINVAL, "motion.kind = even, expected forced, autonomous or conservative");
  if (map->size != k->size)
    return ric_fail(error, RIC_EINVAL, "map.size = %zu, expected %zu", map->size, k->size);
  if (!(k->time >= 0 && k->time < k->g->period))
    return ric_fail(error, RIC_EINVAL, "plane.time = %g, expected 0 <= time < %g, the period", k->time, k->g->period);
  if (is_at_impact(k, k->time))
    return ric_fail(error, RIC_EINVAL, "plane.time = %.9g, at which the motion has an impact, expected another",
                    k->time);
  return RIC_OK;
}

ric_status section_open(section *k, ric_family *f, const ric_grazing *g, const ric_grazing_plane *plane,
                        ric_grazing_map *map, ric_error *error) {
  *k = (section){.g = g, .f = f, .forced = is_forced(f), .numbers = g->numbers};
  k->time = plane ? plane->time : is_at_impact(k, 0) ? g->time : 0;
  k->state = g->numbers + (k->forced ? 1 : 0);
  k->size = k->state - 1;
  k->grazing_time = g->time >= k->time ? g->time : g->time + g->period; /* after the section */
  RIC_TRY(check_map(k, map, error));
  family_forget(f);
  RIC_TRY(family_set(f, g->parameter, g->second, error));
  RIC_TRY(allocate_section(k, error));
  RIC_TRY(read_rates(k, error));
  RIC_TRY(set_normal(k, plane ? plane->normal : NULL, error));
  set_basis(k);
  return set_map(k, map, error);
}

void section_close(section *k) {
  free(k->block);
  k->block = NULL;
}

ric_status ric_grazing_section(ric_family *f, const ric_grazing *g, const ric_grazing_plane *plane,
                               ric_grazing_map *map, double *basis, ric_error *error) {
  REQUIRE(error, {"family", f}, {"grazing", g}, {"map", map});
  section k;
  ric_status status = section_open(&k, f, g, plane, map, error);
  if (status == RIC_OK)
    status = section_second(&k, map, error);
  if (status == RIC_OK && basis)
    memcpy(basis, k.basis, k.size * k.state * sizeof *basis);
  section_close(&k);
  return status;
}
