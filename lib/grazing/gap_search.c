#include "gap_search.h"

#include <math.h>

enum { HALVINGS = 30 }; /* of a segment on which the gap rate is not resolved */

ric_status gap_search_init(gap_search *s, ric_flow *flow, size_t obstacle, ric_error *error) {
  *s = (gap_search){.flow = flow, .obstacle = obstacle};
  return gap_reader_init(&s->reader, flow, error);
}

void gap_search_clear(gap_search *s) {
  gap_reader_clear(&s->reader);
}

/* One search along the motion; slopes are those along it, against time when it runs backwards. */
typedef struct way {
  gap_search *s;
  bool opening;        /* else a minimum */
  double level, slope; /* of the gap, where the last part ended */
  double time;         /* found */
  const char *trouble;
} way;

/* The gap [degree + 2] on a part, from its rate there. */
static int integrate(const gap_part *rate, double length, double level, double *c) {
  double width = (rate->to - rate->from) * length;
  c[0] = level;
  for (int j = 0; j <= rate->degree; j++)
    c[j + 1] = rate->c[j] * width / (j + 1);
  return rate->degree + 1;
}

static bool finds(const way *w, const double *c, int degree, double *at) {
  double value, below[RIC_POLY_DEGREE + 2];
  if (w->opening) {
    for (int j = 0; j <= degree; j++)
      below[j] = -c[j];
    return ric_poly_first_root(below, degree, at);
  }
  if (w->slope < 0 && c[1] > 0) { /* between the last part and this one */
    *at = 0;
    return true;
  }
  return ric_poly_first_minimum(c, degree, INFINITY, at, &value);
}

static bool look_at_part(way *w, const ric_segment *piece, const gap_part *rate) {
  double c[RIC_POLY_DEGREE + 2], at;
  int degree = integrate(rate, piece->length, w->level, c);
  if (finds(w, c, degree, &at)) {
    w->time = piece->start + (rate->from + at * (rate->to - rate->from)) * piece->length;
    return true;
  }
  w->level = ric_poly_value(c, degree, 1, &w->slope);
  return false;
}

/* Whether it is found on [from, to] of a piece, or there is trouble. */
static bool look(way *w, const ric_segment *piece, double from, double to, double before, int halvings) {
  gap_part rate;
  w->trouble = gap_read(&w->s->reader, piece, w->s->obstacle, WATCH_RATE, from, to, &rate);
  if (w->trouble)
    return true;
  if (gap_is_resolved(&rate, before) || halvings == 0)
    return look_at_part(w, piece, &rate);
  double middle = (from + to) / 2;
  return look(w, piece, from, middle, rate.residual, halvings - 1) ||
         look(w, piece, middle, to, rate.residual, halvings - 1);
}

static bool look_at_step(way *w) {
  ric_flow *flow = w->s->flow;
  const ric_system *system = flow->system;
  for (size_t i = 0; i < ric_flow_pieces(flow); i++) {
    ric_segment piece = ric_flow_piece(flow, i);
    size_t coordinate = system->obstacles ? system->obstacles[w->s->obstacle].coordinate : 0;
    if (coordinate < piece.first || coordinate - piece.first >= piece.coordinates)
      continue;
    gap_reader_reset(&w->s->reader);
    if (look(w, &piece, 0, 1, INFINITY, HALVINGS))
      return true;
  }
  return false;
}

static ric_status go(way *w, double t, const double *x, double span, ric_error *error) {
  ric_flow *flow = w->s->flow;
  double end = t + span;
  RIC_TRY(ric_flow_start(flow, t, x, x + flow->system->coordinates, error));
  while (ric_flow_time(flow) != end) {
    ric_status status = ric_flow_step(flow, end, error);
    if (status == RIC_ENUMERIC) /* nothing is to be found where the motion ends */
      return RIC_OK;
    RIC_TRY(status);
    if (look_at_step(w))
      break;
    ric_flow_accept(flow, 1);
  }
  if (w->trouble)
    return ric_fail(error, RIC_ECALLBACK, "from t = %g, obstacle %zu: %s", t, w->s->obstacle, w->trouble);
  return RIC_OK;
}

ric_status gap_search_minimum(gap_search *s, double t, const double *x, double span, double rate, double *time,
                              ric_error *error) {
  way w = {.s = s, .slope = copysign(1, span) * rate, .time = NAN};
  RIC_TRY(go(&w, t, x, span, error));
  *time = w.time;
  return RIC_OK;
}

ric_status gap_search_opening(gap_search *s, double t, const double *x, double span, double depth, double *time,
                              ric_error *error) {
  way w = {.s = s, .opening = true, .level = depth, .time = NAN};
  RIC_TRY(go(&w, t, x, span, error));
  *time = w.time;
  return RIC_OK;
}
