#include "shooting_solution.h"

#include "support.h"

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

shooting_solution shooting_solution_of_system(ric_system *system, const ric_shooting_problem *problem) {
  shooting_solution s = {.system = system};
  ric_error error;
  check(ric_shooting_create(system, problem, &s.shooting, &error), &error);
  s.unknowns = ric_shooting_unknowns(s.shooting);
  s.z = calloc(s.unknowns, sizeof *s.z);
  assert_non_null(s.z);
  check(ric_orbit_init_for(&s.orbit, system, ric_shooting_impacts(s.shooting), &error), &error);
  return s;
}

void shooting_solution_clear(shooting_solution *s) {
  ric_shooting_destroy(&s->shooting);
  ric_system_destroy(&s->system);
  ric_orbit_clear(&s->orbit);
  free(s->z);
  *s = (shooting_solution){0};
}

void shooting_solution_guess(shooting_solution *s, const double *q, const double *u, const double *times,
                             double period) {
  ric_error error;
  check(ric_shooting_guess(s->shooting, q, u, times, period, s->z, &error), &error);
  s->given = period;
}

void shooting_solution_solve(shooting_solution *s) {
  ric_error error;
  check(ric_shooting_solve(s->shooting, s->z, s->given, 0, &s->iterations, &error), &error);
  check(ric_shooting_orbit(s->shooting, s->z, s->given, &s->orbit, &error), &error);
}

/* Central differences of F along one number. */
static void slope(shooting_solution *s, double *number, double step, double *below, double *above) {
  ric_error error;
  double kept = *number;
  *number = kept + step;
  check(ric_shooting_residual(s->shooting, s->z, s->given, above, NULL, NULL, &error), &error);
  *number = kept - step;
  check(ric_shooting_residual(s->shooting, s->z, s->given, below, NULL, NULL, &error), &error);
  *number = kept;
  for (size_t i = 0; i < s->unknowns; i++)
    above[i] = (above[i] - below[i]) / (2 * step);
}

double shooting_jacobian_error(shooting_solution *s, double step) {
  size_t n = s->unknowns;
  double *J = malloc((n * n + 4 * n) * sizeof *J), worst = 0, size = 1;
  assert_non_null(J);
  double *F = J + n * n, *F_given = F + n, *below = F + 2 * n, *above = F + 3 * n;
  ric_error error;
  check(ric_shooting_residual(s->shooting, s->z, s->given, F, J, F_given, &error), &error);
  for (size_t j = 0; j <= n; j++) {
    slope(s, j < n ? &s->z[j] : &s->given, step, below, above);
    for (size_t i = 0; i < n; i++) {
      double exact = j < n ? J[i * n + j] : F_given[i];
      worst = fmax(worst, fabs(exact - above[i]));
      size = fmax(size, fabs(exact));
    }
  }
  free(J);
  return worst / size;
}

shooting_solution shooting_solution_of_chain(const ric_chain *chain, const ric_pattern *pattern) {
  size_t n = chain->particles, count[2] = {0}, *hit = malloc(2 * n * sizeof *hit);
  ric_system *system = NULL;
  ric_error error;
  assert_non_null(hit);
  check(ric_system_create_chain(chain, &system, &error), &error);
  for (size_t k = 0; k < ric_pattern_impacts(pattern); k++) {
    size_t particle = ric_pattern_impact(pattern, k), half = ric_pattern_role(pattern, particle) == RIC_ROLE_HALF;
    hit[half * n + count[half]++] = particle;
  }
  const ric_shooting_problem problem = {.kind = RIC_MOTION_EVEN,
                                        .at_start = hit,
                                        .start_count = count[0],
                                        .at_half = hit + n,
                                        .half_count = count[1],
                                        .flow = ric_flow_options_default()};
  shooting_solution s = shooting_solution_of_system(system, &problem);
  free(hit);
  return s;
}
