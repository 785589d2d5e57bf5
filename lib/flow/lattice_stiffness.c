/* The stiffness of a lattice along a step, as series. */
#include <string.h>

#include "hertz_series.h"
#include "lattice_variation_parts.h"

bool lattice_variation_varies(const lattice_variation *v, const lattice_contacts *acting) {
  return v->nonlinear || acting->pressed_count > 0;
}

void lattice_variation_begin(lattice_variation *v, double length) {
  v->length = length;
  v->varies = false;
}

void lattice_variation_take(lattice_variation *v, const ric_segment *piece, double x) {
  double power = 1;
  for (int j = 0; j <= v->order; j++, power *= x)
    for (size_t i = 0; i < piece->coordinates; i++) {
      double c = j <= piece->degree ? piece->coef[(size_t)j * piece->stride + i] : 0;
      v->q[(size_t)j * v->n + piece->first + i] = power * c;
    }
}

/* Coefficients of an extension: of particle b over particle a, n standing for a wall. */
static void extension(const lattice_variation *v, size_t a, size_t b, double *e) {
  for (int j = 0; j <= v->order; j++) {
    const double *q = v->q + (size_t)j * v->n;
    e[j] = (b < v->n ? q[b] : 0) - (a < v->n ? q[a] : 0);
  }
}

/* Adds 2 a e + 3 b e^2 to a column of coefficients. */
static void add_spring(const ric_spring *s, const double *e, int order, double *column, size_t stride) {
  if (s->quadratic == 0 && s->cubic == 0)
    return;
  for (int j = 0; j <= order; j++) {
    double square = 0;
    for (int i = 0; i <= j; i++)
      square += e[i] * e[j - i];
    column[(size_t)j * stride] += 2 * s->quadratic * e[j] + 3 * s->cubic * square;
  }
}

static void stiffen_sites(lattice_variation *v) {
  double e[LATTICE_SERIES_ORDER + 1];
  for (size_t i = 0; i < v->n; i++) {
    ric_spring own = ric_lattice_on_site(v->lattice, i);
    extension(v, v->n, i, e);
    add_spring(&own, e, v->order, v->site + i, v->n);
  }
}

static void stiffen_links(lattice_variation *v) {
  double e[LATTICE_SERIES_ORDER + 1];
  size_t n = v->n;
  for (size_t i = 0; i <= n; i++) {
    ric_spring link = ric_lattice_link(v->lattice, i);
    size_t a = i > 0 ? i - 1 : v->ring ? n - 1 : n, b = i < n ? i : v->ring ? 0 : n;
    extension(v, a, b, e);
    add_spring(&link, e, v->order, v->link + i, n + 1);
  }
}

static void stiffen_press(lattice_variation *v, const lattice_press *p) {
  double u[LATTICE_SERIES_ORDER + 1], r[LATTICE_SERIES_ORDER + 1];
  for (int j = 0; j <= v->order; j++)
    u[j] = -p->side * v->q[(size_t)j * v->n + p->coordinate];
  u[0] += p->side * p->position;
  hertz_root_series(u, v->order, r);
  for (int j = 0; j <= v->order; j++)
    v->site[(size_t)j * v->n + p->coordinate] += 1.5 * p->stiffness * r[j];
}

void lattice_variation_stiffen(lattice_variation *v, const lattice_contacts *acting) {
  size_t levels = (size_t)v->order + 1;
  v->varies = true;
  memset(v->site, 0, levels * v->n * sizeof *v->site);
  memset(v->link, 0, levels * (v->n + 1) * sizeof *v->link);
  if (v->nonlinear) {
    stiffen_sites(v);
    stiffen_links(v);
  }
  for (size_t k = 0; k < acting->pressed_count; k++)
    stiffen_press(v, &acting->pressed[k]);
}
