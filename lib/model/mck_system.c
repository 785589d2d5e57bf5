#include "mck_system.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mck_hold.h"
#include "mck_mass.h"
#include "mck_tangent.h"

double mck_mobility(const mck_system *s, size_t i) {
  return s->inverse[s->base.uncoupled ? i : i * s->base.coordinates + i];
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
  return forcing(s, i, cos(s->frequency * t), sin(s->frequency * t)) - mck_rows_dot(&s->stiffness, i, q) -
         mck_rows_dot(&s->damping, i, u);
}

static void free_accelerations(const mck_system *s, const unsigned char *contact, double t, const double *q,
                               const double *u, double *acceleration) {
  double cosine = cos(s->frequency * t), sine = sin(s->frequency * t);
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

/* A diagonal mass: the force on one coordinate is minus the free one, and contacts there share it. */
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
  return mck_of(s)->mass[coordinate]; /* asked of diagonal ones */
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

/* Makes the numbers of a model that has been checked; release them whatever the status. */
static ric_status make(mck_system *s, const ric_mck *mck, ric_error *error) {
  s->frequency = mck->frequency;
  RIC_TRY(mck_rows_copy(&s->springs, &mck->stiffness, mck->coordinates, NULL, error));
  return mck_divide_by_mass(s, mck, error);
}

ric_status ric_system_create_mck(const ric_mck *mck, const ric_obstacle *obstacles, size_t count, ric_system **system,
                                 ric_error *error) {
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
  if (system->taylor != SYSTEM_MCK)
    return ric_fail(error, RIC_EINVAL,
                    "an M-C-K model for a system of another kind, expected one made of such a model");
  RIC_TRY(ric_mck_check(mck, error));
  if (mck->coordinates != system->coordinates)
    return ric_fail(error, RIC_EINVAL, "coordinates = %zu, expected %zu as the system was made", mck->coordinates,
                    system->coordinates);
  mck_system *s = (mck_system *)system, made = {.base = s->base}, before = *s;
  ric_status status = make(&made, mck, error);
  if (status == RIC_OK) {
    made.base.revision++;
    *s = made;
  }
  release(status == RIC_OK ? &before : &made);
  return status;
}
