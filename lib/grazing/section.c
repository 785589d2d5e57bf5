/* The coefficients of the return map on a section.
 *
 * Small differences (dx, dt) of a state and its time go along the motion as dx - F dt at one time: from time a to b,
 * with Y the derivative of the state at b by that at a,
 *
 *   (dx, dt) -> (Y (dx - F(a) dt) + F(b) dt, dt).
 *
 * Without forcing dt is left out. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/number_block.h"
#include "section.h"

/* Flows that cross a section at an angle below it do not cross it. */
static const double least_angle = 1e-8;

/* Sections this near to an impact, over the period, are at it. */
static const double impact_tol = 1e-9;

static bool is_forced(const ric_family *f) {
  return f->problem.motion.kind == RIC_MOTION_FORCED;
}

size_t ric_grazing_coordinates(const ric_grazing *g, const ric_shooting *s) {
  return s->arcs.kind == RIC_MOTION_FORCED ? g->numbers : g->numbers - 1;
}

static ric_status allocate(section *k, ric_error *error) {
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

static double dot(const double *a, const double *b, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++)
    sum += a[i] * b[i];
  return sum;
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

/* How fast a motion with rates of this size crosses the section at most. The rate of time, 1, has another unit: it
 * stands by itself. */
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

/* The rows of Householder's reflection that takes the normal to the last unit vector, but the last: for a stroboscopic
 * section unit vectors. */
static void set_basis(section *k) {
  const size_t last = k->state - 1;
  const double sign = k->normal[last] < 0 ? -1 : 1; /* to +- the unit vector on whose side it lies: v is not small */
  for (size_t j = 0; j < k->size; j++)
    for (size_t i = 0; i < k->state; i++) {
      const double vi = k->normal[i] + (i == last ? sign : 0), vj = k->normal[j];
      k->basis[j * k->state + i] = (i == j ? 1 : 0) - vi * vj / (1 + sign * k->normal[last]);
    }
}

/* Coordinates of what is left of a vector [state] when it is moved along the flow onto the section. */
void section_project(const section *k, const double *vector, double *z) {
  const double along = dot(k->normal, vector, k->state) / dot(k->normal, k->rates, k->state);
  for (size_t j = 0; j < k->size; j++) {
    const double *row = k->basis + j * k->state;
    z[j] = dot(row, vector, k->state) - along * dot(row, k->rates, k->state);
  }
}

/* --- the coefficients --- */

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

/* A period later the rates are those of the start. */
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

/* Minima of the gap do not know when they are: eta sees differences at one time. */
static ric_status set_eta(section *k, double *eta, ric_error *error) {
  RIC_TRY(transfer(k, k->time, k->touch, error));
  for (size_t j = 0; j < k->size; j++) {
    at_one_time(k, k->basis + j * k->state, k->from);
    multiply(k, k->from, k->goes);
    eta[j] = dot(k->g->local.eta, k->goes, k->numbers);
  }
  return RIC_OK;
}

/* What the bypass map adds at the touch, on the section after it. */
static void set_after(section *k, const double *added, double *z) {
  memset(k->goes, 0, k->state * sizeof *k->goes);
  multiply(k, added, k->goes);
  section_project(k, k->goes, z);
}

/* All but kappa. */
static ric_status set_map(section *k, ric_grazing_map *map, ric_error *error) {
  const ric_grazing *g = k->g;
  RIC_TRY(set_L(k, map->L, error));
  RIC_TRY(set_eta(k, map->eta, error));
  RIC_TRY(transfer(k, k->touch, k->time + g->period, error));
  set_after(k, g->local.xi, map->xi);
  map->stretch = sqrt(2 * g->local.acceleration);
  return RIC_OK;
}

/* Neighbouring motions are on different sides of the impact there. */
static bool is_at_impact(const section *k, double time) {
  const arc_plan *arcs = &k->f->shooting->arcs;
  for (size_t i = 0; i < arcs->sequence_count; i++) {
    const double apart = remainder(time - arcs_time(arcs->impacts[i], k->g->z, k->g->period), k->g->period);
    if (fabs(apart) <= impact_tol * k->g->period)
      return true;
  }
  return false;
}

static ric_status check(const section *k, const ric_grazing_map *map, ric_error *error) {
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
  k->touch = g->time >= k->time ? g->time : g->time + g->period; /* on the way from the section */
  RIC_TRY(check(k, map, error));
  family_forget(f);
  RIC_TRY(family_set(f, g->parameter, g->second, error));
  RIC_TRY(allocate(k, error));
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
  section k;
  ric_status status = section_open(&k, f, g, plane, map, error);
  if (status == RIC_OK)
    status = section_second(&k, map, error);
  if (status == RIC_OK && basis)
    memcpy(basis, k.basis, k.size * k.state * sizeof *basis);
  section_close(&k);
  return status;
}
