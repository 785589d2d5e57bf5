/* The stiffness of a lattice along a step, as series. */
#include <string.h>

#include "hertz_series.h"
#include "lattice_variation_parts.h"

bool lattice_variation_varies(const lattice_variation *v, const lattice_contacts *acting) {
  return v->nonlinear > 0 || acting->pressed_count > 0;
}

void lattice_variation_begin(lattice_variation *v, double length) {
  v->length = length;
  v->count = 0;
  memset(v->first_pull, 0, (v->n + 1) * sizeof *v->first_pull);
}

void lattice_variation_take(lattice_variation *v, const ric_segment *piece, double x) {
  double power = 1;
  for (int j = 0; j <= v->order; j++, power *= x) {
    const double *c = piece->coef + (size_t)j * piece->stride;
    double *q = v->q + (size_t)j * v->n + piece->first;
    for (size_t i = 0; i < piece->coordinates; i++)
      q[i] = power * c[i];
  }
}

/* Coefficients of an extension. */
RIC_INLINE void extension(const lattice_variation *v, const varying_spring *s, double *e) {
  for (int j = 0; j <= v->order; j++) {
    const double *q = v->q + (size_t)j * v->n;
    e[j] = (s->to != NO_PARTICLE ? q[s->to] : 0) - (s->from != NO_PARTICLE ? q[s->from] : 0);
  }
}

enum { PADDED = (LATTICE_SERIES_ORDER / RIC_LANES + 1) * RIC_LANES };

/* Coefficients of e^2 up to the order, some at a time; e has as many zeros before it. */
RIC_INLINE void square(const double *e, int order, double *out) {
  for (int j = 0; j <= order; j += RIC_LANES) {
    ric_lanes even = {0}, odd = {0};
    for (int i = 0; i < j + RIC_LANES; i += 2) {
      even += e[i] * *(const ric_lanes *)(e + j - i);
      odd += e[i + 1] * *(const ric_lanes *)(e + j - i - 1);
    }
    *(ric_lanes *)(out + j) = even + odd;
  }
}

/* 2 a e + 3 b e^2. */
RIC_VECTORISED static void stiffen_springs(const lattice_variation *v) {
  double zeros_and_e[2 * PADDED + 2] = {0}, *e = zeros_and_e + PADDED, squares[PADDED];
  for (size_t k = 0; k < v->nonlinear; k++) {
    const varying_spring *s = &v->varying[k];
    double *stiffness = v->k + k * ((size_t)v->order + 1), twice = 2 * s->quadratic, thrice = 3 * s->cubic;
    extension(v, s, e);
    square(e, v->order, squares);
    for (int j = 0; j <= v->order; j++)
      stiffness[j] = twice * e[j] + thrice * squares[j];
  }
}

static void stiffen_press(const lattice_variation *v, const lattice_press *p, double *k) {
  double u[LATTICE_SERIES_ORDER + 1];
  for (int j = 0; j <= v->order; j++)
    u[j] = -p->side * v->q[(size_t)j * v->n + p->coordinate];
  u[0] += p->side * p->position;
  hertz_root_series(u, v->order, k);
  for (int j = 0; j <= v->order; j++)
    k[j] *= 1.5 * p->stiffness;
}

/* Lists by particle what the springs do. Counted, then summed up, then filled from the last to the first. */
static void list_pulls(lattice_variation *v) {
  size_t *first = v->first_pull; /* zeros */
  for (size_t k = 0; k < v->count; k++) {
    if (v->varying[k].to != NO_PARTICLE)
      first[v->varying[k].to]++;
    if (v->varying[k].from != NO_PARTICLE)
      first[v->varying[k].from]++;
  }
  for (size_t i = 1; i <= v->n; i++)
    first[i] += first[i - 1];
  for (size_t k = v->count; k-- > 0;) {
    size_t to = v->varying[k].to, from = v->varying[k].from;
    if (to != NO_PARTICLE)
      v->pulls[--first[to]] = (spring_pull){k, -v->inverse_mass[to]};
    if (from != NO_PARTICLE)
      v->pulls[--first[from]] = (spring_pull){k, v->inverse_mass[from]};
  }
}

void lattice_variation_stiffen(lattice_variation *v, const lattice_contacts *acting) {
  size_t levels = (size_t)v->order + 1;
  v->count = v->nonlinear + acting->pressed_count;
  stiffen_springs(v);
  for (size_t i = 0; i < acting->pressed_count; i++) {
    v->varying[v->nonlinear + i] = (varying_spring){.from = NO_PARTICLE, .to = acting->pressed[i].coordinate};
    stiffen_press(v, &acting->pressed[i], v->k + (v->nonlinear + i) * levels);
  }
  list_pulls(v);
}
