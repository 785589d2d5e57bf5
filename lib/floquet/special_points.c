/* Special points along a sweep: three searches, one list. */
#include "ricochet/special_points.h"
#include "numeric/required.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Room for critical parameters: their search is long, and repeated only in the unlikely case of more of them. */
enum { CRITICAL_ROOM = 64 };

typedef struct special_list {
  ric_orbit_solver *solver;
  const ric_special_range *range;
  ric_special_point *points; /* [count] */
  size_t count;
} special_list;

const char *ric_special_name(ric_special_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_SPECIAL_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_SPECIAL_KINDS ? names[kind] : "unknown kind";
}

/* Makes room for more points. @returns the first of them, NULL when out of memory */
static ric_special_point *extend(special_list *s, size_t more, ric_error *error) {
  ric_special_point *points = realloc(s->points, (s->count + more + 1) * sizeof *points);
  if (!points) {
    ric_fail(error, RIC_ENOMEM, "no memory for %zu special points", s->count + more);
    return NULL;
  }
  s->points = points;
  for (size_t i = 0; i < more; i++)
    points[s->count + i] = (ric_special_point){.mode = SIZE_MAX, .multiplier = {NAN, NAN}, .uncertainty = NAN};
  s->count += more;
  return points + s->count - more;
}

/* --- the three searches: the first two are asked for their number, and again with room for it --------------------- */

static ric_status list_resonances(const special_list *s, ric_resonance *found, size_t *count, ric_error *error) {
  const ric_special_range *r = s->range;
  return ric_chain_resonances(r->chain, r->along, r->period, r->low, r->high, found, *count, count, error);
}

static ric_status add_resonances(special_list *s, ric_error *error) {
  size_t count = 0;
  RIC_TRY(list_resonances(s, NULL, &count, error));
  ric_resonance *found = calloc(count + 1, sizeof *found);
  ric_special_point *points = found ? extend(s, count, error) : NULL;
  const ric_status status = points ? list_resonances(s, found, &count, error)
                                   : ric_fail(error, RIC_ENOMEM, "no memory for %zu resonances", count);
  for (size_t i = 0; status == RIC_OK && i < count; i++) {
    points[i].kind = RIC_SPECIAL_RESONANCE;
    points[i].parameter = found[i].parameter;
    points[i].mode = found[i].mode;
    points[i].harmonic = found[i].harmonic;
  }
  free(found);
  return status;
}

static ric_status list_singular(const special_list *s, double *found, size_t *count, ric_error *error) {
  const ric_special_range *r = s->range;
  return ric_orbit_singular_points(s->solver, r->chain, r->pattern, r->along, r->period, r->low, r->high, found, *count,
                                   count, error);
}

static ric_status add_singular(special_list *s, ric_error *error) {
  size_t count = 0;
  RIC_TRY(list_singular(s, NULL, &count, error));
  double *found = calloc(count + 1, sizeof *found);
  ric_special_point *points = found ? extend(s, count, error) : NULL;
  const ric_status status = points ? list_singular(s, found, &count, error)
                                   : ric_fail(error, RIC_ENOMEM, "no memory for %zu singular points", count);
  for (size_t i = 0; status == RIC_OK && i < count; i++) {
    points[i].kind = RIC_SPECIAL_SINGULAR;
    points[i].parameter = found[i];
  }
  free(found);
  return status;
}

/* @param found  set, to be freed by the caller in any case */
static ric_status list_critical(const special_list *s, ric_critical **found, size_t *count, ric_error *error) {
  const ric_special_range *r = s->range;
  ric_status status = RIC_OK;
  *found = NULL;
  *count = CRITICAL_ROOM;
  for (size_t room = 0; status == RIC_OK && *count > room;) {
    room = *count;
    free(*found);
    *found = calloc(room, sizeof **found);
    if (!*found)
      return ric_fail(error, RIC_ENOMEM, "no memory for %zu critical parameters", room);
    status = ric_orbit_critical_points(s->solver, r->chain, r->pattern, r->along, r->period, r->low, r->high, r->points,
                                       *found, room, count, error);
  }
  return status;
}

static ric_status add_critical(special_list *s, ric_error *error) {
  ric_critical *found;
  size_t count;
  ric_status status = list_critical(s, &found, &count, error);
  ric_special_point *points = status == RIC_OK ? extend(s, count, error) : NULL;
  if (status == RIC_OK && !points)
    status = RIC_ENOMEM;
  for (size_t i = 0; status == RIC_OK && i < count; i++) {
    points[i].kind = (ric_special_kind)(RIC_SPECIAL_PLUS_ONE + (int)found[i].kind);
    points[i].parameter = found[i].parameter;
    points[i].multiplier = found[i].mu;
    points[i].change = found[i].outwards ? +1 : -1;
    points[i].uncertainty = found[i].uncertainty;
  }
  free(found);
  return status;
}

/* --- one list ----------------------------------------------------------------------------------------------------- */

static int compare_points(const void *a, const void *b) {
  const ric_special_point *x = a, *y = b;
  if (x->parameter != y->parameter)
    return x->parameter < y->parameter ? -1 : 1;
  if (x->kind != y->kind)
    return (int)x->kind - (int)y->kind;
  return x->mode < y->mode ? -1 : x->mode > y->mode;
}

static ric_status find_all(special_list *s, ric_error *error) {
  RIC_TRY(add_resonances(s, error));
  RIC_TRY(add_singular(s, error));
  if (s->range->points > 0 && s->range->low < s->range->high) /* else nothing lies between */
    RIC_TRY(add_critical(s, error));
  if (s->count > 0)
    qsort(s->points, s->count, sizeof *s->points, compare_points);
  return RIC_OK;
}

/* With the outcome of the orbit exactly there. */
static ric_status report_all(special_list *s, int (*point)(const ric_special_point *point, void *user), void *user,
                             ric_error *error) {
  const ric_special_range *r = s->range;
  const bool along_gamma = r->along == RIC_ALONG_GAMMA;
  ric_orbit orbit = {0};
  ric_chain chain = *r->chain;
  bool over = false;
  ric_status status = ric_orbit_init(&orbit, chain.particles, ric_pattern_impacts(r->pattern), error);
  for (size_t i = 0; i < s->count && status == RIC_OK && !over; i++) {
    ric_special_point *p = &s->points[i];
    if (along_gamma)
      chain.gamma = p->parameter;
    status = ric_orbit_solve(s->solver, &chain, r->pattern, along_gamma ? r->period : p->parameter, &orbit, error);
    p->outcome = orbit.outcome;
    over = status == RIC_OK && point(p, user) != 0;
  }
  ric_orbit_clear(&orbit);
  return status;
}

ric_status ric_orbit_special_points(ric_orbit_solver *solver, const ric_special_range *range,
                                    int (*point)(const ric_special_point *point, void *user), void *user,
                                    ric_error *error) {
  REQUIRE(error, {"solver", solver}, {"range", range}, {"point", called(point != NULL)});
  special_list list = {.solver = solver, .range = range};
  ric_status status = find_all(&list, error);
  if (status == RIC_OK)
    status = report_all(&list, point, user, error);
  free(list.points);
  return status;
}
