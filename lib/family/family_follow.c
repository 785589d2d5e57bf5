/* The walk along a family. */
#include <math.h>
#include <stdint.h>

#include "family_parts.h"

/* A walk with the caller's callback. */
typedef struct follower {
  ric_family *f;
  int (*point)(const ric_family_point *point, void *user);
  void *user;
  ric_curve_run *run;
  ric_status status; /* of a look that failed in the callback */
  ric_error *error;
} follower;

static ric_family_kind kind_of(ric_curve_point_kind kind) {
  switch (kind) {
  case RIC_CURVE_FOLD:
    return RIC_FAMILY_FOLD;
  case RIC_CURVE_BRANCH_POINT:
    return RIC_FAMILY_BRANCH_POINT;
  case RIC_CURVE_REGULAR:
  case RIC_CURVE_TEST:
  case RIC_CURVE_POINT_KINDS:
    break;
  }
  return RIC_FAMILY_REGULAR;
}

static int show(const ric_curve_point *c, void *user) {
  follower *w = user;
  ric_family *f = w->f;
  ric_family_point point = {.kind = kind_of(c->kind),
                            .parameter = c->p,
                            .unknowns = f->unknowns,
                            .z = c->u,
                            .tangent = c->t_u, /* t_p follows */
                            .orbit = &f->orbit,
                            .multipliers = f->options.multipliers ? &f->multipliers : NULL,
                            .obstacle = SIZE_MAX,
                            .time = NAN,
                            .arclength = c->arclength,
                            .step = c->step,
                            .iterations = c->iterations};
  w->status = family_set(f, c->p, f->problem.second, w->error);
  if (w->status == RIC_OK)
    w->status = family_look(f, c->u, w->error);
  if (w->status != RIC_OK)
    return 1;
  point.given = f->given;
  if (c->kind == RIC_CURVE_TEST) {
    family_name_zero(f, c->u, c->which, &point);
    if (point.kind == RIC_FAMILY_REGULAR) { /* a zero that means nothing */
      w->run->special--;
      return 0;
    }
  }
  int over = w->point ? w->point(&point, w->user) : 0;
  family_forget(f);
  return over;
}

ric_status ric_family_follow(ric_family *f, double *z, double parameter, const double *tangent,
                             int (*point)(const ric_family_point *point, void *user), void *user, ric_curve_run *run,
                             ric_error *error) {
  ric_error own;
  follower w = {.f = f, .point = point, .user = user, .run = run, .error = error ? error : &own};
  f->coincide = SIZE_MAX;
  family_forget(f);
  RIC_TRY(ric_curve_follow(f->curve, z, parameter, tangent, show, &w, run, w.error));
  return w.status;
}

ric_status ric_family_switch(ric_family *f, const double *z, double parameter, const double *tangent, double *other,
                             ric_error *error) {
  family_forget(f);
  return ric_curve_switch(f->curve, z, parameter, tangent, other, error);
}
