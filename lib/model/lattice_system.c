/* Lattices: forces and energies, their derivatives, and the system of a lattice. */
#include "lattice_system.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/elementary.h"
#include "ricochet/lattice.h"
#include "numeric/required.h"

ric_lattice ric_lattice_default(size_t particles, ric_ends ends) {
  return (ric_lattice){.particles = particles, .ends = ends, .mass = 1, .on_site = {.linear = 1}};
}

ric_lattice ric_lattice_of_chain(const ric_chain *chain) {
  ric_lattice lattice = ric_lattice_default(chain->particles, chain->ends);
  lattice.link.linear = chain->gamma;
  return lattice;
}

static ric_status check_masses(const ric_lattice *lattice, ric_error *error) {
  for (size_t i = 0; i < (lattice->masses ? lattice->particles : 1); i++) {
    double mass = ric_lattice_mass(lattice, i);
    if (!(mass > 0 && mass < INFINITY))
      return ric_fail(error, RIC_EINVAL, "mass of particle %zu = %g, expected a finite number > 0", i, mass);
  }
  return RIC_OK;
}

static ric_status check_spring(const ric_spring *s, const char *what, size_t i, ric_error *error) {
  const double value[] = {s->linear, s->quadratic, s->cubic};
  static const char *const name[] = {"linear", "quadratic", "cubic"};
  for (size_t k = 0; k < 3; k++)
    if (!isfinite(value[k]))
      return ric_fail(error, RIC_EINVAL, "%s %zu: %s = %g, expected a finite number", what, i, name[k], value[k]);
  if (!(s->damping >= 0 && s->damping < INFINITY))
    return ric_fail(error, RIC_EINVAL, "%s %zu: damping = %g, expected a finite number >= 0", what, i, s->damping);
  return RIC_OK;
}

static ric_status check_springs(const ric_lattice *lattice, ric_error *error) {
  size_t n = lattice->particles;
  for (size_t i = 0; i < (lattice->on_sites ? n : 1); i++)
    RIC_TRY(check_spring(lattice->on_sites ? &lattice->on_sites[i] : &lattice->on_site, "on-site spring", i, error));
  for (size_t i = 0; i < (lattice->links ? n + 1 : 1); i++)
    RIC_TRY(check_spring(lattice->links ? &lattice->links[i] : &lattice->link, "link", i, error));
  return RIC_OK;
}

static ric_status check_force(const double *force, size_t n, const char *what, ric_error *error) {
  for (size_t i = 0; force && i < n; i++)
    if (!isfinite(force[i]))
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected a finite number", what, i, force[i]);
  return RIC_OK;
}

ric_status ric_lattice_check(const ric_lattice *lattice, ric_error *error) {
  REQUIRE(error, {"lattice", lattice});
  size_t n = lattice->particles;
  if (n < 1)
    return ric_fail(error, RIC_EINVAL, "particles = 0, expected at least 1");
  if (lattice->ends != RIC_ENDS_PERIODIC && lattice->ends != RIC_ENDS_FIXED && lattice->ends != RIC_ENDS_FREE)
    return ric_fail(error, RIC_EINVAL, "ends = %d, expected periodic, fixed or free", (int)lattice->ends);
  RIC_TRY(check_masses(lattice, error));
  RIC_TRY(check_springs(lattice, error));
  if (!isfinite(lattice->frequency))
    return ric_fail(error, RIC_EINVAL, "frequency = %g, expected a finite number", lattice->frequency);
  RIC_TRY(check_force(lattice->force_cos, n, "force_cos", error));
  return check_force(lattice->force_sin, n, "force_sin", error);
}

static bool is_ring(const ric_lattice *lattice) {
  return lattice->ends == RIC_ENDS_PERIODIC && lattice->particles >= 3;
}

ric_spring ric_lattice_link(const ric_lattice *lattice, size_t i) {
  bool outer = i == 0 || i == lattice->particles, ring = is_ring(lattice);
  if (outer && !ring && lattice->ends != RIC_ENDS_FIXED)
    return (ric_spring){0};
  if (!lattice->links)
    return lattice->link;
  return lattice->links[ring && outer ? 0 : i];
}

static double spring_force(const ric_spring *s, double x, double rate) {
  return x * (s->linear + x * (s->quadratic + x * s->cubic)) + s->damping * rate;
}

static double spring_energy(const ric_spring *s, double x) {
  return x * x * (s->linear / 2 + x * (s->quadratic / 3 + x * s->cubic / 4));
}

/* Extension of link i, or its rate. */
static double extension(const ric_lattice *lattice, const double *x, size_t i) {
  size_t n = lattice->particles;
  double wall = 0;
  double left = i > 0 ? x[i - 1] : is_ring(lattice) ? x[n - 1] : wall;
  double right = i < n ? x[i] : is_ring(lattice) ? x[0] : wall;
  return right - left;
}

static double link_force(const ric_lattice *lattice, size_t i, const double *q, const double *v) {
  ric_spring link = ric_lattice_link(lattice, i);
  return spring_force(&link, extension(lattice, q, i), extension(lattice, v, i));
}

/* Forces on a particle other than those of its links; the forcing's cosine and sine are given. */
static double own_force(const ric_lattice *lattice, size_t i, double q, double v, double cosine, double sine) {
  ric_spring spring = ric_lattice_on_site(lattice, i);
  double force = -spring_force(&spring, q, v);
  if (lattice->force_cos)
    force += lattice->force_cos[i] * cosine;
  if (lattice->force_sin)
    force += lattice->force_sin[i] * sine;
  return force;
}

double lattice_force(const ric_lattice *lattice, size_t particle, double t, const double *q, const double *v) {
  double left = link_force(lattice, particle, q, v), right = link_force(lattice, particle + 1, q, v), cosine, sine;
  ric_sincos(lattice->frequency * t, &sine, &cosine);
  return own_force(lattice, particle, q[particle], v[particle], cosine, sine) - left + right;
}

void ric_lattice_acceleration(const ric_lattice *lattice, double t, const double *q, const double *v,
                              double *acceleration) {
  double left = link_force(lattice, 0, q, v), cosine, sine;
  ric_sincos(lattice->frequency * t, &sine, &cosine);
  for (size_t i = 0; i < lattice->particles; i++) {
    double right = link_force(lattice, i + 1, q, v);
    acceleration[i] = (own_force(lattice, i, q[i], v[i], cosine, sine) - left + right) / ric_lattice_mass(lattice, i);
    left = right;
  }
}

double ric_lattice_energy(const ric_lattice *lattice, const double *q, const double *v) {
  size_t n = lattice->particles;
  double energy = 0;
  for (size_t i = 0; i < n; i++) {
    ric_spring spring = ric_lattice_on_site(lattice, i);
    energy += ric_lattice_mass(lattice, i) * v[i] * v[i] / 2 + spring_energy(&spring, q[i]);
  }
  for (size_t i = 0; i < (is_ring(lattice) ? n : n + 1); i++) {
    ric_spring link = ric_lattice_link(lattice, i);
    energy += spring_energy(&link, extension(lattice, q, i));
  }
  return energy;
}

/* Gershgorin's circles. Links to a wall have no entry beside the diagonal. */
lattice_rows_bound lattice_row_bounds(const ric_lattice *lattice) {
  size_t n = lattice->particles;
  lattice_rows_bound b = {.softest = INFINITY};
  for (size_t i = 0; i < n; i++) {
    ric_spring own = ric_lattice_on_site(lattice, i);
    ric_spring left = ric_lattice_link(lattice, i), right = ric_lattice_link(lattice, i + 1);
    double to_left = i > 0 || is_ring(lattice), to_right = i + 1 < n || is_ring(lattice);
    double diagonal = own.linear + left.linear + right.linear, mass = ric_lattice_mass(lattice, i);
    double beside = to_left * fabs(left.linear) + to_right * fabs(right.linear);
    double c = own.damping + (1 + to_left) * left.damping + (1 + to_right) * right.damping;
    b.stiffness = fmax(b.stiffness, (fabs(diagonal) + beside) / mass);
    b.softest = fmin(b.softest, (diagonal - beside) / mass);
    b.damping = fmax(b.damping, c / mass);
  }
  return b;
}

double ric_lattice_frequency_bound(const ric_lattice *lattice) {
  return sqrt(lattice_row_bounds(lattice).stiffness);
}

/* Particle on the other side of an outer link; n where that is a wall. */
static size_t left_of(const ric_lattice *l, size_t link) {
  bool ring = l->ends == RIC_ENDS_PERIODIC && l->particles >= 3;
  return link > 0 ? link - 1 : ring ? l->particles - 1 : l->particles;
}

static size_t right_of(const ric_lattice *l, size_t link) {
  bool ring = l->ends == RIC_ENDS_PERIODIC && l->particles >= 3;
  return link < l->particles ? link : ring ? 0 : l->particles;
}

static double stiffness(const ric_spring *s, double x) {
  return s->linear + x * (2 * s->quadratic + 3 * s->cubic * x);
}

/* acceleration_to += sign (k d_q + c d_u)_from for all columns; particles may be walls. */
static void pull(const ric_lattice *l, const tangents *d, size_t to, size_t from, double k, double c,
                 double *acceleration) {
  size_t columns = d->columns;
  if (to == l->particles || from == l->particles)
    return;
  double w = 1 / ric_lattice_mass(l, to);
  const double *q = d->q + from * columns, *u = d->u + from * columns;
  double *a = acceleration + to * columns;
  for (size_t j = 0; j < columns; j++)
    a[j] += w * (k * q[j] + c * u[j]);
}

void lattice_tangent(const ric_lattice *lattice, const double *q, const tangents *d, double *acceleration) {
  size_t n = lattice->particles;
  memset(acceleration, 0, n * d->columns * sizeof *acceleration);
  for (size_t i = 0; i < n; i++) {
    ric_spring own = ric_lattice_on_site(lattice, i);
    pull(lattice, d, i, i, -stiffness(&own, q[i]), -own.damping, acceleration);
  }
  bool ring = lattice->ends == RIC_ENDS_PERIODIC && n >= 3;
  for (size_t i = 0; i < (ring ? n : n + 1); i++) { /* link 0 of a ring is link n */
    ric_spring link = ric_lattice_link(lattice, i);
    size_t a = left_of(lattice, i), b = right_of(lattice, i);
    double k = stiffness(&link, (b < n ? q[b] : 0) - (a < n ? q[a] : 0)), c = link.damping;
    pull(lattice, d, a, a, -k, -c, acceleration);
    pull(lattice, d, a, b, k, c, acceleration);
    pull(lattice, d, b, b, -k, -c, acceleration);
    pull(lattice, d, b, a, k, c, acceleration);
  }
}

typedef struct lattice_system {
  ric_system base;
  ric_lattice lattice;
  double *masses, *force_cos, *force_sin; /* owned, NULL if no lattice of this system has had one */
  ric_spring *on_sites, *links;
} lattice_system;

const ric_lattice *lattice_system_lattice(const ric_system *system) {
  return &((const lattice_system *)(const void *)system)->lattice;
}

/* Force of a compliant obstacle on its coordinate: Hertz's law is zero where the gap is open. */
static double push(const ric_obstacle *o, double q) {
  return o->side * hertz_force(o->stiffness, ric_obstacle_gap(o, q));
}

/* Whether a compliant obstacle acts: by its contact state, or by the sign of its gap (in Hertz's law) if no states are
 * given. */
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
  (void)u; /* no force depends on speeds together with another variable */
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

/* Makes room for an array that may be NULL; existing arrays are kept. False without memory. */
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

/* Copies a lattice that has been checked; without memory nothing has changed. */
static ric_status take_lattice(lattice_system *s, const ric_lattice *l, ric_error *error) {
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
  REQUIRE(error, {"lattice", lattice}, {"obstacles", unless_empty(count, obstacles)}, {"system", system});
  *system = NULL;
  RIC_TRY(ric_lattice_check(lattice, error));
  size_t n = lattice->particles;
  lattice_system *s = calloc(1, sizeof *s);
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a lattice of %zu particles", n);
  s->base = (ric_system){.model = &model, .taylor = SYSTEM_LATTICE, .coordinates = n, .speeds = n, .uncoupled = true};
  ric_system *made = &s->base;
  ric_status status = take_lattice(s, lattice, error);
  if (status == RIC_OK)
    status = system_take_obstacles(made, obstacles, count, error);
  if (status != RIC_OK)
    ric_system_destroy(&made);
  *system = made;
  return status;
}

ric_status ric_system_set_lattice(ric_system *system, const ric_lattice *lattice, ric_error *error) {
  REQUIRE(error, {"system", system}, {"lattice", lattice});
  static const char *const ends[] = {"periodic", "fixed", "free"};
  if (system->taylor != SYSTEM_LATTICE)
    return ric_fail(error, RIC_EINVAL, "the system is not a lattice, expected a system created from a lattice");
  RIC_TRY(ric_lattice_check(lattice, error));
  lattice_system *s = (lattice_system *)(void *)system;
  if (lattice->particles != s->lattice.particles)
    return ric_fail(error, RIC_EINVAL, "particles = %zu, expected %zu as at the creation of the system",
                    lattice->particles, s->lattice.particles);
  if (lattice->ends != s->lattice.ends)
    return ric_fail(error, RIC_EINVAL, "ends = %s, expected %s as at the creation of the system", ends[lattice->ends],
                    ends[s->lattice.ends]);
  RIC_TRY(take_lattice(s, lattice, error));
  system->revision++;
  return RIC_OK;
}
