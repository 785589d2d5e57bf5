#include "lattice_system.h"

#include <stdlib.h>
#include <string.h>

#include "lattice_force.h"
#include "lattice_tangent.h"

typedef struct lattice_system {
  ric_system base;
  ric_lattice lattice;
  double *masses, *force_cos, *force_sin; /* owned, NULL where no lattice of this system has had one */
  ric_spring *on_sites, *links;
} lattice_system;

const ric_lattice *lattice_system_lattice(const ric_system *system) {
  return &((const lattice_system *)(const void *)system)->lattice;
}

/* Force of a compliant obstacle on its coordinate: Hertz's law is zero where the gap is open. */
static double push(const ric_obstacle *o, double q) {
  return o->side * hertz_force(o->stiffness, ric_obstacle_gap(o, q));
}

/* Whether a compliant obstacle acts: by its state, or by the sign of its gap (in Hertz's law) when none are given. */
static bool presses(const ric_obstacle *o, const unsigned char *contact, size_t obstacle) {
  return contact ? contact[obstacle] == CONTACT_PRESSED : isfinite(o->stiffness);
}

static const char *rate(const ric_system *s, const unsigned char *contact, double t, const double *q, const double *u,
                        double *q_rate, double *u_rate) {
  const ric_lattice *lattice = lattice_system_lattice(s);
  size_t n = s->coordinates;
  memmove(q_rate, u, n * sizeof *u);
  ric_lattice_acceleration(lattice, t, q, u, u_rate);
  for (size_t j = 0; j < s->obstacle_count; j++) {
    const ric_obstacle *o = &s->obstacles[j];
    if (presses(o, contact, j))
      u_rate[o->coordinate] += push(o, q[o->coordinate]) / ric_lattice_mass(lattice, o->coordinate);
  }
  for (size_t j = 0; contact && j < s->obstacle_count; j++)
    if (contact[j] == CONTACT_HELD)
      q_rate[s->obstacles[j].coordinate] = u_rate[s->obstacles[j].coordinate] = 0;
  for (size_t i = 0; i < n; i++)
    if (!isfinite(u_rate[i]))
      return "an acceleration is not finite";
  return NULL;
}

static const char *tangent(const ric_system *s, const unsigned char *contact, double t, const double *q,
                           const double *u, const tangents *d, const tangents *d_rate) {
  (void)t;
  (void)u; /* no force depends on speeds and on anything else at once */
  const ric_lattice *lattice = lattice_system_lattice(s);
  size_t columns = d->columns, row = columns * sizeof *d->q;
  memmove(d_rate->q, d->u, s->coordinates * row);
  lattice_tangent(lattice, q, d, d_rate->u);
  for (size_t j = 0; j < s->obstacle_count; j++) {
    const ric_obstacle *o = &s->obstacles[j];
    size_t i = o->coordinate;
    double stiffness = presses(o, contact, j) ? hertz_stiffness(o->stiffness, ric_obstacle_gap(o, q[i])) : 0;
    for (size_t k = 0; stiffness != 0 && k < columns; k++)
      d_rate->u[i * columns + k] -= stiffness / ric_lattice_mass(lattice, i) * d->q[i * columns + k];
  }
  for (size_t j = 0; contact && j < s->obstacle_count; j++)
    if (contact[j] == CONTACT_HELD) {
      memset(d_rate->q + s->obstacles[j].coordinate * columns, 0, row);
      memset(d_rate->u + s->obstacles[j].coordinate * columns, 0, row);
    }
  return NULL;
}

static const char *direction(const ric_system *s, size_t obstacle, double t, const double *q, contact_direction *d) {
  const ric_obstacle *o = &s->obstacles[obstacle];
  (void)t;
  (void)q;
  d->first = o->coordinate;
  d->count = 1;
  d->g[0] = o->side;
  d->w[0] = o->side / ric_lattice_mass(lattice_system_lattice(s), o->coordinate);
  d->offset = 0;
  return NULL;
}

static const char *reaction(const ric_system *s, const unsigned char *contact, size_t obstacle, double t,
                            const double *q, const double *u, double *lambda) {
  const ric_obstacle *o = &s->obstacles[obstacle];
  size_t i = o->coordinate;
  double force = lattice_force(lattice_system_lattice(s), i, t, q, u);
  for (size_t k = system_first_obstacle(s, i); k < s->obstacle_count; k++) {
    size_t j = s->by_coordinate[k];
    if (s->obstacles[j].coordinate != i)
      break;
    if (presses(&s->obstacles[j], contact, j))
      force += push(&s->obstacles[j], q[i]);
  }
  *lambda = -o->side * force;
  return NULL;
}

static const char *energy(const ric_system *s, double t, const double *q, const double *u, double *value) {
  (void)t;
  double sum = ric_lattice_energy(lattice_system_lattice(s), q, u);
  for (size_t j = 0; j < s->obstacle_count; j++) {
    const ric_obstacle *o = &s->obstacles[j];
    if (isfinite(o->stiffness))
      sum += hertz_energy(o->stiffness, ric_obstacle_gap(o, q[o->coordinate]));
  }
  *value = sum;
  return NULL;
}

static double mass(const ric_system *s, size_t coordinate) {
  return ric_lattice_mass(lattice_system_lattice(s), coordinate);
}

static bool forced(const ric_system *s) {
  const ric_lattice *lattice = lattice_system_lattice(s);
  return lattice->force_cos || lattice->force_sin;
}

static bool repeats(const ric_system *s, double time) {
  return !forced(s) || frequency_repeats(lattice_system_lattice(s)->frequency, time);
}

static void destroy(ric_system *system) {
  lattice_system *s = (lattice_system *)(void *)system;
  free(s->masses);
  free(s->force_cos);
  free(s->force_sin);
  free(s->on_sites);
  free(s->links);
  free(s);
}

static const system_model model = {.rate = rate,
                                   .tangent = tangent,
                                   .gap = obstacle_gap,
                                   .gap_derivative = obstacle_gap_derivative,
                                   .gap_rate = obstacle_gap_rate,
                                   .gap_acceleration = obstacle_gap_acceleration,
                                   .direction = direction,
                                   .reaction = reaction,
                                   .energy = energy,
                                   .restitution = obstacle_restitution,
                                   .mass = mass,
                                   .forced = forced,
                                   .repeats = repeats,
                                   .destroy = destroy};

/* Room for an array that may be NULL; there stays what there was. False when there is no memory. */
static bool reserve_doubles(const double *given, size_t count, double **own) {
  if (given && !*own)
    *own = malloc(count * sizeof **own);
  return !given || *own;
}

static bool reserve_springs(const ric_spring *given, size_t count, ric_spring **own) {
  if (given && !*own)
    *own = malloc(count * sizeof **own);
  return !given || *own;
}

static const double *copy_doubles(const double *given, size_t count, double *own) {
  return given ? memcpy(own, given, count * sizeof *own) : NULL;
}

static const ric_spring *copy_springs(const ric_spring *given, size_t count, ric_spring *own) {
  return given ? memcpy(own, given, count * sizeof *own) : NULL;
}

/* Takes a lattice that has been checked; nothing has changed when there is no memory. */
static ric_status take(lattice_system *s, const ric_lattice *l, ric_error *error) {
  size_t n = l->particles;
  bool room = reserve_doubles(l->masses, n, &s->masses) && reserve_doubles(l->force_cos, n, &s->force_cos) &&
              reserve_doubles(l->force_sin, n, &s->force_sin) && reserve_springs(l->on_sites, n, &s->on_sites) &&
              reserve_springs(l->links, n + 1, &s->links);
  if (!room)
    return ric_fail(error, RIC_ENOMEM, "no memory for a lattice of %zu particles", n);
  s->lattice = *l;
  s->lattice.masses = copy_doubles(l->masses, n, s->masses);
  s->lattice.force_cos = copy_doubles(l->force_cos, n, s->force_cos);
  s->lattice.force_sin = copy_doubles(l->force_sin, n, s->force_sin);
  s->lattice.on_sites = copy_springs(l->on_sites, n, s->on_sites);
  s->lattice.links = copy_springs(l->links, n + 1, s->links);
  return RIC_OK;
}

ric_status ric_system_create_lattice(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count,
                                     ric_system **system, ric_error *error) {
  *system = NULL;
  RIC_TRY(ric_lattice_check(lattice, error));
  size_t n = lattice->particles;
  lattice_system *s = calloc(1, sizeof *s);
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a lattice of %zu particles", n);
  s->base = (ric_system){.model = &model, .taylor = SYSTEM_LATTICE, .coordinates = n, .speeds = n, .uncoupled = true};
  ric_system *made = &s->base;
  ric_status status = take(s, lattice, error);
  if (status == RIC_OK)
    status = system_take_obstacles(made, obstacles, count, error);
  if (status != RIC_OK)
    ric_system_destroy(&made);
  *system = made;
  return status;
}

ric_status ric_system_set_lattice(ric_system *system, const ric_lattice *lattice, ric_error *error) {
  static const char *const ends[] = {"periodic", "fixed", "free"};
  if (system->taylor != SYSTEM_LATTICE)
    return ric_fail(error, RIC_EINVAL, "a lattice for a system of another kind, expected one made of a lattice");
  RIC_TRY(ric_lattice_check(lattice, error));
  lattice_system *s = (lattice_system *)(void *)system;
  if (lattice->particles != s->lattice.particles)
    return ric_fail(error, RIC_EINVAL, "particles = %zu, expected %zu as the system was made", lattice->particles,
                    s->lattice.particles);
  if (lattice->ends != s->lattice.ends)
    return ric_fail(error, RIC_EINVAL, "ends = %s, expected %s as the system was made", ends[lattice->ends],
                    ends[s->lattice.ends]);
  RIC_TRY(take(s, lattice, error));
  system->revision++;
  return RIC_OK;
}
