#include "gap.h"

#include <stdlib.h>

#include "flow/chebyshev.h"

ric_status gap_reader_init(gap_reader *reader, const ric_flow *flow, ric_error *error) {
  const ric_system *s = flow->system;
  *reader = (gap_reader){.system = s, .tolerance = flow->options.tolerance, .from = NAN, .to = NAN};
  if (s->obstacles)
    return RIC_OK;
  reader->q = malloc(GAP_NODES * s->coordinates * sizeof *reader->q);
  return reader->q ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for the gaps of %zu coordinates", s->coordinates);
}

void gap_reader_clear(gap_reader *reader) {
  free(reader->q);
  *reader = (gap_reader){0};
}

void gap_reader_reset(gap_reader *reader) {
  reader->from = reader->to = NAN;
}

static void read_coordinate(const ric_segment *piece, const ric_obstacle *o, gap_part *part) {
  const double *c = piece->coef + (o->coordinate - piece->first);
  part->degree = piece->degree;
  for (int j = 0; j <= piece->degree; j++)
    part->c[j] = o->side * c[(size_t)j * piece->stride];
  part->c[0] = o->side * (c[0] - o->position);
}

static void states_at_nodes(gap_reader *r, const ric_segment *piece, double from, double to) {
  if (r->from == from && r->to == to)
    return;
  for (int k = 0; k < GAP_NODES; k++)
    ric_segment_state(piece, from + chebyshev_point(k, GAP_DEGREE) * (to - from),
                      r->q + (size_t)k * r->system->coordinates, NULL);
  r->from = from;
  r->to = to;
}

static bool is_resolved(const double *a, double tolerance) {
  double largest = 1;
  for (int j = 0; j < GAP_NODES; j++)
    largest = fmax(largest, fabs(a[j]));
  return fabs(a[GAP_DEGREE]) + fabs(a[GAP_DEGREE - 1]) <= fmax(tolerance, 1e-14) * largest;
}

const char *gap_read(gap_reader *reader, const ric_segment *piece, size_t obstacle, double from, double to,
                     gap_part *part, bool *resolved) {
  const ric_system *s = reader->system;
  part->from = from;
  part->to = to;
  *resolved = true;
  if (s->obstacles) {
    read_coordinate(piece, &s->obstacles[obstacle], part);
    return NULL;
  }
  double value[GAP_NODES], a[GAP_NODES], start = piece->start + from * piece->length;
  states_at_nodes(reader, piece, from, to);
  for (int k = 0; k < GAP_NODES; k++) {
    double t = start + chebyshev_point(k, GAP_DEGREE) * (to - from) * piece->length;
    const char *trouble = s->model->gap(s, obstacle, t, reader->q + (size_t)k * s->coordinates, &value[k]);
    if (trouble)
      return trouble;
  }
  chebyshev_coefficients(value, GAP_DEGREE, a);
  *resolved = is_resolved(a, reader->tolerance);
  part->degree = GAP_DEGREE;
  chebyshev_to_powers(a, GAP_DEGREE, part->c);
  return NULL;
}
