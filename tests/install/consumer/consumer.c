/* A program outside the project: the orbit of Example 1 at one coupling, through the installed headers alone. */
#include <ricochet/ricochet.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  const size_t particles = 30, impact[] = {15};
  ric_error error;
  ric_chain chain = ric_chain_default(particles, 0.05);
  ric_pattern *pattern = NULL;
  ric_orbit_solver *solver = NULL;
  ric_orbit orbit = {0};
  int ok = strcmp(ric_version(), RIC_VERSION) == 0 &&
           ric_pattern_create(particles, impact, 1, NULL, 0, &pattern, &error) == RIC_OK &&
           ric_orbit_solver_create(NULL, &solver, &error) == RIC_OK &&
           ric_orbit_init(&orbit, particles, 1, &error) == RIC_OK &&
           ric_orbit_solve(solver, &chain, pattern, 4.71238898038469, &orbit, &error) == RIC_OK;
  if (ok)
    printf("%s, speed after the impact %.12f\n", ric_outcome_name(orbit.outcome), orbit.v[15]);
  else
    fprintf(stderr, "%s\n", error.message);
  ric_orbit_clear(&orbit);
  ric_orbit_solver_destroy(&solver);
  ric_pattern_destroy(&pattern);
  return ok && orbit.outcome == RIC_ADMISSIBLE ? 0 : 1;
}
