/* Curves of grazing in two parameters, with the criterion along them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "section.h"

typedef struct tracer {
  ric_family *f;
  ric_grazing grazing; /* of the point looked at last */
  ric_grazing_map map;
  ric_grazing_criterion criterion;
  double coefficients[RIC_GRAZING_CURVE_COEFFICIENTS];
  size_t count;
  double *rates; /* [n + m] */
  int (*seen)(const ric_grazing_curve_point *point, void *user);
  void *user;
  ric_status status; /* of a look that failed in the callback */
  ric_error *error;
} tracer;

static ric_status look(tracer *t, const ric_family_curve_point *p, ric_error *error) {
  ric_family *f = t->f;
  ric_grazing *g = &t->grazing;
  const size_t obstacle = g->local.obstacle;
  const shooting_gaps *gaps = f->shooting->gaps; /* of the point's orbit: where the gap is zero on the curve */
  const gap_found *least = gaps->hit[obstacle] ? &gaps->own : &gaps->free;
  touch at = {.obstacle = obstacle, .time = least->time, .x = g->x, .rates = t->rates};
  if (least->obstacle != obstacle)
    return ric_fail(error, RIC_ENUMERIC, "obstacle %zu is touched where obstacle %zu was", least->obstacle, obstacle);
  memcpy(g->z, p->z, g->unknowns * sizeof *g->z);
  g->parameter = p->parameter;
  g->second = p->second;
  RIC_TRY(touch_find(f->shooting, g->z, p->given, p->orbit->period, &at, error));
  RIC_TRY(grazing_keep(f, &at, p->orbit->period, g, error));
  const ric_grazing_plane plane = {.time = g->time};
  section here;
  const ric_status status = section_open(&here, f, g, &plane, &t->map, error);
  section_close(&here);
  RIC_TRY(status);
  return ric_grazing_criterion_find(&t->map, NULL, &t->criterion, t->coefficients, t->count, NULL, error);
}

static ric_status tests(const ric_family_curve_point *point, double *values, void *user, ric_error *error) {
  tracer *t = user;
  RIC_TRY(look(t, point, error));
  memcpy(values, t->coefficients, t->count * sizeof *values);
  return RIC_OK;
}

static int show(const ric_family_curve_point *p, void *user) {
  tracer *t = user;
  t->status = look(t, p, t->error);
  if (t->status != RIC_OK)
    return 1;
  const ric_grazing_curve_point point = {.grazing = &t->grazing,
                                         .criterion = &t->criterion,
                                         .coefficients = t->coefficients,
                                         .count = t->count,
                                         .zero = p->zero};
  return t->seen ? t->seen(&point, t->user) : 0;
}

static ric_status begin(tracer *t, const ric_grazing *from, ric_error *error) {
  RIC_TRY(ric_grazing_init(&t->grazing, t->f->shooting, error));
  t->grazing.time = from->time;
  t->grazing.local.obstacle = from->local.obstacle;
  RIC_TRY(ric_grazing_map_init(&t->map, ric_grazing_coordinates(from, t->f->shooting), error));
  t->rates = malloc(from->numbers * sizeof *t->rates);
  return t->rates ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for %zu rates", from->numbers);
}

ric_status ric_grazing_trace(ric_family *f, const ric_grazing *from, const ric_curve_options *options, size_t count,
                             int (*seen)(const ric_grazing_curve_point *point, void *user), void *user,
                             ric_curve_run *run, ric_error *error) {
  ric_error own;
  tracer t = {.f = f, .count = count, .seen = seen, .user = user, .error = error ? error : &own};
  const ric_family_point point = {.kind = RIC_FAMILY_GRAZING,
                                  .parameter = from->parameter,
                                  .unknowns = from->unknowns,
                                  .z = from->z,
                                  .given = from->given,
                                  .obstacle = from->local.obstacle,
                                  .time = from->time};
  const ric_family_curve_tests along = {count, tests, &t};
  if (count > RIC_GRAZING_CURVE_COEFFICIENTS)
    return ric_fail(error, RIC_EINVAL, "count = %zu, expected at most %d coefficients", count,
                    RIC_GRAZING_CURVE_COEFFICIENTS);
  ric_status status = begin(&t, from, t.error);
  if (status == RIC_OK)
    status = ric_family_trace(f, &point, options, &along, show, &t, run, t.error);
  if (status == RIC_OK)
    status = t.status;
  ric_grazing_clear(&t.grazing);
  ric_grazing_map_clear(&t.map);
  free(t.rates);
  return status;
}
