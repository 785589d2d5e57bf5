#include "ricochet/lattice.h"

#include <math.h>
#include <stdbool.h>

#include "lattice_force.h"

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
  double phase = lattice->frequency * t, left = link_force(lattice, particle, q, v);
  double right = link_force(lattice, particle + 1, q, v);
  return own_force(lattice, particle, q[particle], v[particle], cos(phase), sin(phase)) - left + right;
}

void ric_lattice_acceleration(const ric_lattice *lattice, double t, const double *q, const double *v,
                              double *acceleration) {
  double cosine = cos(lattice->frequency * t), sine = sin(lattice->frequency * t);
  double left = link_force(lattice, 0, q, v);
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
