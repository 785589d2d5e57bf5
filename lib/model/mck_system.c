/* M-C-K systems: models that are checked, contacts that hold coordinates, derivatives, and the system. */
#include "mck_system.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "ricochet/elementary.h"
#include "ricochet/mck.h"
#include "numeric/required.h"

/* Entries of a computed mass matrix differ by rounding from those of its transpose; larger differences are errors. */
static const double symmetry_tol = 1e-12;

static ric_status check_dense(const char *name, const double *a, size_t n, ric_error *error) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      if (!isfinite(a[i * n + j]))
        return ric_fail(error, RIC_EINVAL, "%s[%zu][%zu] = %g, expected a finite number", name, i, j, a[i * n + j]);
  return RIC_OK;
}

static ric_status check_row(const char *name, const ric_matrix *a, size_t i, size_t n, ric_error *error) {
  if (a->row_start[i + 1] < a->row_start[i])
    return ric_fail(error, RIC_EINVAL, "%s: row_start[%zu] = %zu, expected at least row_start[%zu] = %zu", name, i + 1,
                    a->row_start[i + 1], i, a->row_start[i]);
  for (size_t k = a->row_start[i]; k < a->row_start[i + 1]; k++) {
    if (a->column[k] >= n)
      return ric_fail(error, RIC_EINVAL, "%s: column[%zu] = %zu in row %zu, expected less than %zu", name, k,
                      a->column[k], i, n);
    if (!isfinite(a->values[k]))
      return ric_fail(error, RIC_EINVAL, "%s[%zu][%zu] = %g, expected a finite number", name, i, a->column[k],
                      a->values[k]);
  }
  return RIC_OK;
}

static ric_status check_matrix(const char *name, const ric_matrix *a, size_t n, ric_error *error) {
  if (!a->values)
    return RIC_OK;
  if (!a->row_start)
    return check_dense(name, a->values, n, error);
  if (!a->column)
    return ric_fail(error, RIC_EINVAL, "%s: column = NULL, expected the columns of the entries", name);
  for (size_t i = 0; i < n; i++)
    RIC_TRY(check_row(name, a, i, n, error));
  return RIC_OK;
}

static ric_status check_symmetric(const double *m, size_t n, ric_error *error) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++)
      if (!(fabs(m[i * n + j] - m[j * n + i]) <= symmetry_tol * sqrt(fabs(m[i * n + i] * m[j * n + j]))))
        return ric_fail(error, RIC_EINVAL, "mass[%zu][%zu] = %g and mass[%zu][%zu] = %g, expected a symmetric matrix",
                        i, j, m[i * n + j], j, i, m[j * n + i]);
  return RIC_OK;
}

static ric_status check_diagonal(const ric_matrix *m, size_t n, ric_error *error) {
  for (size_t i = 0; i < n; i++) {
    double mass = 0;
    for (size_t k = m->row_start[i]; k < m->row_start[i + 1]; k++) {
      if (m->column[k] != i)
        return ric_fail(error, RIC_EINVAL, "mass[%zu][%zu] = %g in a sparse matrix, expected diagonal entries only", i,
                        m->column[k], m->values[k]);
      mass += m->values[k];
    }
    if (!(mass > 0 && mass < INFINITY))
      return ric_fail(error, RIC_EINVAL, "mass[%zu][%zu] = %g, expected > 0", i, i, mass);
  }
  return RIC_OK;
}

static ric_status check_vector(const char *name, const double *x, size_t n, ric_error *error) {
  for (size_t i = 0; x && i < n; i++)
    if (!isfinite(x[i]))
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected a finite number", name, i, x[i]);
  return RIC_OK;
}

ric_status ric_mck_check(const ric_mck *mck, ric_error *error) {
  REQUIRE(error, {"mck", mck});
  size_t n = mck->coordinates;
  if (n < 1)
    return ric_fail(error, RIC_EINVAL, "coordinates = 0, expected at least 1");
  if (!mck->mass.values)
    return ric_fail(error, RIC_EINVAL, "mass: values = NULL, expected a positive definite matrix");
  RIC_TRY(check_matrix("mass", &mck->mass, n, error));
  RIC_TRY(check_matrix("damping", &mck->damping, n, error));
  RIC_TRY(check_matrix("stiffness", &mck->stiffness, n, error));
  RIC_TRY(mck->mass.row_start ? check_diagonal(&mck->mass, n, error) : check_symmetric(mck->mass.values, n, error));
  if (!isfinite(mck->frequency))
    return ric_fail(error, RIC_EINVAL, "frequency = %g, expected a finite number", mck->frequency);
  RIC_TRY(check_vector("force_cos", mck->force_cos, n, error));
  return check_vector("force_sin", mck->force_sin, n, error);
}

/* Only rigid obstacles hold coordinates; without contact states any of them may. */
static int may_hold(const ric_system *s, const unsigned char *contact, size_t obstacle) {
  return isinf(s->obstacles[obstacle].stiffness) && (!contact || contact[obstacle] == CONTACT_HELD);
}

static size_t coordinates_to_hold(const ric_system *s, const unsigned char *contact) {
  size_t count = 0, last = SIZE_MAX;
  for (size_t k = 0; k < s->obstacle_count; k++) {
    size_t coordinate = s->obstacles[s->by_coordinate[k]].coordinate;
    if (!may_hold(s, contact, s->by_coordinate[k]) || coordinate == last)
      continue;
    last = coordinate;
    count++;
  }
  return count;
}

int mck_hold_init(mck_hold *hold, const mck_system *s, const unsigned char *contact) {
  size_t size = coordinates_to_hold(&s->base, contact), room = size ? size : 1;
  *hold = (mck_hold){0};
  hold->coordinate = malloc(room * sizeof *hold->coordinate);
  hold->sharing = malloc(room * sizeof *hold->sharing);
  hold->force = malloc(room * sizeof *hold->force);
  hold->order = malloc(room * sizeof *hold->order);
  if (!s->base.uncoupled)
    hold->factor = malloc(room * room * sizeof *hold->factor); /* M itself is no smaller */
  return hold->coordinate && hold->sharing && hold->force && hold->order && (s->base.uncoupled || hold->factor);
}

void mck_hold_clear(mck_hold *hold) {
  free(hold->coordinate);
  free(hold->sharing);
  free(hold->force);
  free(hold->order);
  free(hold->factor);
  *hold = (mck_hold){0};
}

static void collect(mck_hold *hold, const ric_system *s, const unsigned char *contact) {
  hold->count = 0;
  for (size_t k = 0; k < s->obstacle_count; k++) {
    size_t obstacle = s->by_coordinate[k], coordinate = s->obstacles[obstacle].coordinate;
    if (!may_hold(s, contact, obstacle))
      continue;
    if (hold->count > 0 && hold->coordinate[hold->count - 1] == coordinate) {
      hold->sharing[hold->count - 1]++;
      continue;
    }
    hold->coordinate[hold->count] = coordinate;
    hold->sharing[hold->count++] = 1;
  }
}

/* Pivoted, because GSL's plain Cholesky calls its error handler where a matrix is not positive definite. */
static const char *factorise_held(mck_hold *hold, const mck_system *s) {
  size_t size = hold->count, n = s->base.coordinates;
  for (size_t i = 0; i < size; i++)
    for (size_t j = 0; j < size; j++)
      hold->factor[i * size + j] = s->inverse[hold->coordinate[i] * n + hold->coordinate[j]];
  gsl_matrix_view a = gsl_matrix_view_array(hold->factor, size, size);
  gsl_permutation p = {.size = size, .data = hold->order};
  gsl_linalg_pcholesky_decomp(&a.matrix, &p);
  for (size_t i = 0; i < size; i++)
    if (!(hold->factor[i * size + i] > 0))
      return "the inverse of the mass matrix is not positive definite at the held coordinates";
  return NULL;
}

const char *mck_hold_set(mck_hold *hold, const mck_system *s, const unsigned char *contact) {
  collect(hold, &s->base, contact);
  return s->base.uncoupled || hold->count == 0 ? NULL : factorise_held(hold, s);
}

static void find_forces(mck_hold *hold, const mck_system *s, const double *acceleration) {
  for (size_t k = 0; k < hold->count; k++)
    hold->force[k] = -acceleration[hold->coordinate[k]];
  if (s->base.uncoupled) {
    for (size_t k = 0; k < hold->count; k++)
      hold->force[k] *= s->mass[hold->coordinate[k]];
    return;
  }
  gsl_matrix_view a = gsl_matrix_view_array(hold->factor, hold->count, hold->count);
  gsl_vector_view x = gsl_vector_view_array(hold->force, hold->count);
  gsl_permutation p = {.size = hold->count, .data = hold->order};
  gsl_linalg_pcholesky_svx(&a.matrix, &p, &x.vector);
}

void mck_push(const mck_system *s, size_t i, double force, double *acceleration) {
  size_t n = s->base.coordinates;
  if (s->base.uncoupled) {
    acceleration[i] += s->inverse[i] * force;
    return;
  }
  for (size_t k = 0; k < n; k++)
    acceleration[k] += s->inverse[i * n + k] * force;
}

void mck_hold_project(mck_hold *hold, const mck_system *s, double *acceleration) {
  if (hold->count == 0)
    return;
  find_forces(hold, s, acceleration);
  for (size_t k = 0; k < hold->count; k++)
    mck_push(s, hold->coordinate[k], hold->force[k], acceleration);
  for (size_t k = 0; k < hold->count; k++)
    acceleration[hold->coordinate[k]] = 0;
}

size_t mck_hold_find(const mck_hold *hold, size_t coordinate) {
  size_t low = 0, high = hold->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (hold->coordinate[middle] < coordinate)
      low = middle + 1;
    else
      high = middle;
  }
  return low < hold->count && hold->coordinate[low] == coordinate ? low : hold->count;
}

/* The linearised forces of M-C-K systems. */

/* Accelerations [n] along one tangent vector, contacts not held. */
static void accelerate(const mck_system *s, const unsigned char *contact, const double *q, const double *d_q,
                       const double *d_u, double *acceleration) {
  memset(acceleration, 0, s->base.coordinates * sizeof *acceleration);
  mck_rows_apply(&s->stiffness, -1, d_q, acceleration);
  mck_rows_apply(&s->damping, -1, d_u, acceleration);
  for (size_t j = 0; j < s->base.obstacle_count; j++) {
    const ric_obstacle *o = &s->base.obstacles[j];
    size_t i = o->coordinate;
    if (isfinite(o->stiffness) && (!contact || contact[j] == CONTACT_PRESSED))
      mck_push(s, i, -hertz_stiffness(o->stiffness, ric_obstacle_gap(o, q[i])) * d_q[i], acceleration);
  }
}

/* @param work  [3][n] */
static void column(const mck_system *s, const unsigned char *contact, mck_hold *hold, const double *q,
                   const tangents *d, size_t k, const tangents *d_rate, double *work) {
  size_t n = s->base.coordinates, columns = d->columns;
  double *d_q = work, *d_u = work + n, *acceleration = work + 2 * n;
  for (size_t i = 0; i < n; i++) {
    d_q[i] = d->q[i * columns + k];
    d_u[i] = d->u[i * columns + k];
  }
  accelerate(s, contact, q, d_q, d_u, acceleration);
  mck_hold_project(hold, s, acceleration);
  for (size_t i = 0; i < n; i++) {
    d_rate->q[i * columns + k] = d_u[i];
    d_rate->u[i * columns + k] = acceleration[i];
  }
}

/** The table's `tangent`. */
static const char *mck_tangent(const ric_system *base, const unsigned char *contact, double t, const double *q,
                               const double *u, const tangents *d, const tangents *d_rate) {
  (void)t;
  (void)u;
  const mck_system *s = mck_of(base);
  mck_hold hold = {0};
  double *work = malloc(3 * base->coordinates * sizeof *work);
  bool held = contact && base->obstacle_count && memchr(contact, CONTACT_HELD, base->obstacle_count);
  const char *trouble = work && (!held || mck_hold_init(&hold, s, contact)) ? NULL : "no memory for contacts";
  if (!trouble && held)
    trouble = mck_hold_set(&hold, s, contact);
  for (size_t k = 0; !trouble && k < d->columns; k++)
    column(s, contact, &hold, q, d, k, d_rate, work);
  mck_hold_clear(&hold);
  free(work);
  return trouble;
}

double mck_mobility(const mck_system *s, size_t i) {
  return s->inverse[s->base.uncoupled ? i : i * s->base.coordinates + i];
}

static double forcing(const mck_system *s, size_t i, double cosine, double sine) {
  return (s->force_cos ? s->force_cos[i] * cosine : 0) + (s->force_sin ? s->force_sin[i] * sine : 0);
}

/* Force that a compliant contact puts on its coordinate. */
static double pressure(const ric_obstacle *o, const unsigned char *contact, size_t obstacle, const double *q) {
  if (isinf(o->stiffness) || (contact && contact[obstacle] != CONTACT_PRESSED))
    return 0;
  return o->side * hertz_force(o->stiffness, ric_obstacle_gap(o, q[o->coordinate]));
}

static double free_acceleration(const mck_system *s, size_t i, double t, const double *q, const double *u) {
  double cosine, sine;
  ric_sincos(s->frequency * t, &sine, &cosine);
  return forcing(s, i, cosine, sine) - mck_rows_dot(&s->stiffness, i, q) - mck_rows_dot(&s->damping, i, u);
}

static void free_accelerations(const mck_system *s, const unsigned char *contact, double t, const double *q,
                               const double *u, double *acceleration) {
  double cosine, sine;
  ric_sincos(s->frequency * t, &sine, &cosine);
  for (size_t i = 0; i < s->base.coordinates; i++)
    acceleration[i] = forcing(s, i, cosine, sine);
  mck_rows_apply(&s->stiffness, -1, q, acceleration);
  mck_rows_apply(&s->damping, -1, u, acceleration);
  for (size_t j = 0; j < s->base.obstacle_count; j++) {
    const ric_obstacle *o = &s->base.obstacles[j];
    double force = pressure(o, contact, j, q);
    if (force != 0)
      mck_push(s, o->coordinate, force, acceleration);
  }
}

static int holds(const ric_system *s, const unsigned char *contact) {
  return contact && s->obstacle_count && memchr(contact, CONTACT_HELD, s->obstacle_count) != NULL;
}

static const char *mck_rate(const ric_system *base, const unsigned char *contact, double t, const double *q,
                            const double *u, double *q_rate, double *u_rate) {
  const mck_system *s = mck_of(base);
  free_accelerations(s, contact, t, q, u, u_rate);
  memmove(q_rate, u, base->coordinates * sizeof *q_rate);
  if (!holds(base, contact))
    return NULL;
  mck_hold hold;
  const char *trouble = mck_hold_init(&hold, s, contact) ? mck_hold_set(&hold, s, contact) : "no memory for contacts";
  if (!trouble)
    mck_hold_project(&hold, s, u_rate);
  mck_hold_clear(&hold);
  return trouble;
}

static const char *mck_direction(const ric_system *base, size_t obstacle, double t, const double *q,
                                 contact_direction *d) {
  (void)t;
  (void)q;
  const mck_system *s = mck_of(base);
  const ric_obstacle *o = &base->obstacles[obstacle];
  size_t n = base->coordinates, i = o->coordinate;
  d->first = base->uncoupled ? i : 0;
  d->count = base->uncoupled ? 1 : n;
  d->offset = 0;
  for (size_t k = 0; k < d->count; k++) {
    d->g[k] = d->first + k == i ? o->side : 0;
    d->w[k] = o->side * (base->uncoupled ? s->inverse[i] : s->inverse[i * n + k]);
  }
  return NULL;
}

/* Diagonal mass matrix: the contact force on a coordinate is minus the free force, and contacts there share it. */
static double own_reaction(const mck_system *s, const unsigned char *contact, size_t obstacle, double t,
                           const double *q, const double *u) {
  size_t i = s->base.obstacles[obstacle].coordinate;
  double force = s->mass[i] * free_acceleration(s, i, t, q, u), sharing = 0;
  for (size_t k = system_first_obstacle(&s->base, i); k < s->base.obstacle_count; k++) {
    size_t other = s->base.by_coordinate[k];
    const ric_obstacle *o = &s->base.obstacles[other];
    if (o->coordinate != i)
      break;
    force += pressure(o, contact, other, q);
    sharing += contact[other] == CONTACT_HELD;
  }
  return -s->base.obstacles[obstacle].side * force / sharing;
}

static const char *coupled_reaction(const mck_system *s, const unsigned char *contact, size_t obstacle, double t,
                                    const double *q, const double *u, double *lambda) {
  const ric_obstacle *o = &s->base.obstacles[obstacle];
  mck_hold hold;
  double *acceleration = malloc(s->base.coordinates * sizeof *acceleration);
  const char *trouble = mck_hold_init(&hold, s, contact) && acceleration ? NULL : "no memory for contacts";
  if (!trouble)
    trouble = mck_hold_set(&hold, s, contact);
  if (!trouble) {
    free_accelerations(s, contact, t, q, u, acceleration);
    mck_hold_project(&hold, s, acceleration);
    size_t k = mck_hold_find(&hold, o->coordinate);
    *lambda = o->side * hold.force[k] / (double)hold.sharing[k];
  }
  mck_hold_clear(&hold);
  free(acceleration);
  return trouble;
}

static const char *mck_reaction(const ric_system *base, const unsigned char *contact, size_t obstacle, double t,
                                const double *q, const double *u, double *lambda) {
  if (contact[obstacle] != CONTACT_HELD) {
    *lambda = 0;
    return NULL;
  }
  if (!base->uncoupled)
    return coupled_reaction(mck_of(base), contact, obstacle, t, q, u, lambda);
  *lambda = own_reaction(mck_of(base), contact, obstacle, t, q, u);
  return NULL;
}

static double kinetic(const mck_system *s, const double *u) {
  size_t n = s->base.coordinates;
  double twice = 0;
  for (size_t i = 0; i < n; i++) {
    double momentum = s->base.uncoupled ? s->mass[i] * u[i] : 0;
    for (size_t k = 0; !s->base.uncoupled && k < n; k++)
      momentum += s->mass[i * n + k] * u[k];
    twice += momentum * u[i];
  }
  return twice / 2;
}

static const char *mck_energy(const ric_system *base, double t, const double *q, const double *u, double *energy) {
  (void)t;
  const mck_system *s = mck_of(base);
  double sum = kinetic(s, u);
  for (size_t i = 0; i < base->coordinates; i++)
    sum += q[i] * mck_rows_dot(&s->springs, i, q) / 2;
  for (size_t j = 0; j < base->obstacle_count; j++) {
    const ric_obstacle *o = &base->obstacles[j];
    if (isfinite(o->stiffness))
      sum += hertz_energy(o->stiffness, ric_obstacle_gap(o, q[o->coordinate]));
  }
  *energy = sum;
  return NULL;
}

/* Frees the numbers. */
static void release(mck_system *s) {
  free(s->mass);
  free(s->inverse);
  free(s->force_cos);
  free(s->force_sin);
  mck_rows_clear(&s->damping);
  mck_rows_clear(&s->stiffness);
  mck_rows_clear(&s->springs);
}

static void mck_destroy(ric_system *base) {
  mck_system *s = (mck_system *)base;
  release(s);
  free(s);
}

static double mck_mass(const ric_system *s, size_t coordinate) {
  return mck_of(s)->mass[coordinate]; /* called for diagonal mass matrices only */
}

static bool mck_forced(const ric_system *s) {
  return mck_of(s)->force_cos || mck_of(s)->force_sin;
}

static bool mck_repeats(const ric_system *s, double time) {
  return !mck_forced(s) || frequency_repeats(mck_of(s)->frequency, time);
}

static const system_model mck_model = {.rate = mck_rate,
                                       .tangent = mck_tangent,
                                       .gap = obstacle_gap,
                                       .gap_derivative = obstacle_gap_derivative,
                                       .gap_rate = obstacle_gap_rate,
                                       .gap_acceleration = obstacle_gap_acceleration,
                                       .direction = mck_direction,
                                       .reaction = mck_reaction,
                                       .energy = mck_energy,
                                       .restitution = obstacle_restitution,
                                       .mass = mck_mass,
                                       .forced = mck_forced,
                                       .repeats = mck_repeats,
                                       .destroy = mck_destroy};

/* Creates the numbers of a model that has been checked; release them for every status. */
static ric_status make(mck_system *s, const ric_mck *mck, ric_error *error) {
  s->frequency = mck->frequency;
  RIC_TRY(mck_rows_copy(&s->springs, &mck->stiffness, mck->coordinates, NULL, error));
  return mck_divide_by_mass(s, mck, error);
}

ric_status ric_system_create_mck(const ric_mck *mck, const ric_obstacle *obstacles, size_t count, ric_system **system,
                                 ric_error *error) {
  REQUIRE(error, {"mck", mck}, {"obstacles", unless_empty(count, obstacles)}, {"system", system});
  *system = NULL;
  RIC_TRY(ric_mck_check(mck, error));
  mck_system *s = calloc(1, sizeof *s);
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a system of %zu coordinates", mck->coordinates);
  s->base = (ric_system){
      .model = &mck_model, .taylor = SYSTEM_MCK, .coordinates = mck->coordinates, .speeds = mck->coordinates};
  ric_status status = system_take_obstacles(&s->base, obstacles, count, error);
  if (status == RIC_OK)
    status = make(s, mck, error);
  *system = &s->base;
  if (status != RIC_OK)
    ric_system_destroy(system);
  return status;
}

ric_status ric_system_set_mck(ric_system *system, const ric_mck *mck, ric_error *error) {
  REQUIRE(error, {"system", system}, {"mck", mck});
  if (system->taylor != SYSTEM_MCK)
    return ric_fail(error, RIC_EINVAL,
                    "the system is not an M-C-K system, expected a system created from an M-C-K model");
  RIC_TRY(ric_mck_check(mck, error));
  if (mck->coordinates != system->coordinates)
    return ric_fail(error, RIC_EINVAL, "coordinates = %zu, expected %zu as at the creation of the system",
                    mck->coordinates, system->coordinates);
  mck_system *s = (mck_system *)system, made = {.base = s->base}, before = *s;
  ric_status status = make(&made, mck, error);
  if (status == RIC_OK) {
    made.base.revision++;
    *s = made;
  }
  release(status == RIC_OK ? &before : &made);
  return status;
}
