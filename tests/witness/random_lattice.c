#include "random_lattice.h"

static ric_spring spring(random_source *source, double linear, int nonlinear, int damped) {
  ric_spring s = {.linear = random_uniform(source, 0.5 * linear, linear)};
  if (nonlinear) {
    s.quadratic = random_uniform(source, -0.1, 0.1);
    s.cubic = random_uniform(source, 0.1, 0.4);
  }
  if (damped)
    s.damping = random_uniform(source, 0, 0.2);
  return s;
}

void random_lattice_set(random_lattice *r, random_source *source, size_t n, ric_ends ends, unsigned with) {
  r->lattice = ric_lattice_default(n, ends);
  r->lattice.masses = r->masses;
  r->lattice.on_sites = r->on_sites;
  r->lattice.links = r->links;
  for (size_t i = 0; i < n; i++) {
    r->masses[i] = random_uniform(source, 0.5, 2);
    r->on_sites[i] = spring(source, 1, with & WITH_SITES, with & WITH_SITE_DAMPING);
    r->force_cos[i] = random_uniform(source, -0.3, 0.3);
    r->force_sin[i] = random_uniform(source, -0.3, 0.3);
  }
  for (size_t i = 0; i <= n; i++)
    r->links[i] = spring(source, 0.6, with & WITH_LINKS, with & WITH_LINK_DAMPING);
  if (with & WITH_FORCING) {
    r->lattice.frequency = 1.3;
    r->lattice.force_cos = r->force_cos;
    r->lattice.force_sin = r->force_sin;
  }
}

void random_lattice_state(random_source *source, size_t n, double *q, double *v) {
  for (size_t i = 0; i < n; i++) {
    q[i] = random_uniform(source, -1, 1);
    v[i] = random_uniform(source, -1, 1);
  }
}
