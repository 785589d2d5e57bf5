#include "ritz_approximation.h"

#include "support.h"

#include "recorded_run.h"

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

ric_system *duffing_masses(double epsilon, int side) {
  const ric_spring links[3] = {[0] = {.linear = 3}, [1] = {.linear = 1, .cubic = epsilon}};
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  const ric_obstacle obstacle = {.coordinate = 1, .side = side, .position = -2.0 * side, 1, INFINITY};
  lattice.on_site = (ric_spring){0};
  lattice.links = links;
  return lattice_system(&lattice, &obstacle, 1);
}

/* Even motions with the impact of obstacle 0 at t = 0. Takes the system over. */
static shooting_solution one_impact(ric_system *system) {
  static const size_t obstacle = 0;
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_EVEN, .at_start = &obstacle, .start_count = 1, .flow = ric_flow_options_default()};
  return shooting_solution_of_system(system, &problem);
}

shooting_solution duffing_mode(double epsilon, double before, int side) {
  /* Periods of the smooth mode whose second mass comes to 2. */
  static const double touching[4][2] = {{0, 7.524776}, {0.05, 7.366492}, {0.1, 7.235630}, {0.2, 7.030063}};
  shooting_solution s = one_impact(duffing_masses(epsilon, side));
  const double q[2] = {-0.65 * side, -2.0 * side}, u[2] = {0, 0.8 * before * side};
  double period = 0;
  for (size_t k = 0; k < 4; k++)
    period = touching[k][0] == epsilon ? touching[k][1] : period;
  shooting_solution_guess(&s, q, u, NULL, period - before);
  shooting_solution_solve(&s);
  assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
  return s;
}

shooting_solution chain_mode(size_t particles, size_t particle, ric_ends ends, double gamma, double period, int side) {
  ric_lattice lattice = ric_lattice_default(particles, ends);
  const ric_obstacle obstacle = {.coordinate = particle, .side = side, .position = -side, 1, INFINITY};
  double q[16] = {0}, u[16] = {0};
  lattice.on_site = (ric_spring){.linear = 1, .quadratic = 0.03 * side, .cubic = 0.02};
  lattice.link = (ric_spring){.linear = gamma, .quadratic = -0.01 * side, .cubic = 0.02};
  shooting_solution s = one_impact(lattice_system(&lattice, &obstacle, 1));
  u[particle] = -tan(period / 2) * side;
  shooting_solution_guess(&s, q, u, NULL, period);
  shooting_solution_solve(&s);
  assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
  return s;
}

ritz_approximation ritz_approximate(shooting_solution *s, size_t functions, bool constants) {
  const ric_ritz_options options = {.functions = functions, .constants = constants};
  ritz_approximation a = {0};
  ric_error error;
  check(ric_ritz_create(s->system, 0, &options, &a.ritz, &error), &error);
  a.c = calloc(ric_ritz_unknowns(a.ritz), sizeof *a.c);
  assert_non_null(a.c);
  check(ric_ritz_refine(a.ritz, s->shooting, s->z, s->given, 0, a.c, NULL, &error), &error);
  check(ric_ritz_error(a.ritz, a.c, s->given, s->shooting, s->z, &a.error_q, &a.error_v, &error), &error);
  if (constants)
    assert_int_equal(ric_ritz_functions(a.ritz), functions);
  return a;
}

void ritz_approximation_clear(ritz_approximation *a) {
  ric_ritz_destroy(&a->ritz);
  free(a->c);
  *a = (ritz_approximation){0};
}

double convergence_order(const size_t *number, const double *error, size_t count) {
  double x = 0, y = 0, xx = 0, xy = 0, n = (double)count;
  for (size_t k = 0; k < count; k++) {
    double a = log((double)number[k]), b = log(error[k]);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (x * y - n * xy) / (n * xx - x * x);
}
