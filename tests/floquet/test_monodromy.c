/* Monodromy matrices of periodic motions: what they predict, and what is known of their determinants. */
#include "support.h"

#include <gsl/gsl_linalg.h>

#include "witness/derivative.h"
#include "witness/random_lattice.h"
#include "witness/recorded_run.h"
#include "scenario/scenario.h"

enum { N = 30, MOST = 8, SIZE = 4 * MOST * MOST };

static double log_determinant(double *A, size_t size) {
  gsl_matrix_view a = gsl_matrix_view_array(A, size, size);
  gsl_permutation *p = gsl_permutation_alloc(size);
  int sign;
  gsl_linalg_LU_decomp(&a.matrix, p, &sign);
  gsl_permutation_free(p);
  assert_int_equal(gsl_linalg_LU_sgndet(&a.matrix, sign), 1); /* pairs of signs: every impact turns two */
  return gsl_linalg_LU_lndet(&a.matrix);
}

/* Divergence of a lattice: minus the dampers over the masses. */
static double divergence(const ric_lattice *l) {
  double sum = 0;
  for (size_t i = 0; i < l->particles; i++) {
    ric_spring own = ric_lattice_on_site(l, i), left = ric_lattice_link(l, i), right = ric_lattice_link(l, i + 1);
    sum -= (own.damping + left.damping + right.damping) / ric_lattice_mass(l, i);
  }
  return sum;
}

static double losses(const recorded_run *r, const ric_obstacle *obstacles) {
  double sum = 0;
  for (size_t i = 0; i < r->count; i++)
    if (ric_event_jumps(&r->events[i]))
      sum += 2 * log(obstacles[r->events[i].obstacle].restitution);
  return sum;
}

static void determinant_is_that_of_impacts_and_damping(void **state) {
  (void)state;
  size_t impacts = 0;
  for (uint64_t seed = 0; seed < 60; seed++) {
    static random_lattice l;
    static double D[SIZE];
    random_source source = {.state = seed};
    size_t n = 1 + random_below(&source, MOST);
    double x[2 * MOST], end = 6;
    ric_obstacle floors[MOST];
    random_lattice_set(&l, &source, n, (ric_ends)(seed % 3), WITH_ALL);
    for (size_t i = 0; i < n; i++) {
      x[i] = random_uniform(&source, -0.35, 0.6);
      x[n + i] = random_uniform(&source, -1, 1);
      floors[i] = ric_obstacle_floor(i, -0.5);
      floors[i].restitution = random_uniform(&source, 0.5, 1);
    }
    ric_system *system = lattice_system(&l.lattice, floors, n);
    recorded_run r = record_run(system, NULL, x, x + n, end);
    assert_int_equal(derivative_by_tangents(system, NULL, 0, x, end, D), RIC_RUN_COMPLETED);
    double size = 1;
    for (size_t i = 0; i < 4 * n * n; i++)
      size = fmax(size, fabs(D[i]));
    double expected = divergence(&l.lattice) * end + losses(&r, floors);
    assert_close(log_determinant(D, 2 * n), expected, 1e-13 * size * size * exp(fabs(expected) / 2));
    impacts += recorded_run_impacts(&r);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
  assert_true(impacts > 100);
}

/* The orbit of the source's figure, its state at T/4 and its monodromy matrix. */
typedef struct unstable {
  ric_system *system;
  double period, q[N], v[N], M[4 * N * N];
} unstable;

static void unstable_set(unstable *u) {
  scenario s = scenario_middle(N, RIC_ENDS_PERIODIC, 0.149153131912, 4.69756390941);
  ric_orbit_solver *solver = NULL;
  ric_orbit orbit;
  ric_monodromy monodromy;
  double quarter = s.period / 4;
  u->period = s.period;
  assert_int_equal(ric_orbit_solver_create(NULL, &solver, NULL), RIC_OK);
  assert_int_equal(ric_orbit_init(&orbit, N, 1, NULL), RIC_OK);
  assert_int_equal(ric_orbit_solve(solver, &s.chain, s.pattern, s.period, &orbit, NULL), RIC_OK);
  assert_int_equal(ric_orbit_states(solver, &s.chain, &orbit, &quarter, 1, u->q, u->v, NULL), RIC_OK);
  assert_int_equal(ric_orbit_monodromy(solver, &s.chain, &orbit, NULL, u->M, &monodromy, NULL), RIC_OK);
  assert_int_equal(monodromy.outcome, RIC_RUN_COMPLETED);
  assert_int_equal(monodromy.impacts, 1);
  assert_true(monodromy.closure_error < 1e-13);
  assert_int_equal(ric_system_create_chain(&s.chain, &u->system, NULL), RIC_OK);
  ric_orbit_clear(&orbit);
  ric_orbit_solver_destroy(&solver);
  scenario_clear(&s);
}

/* Largest eigenvalue of M by the power method; its eigenvector [2N] of unit length. */
static double dominant(const double *M, double *e) {
  double mu = 0, next[2 * N];
  for (int i = 0; i < 2 * N; i++)
    e[i] = 1.0 / (1 + i);
  for (int k = 0; k < 400; k++) {
    double sum = 0;
    for (int i = 0; i < 2 * N; i++) {
      next[i] = 0;
      for (int j = 0; j < 2 * N; j++)
        next[i] += M[2 * N * i + j] * e[j];
      sum += next[i] * next[i];
    }
    mu = sqrt(sum);
    for (int i = 0; i < 2 * N; i++)
      e[i] = next[i] / mu;
  }
  return mu;
}

static void unstable_orbit_is_left_along_its_eigenvector(void **state) {
  (void)state;
  static unstable u;
  unstable_set(&u);
  double e[2 * N], q[N], v[N], mu = dominant(u.M, e), size = 1e-9;
  assert_close(mu, 1.882696258, 1e-9);
  for (int i = 0; i < N; i++) {
    q[i] = u.q[i] + size * e[i];
    v[i] = u.v[i] + size * e[N + i];
  }
  ric_trajectory *trajectory = NULL;
  assert_int_equal(ric_trajectory_create(u.system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, u.period / 4, q, v, NULL), RIC_OK);
  for (int k = 1; k <= 12; k++) {
    ric_run run;
    assert_int_equal(ric_trajectory_run(trajectory, (k + 0.25) * u.period, NULL, &run, NULL), RIC_OK);
    size *= mu;
    for (int i = 0; i < N; i++) { /* the rest is of second order, and of the rounding at the start */
      assert_close(ric_trajectory_q(trajectory)[i] - u.q[i], size * e[i], 3 * size * size + 1e-5 * size);
      assert_close(ric_trajectory_u(trajectory)[i] - u.v[i], size * e[N + i], 3 * size * size + 1e-5 * size);
    }
  }
  assert_true(size > 1e-6);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&u.system);
}

static void periods_must_be_positive(void **state) {
  (void)state;
  double q = 1, u = 0, M[4];
  ric_monodromy monodromy;
  ric_error error;
  ric_system *ball = falling_ball(1);
  assert_int_equal(ric_monodromy_find(ball, 0, &q, &u, 0, NULL, M, &monodromy, &error), RIC_EINVAL);
  assert_string_equal(error.message, "period = 0, expected > 0");
  ric_system_destroy(&ball);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(determinant_is_that_of_impacts_and_damping),
      cmocka_unit_test(unstable_orbit_is_left_along_its_eigenvector),
      cmocka_unit_test(periods_must_be_positive),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
