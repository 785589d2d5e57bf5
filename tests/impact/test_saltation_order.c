/* Saltation matrices themselves: determinants, limits, and impacts at one time in both orders. */
#include "support.h"

#include <gsl/gsl_linalg.h>

#include "witness/derivative.h"
#include "witness/random_lattice.h"
#include "witness/recorded_run.h"

enum { MOST = 6, SIZE = 4 * MOST * MOST };

static double determinant(const double *A, size_t size) {
  double store[SIZE];
  memcpy(store, A, size * size * sizeof *A);
  gsl_matrix_view a = gsl_matrix_view_array(store, size, size);
  gsl_permutation *p = gsl_permutation_alloc(size);
  int sign;
  gsl_linalg_LU_decomp(&a.matrix, p, &sign);
  gsl_permutation_free(p);
  return gsl_linalg_LU_det(&a.matrix, sign);
}

static void determinant_is_the_square_of_the_restitution(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < 100; seed++) {
    static random_lattice r;
    static double S[SIZE];
    random_source source = {.state = seed};
    size_t n = 1 + random_below(&source, MOST), i = random_below(&source, n);
    double q[MOST], u[MOST], e = random_uniform(&source, 0, 1);
    ric_saltation_kind kind;
    random_lattice_set(&r, &source, n, (ric_ends)(seed % 3), WITH_ALL);
    random_lattice_state(&source, n, q, u);
    ric_obstacle floor = ric_obstacle_floor(i, q[i]);
    floor.restitution = e;
    u[i] = -0.1 - fabs(u[i]);
    ric_system *system = lattice_system(&r.lattice, &floor, 1);
    assert_int_equal(ric_saltation_find(system, 0.2, q, u, &(size_t){0}, 1, 1e-10, S, NULL, &kind, NULL), RIC_OK);
    assert_int_equal(kind, RIC_SALTATION_DIFFERENTIABLE);
    assert_close(determinant(S, 2 * n), e * e, 1e-12);
    assert_close(S[i * 2 * n + i], -e, 1e-14); /* [JAP] (16) */
    assert_close(S[(n + i) * 2 * n + n + i], -e, 1e-14);
    ric_system_destroy(&system);
  }
}

static void slow_impacts_are_refused(void **state) {
  (void)state;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, -1); /* the spring pulls away from it */
  ric_system *system = lattice_system(&mass, &floor, 1);
  static const double rates[] = {1e-11, 1e-6, 1e-4}; /* the second goes 5e-13 deep */
  for (int k = 0; k < 3; k++) {
    double S[4] = {7, 7, 7, 7}, q = -1, u = -rates[k];
    ric_saltation_kind kind;
    assert_int_equal(ric_saltation_find(system, 0, &q, &u, &(size_t){0}, 1, 1e-10, S, NULL, &kind, NULL), RIC_OK);
    assert_int_equal(kind, k < 2 ? RIC_SALTATION_GRAZING : RIC_SALTATION_DIFFERENTIABLE);
    assert_true(k == 2 || S[0] == 7);
  }
  ric_error error;
  ric_saltation_kind kind;
  double S[4], still = 0, q = -1;
  assert_int_equal(ric_saltation_find(system, 0, &q, &still, &(size_t){0}, 1, 1e-10, S, NULL, &kind, &error),
                   RIC_EINVAL);
  assert_non_null(strstr(error.message, "gap rate of obstacle 0 is 0"));
  assert_int_equal(ric_saltation_find(system, 0, &q, &still, &(size_t){1}, 1, 1e-10, S, NULL, &kind, &error),
                   RIC_EINVAL);
  assert_non_null(strstr(error.message, "obstacle 1, expected one of 1"));
  ric_system_destroy(&system);
}

/* Two particles that hit their floors together; with a damper between them each feels the other's speed. */
typedef struct pair {
  ric_system *free, *with_floors;
  double start[4], at_impact[4];
  double time; /* of the impact */
} pair;

static pair pair_create(double damping) {
  pair p = {.start = {-0.3, -0.3, -1, -1}};
  ric_lattice two = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_obstacle floors[2] = {ric_obstacle_floor(0, -0.5), ric_obstacle_floor(1, -0.5)};
  two.link = (ric_spring){.linear = 0.7, .damping = damping};
  p.free = lattice_system(&two, NULL, 0);
  p.with_floors = lattice_system(&two, floors, 2);
  recorded_run r = record_run(p.with_floors, NULL, p.start, p.start + 2, 0.5);
  assert_int_equal(r.count, 2);
  p.time = r.events[0].time;
  recorded_run_clear(&r);
  r = record_run(p.free, NULL, p.start, p.start + 2, p.time);
  memcpy(p.at_impact, r.q, 2 * sizeof(double));
  memcpy(p.at_impact + 2, r.u, 2 * sizeof(double));
  recorded_run_clear(&r);
  return p;
}

static void pair_clear(pair *p) {
  ric_system_destroy(&p->free);
  ric_system_destroy(&p->with_floors);
}

static void multiply(const double *A, const double *B, double *C) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      C[4 * i + j] = 0;
      for (int k = 0; k < 4; k++)
        C[4 * i + j] += A[4 * i + k] * B[4 * k + j];
    }
}

static void reach(const pair *p, const double *x, double end, double *out) {
  recorded_run r = record_run(p->with_floors, NULL, x, x + 2, end);
  memcpy(out, r.q, 2 * sizeof(double));
  memcpy(out + 2, r.u, 2 * sizeof(double));
  recorded_run_clear(&r);
}

/* Largest difference between D d and the difference quotient in the direction d. */
static double quotient_error(const pair *p, const double *D, const double *d, double h, double end) {
  double x[4], moved[4], still[4], most = 0;
  for (int i = 0; i < 4; i++)
    x[i] = p->start[i] + h * d[i];
  reach(p, x, end, moved);
  reach(p, p->start, end, still);
  for (int i = 0; i < 4; i++) {
    double along = 0;
    for (int j = 0; j < 4; j++)
      along += D[4 * i + j] * d[j];
    most = fmax(most, fabs((moved[i] - still[i]) / h - along));
  }
  return most;
}

/* The derivative of a run through the impacts in one order, from that of free motion and a saltation matrix. */
static void compose(const pair *p, const double *S, double end, double *D) {
  double before[16], after[16], half[16], x[4] = {p->at_impact[0], p->at_impact[1], -p->at_impact[2], -p->at_impact[3]};
  derivative_by_tangents(p->free, NULL, 0, p->start, p->time, before);
  derivative_by_tangents(p->free, NULL, p->time, x, end, after);
  multiply(S, before, half);
  multiply(after, half, D);
}

static void both_orders_agree_where_no_force_depends_on_the_others_speed(void **state) {
  (void)state;
  pair p = pair_create(0);
  double S[16], reverse[16], D[16], run[16], end = 0.6;
  ric_saltation_kind kind;
  assert_int_equal(ric_saltation_find(p.with_floors, p.time, p.at_impact, p.at_impact + 2, (size_t[]){0, 1}, 2, 1e-10,
                                      S, reverse, &kind, NULL),
                   RIC_OK);
  assert_int_equal(kind, RIC_SALTATION_DIFFERENTIABLE);
  assert_true(derivative_error(S, reverse, 4) < 1e-14);
  compose(&p, S, end, D);
  assert_int_equal(derivative_by_tangents(p.with_floors, NULL, 0, p.start, end, run), RIC_RUN_COMPLETED);
  assert_true(derivative_error(run, D, 4) < 1e-12);
  static const double d[4] = {1, -0.5, 0.3, 0.8};
  double coarse = quotient_error(&p, D, d, 1e-4, end), fine = quotient_error(&p, D, d, 1e-5, end);
  assert_true(fine < 1e-4);
  assert_close(coarse / fine, 10, 0.5); /* O(h), no better */
  pair_clear(&p);
}

static void orders_differ_where_a_damper_couples_them(void **state) {
  (void)state;
  pair p = pair_create(0.4);
  double S[2][16], D[16], end = 0.6;
  ric_saltation_kind kind;
  assert_int_equal(ric_saltation_find(p.with_floors, p.time, p.at_impact, p.at_impact + 2, (size_t[]){0, 1}, 2, 1e-10,
                                      S[0], S[1], &kind, NULL),
                   RIC_OK);
  assert_int_equal(kind, RIC_SALTATION_NOT_DIFFERENTIABLE);
  assert_int_equal(derivative_by_tangents(p.with_floors, NULL, 0, p.start, end, D), RIC_RUN_NOT_DIFFERENTIABLE);
  for (int first = 0; first < 2; first++) {
    double d[4] = {0, 0, 0.3, 0.8};
    d[first] = -1; /* this one is lower, and comes first */
    compose(&p, S[first], end, D);
    assert_true(quotient_error(&p, D, d, 1e-5, end) < 1e-4);
    compose(&p, S[!first], end, D);
    assert_true(quotient_error(&p, D, d, 1e-5, end) > 0.05);
  }
  pair_clear(&p);
}

/* Balls of masses 1 and 2 joined by inertia: which one lands first decides where both go. */
static void coupled_contacts_have_no_derivative(void **state) {
  (void)state;
  const ric_mck model = {
      .coordinates = 2, .mass.values = (double[]){1, 0.4, 0.4, 2}, .stiffness.values = (double[]){1, 0, 0, 1}};
  ric_obstacle floors[2] = {ric_obstacle_floor(0, -0.5), ric_obstacle_floor(1, -0.5)};
  ric_system *system = NULL;
  double S[2][16];
  ric_saltation_kind kind;
  assert_int_equal(ric_system_create_mck(&model, floors, 2, &system, NULL), RIC_OK);
  static const double q[2] = {-0.5, -0.5}, u[2] = {-1, -0.7};
  assert_int_equal(ric_saltation_find(system, 0, q, u, (size_t[]){0, 1}, 2, 1e-10, S[0], S[1], &kind, NULL), RIC_OK);
  assert_int_equal(kind, RIC_SALTATION_NOT_DIFFERENTIABLE);
  assert_close(determinant(S[0], 4), 1, 1e-10); /* each is a product of elastic impacts */
  assert_close(determinant(S[1], 4), 1, 1e-10);
  ric_system_destroy(&system);
}

/* A ball that comes to rest, is held, and is let go: its tangent vectors vanish while it is held. */
static void rest_takes_the_tangent_vectors_of_a_contact(void **state) {
  (void)state;
  ric_system *ball = falling_ball(0.5);
  ric_trajectory *trajectory = NULL;
  ric_run run;
  assert_int_equal(ric_trajectory_create(ball, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, (double[]){1}, (double[]){0}, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_carry(trajectory, 2, (double[]){1, 0}, (double[]){0, 1}, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, 10, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  assert_true(ric_trajectory_rests(trajectory, 0));
  for (int k = 0; k < 2; k++) {
    assert_close(ric_trajectory_dq(trajectory)[k], 0, 1e-12);
    assert_close(ric_trajectory_du(trajectory)[k], 0, 1e-12);
  }
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&ball);
}

/* A mass that just touches: the run ends there, and goes on without tangent vectors. */
static void runs_end_where_a_contact_grazes(void **state) {
  (void)state;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, -1);
  ric_system *system = lattice_system(&mass, &floor, 1);
  ric_trajectory *trajectory = NULL;
  ric_run run;
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_carry(trajectory, 1, (double[]){1}, (double[]){0}, NULL), RIC_EINVAL);
  assert_int_equal(ric_trajectory_start(trajectory, 0, (double[]){1}, (double[]){0}, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_carry(trajectory, 1, (double[]){1}, (double[]){0}, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_columns(trajectory), 1);
  assert_int_equal(ric_trajectory_run(trajectory, 10, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_GRAZING);
  assert_non_null(strstr(run.reason, "grazing contact of obstacle 0"));
  assert_int_equal(ric_trajectory_columns(trajectory), 0);
  assert_int_equal(ric_trajectory_run(trajectory, 10, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

/* A ball as a first-order system, whose map means nothing where the gap opens. */
static int ball_rate(double t, const double *x, double *rate, void *user) {
  (void)t, (void)user;
  rate[0] = x[1];
  rate[1] = -1;
  return 0;
}

static int ball_gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = x[0];
  return 0;
}

static int ball_impact(double t, const double *x, size_t obstacle, double *after, void *user) {
  (void)t, (void)obstacle, (void)user;
  after[0] = x[0];
  after[1] = x[1] < 0 ? -0.8 * x[1] : 1000;
  return 0;
}

static void impact_maps_are_differentiated_where_gaps_close(void **state) {
  (void)state;
  const ric_first_order model = {
      .states = 2, .obstacles = 1, .rate = ball_rate, .gap = ball_gap, .impact = ball_impact};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_first_order(&model, &system, NULL), RIC_OK);
  for (double rate = 1; rate > 1e-5; rate /= 10) {
    double S[4], x[2] = {0, -rate};
    ric_saltation_kind kind;
    assert_int_equal(ric_saltation_find(system, 0, x, NULL, &(size_t){0}, 1, 1e-10, S, NULL, &kind, NULL), RIC_OK);
    assert_close(S[0], -0.8, 1e-10);
    assert_close(S[3], -0.8, 1e-8);
    assert_close(S[2], 1.8 / rate, 1e-6 / rate); /* (a+ + e a-) / v- with a = -1 */
  }
  ric_system_destroy(&system);
}

/* Vectors that are handed to a trajectory whose contact rests lose what the contact holds. */
static void vectors_carried_at_rest_are_held(void **state) {
  (void)state;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, 0.5); /* the spring presses onto it */
  floor.restitution = 0;
  ric_system *system = lattice_system(&mass, &floor, 1);
  ric_trajectory *trajectory = NULL;
  ric_run run;
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, (double[]){1}, (double[]){0}, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, 5, NULL, &run, NULL), RIC_OK);
  assert_true(ric_trajectory_rests(trajectory, 0));
  assert_int_equal(ric_trajectory_carry(trajectory, 2, (double[]){1, 0}, (double[]){0, 1}, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, 6, NULL, &run, NULL), RIC_OK);
  for (int k = 0; k < 2; k++)
    assert_true(ric_trajectory_dq(trajectory)[k] == 0 && ric_trajectory_du(trajectory)[k] == 0);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(determinant_is_the_square_of_the_restitution),
      cmocka_unit_test(slow_impacts_are_refused),
      cmocka_unit_test(both_orders_agree_where_no_force_depends_on_the_others_speed),
      cmocka_unit_test(orders_differ_where_a_damper_couples_them),
      cmocka_unit_test(coupled_contacts_have_no_derivative),
      cmocka_unit_test(rest_takes_the_tangent_vectors_of_a_contact),
      cmocka_unit_test(runs_end_where_a_contact_grazes),
      cmocka_unit_test(impact_maps_are_differentiated_where_gaps_close),
      cmocka_unit_test(vectors_carried_at_rest_are_held),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
