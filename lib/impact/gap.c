#include "gap.h"

#include <stdlib.h>

#include "numeric/chebyshev.h"

enum { POINTS = GAP_NODES + GAP_PROBES };
static const double probes[GAP_PROBES] = {0.31830988618379067, 0.80901699437494742}; /* far from the nodes */

ric_status gap_reader_init(gap_reader *reader, ric_flow *flow, ric_error *error) {
  const ric_system *s = flow->system;
  size_t size = s->coordinates + s->speeds;
  *reader = (gap_reader){.flow = flow, .from = NAN, .to = NAN};
  if (s->obstacles && flow->method->reaction)
    return RIC_OK;
  reader->states = malloc(POINTS * size * sizeof *reader->states);
  return reader->states ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for the gaps of %zu coordinates", size);
}

void gap_reader_clear(gap_reader *reader) {
  free(reader->states);
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

static void differentiate(const ric_segment *piece, gap_part *part) {
  for (int j = 1; j <= part->degree; j++)
    part->c[j - 1] = j * part->c[j] / piece->length;
  part->c[part->degree] = 0;
}

static double point(int k) {
  return k < GAP_NODES ? chebyshev_point(k, GAP_DEGREE) : probes[k - GAP_NODES];
}

static void states_at_points(gap_reader *r, const ric_segment *piece, double from, double to) {
  size_t n = r->flow->system->coordinates, m = r->flow->system->speeds;
  if (r->from == from && r->to == to)
    return;
  for (int k = 0; k < POINTS; k++) {
    double *q = r->states + (size_t)k * (n + m);
    ric_segment_state(piece, from + point(k) * (to - from), q, m ? q + n : NULL);
  }
  r->from = from;
  r->to = to;
}

static const char *value_at(const gap_reader *r, size_t obstacle, watch what, double t, const double *q,
                            double *value) {
  const ric_system *s = r->flow->system;
  if (what == WATCH_FORCE)
    return s->model->reaction(s, r->flow->contact, obstacle, t, q, q + s->coordinates, value);
  if (what == WATCH_RATE)
    return s->model->gap_rate(s, obstacle, t, q, q + s->coordinates, value);
  return s->model->gap(s, obstacle, t, q, value);
}

/* The size of the last terms, and of what is missed where the interpolant was not made to be right. */
static double residual_of(const double *a, const double *c, const double *value, double tolerance) {
  double size = 1, missed = fabs(a[GAP_DEGREE]) + fabs(a[GAP_DEGREE - 1]);
  for (int j = 0; j < GAP_NODES; j++)
    size = fmax(size, fabs(a[j]));
  for (int k = 0; k < GAP_PROBES; k++)
    missed =
        fmax(missed, fabs(ric_poly_value(c, GAP_DEGREE, probes[k], NULL) - value[GAP_NODES + k]) / 10 - 1e-12 * size);
  return missed / (fmax(tolerance, 1e-14) * size);
}

bool gap_is_resolved(const gap_part *part, double before) {
  return part->residual <= 1 || (part->residual > before / 8 && part->residual <= 1e5);
}

static const char *interpolate(gap_reader *r, const ric_segment *piece, size_t obstacle, watch what, gap_part *part) {
  size_t size = r->flow->system->coordinates + r->flow->system->speeds;
  double value[POINTS], a[GAP_NODES], width = part->to - part->from;
  states_at_points(r, piece, part->from, part->to);
  for (int k = 0; k < POINTS; k++) {
    double t = piece->start + (part->from + point(k) * width) * piece->length;
    const char *trouble = value_at(r, obstacle, what, t, r->states + (size_t)k * size, &value[k]);
    if (trouble)
      return trouble;
  }
  chebyshev_coefficients(value, GAP_DEGREE, a);
  part->degree = GAP_DEGREE;
  chebyshev_to_powers(a, GAP_DEGREE, part->c);
  bool rough = what == WATCH_FORCE && !r->flow->system->obstacles; /* from differences of gap rates */
  part->residual = residual_of(a, part->c, value, fmax(r->flow->options.tolerance, rough ? 1e-7 : 0));
  return NULL;
}

const char *gap_read(gap_reader *reader, const ric_segment *piece, size_t obstacle, watch what, double from, double to,
                     gap_part *part) {
  const ric_flow *flow = reader->flow;
  bool of_coordinate = what != WATCH_FORCE && flow->system->obstacles;
  part->from = from;
  part->to = to;
  part->residual = 0;
  if (of_coordinate)
    read_coordinate(piece, &flow->system->obstacles[obstacle], part);
  else if (what == WATCH_FORCE && flow->method->reaction)
    part->degree = flow->method->reaction(reader->flow, obstacle, part->c);
  else {
    const char *trouble = interpolate(reader, piece, obstacle, what, part);
    if (trouble)
      return trouble;
  }
  if (of_coordinate && what == WATCH_RATE)
    differentiate(piece, part);
  for (int j = 0; what == WATCH_PRESS && j <= part->degree; j++)
    part->c[j] = -part->c[j];
  return part->degree < 0 ? "the force of a held contact could not be evaluated" : NULL;
}
