/* Families of motions: the equations of shooting along a parameter, and their continuation. */
#include "family.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/family.h"
#include "numeric/required.h"

/* Continuation runs along a family. */

/* A continuation run with the caller's callback. */
typedef struct follower {
  ric_family *f;
  int (*point)(const ric_family_point *point, void *user);
  void *user;
  ric_curve_run *run;
  ric_status status; /* of an evaluation in the callback */
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

/* --- parameters --------------------------------------------------------------------------------------------------- */

ric_status family_set(ric_family *f, double first, double second, ric_error *error) {
  const ric_family_problem *p = &f->problem;
  if (f->at[0] == first && f->at[1] == second)
    return RIC_OK;
  f->at[0] = f->at[1] = NAN;
  const double both[2] = {first, second};
  f->given = p->set ? p->given : first;
  if (p->set)
    RIC_TRY(p->set(p->system, both, &f->given, p->user, error));
  if (p->set && p->periods > 1 && !p->motion.energy_given)
    f->given *= (double)p->periods;
  f->at[0] = first;
  f->at[1] = second;
  return RIC_OK;
}

void family_forget(ric_family *f) {
  f->at[0] = f->at[1] = f->evaluated_at[0] = f->evaluated_at[1] = NAN;
}

static int report_point(const ric_curve_point *c, void *user) {
  follower *w = user;
  ric_family *f = w->f;
  ric_family_point point = {.kind = kind_of(c->kind),
                            .parameter = c->p,
                            .unknowns = f->unknowns,
                            .z = c->u,
                            .tangent = c->t_u, /* t_p is its last number */
                            .orbit = &f->orbit,
                            .multipliers = f->options.multipliers ? &f->multipliers : NULL,
                            .obstacle = SIZE_MAX,
                            .time = NAN,
                            .arclength = c->arclength,
                            .step = c->step,
                            .iterations = c->iterations};
  w->status = family_set(f, c->p, f->problem.second, w->error);
  if (w->status == RIC_OK)
    w->status = family_complete(f, c->u, w->error);
  if (w->status != RIC_OK)
    return 1;
  point.given = f->given;
  if (c->kind == RIC_CURVE_TEST) {
    family_classify_zero(f, c->u, c->which, &point);
    if (point.kind == RIC_FAMILY_REGULAR) { /* a zero that is no special point */
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
  REQUIRE(error, {"family", f}, {"z", z}, {"run", run});
  ric_error own;
  follower w = {.f = f, .point = point, .user = user, .run = run, .error = error ? error : &own};
  f->coincide = SIZE_MAX;
  family_forget(f);
  RIC_TRY(ric_curve_follow(f->curve, z, parameter, tangent, report_point, &w, run, w.error));
  return w.status;
}

ric_status ric_family_switch(ric_family *f, const double *z, double parameter, const double *tangent, double *other,
                             ric_error *error) {
  REQUIRE(error, {"family", f}, {"z", z}, {"tangent", tangent}, {"other", other});
  family_forget(f);
  return ric_curve_switch(f->curve, z, parameter, tangent, other, error);
}

/* Step of differences in a parameter, relative to 1 + its size. Their error affects the convergence of Newton's
 * method and the predictions only: solutions satisfy F, which does not depend on them. */
static const double parameter_step = 1e-5;

const char *ric_family_kind_name(ric_family_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_FAMILY_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_FAMILY_KINDS ? names[kind] : "unknown kind";
}

ric_family_options ric_family_options_default(void) {
  ric_family_options options = {
      .curve = ric_curve_options_default(), .multipliers = true, .judge = ric_multiplier_options_default()};
  options.curve.newton_tol = 1e-12;
  return options;
}

static ric_status shifted_residual(ric_family *f, const double *at, size_t by, double shift, const double *z, double *F,
                                   ric_error *error) {
  double beside[2] = {at[0], at[1]};
  beside[by] += shift;
  RIC_TRY(family_set(f, beside[0], beside[1], error));
  return ric_shooting_residual(f->shooting, z, f->given, F, NULL, NULL, error);
}

/* Whether there is no residual at the shifted parameter: other failures are returned to the caller. */
static bool is_missing(ric_status status) {
  return status == RIC_EINVAL || status == RIC_ENUMERIC;
}

/* Derivative of F by a parameter at `at`: central differences, or one-sided ones of second order at the end of its
 * range. */
static ric_status difference_quotient(ric_family *f, const double *at, const double *z, size_t by, const double *F,
                                      double *F_p, ric_error *error) {
  const double h = parameter_step * (1 + fabs(at[by]));
  ric_status below = shifted_residual(f, at, by, -h, z, f->below, error);
  if (below != RIC_OK && !is_missing(below))
    return below;
  ric_status above = shifted_residual(f, at, by, h, z, f->above, error);
  if (above != RIC_OK && (!is_missing(above) || below != RIC_OK))
    return is_missing(above) ? RIC_ENUMERIC : above;
  for (size_t i = 0; below == RIC_OK && above == RIC_OK && i < f->unknowns; i++)
    F_p[i] = (f->above[i] - f->below[i]) / (2 * h);
  if (below == RIC_OK && above == RIC_OK)
    return RIC_OK;
  double side = above == RIC_OK ? 1 : -1, *near = side > 0 ? f->above : f->below, *far = side > 0 ? f->below : f->above;
  RIC_TRY(shifted_residual(f, at, by, 2 * side * h, z, far, error));
  for (size_t i = 0; i < f->unknowns; i++)
    F_p[i] = side * (4 * near[i] - far[i] - 3 * F[i]) / (2 * h);
  return RIC_OK;
}

static ric_status parameter_derivative(ric_family *f, const double *z, size_t by, const double *F, double *F_p,
                                       ric_error *error) {
  const double at[2] = {f->at[0], f->at[1]};
  RIC_TRY(difference_quotient(f, at, z, by, F, F_p, error));
  return family_set(f, at[0], at[1], error);
}

ric_status family_residual(ric_family *f, const double *z, size_t by, double *F, double *J, double *F_p,
                           ric_error *error) {
  bool exact = !f->problem.set;
  RIC_TRY(ric_shooting_residual(f->shooting, z, f->given, F, J, exact ? F_p : NULL, error));
  return exact ? RIC_OK : parameter_derivative(f, z, by, F, F_p, error);
}

/* Newton's method ends with a residual at its solution: the same run evaluates the orbit of that point. */
static ric_status curve_residual(const double *u, double p, double *F, double *J, double *F_p, void *user,
                                 ric_error *error) {
  ric_family *f = user;
  bool exact = !f->problem.set;
  RIC_TRY(family_set(f, p, f->problem.second, error));
  RIC_TRY(family_evaluate(f, u, F, J, exact ? F_p : NULL, error));
  return exact ? RIC_OK : parameter_derivative(f, u, 0, F, F_p, error);
}

static ric_status test(const double *u, double p, const double *t_u, double t_p, double *values, void *user,
                       ric_error *error) {
  ric_family *f = user;
  (void)t_u, (void)t_p;
  RIC_TRY(family_set(f, p, f->problem.second, error));
  RIC_TRY(family_complete(f, u, error));
  family_tests(f, u, values);
  return RIC_OK;
}

/* --- life --------------------------------------------------------------------------------------------------------- */

static ric_status copy_hits(ric_family *f, ric_error *error) {
  ric_shooting_problem *m = &f->problem.motion;
  size_t total = m->start_count + m->half_count + m->count;
  f->hits = malloc((total + 1) * sizeof *f->hits);
  if (!f->hits)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu impacts", total);
  const size_t *from[3] = {m->at_start, m->at_half, m->sequence}, count[3] = {m->start_count, m->half_count, m->count};
  size_t *to[3] = {f->hits, f->hits + m->start_count, f->hits + m->start_count + m->half_count};
  for (int k = 0; k < 3; k++)
    if (count[k] > 0)
      memcpy(to[k], from[k], count[k] * sizeof *f->hits);
  m->at_start = to[0];
  m->at_half = to[1];
  m->sequence = to[2];
  return RIC_OK;
}

static ric_status check_family(const ric_family_problem *p, const ric_family_options *o, ric_error *error) {
  REQUIRE(error, {"system", p->system});
  size_t numbers = ric_system_coordinates(p->system) + ric_system_speeds(p->system);
  if (p->parameters < 1 || p->parameters > 2 || (p->parameters == 2 && !p->set))
    return ric_fail(error, RIC_EINVAL, "parameters = %zu, expected 1, or 2 with a function that sets them",
                    p->parameters);
  if (o->multipliers && numbers > RIC_FAMILY_NUMBERS)
    return ric_fail(error, RIC_ELIMIT, "multipliers of a state of %zu numbers, expected at most %d", numbers,
                    RIC_FAMILY_NUMBERS);
  return RIC_OK;
}

static ric_status allocate_family(ric_family *f, ric_error *error) {
  size_t n = f->unknowns;
  f->block = calloc(3 * n, sizeof *f->block);
  if (!f->block)
    return ric_fail(error, RIC_ENOMEM, "no memory for a family of %zu unknowns", n);
  f->below = f->block;
  f->above = f->block + n;
  f->evaluated_z = f->block + 2 * n;
  RIC_TRY(ric_orbit_init_for(&f->orbit, f->problem.system, ric_shooting_impacts(f->shooting), error));
  if (!f->options.multipliers)
    return RIC_OK;
  return ric_multipliers_init(&f->multipliers, f->shooting->arcs.size, error);
}

static ric_status build_family(ric_family *f, ric_error *error) {
  const ric_shooting_problem *m = &f->problem.motion;
  RIC_TRY(copy_hits(f, error));
  RIC_TRY(ric_shooting_create(f->problem.system, m, &f->shooting, error));
  f->unknowns = ric_shooting_unknowns(f->shooting);
  f->impacts = m->start_count + m->half_count + m->count;
  f->tests = TEST_IMPACTS + f->impacts + (m->count > 0 ? f->shooting->arcs.arc_count : 0);
  RIC_TRY(allocate_family(f, error));
  const ric_curve_problem curve = {
      .unknowns = f->unknowns, .residual = curve_residual, .tests = f->tests, .test = test, .user = f};
  return ric_curve_create(&curve, &f->options.curve, &f->curve, error);
}

void ric_family_destroy(ric_family **family) {
  if (!family || !*family)
    return;
  ric_family *f = *family;
  ric_curve_destroy(&f->curve);
  ric_shooting_destroy(&f->shooting);
  ric_orbit_clear(&f->orbit);
  ric_multipliers_clear(&f->multipliers);
  free(f->hits);
  free(f->block);
  free(f);
  *family = NULL;
}

ric_status ric_family_create(const ric_family_problem *problem, const ric_family_options *options, ric_family **family,
                             ric_error *error) {
  REQUIRE(error, {"problem", problem}, {"family", family});
  ric_family_options o = options ? *options : ric_family_options_default();
  *family = NULL;
  RIC_TRY(check_family(problem, &o, error));
  ric_family *f = calloc(1, sizeof *f);
  if (!f)
    return ric_fail(error, RIC_ENOMEM, "no memory for a family");
  f->problem = *problem;
  f->options = o;
  f->coincide = SIZE_MAX;
  family_forget(f);
  ric_status status = build_family(f, error);
  if (status == RIC_OK)
    *family = f;
  else
    ric_family_destroy(&f);
  return status;
}

ric_shooting *ric_family_shooting(ric_family *family) {
  return family->shooting;
}

ric_status ric_family_start(ric_family *f, double parameter, const double *q, const double *u, const double *times,
                            double period, double *z, int *iterations, ric_error *error) {
  REQUIRE(error, {"family", f}, {"q", q}, {"z", z});
  family_forget(f);
  RIC_TRY(family_set(f, parameter, f->problem.second, error));
  RIC_TRY(ric_shooting_guess(f->shooting, q, u, times, period, z, error));
  return ric_shooting_solve(f->shooting, z, f->given, 0, iterations, error);
}
