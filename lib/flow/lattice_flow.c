#include "ricochet/lattice_flow.h"

#include <stdlib.h>

#include "model/image_ring.h"

enum {
  HALO = RIC_LATTICE_ORDER / 2,         /* neighbours read beyond each end of a block */
  WIDTH = RIC_LATTICE_BLOCK + 2 * HALO, /* columns of the coefficient array */
  LEVELS = RIC_LATTICE_ORDER + 1
};

struct ric_lattice_flow {
  double coef[LEVELS][WIDTH];
};

double ric_lattice_step(const ric_chain *chain) {
  return 2.2 / ric_chain_frequency_max(chain);
}

ric_status ric_lattice_flow_create(ric_lattice_flow **flow, ric_error *error) {
  *flow = calloc(1, sizeof **flow);
  return *flow ? RIC_OK
               : ric_fail(error, RIC_ENOMEM, "no memory for the Taylor coefficients (%zu bytes)", sizeof **flow);
}

void ric_lattice_flow_destroy(ric_lattice_flow **flow) {
  if (!flow)
    return;
  free(*flow);
  *flow = NULL;
}

/* Row [width] of a block and its halo, scaled, from a function on the chain and its images. */
static void load(const ric_chain *chain, const double *x, double scale, ptrdiff_t begin, size_t width, double *row) {
  ptrdiff_t n = (ptrdiff_t)chain->particles, end = begin + (ptrdiff_t)width;
  ptrdiff_t inner = begin > 0 ? begin : 0, outer = end < n ? end : n;
  for (ptrdiff_t i = begin; i < inner; i++)
    row[i - begin] = scale * image_ring_value(chain, x, i);
  for (ptrdiff_t i = inner; i < outer; i++)
    row[i - begin] = scale * x[i];
  for (ptrdiff_t i = outer; i < end; i++)
    row[i - begin] = scale * image_ring_value(chain, x, i);
}

/* One step of the recurrence on the columns [low, high). */
static void raise_order(const double *restrict c, double *restrict next, size_t low, size_t high, double own,
                        double neighbour) {
  for (size_t i = low; i < high; i++)
    next[i] = own * c[i] + neighbour * (c[i - 1] + c[i + 1]);
}

ric_segment ric_lattice_flow_segment(ric_lattice_flow *flow, const ric_chain *chain, const double *q, const double *v,
                                     double start, double length, size_t first, size_t count) {
  double gamma = image_ring_gamma(chain);
  size_t width = count + 2 * HALO;
  ptrdiff_t begin = (ptrdiff_t)first - HALO;
  load(chain, q, 1, begin, width, flow->coef[0]);
  load(chain, v, length, begin, width, flow->coef[1]);
  for (size_t j = 0; j + 2 < LEVELS; j++) {
    double scale = length * length / (double)((j + 1) * (j + 2)); /* [JAP] (1) in Taylor coefficients */
    size_t lost = j / 2 + 1;                                      /* a ring of the halo per two orders */
    raise_order(flow->coef[j], flow->coef[j + 2], lost, width - lost, -scale * (1 + 2 * gamma), scale * gamma);
  }
  return (ric_segment){.first = first,
                       .coordinates = count,
                       .stride = WIDTH,
                       .degree = RIC_LATTICE_ORDER,
                       .start = start,
                       .length = length,
                       .coef = &flow->coef[0][HALO]};
}
