#include "locate.h"

#include <stdlib.h>

enum { HALVINGS = 8 /* of a step whose gaps are hard to interpolate */ };

ric_status locator_init(locator *l, const ric_flow *flow, double grazing_tol, double noise, ric_error *error) {
  size_t count = flow->system->obstacle_count;
  *l = (locator){.grazing_tol = grazing_tol, .noise = noise};
  RIC_TRY(gap_reader_init(&l->reader, flow, error));
  l->departure = calloc(count ? count : 1, 1);
  if (l->departure)
    return RIC_OK;
  locator_clear(l);
  return ric_fail(error, RIC_ENOMEM, "no memory for %zu obstacles", count);
}

void locator_clear(locator *l) {
  gap_reader_clear(&l->reader);
  free(l->departure);
  free(l->lower);
  free(l->upper);
  free(l->roots.hits);
  free(l->grazes.hits);
  *l = (locator){0};
}

static ric_status add_hit(hit_list *list, hit h, ric_error *error) {
  if (list->count == list->capacity) {
    size_t capacity = list->capacity ? 2 * list->capacity : 16;
    hit *hits = realloc(list->hits, capacity * sizeof *hits);
    if (!hits)
      return ric_fail(error, RIC_ENOMEM, "no memory for %zu events at one time", capacity);
    list->hits = hits;
    list->capacity = capacity;
  }
  list->hits[list->count++] = h;
  return RIC_OK;
}

/* One step being looked at. */
typedef struct scan {
  locator *l;
  ric_flow *flow;
  double together; /* positions this close are one event */
  ric_error *error;
} scan;

static ric_status found_root(scan *s, size_t obstacle, double x) {
  if (x > s->l->first + s->together)
    return RIC_OK;
  if (x < s->l->first)
    s->l->first = x;
  return add_hit(&s->l->roots, (hit){.obstacle = obstacle, .x = x, .depth = NAN}, s->error);
}

/* Cuts a part off behind the first root so far: what comes later is of no interest, and on the short interval that is
 * left the cheap bounds exclude nearly every other contact. @returns false when nothing is left. */
static bool shorten(const scan *s, gap_part *part) {
  double y = (s->l->first + s->together - part->from) / (part->to - part->from), power = 1;
  if (y >= 1)
    return true;
  for (int j = 1; j <= part->degree; j++)
    part->c[j] *= power *= y;
  part->to = part->from + y * (part->to - part->from);
  return y > 0;
}

/* First root of a contact's function on a part that starts at the departure, or not. */
static int first_root(const scan *s, const double *c, int degree, departure from, double *y) {
  double shifted[RIC_POLY_DEGREE + 1];
  if (from == DEPARTED)
    return ric_poly_first_root(c, degree, y);
  if (from == DEPARTS_FAST)
    return ric_poly_first_root(c + 1, degree - 1, y);
  for (int j = 0; j <= degree; j++)
    shifted[j] = c[j];
  shifted[0] += s->l->noise;
  return ric_poly_first_root(shifted, degree, y);
}

/* Whether the gap comes down to grazing_tol at all: for most contacts that bounds did not exclude, it does not. */
static bool comes_near(const scan *s, const gap_part *part) {
  double lowered[RIC_POLY_DEGREE + 1];
  for (int j = 0; j <= part->degree; j++)
    lowered[j] = part->c[j];
  lowered[0] -= s->l->grazing_tol;
  return !ric_poly_is_positive(lowered, part->degree);
}

/* Root and near misses of an open rigid contact on one part; `found` ends the search along the piece. */
static ric_status look_at_gap(scan *s, size_t obstacle, const gap_part *part, departure from, bool *found) {
  double y, at, least, width = part->to - part->from;
  *found = false;
  if (from == DEPARTED && !comes_near(s, part))
    return RIC_OK;
  *found = first_root(s, part->c, part->degree, from, &y);
  if (from != DEPARTS_SLOWLY && ric_poly_first_minimum(part->c, part->degree, s->l->grazing_tol, &at, &least) &&
      least > 0 && !(*found && at >= y))
    RIC_TRY(
        add_hit(&s->l->grazes, (hit){.obstacle = obstacle, .x = part->from + at * width, .depth = least}, s->error));
  return *found ? found_root(s, obstacle, part->from + y * width) : RIC_OK;
}

static ric_status scan_gap(scan *s, const ric_segment *piece, size_t obstacle, double from, double to, int halvings,
                           bool *found) {
  gap_part part;
  bool resolved;
  const char *trouble = gap_read(&s->l->reader, piece, obstacle, from, to, &part, &resolved);
  *found = false;
  if (trouble)
    return ric_fail(s->error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", piece->start, obstacle, trouble);
  if (!shorten(s, &part))
    return RIC_OK;
  if (!resolved && halvings > 0) {
    double middle = (from + to) / 2;
    RIC_TRY(scan_gap(s, piece, obstacle, from, middle, halvings - 1, found));
    return *found ? RIC_OK : scan_gap(s, piece, obstacle, middle, to, halvings - 1, found);
  }
  return look_at_gap(s, obstacle, &part, from == 0 ? (departure)s->l->departure[obstacle] : DEPARTED, found);
}

/* A function on the whole step. */
static ric_status scan_whole(scan *s, size_t obstacle, gap_part *part, departure from) {
  double y;
  if (!shorten(s, part) || !first_root(s, part->c, part->degree, from, &y))
    return RIC_OK;
  return found_root(s, obstacle, y * part->to);
}

/* A compliant obstacle: its gap while open, minus its gap while pressed. */
static ric_status scan_compliant(scan *s, const ric_segment *piece, size_t obstacle, contact_state state) {
  gap_part part;
  bool resolved;
  gap_read(&s->l->reader, piece, obstacle, 0, 1, &part, &resolved); /* at a coordinate: cannot fail */
  for (int j = 0; state == CONTACT_PRESSED && j <= part.degree; j++)
    part.c[j] = -part.c[j];
  return scan_whole(s, obstacle, &part, (departure)s->l->departure[obstacle]);
}

static ric_status scan_held(scan *s, size_t obstacle) {
  gap_part part = {.from = 0, .to = 1};
  part.degree = s->flow->method->reaction(s->flow, obstacle, part.c);
  if (part.degree < 0)
    return ric_fail(s->error, RIC_ECALLBACK, "at t = %g, obstacle %zu: its force could not be evaluated", s->flow->time,
                    obstacle);
  return scan_whole(s, obstacle, &part, DEPARTED);
}

static ric_status scan_contact(scan *s, const ric_segment *piece, size_t obstacle) {
  contact_state state = flow_contact(s->flow, obstacle);
  const ric_obstacle *o = s->flow->system->obstacles;
  bool found;
  if (state == CONTACT_HELD)
    return scan_held(s, obstacle);
  if (o && o[obstacle].stiffness < INFINITY)
    return scan_compliant(s, piece, obstacle, state);
  return scan_gap(s, piece, obstacle, 0, 1, HALVINGS, &found);
}

static ric_status make_room(locator *l, size_t width, ric_error *error) {
  if (width <= l->width)
    return RIC_OK;
  free(l->lower);
  free(l->upper);
  l->lower = malloc(width * sizeof *l->lower);
  l->upper = malloc(width * sizeof *l->upper);
  l->width = l->lower && l->upper ? width : 0;
  return l->width ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for bounds of %zu coordinates", width);
}

/* Obstacles at the coordinates of a piece, nearly all of which the bounds exclude. */
static ric_status scan_coordinates(scan *s, const ric_segment *piece) {
  const ric_system *system = s->flow->system;
  locator *l = s->l;
  RIC_TRY(make_room(l, piece->coordinates, s->error));
  ric_segment_bounds(piece, l->lower, l->upper);
  for (size_t k = system_first_obstacle(system, piece->first); k < system->obstacle_count; k++) {
    size_t j = system->by_coordinate[k];
    const ric_obstacle *o = &system->obstacles[j];
    size_t i = o->coordinate - piece->first;
    if (i >= piece->coordinates)
      break;
    double least = o->side > 0 ? l->lower[i] - o->position : o->position - l->upper[i];
    if (!(least > l->grazing_tol) || flow_contact(s->flow, j) != CONTACT_OPEN)
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
  size_t x = ((const hit *)a)->obstacle, y = ((const hit *)b)->obstacle;
  return x < y ? -1 : x > y;
}

static int by_position(const void *a, const void *b) {
  double x = ((const hit *)a)->x, y = ((const hit *)b)->x;
  return x < y ? -1 : x > y ? 1 : by_obstacle(a, b);
}

/* Drops what comes later than the first root, which was not known while the pieces were looked at. */
static void keep(hit_list *list, double latest) {
  size_t kept = 0;
  for (size_t i = 0; i < list->count; i++)
    if (list->hits[i].x <= latest)
      list->hits[kept++] = list->hits[i];
  list->count = kept;
}

ric_status locator_scan(locator *l, ric_flow *flow, double time_tol, ric_error *error) {
  scan s = {.l = l, .flow = flow, .together = time_tol / fabs(flow->length), .error = error};
  l->first = 2;
  l->roots.count = l->grazes.count = 0;
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
