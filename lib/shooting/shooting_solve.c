/* Solving F(z) = 0 from afar. */
#include <math.h>

#include "numeric/largest.h"
#include "numeric/newton.h"
#include "shooting_parts.h"

static const double default_tolerance = 1e-13;
/* Ends of a conservative motion that are farther apart, relative to 1 + the largest unknown, are not one state. */
static const double lambda_tol = 1e-6;

/* Motions that take so many times the steps of the guess, and some, lead nowhere: Newton's method tries states of any
 * size, and fast ones would take for ever. */
enum { STEPS_GROW = 50, STEPS_MORE = 1000 };

typedef struct search {
  ric_shooting *s;
  double given;
  unsigned long long most_steps; /* of a motion; 0 before the first */
} search;

static ric_status residual(const double *z, double *F, double *J, void *user, ric_error *error) {
  search *k = user;
  arc_runner *runner = &k->s->runner;
  unsigned long long before = ric_flow_counted(arc_runner_flow(runner)).steps;
  if (J) /* at a point whose residual is known */
    return ric_shooting_residual(k->s, z, k->given, F, J, NULL, error);
  runner->last_step = k->most_steps ? before + k->most_steps : 0;
  ric_status status = ric_shooting_residual(k->s, z, k->given, F, NULL, NULL, error);
  runner->last_step = 0;
  if (k->most_steps == 0)
    k->most_steps = STEPS_GROW * (ric_flow_counted(arc_runner_flow(runner)).steps - before) + STEPS_MORE;
  return status;
}

/* E(x - lambda grad E) = E(x) has other solutions than lambda = 0: they close nothing. */
static ric_status check_lambda(const ric_shooting *s, const double *z, ric_error *error) {
  size_t index = s->arcs.lambda;
  double added = index == NO_UNKNOWN ? 0 : fabs(z[index]) * largest(s->gradient, s->arcs.size);
  if (added <= lambda_tol * (1 + largest(z, s->arcs.unknowns)))
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC,
                  "shooting converges to no motion: its ends are %.3g apart along the gradient of the energy", added);
}

ric_status ric_shooting_solve(ric_shooting *s, double *z, double given, double tolerance, int *iterations,
                              ric_error *error) {
  int count = 0;
  double tol = tolerance == 0 ? default_tolerance : tolerance;
  search k = {.s = s, .given = given};
  const newton_problem problem = {.name = "shooting", .unknowns = s->arcs.unknowns, .residual = residual, .user = &k};
  if (!(tol > 0 && tol < 1))
    return ric_fail(error, RIC_EINVAL, "tolerance = %g, expected 0 to 1", tolerance);
  ric_status status = newton_solve(&problem, z, tol, &count, error);
  if (status == RIC_OK)
    status = check_lambda(s, z, error);
  if (iterations)
    *iterations = count;
  return status;
}
