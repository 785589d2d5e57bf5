#include "lattice_tangent.h"

#include <stdbool.h>
#include <string.h>

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
