/* Exploration of families: segments are followed one after the other. */
#include "ricochet/explore.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "family.h"
#include "numeric/required.h"

/* A segment that is queued, followed or done. */
typedef struct segment {
  ric_explore_segment view; /* passed to the visitor */
  bool owned;               /* the exploration made its family and destroys it */
  double *z;                /* [unknowns]; NULL: no first point was found */
  double *tangent;          /* [unknowns + 1]; NULL: it is computed at the start */
  double parameter;
  ric_error why; /* why there is no first point */
} segment;

/* A point at which families meet. */
typedef struct meeting {
  double parameter, period, energy;
} meeting;

typedef struct exploration {
  ric_explore_options options;
  ric_explore_visitor visitor;
  segment *segments; /* [options.segments] */
  meeting *meetings; /* [options.segments] */
  size_t count, current, meeting_count, specials;
  ric_status status; /* RIC_OK, or the failure of a callback: RIC_ENOMEM, RIC_ESTOPPED */
  bool over;         /* the visitor has asked to stop */
  ric_error *error;
} exploration;

const char *ric_explore_origin_name(ric_explore_origin origin) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_EXPLORE_ORIGIN_LIST(X)
#undef X
  };
  return (unsigned)origin < RIC_EXPLORE_ORIGINS ? names[origin] : "unknown origin";
}

ric_explore_options ric_explore_options_default(void) {
  return (ric_explore_options){.segments = 16, .same_point_tol = 1e-6};
}

/* --- the queue ---------------------------------------------------------------------------------------------------- */

static bool is_near(double a, double b, double tolerance) {
  return fabs(a - b) <= tolerance * (1 + fabs(b));
}

/* Whether families are known to meet at this point already; records it otherwise. */
static bool is_known_meeting(exploration *e, const ric_family_point *point) {
  const meeting m = {point->parameter, point->orbit->period, point->orbit->energy};
  const double tolerance = e->options.same_point_tol;
  for (size_t i = 0; i < e->meeting_count; i++)
    if (is_near(m.parameter, e->meetings[i].parameter, tolerance) &&
        is_near(m.period, e->meetings[i].period, tolerance) && is_near(m.energy, e->meetings[i].energy, tolerance))
      return true;
  e->meetings[e->meeting_count++] = m;
  return false;
}

/* Queues a segment that begins at the special point reported last. */
static segment *add_segment(exploration *e, ric_explore_origin origin, const ric_family_point *point) {
  segment *s = &e->segments[e->count];
  *s = (segment){.view = {.index = e->count, .origin = origin, .special = e->specials - 1, .reason = ""},
                 .parameter = point->parameter};
  e->count++;
  return s;
}

/* A segment whose first point was not found has no points and keeps the reason. Without memory, or when stopped, the
 * exploration ends. */
static void record_failure(exploration *e, segment *s, ric_status status) {
  s->view.status = status;
  s->view.reason = s->why.message;
  if (status == RIC_ENOMEM || status == RIC_ESTOPPED)
    e->status = ric_fail(e->error, status, "%s", s->why.message);
}

typedef ric_status (*way_over)(ric_family *family, const ric_family_point *point, ric_family_junction *junction,
                               ric_error *error);

static void add_other_family(exploration *e, ric_explore_origin origin, const ric_family_point *point, way_over way) {
  ric_family_junction junction = {0};
  ric_family *family = e->segments[e->current].view.family;
  segment *s = add_segment(e, origin, point);
  const ric_status status = way(family, point, &junction, &s->why);
  if (status != RIC_OK) {
    ric_family_junction_clear(&junction);
    record_failure(e, s, status);
    return;
  }
  s->view.family = junction.family;
  s->owned = true;
  s->z = junction.z;
  s->tangent = junction.tangent;
  s->parameter = junction.parameter;
}

static double *copy_scaled(const double *numbers, size_t count, double factor) {
  double *copy = malloc(count * sizeof *copy);
  for (size_t i = 0; copy && i < count; i++)
    copy[i] = factor * numbers[i];
  return copy;
}

/* @param other  [unknowns + 1] tangent of the other branch @param side  1 or -1: the half along it or against it */
static void add_half(exploration *e, const ric_family_point *point, const double *other, int side) {
  ric_family *family = e->segments[e->current].view.family;
  segment *s = add_segment(e, RIC_EXPLORE_BRANCH_POINT, point);
  s->view.family = family;
  s->z = copy_scaled(point->z, point->unknowns, 1);
  s->tangent = copy_scaled(other, point->unknowns + 1, side);
  if (!s->z || !s->tangent)
    record_failure(e, s, ric_fail(&s->why, RIC_ENOMEM, "no memory for a point of %zu unknowns", point->unknowns));
}

/* Both halves of the branch that crosses the family here. */
static void add_other_branch(exploration *e, const ric_family_point *point) {
  ric_family *family = e->segments[e->current].view.family;
  ric_error why = {0};
  double *other = calloc(point->unknowns + 1, sizeof *other);
  const ric_status status =
      other ? ric_family_switch(family, point->z, point->parameter, point->tangent, other, &why)
            : ric_fail(&why, RIC_ENOMEM, "no memory for a tangent of %zu unknowns", point->unknowns);
  if (status != RIC_OK) {
    segment *s = add_segment(e, RIC_EXPLORE_BRANCH_POINT, point);
    s->why = why;
    record_failure(e, s, status);
  }
  for (int side = +1; status == RIC_OK && side >= -1 && e->count < e->options.segments; side -= 2)
    add_half(e, point, other, side);
  free(other);
}

/* The families that begin at a special point. */
static void add_families(exploration *e, const ric_family_point *point) {
  const bool even = shooting_is_even(ric_family_shooting(e->segments[e->current].view.family));
  const ric_family_kind kind = point->kind;
  const bool crosses = e->options.cross && (kind == RIC_FAMILY_GRAZING || kind == RIC_FAMILY_IMPACT_LOST);
  const bool doubles = e->options.branches && kind == RIC_FAMILY_PERIOD_DOUBLING && !even;
  const bool switches = e->options.branches && kind == RIC_FAMILY_BRANCH_POINT;
  if (e->count >= e->options.segments || !(crosses || doubles || switches) || is_known_meeting(e, point))
    return;
  if (switches)
    add_other_branch(e, point);
  else if (doubles)
    add_other_family(e, RIC_EXPLORE_PERIOD_DOUBLING, point, ric_family_double);
  else
    add_other_family(e, kind == RIC_FAMILY_GRAZING ? RIC_EXPLORE_GRAZING : RIC_EXPLORE_IMPACT_LOST, point,
                     ric_family_cross);
}

/* --- segments ----------------------------------------------------------------------------------------------------- */

static int visit_point(const ric_family_point *point, void *user) {
  exploration *e = user;
  if (e->visitor.point)
    e->over = e->visitor.point(&e->segments[e->current].view, point, e->visitor.user) != 0;
  if (!e->over && point->kind != RIC_FAMILY_REGULAR) {
    e->specials++;
    add_families(e, point);
  }
  return e->over || e->status != RIC_OK;
}

/* One segment to its end. @returns RIC_OK, RIC_ESTOPPED or RIC_ENOMEM */
static ric_status follow_segment(exploration *e, segment *s) {
  if (s->view.status == RIC_OK) {
    s->view.status =
        ric_family_follow(s->view.family, s->z, s->parameter, s->tangent, visit_point, e, &s->view.run, &s->why);
    s->view.reason = s->view.status == RIC_OK ? s->view.run.reason : s->why.message;
  }
  if (e->status == RIC_OK && (s->view.status == RIC_ENOMEM || s->view.status == RIC_ESTOPPED))
    e->status = ric_fail(e->error, s->view.status, "%s", s->view.reason);
  if (e->status == RIC_OK && !e->over && e->visitor.end)
    e->over = e->visitor.end(&s->view, e->visitor.user) != 0;
  return e->status;
}

static ric_status explore(exploration *e, ric_family *family, const double *z, double parameter) {
  segment *first = &e->segments[e->count++];
  *first = (segment){.view = {.origin = RIC_EXPLORE_START, .special = SIZE_MAX, .family = family, .reason = ""},
                     .z = copy_scaled(z, family->unknowns, 1),
                     .parameter = parameter};
  if (!first->z)
    return ric_fail(e->error, RIC_ENOMEM, "no memory for a point of %zu unknowns", family->unknowns);
  for (; e->current < e->count && !e->over; e->current++)
    RIC_TRY(follow_segment(e, &e->segments[e->current]));
  return RIC_OK;
}

static void clear(exploration *e) {
  for (size_t i = 0; i < e->count; i++) {
    if (e->segments[i].owned)
      ric_family_destroy(&e->segments[i].view.family);
    free(e->segments[i].z);
    free(e->segments[i].tangent);
  }
  free(e->segments);
  free(e->meetings);
}

ric_status ric_family_explore(ric_family *family, const double *z, double parameter, const ric_explore_options *options,
                              const ric_explore_visitor *visitor, ric_error *error) {
  REQUIRE(error, {"family", family}, {"z", z}, {"visitor", visitor});
  exploration e = {.options = options ? *options : ric_explore_options_default(), .visitor = *visitor, .error = error};
  if (!(e.options.segments >= 1 && e.options.same_point_tol >= 0))
    return ric_fail(error, RIC_EINVAL, "segments = %zu, same_point_tol = %g, expected at least 1 and 0",
                    e.options.segments, e.options.same_point_tol);
  e.segments = calloc(e.options.segments, sizeof *e.segments);
  e.meetings = calloc(e.options.segments, sizeof *e.meetings);
  const ric_status status = e.segments && e.meetings
                                ? explore(&e, family, z, parameter)
                                : ric_fail(error, RIC_ENOMEM, "no memory for %zu segments", e.options.segments);
  clear(&e);
  return status;
}
