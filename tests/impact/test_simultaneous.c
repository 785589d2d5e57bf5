/* Impacts at one time: what does not couple commutes; what does is solved together and says so. */
#include "support.h"

#include "witness/recorded_run.h"
#include "scenario/random_source.h"

enum { N = 6 };

static ric_system *chain_over_floors(const double *floors) {
  ric_obstacle obstacles[N];
  ric_lattice chain = ric_lattice_default(N, RIC_ENDS_PERIODIC);
  chain.link.linear = 0.3;
  for (size_t i = 0; i < N; i++) {
    obstacles[i] = ric_obstacle_floor(i, floors[i]);
    obstacles[i].restitution = 0.9;
  }
  return lattice_system(&chain, obstacles, N);
}

/* All particles move alike: q = cos t, and reach the floor at -0.5 together. */
static recorded_run fall_together(const double *delays) {
  double floors[N], q[N], u[N] = {0};
  for (size_t i = 0; i < N; i++) {
    floors[i] = -0.5 - delays[i] * sqrt(0.75); /* reached later by the delay */
    q[i] = 1;
  }
  ric_system *system = chain_over_floors(floors);
  recorded_run r = record_run(system, NULL, q, u, 3);
  ric_system_destroy(&system);
  return r;
}

static void shuffle(random_source *source, double *x) {
  for (size_t i = N - 1; i > 0; i--) {
    size_t j = random_below(source, i + 1);
    double swap = x[i];
    x[i] = x[j];
    x[j] = swap;
  }
}

static void uncoupled_impacts_at_one_time_are_simultaneous(void **state) {
  (void)state;
  recorded_run r = fall_together((double[N]){0});
  assert_int_equal(r.count, N);
  for (size_t i = 0; i < N; i++) {
    assert_int_equal(r.events[i].kind, RIC_EVENT_SIMULTANEOUS);
    assert_int_equal(r.events[i].obstacle, i);
    assert_true(r.events[i].time == r.events[0].time);
    assert_close(r.events[i].gap_rate, -sqrt(0.75), 1e-15);
  }
  recorded_run_clear(&r);
}

/* The positions differ by the delays, 1e-12 at most 6 times, and speeds by what forces do in that time. */
static void every_order_of_split_impacts_agrees_with_the_simultaneous_ones(void **state) {
  (void)state;
  random_source source = {.state = 3};
  recorded_run together = fall_together((double[N]){0});
  double delays[N] = {0, 1e-12, 2e-12, 3e-12, 4e-12, 5e-12};
  for (int order = 0; order < 200; order++) {
    shuffle(&source, delays);
    recorded_run r = fall_together(delays);
    assert_int_equal(r.count, N);
    assert_true(recorded_runs_difference(&r, &together) <= 3e-11);
    recorded_run_clear(&r);
  }
  recorded_run_clear(&together);
}

/* Two masses that share inertia, M = [[2, 1], [1, 2]], both at their floors. */
static ric_system *coupled_pair(double restitution, size_t obstacles) {
  static const double mass[] = {2, 1, 1, 2}, stiffness[] = {1, 0, 0, 1};
  ric_mck pair = {.coordinates = 2, .mass.values = mass, .stiffness.values = stiffness};
  ric_obstacle floors[2] = {ric_obstacle_floor(0, 0), ric_obstacle_floor(1, 0)};
  ric_system *system = NULL;
  floors[0].restitution = floors[1].restitution = restitution;
  assert_int_equal(ric_system_create_mck(&pair, floors, obstacles, &system, NULL), RIC_OK);
  return system;
}

/* M^-1 = [[2, -1], [-1, 2]] / 3: p = (1 + e) / (1/3) each, and both rates turn around. */
static void coupled_impacts_solve_newtons_law_together(void **state) {
  (void)state;
  for (int k = 0; k <= 4; k++) {
    double e = 0.25 * k;
    ric_system *system = coupled_pair(e, 2);
    recorded_run r = record_run(system, NULL, (double[]){0, 0}, (double[]){-1, -1}, 0);
    size_t impacts = recorded_run_impacts(&r);
    assert_int_equal(impacts, 2);
    for (size_t i = 0; i < 2; i++) {
      assert_int_equal(r.events[i].kind, RIC_EVENT_COUPLED);
      assert_close(r.events[i].impulse, 3 * (1 + e), 1e-14);
      assert_close(r.u[i], e, 1e-15);
    }
    assert_close(r.run.impact_loss, 3 * (1 - e * e), 1e-14);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

/* A closed contact without a rate shares in the impulse of another: Moreau's form with (1 + e) h' = (-1.5, 0) has
 * p = (3, 1.5), and the loss is that of the first alone. It does so from the start on. */
static void closed_contact_without_a_rate_shares_in_an_impact(void **state) {
  (void)state;
  static const double mass[] = {2, 1, 1, 2}, stiffness[] = {1, 0, 0, 1};
  ric_mck pair = {.coordinates = 2, .mass.values = mass, .stiffness.values = stiffness};
  ric_obstacle floors[2] = {ric_obstacle_floor(0, 0.3), ric_obstacle_floor(1, 0.3)};
  ric_system *system = NULL;
  floors[0].restitution = 0.5;
  floors[1].restitution = 1;
  assert_int_equal(ric_system_create_mck(&pair, floors, 2, &system, NULL), RIC_OK);
  recorded_run r = record_run(system, NULL, (double[]){0.3, 0.3}, (double[]){-1, 0}, 0);
  assert_int_equal(recorded_run_impacts(&r), 2);
  assert_int_equal(r.events[0].obstacle, 0);
  assert_close(r.events[0].impulse, 3, 1e-14);
  assert_int_equal(r.events[1].obstacle, 1);
  assert_close(r.events[1].impulse, 1.5, 1e-14);
  assert_close(r.u[0], 0.5, 1e-15);
  assert_close(r.u[1], 0, 1e-15);
  assert_close(r.run.impact_loss, 0.75, 1e-14);
  recorded_run_clear(&r);
  ric_system_destroy(&system);
}

/* In sequence, 0 then 1, e = 1 (docs/theory.md with c = -1/2): rates (1 + 2 c - 4 c^2, 1 - 2 c) = (-1, 2) against (1,
 * 1) together: another outcome, and 0 would have to hit again. */
static void coupled_impacts_differ_from_impacts_in_sequence(void **state) {
  (void)state;
  ric_system *first = coupled_pair(1, 1);
  recorded_run r = record_run(first, NULL, (double[]){0, 1}, (double[]){-1, -1}, 0);
  assert_int_equal(recorded_run_impacts(&r), 1);
  assert_close(r.u[0], 1, 1e-15);
  assert_close(r.u[1], -2, 1e-15); /* driven into its floor by the impulse on 0: then p_1 = 2 * 2 / (2/3) = 6 */
  double after_both[2] = {r.u[0] - 6.0 / 3, r.u[1] + 2 * 6.0 / 3};
  assert_close(after_both[0], -1, 1e-14);
  assert_close(after_both[1], 2, 1e-14);
  recorded_run_clear(&r);
  ric_system_destroy(&first);
}

/* An impact that reaches a contact at rest through the mass matrix: M^-1 = [[2, 1], [1, 2]] / 3. */
static void impulse_reaches_a_contact_at_rest(void **state) {
  (void)state;
  static const double mass[] = {2, -1, -1, 2}, stiffness[] = {1, 0, 0, 1};
  ric_mck pair = {.coordinates = 2, .mass.values = mass, .stiffness.values = stiffness};
  ric_obstacle sides[2] = {ric_obstacle_floor(0, 0.3), ric_obstacle_wall(1, 0.5)};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mck(&pair, sides, 2, &system, NULL), RIC_OK);
  recorded_run r = record_run(system, NULL, (double[]){0.3, 0}, (double[]){0, 1}, 1.2);
  const ric_event *rest = recorded_run_first(&r, RIC_EVENT_REST), *hit = recorded_run_first(&r, RIC_EVENT_COUPLED);
  assert_non_null(rest);
  assert_non_null(hit);
  assert_int_equal(rest->obstacle, 0);
  assert_true(r.run.events[RIC_EVENT_COUPLED] >= 2); /* the hit on the wall, and the floor that bears its impulse */
  assert_close(r.run.energy_end, r.run.energy_start - r.run.impact_loss, 1e-13);
  recorded_run_clear(&r);
  ric_system_destroy(&system);
}

/* e = 0, M^-1 = [[2, 1], [1, 2]] / 3: every hit of one mass lifts the other a little, ever less. Both come to rest,
 * under either flow, and the ledger has taken what they had. */
static void masses_that_lift_each_other_come_to_rest(void **state) {
  (void)state;
  static const double mass[] = {2, -1, -1, 2}, stiffness[] = {1, 0, 0, 1};
  const ric_mck pair = {.coordinates = 2, .mass.values = mass, .stiffness.values = stiffness};
  ric_obstacle floors[2] = {ric_obstacle_floor(0, 0.3), ric_obstacle_floor(1, 0.4)};
  floors[0].restitution = floors[1].restitution = 0;
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mck(&pair, floors, 2, &system, NULL), RIC_OK);
  for (int method = RIC_FLOW_TAYLOR; method <= RIC_FLOW_CVODES; method++) {
    ric_trajectory_options options = ric_trajectory_options_default();
    options.flow.method = (ric_flow_method)method;
    recorded_run r = record_run(system, &options, (double[]){0.5, 0.45}, (double[]){0.1, -0.3}, 30);
    assert_int_equal(r.run.outcome, RIC_RUN_COMPLETED);
    assert_true(r.count < 1000);
    assert_true(r.q[0] == 0.3 && r.q[1] == 0.4 && r.u[0] == 0 && r.u[1] == 0);
    assert_close(r.run.energy_start - r.run.impact_loss, r.run.energy_end, 1e-9);
    recorded_run_clear(&r);
  }
  ric_system_destroy(&system);
}

/* A body with three speeds over planes through the origin, in a user's words, with weight 1 along the first. */
enum { SPEEDS = 3, MOST_PLANES = 4 };

typedef struct body {
  double mass[SPEEDS]; /* and moments of inertia */
  size_t planes;
  double normal[MOST_PLANES][SPEEDS], restitution[MOST_PLANES];
} body;

static int body_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)q;
  for (size_t i = 0; i < SPEEDS; i++)
    for (size_t j = 0; j < SPEEDS; j++)
      M[i * SPEEDS + j] = i == j ? ((const body *)user)->mass[i] : 0;
  return 0;
}

static int body_weight(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = -1;
  f[1] = f[2] = 0;
  return 0;
}

static int body_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  const double *a = ((const body *)user)->normal[obstacle];
  (void)t;
  *h = a[0] * q[0] + a[1] * q[1] + a[2] * q[2];
  return 0;
}

static int body_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)t, (void)q;
  memcpy(gradient, ((const body *)user)->normal[obstacle], SPEEDS * sizeof *gradient);
  *in_time = 0;
  return 0;
}

static int body_energy(double t, const double *q, const double *u, double *energy, void *user) {
  const double *m = ((const body *)user)->mass;
  (void)t;
  *energy = q[0] + (m[0] * u[0] * u[0] + m[1] * u[1] * u[1] + m[2] * u[2] * u[2]) / 2;
  return 0;
}

static ric_system *body_system(body *b) {
  ric_mechanical model = {.coordinates = SPEEDS,
                          .speeds = SPEEDS,
                          .obstacles = b->planes,
                          .restitution = b->restitution,
                          .mass = body_mass,
                          .force = body_weight,
                          .gap = body_gap,
                          .gap_gradient = body_gradient,
                          .energy = body_energy,
                          .user = b};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  return system;
}

/* Events after the last impact that was faster than what noise of 1e-11 in a gap makes, 4e-6 or so. */
static size_t events_in_noise(const recorded_run *r) {
  size_t count = 0;
  while (count < r->count && !(r->events[r->count - 1 - count].gap_rate < -1e-5))
    count++;
  return count;
}

/* Few events in the noise, and no energy out of nothing: events are off by the time tolerance of 1e-12, and corrections
 * of gaps, a few in all, by 1e-11. */
static void expect_rest(const recorded_run *r) {
  assert_int_equal(r->run.outcome, RIC_RUN_COMPLETED);
  assert_true(events_in_noise(r) <= 20);
  assert_close(r->run.energy_start - r->run.impact_loss, r->run.energy_end, 1e-10 + 1e-12 * (double)r->count);
}

/* Two floors in the same place, and a third plane: the two are hit at the same time, again and again. */
static void contacts_in_the_same_place_come_to_rest_together(void **state) {
  (void)state;
  for (int k = 0; k < 10; k++) {
    double e = 0.1 * k, tilt = 0.05 * (k % 3);
    body b = {.mass = {1, 0.3, 0.2},
              .planes = 3,
              .normal = {{1, 0.6, 0.2}, {1, 0.6, 0.2}, {1, -0.6, -0.2}},
              .restitution = {e, e, e}};
    ric_system *system = body_system(&b);
    recorded_run r = record_run(system, NULL, (double[]){0.5, tilt, 0}, (double[]){0, 0, 0}, 40);
    expect_rest(&r);
    for (size_t j = 0; j < b.planes; j++) {
      assert_close(ric_system_gap(system, j, 40, r.q), 0, 1e-10);
      assert_close(ric_system_gap_rate(system, j, 40, r.q, r.u), 0, 1e-10);
    }
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

static body table_on_four_legs(random_source *source, double restitution) {
  body b = {.mass = {1, random_uniform(source, 0.1, 0.6), random_uniform(source, 0.1, 0.6)}, .planes = 4};
  for (size_t j = 0; j < b.planes; j++) {
    b.normal[j][0] = 1;
    b.normal[j][1] = j & 1 ? 1 : -1;
    b.normal[j][2] = j & 2 ? 0.7 : -0.7;
    b.restitution[j] = restitution;
  }
  return b;
}

/* Four contacts of three speeds are redundant, and the weight stands over a diagonal: two legs carry it and the others
 * neither press nor leave. A table let go flat or tilted, about one axis or both, rocks and comes to rest on all four.
 */
static void redundant_legs_of_a_table_come_to_rest(void **state) {
  (void)state;
  random_source source = {.state = 5};
  for (size_t k = 0; k < 80; k++) {
    body b = table_on_four_legs(&source, k % 4 == 0 ? 0 : random_uniform(&source, 0.05, 0.9));
    double q[SPEEDS] = {random_uniform(&source, 0.3, 0.6)}, u[SPEEDS] = {0};
    for (size_t i = 1; i < SPEEDS; i++)
      q[i] = k % (i + 2) == 0 ? 0 : random_uniform(&source, -0.1, 0.1);
    ric_system *system = body_system(&b);
    recorded_run r = record_run(system, NULL, q, u, 40);
    expect_rest(&r);
    assert_true(r.count < 5000);
    for (size_t i = 0; i < SPEEDS; i++) {
      assert_close(r.q[i], 0, 1e-11);
      assert_close(r.u[i], 0, 1e-11);
    }
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uncoupled_impacts_at_one_time_are_simultaneous),
      cmocka_unit_test(every_order_of_split_impacts_agrees_with_the_simultaneous_ones),
      cmocka_unit_test(coupled_impacts_solve_newtons_law_together),
      cmocka_unit_test(closed_contact_without_a_rate_shares_in_an_impact),
      cmocka_unit_test(coupled_impacts_differ_from_impacts_in_sequence),
      cmocka_unit_test(impulse_reaches_a_contact_at_rest),
      cmocka_unit_test(masses_that_lift_each_other_come_to_rest),
      cmocka_unit_test(contacts_in_the_same_place_come_to_rest_together),
      cmocka_unit_test(redundant_legs_of_a_table_come_to_rest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
