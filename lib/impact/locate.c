/* Gaps and forces of contacts as polynomials along a step, and their first zeros. */
#include "locate.h"

#include <stdlib.h>

#include "numeric/polynomial.h"
#include "numeric/list.h"

enum { GAP_DEGREE = 12, GAP_NODES = GAP_DEGREE + 1, GAP_PROBES = 2 };

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

static const char *value_at(const gap_reader *r, size_t obstacle, contact_function what, double t, const double *q,
                            double *value) {
  const ric_system *s = r->flow->system;
  if (what == WATCH_FORCE)
    return s->model->reaction(s, r->flow->contact, obstacle, t, q, q + s->coordinates, value);
  if (what == WATCH_RATE)
    return s->model->gap_rate(s, obstacle, t, q, q + s->coordinates, value);
  return s->model->gap(s, obstacle, t, q, value);
}

/* Error estimate: the last terms, and the deviation at the points that are not nodes. */
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

static const char *interpolate(gap_reader *r, const ric_segment *piece, size_t obstacle, contact_function what,
                               gap_part *part) {
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

const char *gap_read(gap_reader *reader, const ric_segment *piece, size_t obstacle, contact_function what, double from,
                     double to, gap_part *part) {
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

enum {
  MOST_PARTS = 1 << 17, /* largest number of parts of a step for a function that is hard to interpolate */
  HALVINGS = 40,
  FEW_COORDINATES = 4
};

void locator_clear(locator *l) {
  gap_reader_clear(&l->reader);
  free(l->departure);
  free(l->base);
  free(l->lower);
  free(l->upper);
  free(l->roots.hits);
  free(l->grazes.hits);
  *l = (locator){0};
}

ric_status locator_init(locator *l, ric_flow *flow, double grazing_tol, ric_error *error) {
  size_t count = flow->system->obstacle_count;
  *l = (locator){.grazing_tol = grazing_tol};
  RIC_TRY(gap_reader_init(&l->reader, flow, error));
  l->departure = calloc(count ? count : 1, 1);
  l->base = calloc(count ? count : 1, sizeof *l->base);
  if (l->departure && l->base)
    return RIC_OK;
  locator_clear(l);
  return ric_fail(error, RIC_ENOMEM, "no memory for %zu obstacles", count);
}

static ric_status add_root(contact_root_list *list, contact_root h, ric_error *error) {
  contact_root *hits = list_room(list->hits, list->count, &list->capacity, sizeof *hits);
  if (!hits)
    return ric_fail(error, RIC_ENOMEM, "no memory for more than %zu events at one time", list->count);
  list->hits = hits;
  list->hits[list->count++] = h;
  return RIC_OK;
}

/* The scan of one step. */
typedef struct scan {
  locator *l;
  ric_flow *flow;
  double together; /* positions closer than this are one event */
  ric_error *error;
} scan;

static ric_status found_root(scan *s, size_t obstacle, double x) {
  if (x > s->l->first + s->together)
    return RIC_OK;
  if (x < s->l->first)
    s->l->first = x;
  return add_root(&s->l->roots, (contact_root){.obstacle = obstacle, .x = x, .depth = NAN}, s->error);
}

/* Cuts a part at the first root found so far, or at the horizon: later roots are irrelevant, and on the short remaining
 * interval cheap bounds exclude nearly every other contact. @returns false if nothing remains. */
static bool shorten(const scan *s, gap_part *part) {
  double end = fmin(s->l->first + s->together, s->l->horizon);
  double y = (end - part->from) / (part->to - part->from), power = 1;
  if (y >= 1)
    return true;
  for (int j = 1; j <= part->degree; j++)
    part->c[j] *= power *= y;
  part->to = part->from + y * (part->to - part->from);
  return y > 0;
}

/* Whether the slope at the start exceeds the rounding of the coefficients. */
static bool has_slope(const double *c, int degree) {
  double size = 0;
  for (int j = 0; j <= degree; j++)
    size += fabs(c[j]);
  return c[1] > 1e-15 * size;
}

/* First root of a contact's function on a part that starts at the departure, or not. */
static int first_root(const scan *s, size_t obstacle, const gap_part *part, departure from, double *y) {
  double shifted[RIC_POLY_DEGREE + 1];
  if (from == DEPARTED)
    return ric_poly_first_root(part->c, part->degree, y);
  if (from == DEPARTS_FAST && has_slope(part->c, part->degree))
    return ric_poly_first_root(part->c + 1, part->degree - 1, y);
  shifted[0] = part->c[0] + s->l->noise - (from == DEPARTS_FAST ? part->c[0] : s->l->base[obstacle]);
  for (int j = 1; j <= part->degree; j++)
    shifted[j] = part->c[j];
  return ric_poly_first_root(shifted, part->degree, y);
}

/* A cheap test of a gap, which decides for most gaps that stay positive or increase, and for most that decrease to zero
 * monotonically. @returns whether it decides */
static bool test_bounds(const scan *s, const gap_part *part, departure from, bool *found, double *y) {
  double tol = s->l->grazing_tol;
  *found = false;
  if (from == DEPARTS_FAST)
    return has_slope(part->c, part->degree) && poly_look_leaves(part->c, part->degree, tol);
  if (from == DEPARTS_SLOWLY)
    return false;
  poly_look seen = poly_look_fall(part->c, part->degree, tol, y);
  *found = seen == POLY_FALLS;
  return seen != POLY_UNDECIDED;
}

/* Whether a minimum above zero is separate from a root caused by rounding at the same grazing point: a separate root
 * lies behind it, with the gap decreasing through zero. A gap below zero by rounding only has no root. */
static bool is_near_miss(const gap_part *part, bool found, double y, double at, double least, double noise) {
  double slope;
  if (!found)
    return true;
  ric_poly_value(part->c, part->degree, y, &slope);
  return least > 0 && at < y && (slope < 0 || least > noise);
}

/* Root and near misses of an open rigid contact on one part; `found` ends the search along the piece. */
static ric_status find_gap_root(scan *s, size_t obstacle, const gap_part *part, departure from, bool *found) {
  double y = 0, at, least, width = part->to - part->from;
  if (test_bounds(s, part, from, found, &y))
    return *found ? found_root(s, obstacle, part->from + y * width) : RIC_OK;
  *found = first_root(s, obstacle, part, from, &y);
  if (from != DEPARTS_SLOWLY && ric_poly_first_minimum(part->c, part->degree, s->l->grazing_tol, &at, &least) &&
      is_near_miss(part, *found, y, at, least, s->l->noise))
    RIC_TRY(add_root(&s->l->grazes, (contact_root){.obstacle = obstacle, .x = part->from + at * width, .depth = least},
                     s->error));
  return *found ? found_root(s, obstacle, part->from + y * width) : RIC_OK;
}

/* The other functions have no near misses. */
static ric_status find_other_root(scan *s, size_t obstacle, const gap_part *part, departure from, bool *found) {
  double y;
  *found = first_root(s, obstacle, part, from, &y);
  return *found ? found_root(s, obstacle, part->from + y * (part->to - part->from)) : RIC_OK;
}

static ric_status find_contact_root(scan *s, size_t obstacle, contact_function what, const gap_part *part,
                                    bool *found) {
  departure from = part->from == 0 ? (departure)s->l->departure[obstacle] : DEPARTED;
  if (what == WATCH_GAP && !system_complies(s->flow->system, obstacle))
    return find_gap_root(s, obstacle, part, from, found);
  return find_other_root(s, obstacle, part, what == WATCH_FORCE ? DEPARTED : from, found);
}

static ric_status scan_part(scan *s, const ric_segment *piece, size_t obstacle, contact_function what, double from,
                            double to, double before, int halvings, bool *found) {
  gap_part part;
  const char *trouble = gap_read(&s->l->reader, piece, obstacle, what, from, to, &part);
  *found = false;
  if (trouble)
    return ric_fail(s->error, RIC_ECALLBACK, "at t = %.10g, obstacle %zu: %s", piece->start, obstacle, trouble);
  if (!shorten(s, &part))
    return RIC_OK;
  if (gap_is_resolved(&part, before))
    return find_contact_root(s, obstacle, what, &part, found);
  if (halvings == 0)
    return ric_fail(s->error, RIC_ELIMIT, "at t = %.10g, obstacle %zu: its %s varies too fast to be resolved",
                    piece->start + from * piece->length, obstacle, what == WATCH_FORCE ? "force" : "gap");
  if (s->l->parts++ > MOST_PARTS && from > 0) { /* the step is too long: stop at what has been scanned */
    s->l->horizon = from;
    return RIC_OK;
  }
  double middle = (from + to) / 2;
  RIC_TRY(scan_part(s, piece, obstacle, what, from, middle, part.residual, halvings - 1, found));
  return *found ? RIC_OK : scan_part(s, piece, obstacle, what, middle, to, part.residual, halvings - 1, found);
}

static ric_status scan_contact(scan *s, const ric_segment *piece, size_t obstacle) {
  static const contact_function functions[] = {
      [CONTACT_OPEN] = WATCH_GAP, [CONTACT_HELD] = WATCH_FORCE, [CONTACT_PRESSED] = WATCH_PRESS};
  contact_state now = flow_contact(s->flow, obstacle);
  bool found;
  if (now == CONTACT_PASSED)
    return RIC_OK;
  return scan_part(s, piece, obstacle, functions[now], 0, 1, INFINITY, HALVINGS, &found);
}

static ric_status reserve_reader(locator *l, size_t width, ric_error *error) {
  if (width <= l->width)
    return RIC_OK;
  free(l->lower);
  free(l->upper);
  l->lower = malloc(width * sizeof *l->lower);
  l->upper = malloc(width * sizeof *l->upper);
  l->width = l->lower && l->upper ? width : 0;
  return l->width ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for bounds of %zu coordinates", width);
}

/* Obstacles at the coordinates of a piece. Bounds of all coordinates exclude nearly all of many obstacles; for few
 * obstacles they cost as much as the first test of each. */
static ric_status scan_coordinates(scan *s, const ric_segment *piece) {
  const ric_system *system = s->flow->system;
  locator *l = s->l;
  bool bounded = piece->coordinates > FEW_COORDINATES;
  RIC_TRY(reserve_reader(l, piece->coordinates, s->error));
  if (bounded)
    ric_segment_bounds(piece, l->lower, l->upper);
  for (size_t k = system_first_obstacle(system, piece->first); k < system->obstacle_count; k++) {
    size_t j = system->by_coordinate[k];
    const ric_obstacle *o = &system->obstacles[j];
    size_t i = o->coordinate - piece->first;
    if (i >= piece->coordinates)
      break;
    bool clear = bounded && obstacle_least_gap(o, l->lower[i], l->upper[i]) > l->grazing_tol;
    if (!clear || flow_contact(s->flow, j) != CONTACT_OPEN)
      RIC_TRY(scan_contact(s, piece, j));
  }
  return RIC_OK;
}

static ric_status scan_piece(scan *s, const ric_segment *piece) {
  gap_reader_reset(&s->l->reader);
  if (s->flow->system->obstacles)
    return scan_coordinates(s, piece);
  for (size_t j = 0; j < s->flow->system->obstacle_count; j++)
    RIC_TRY(scan_contact(s, piece, j));
  return RIC_OK;
}

static int by_obstacle(const void *a, const void *b) {
  size_t x = ((const contact_root *)a)->obstacle, y = ((const contact_root *)b)->obstacle;
  return x < y ? -1 : x > y;
}

static int by_position(const void *a, const void *b) {
  double x = ((const contact_root *)a)->x, y = ((const contact_root *)b)->x;
  return x < y ? -1 : x > y ? 1 : by_obstacle(a, b);
}

/* Drops entries later than the first root, which was not known while the pieces were scanned. */
static void keep(contact_root_list *list, double latest) {
  size_t kept = 0;
  for (size_t i = 0; i < list->count; i++)
    if (list->hits[i].x <= latest)
      list->hits[kept++] = list->hits[i];
  list->count = kept;
}

ric_status locator_scan(locator *l, ric_flow *flow, double time_tol, ric_error *error) {
  scan s = {.l = l, .flow = flow, .together = time_tol / fabs(flow->length), .error = error};
  l->first = 2;
  l->horizon = 1;
  l->roots.count = l->grazes.count = l->parts = 0;
  for (size_t i = 0; i < ric_flow_pieces(flow) && flow->system->obstacle_count > 0; i++) {
    ric_segment piece = ric_flow_piece(flow, i);
    RIC_TRY(scan_piece(&s, &piece));
  }
  keep(&l->roots, l->first + s.together);
  keep(&l->grazes, l->first);
  if (l->roots.count > 1)
    qsort(l->roots.hits, l->roots.count, sizeof *l->roots.hits, by_obstacle);
  if (l->grazes.count > 1)
    qsort(l->grazes.hits, l->grazes.count, sizeof *l->grazes.hits, by_position);
  return RIC_OK;
}
