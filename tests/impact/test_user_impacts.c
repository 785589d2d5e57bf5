/* Impacts of systems in generalised coordinates: a double pendulum against a wall, and a skate, whose one constraint on
 * speeds cannot be integrated. */
#include "support.h"

#include "witness/double_pendulum.h"
#include "witness/recorded_run.h"

/* The lower bob may not pass the wall at x = 0.6. */
static int wall_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = 0.6 - sin(q[0]) - sin(q[1]);
  return 0;
}

static int wall_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)t, (void)obstacle, (void)user;
  gradient[0] = -cos(q[0]);
  gradient[1] = -cos(q[1]);
  *in_time = 0;
  return 0;
}

static double pendulum_energy_of(const double *q, const double *u) {
  return u[0] * u[0] + u[1] * u[1] / 2 + cos(q[0] - q[1]) * u[0] * u[1] - 2 * cos(q[0]) - cos(q[1]);
}

static int pendulum_energy(double t, const double *q, const double *u, double *energy, void *user) {
  (void)t, (void)user;
  *energy = pendulum_energy_of(q, u);
  return 0;
}

static ric_system *pendulum(const double *restitution, int with_gradient) {
  ric_mechanical model = {.coordinates = 2,
                          .speeds = 2,
                          .obstacles = 1,
                          .restitution = restitution,
                          .mass = double_pendulum_mass,
                          .force = double_pendulum_force,
                          .gap = wall_gap,
                          .gap_gradient = with_gradient ? wall_gradient : NULL,
                          .energy = pendulum_energy};
  ric_system *system = NULL;
  ric_error error = {0};
  if (ric_system_create_mechanical(&model, &system, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return system;
}

static const double swing[2] = {-0.9, -0.4}, still[2] = {0, 0};

static void pendulum_conserves_energy_through_elastic_impacts(void **state) {
  (void)state;
  for (int with_gradient = 0; with_gradient <= 1; with_gradient++) {
    ric_system *system = pendulum(NULL, with_gradient);
    recorded_run r = record_run(system, NULL, swing, still, 30);
    assert_int_equal(r.run.outcome, RIC_RUN_COMPLETED);
    assert_true(recorded_run_impacts(&r) >= 5);
    /* steps of CVODES at tolerance 1e-12, each off by a few of it, in a motion of size 2 */
    assert_close(r.run.energy_end, r.run.energy_start, 1e-12 * (double)r.run.flow.steps);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

static int end_at_impact(const ric_event *event, void *user) {
  *(ric_event *)user = *event;
  return ric_event_jumps(event);
}

/* The impulse and both rates of the first impact, against M^-1 written out. */
static void pendulum_impulse_obeys_the_impact_law(void **state) {
  (void)state;
  for (int k = 0; k <= 4; k++) {
    double e = 0.25 * k;
    ric_system *system = pendulum(&e, 1);
    ric_trajectory *trajectory = NULL;
    ric_event hit;
    ric_run run;
    ric_observer observer = {.event = end_at_impact, .user = &hit};
    assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
    assert_int_equal(ric_trajectory_start(trajectory, 0, swing, still, NULL), RIC_OK);
    assert_int_equal(ric_trajectory_run(trajectory, 30, &observer, &run, NULL), RIC_OK);
    assert_int_equal(run.outcome, RIC_RUN_ENDED);
    const double *q = ric_trajectory_q(trajectory), *u = ric_trajectory_u(trajectory);
    double c = cos(q[0] - q[1]), det = 2 - c * c, g[2] = {-cos(q[0]), -cos(q[1])};
    double w[2] = {(g[0] - c * g[1]) / det, (-c * g[0] + 2 * g[1]) / det}; /* M^-1 g */
    double before[2] = {u[0] - hit.impulse * w[0], u[1] - hit.impulse * w[1]};
    double rate = g[0] * before[0] + g[1] * before[1];
    assert_close(hit.gap_rate, rate, 1e-14);
    assert_close(g[0] * u[0] + g[1] * u[1], -e * rate, 1e-14);
    assert_close(hit.impulse, -(1 + e) * rate / (g[0] * w[0] + g[1] * w[1]), 1e-13); /* [FN97] (2.9) */
    assert_close(hit.energy_loss, pendulum_energy_of(q, before) - pendulum_energy_of(q, u), 1e-13);
    assert_close(0.6 - sin(q[0]) - sin(q[1]), 0, 1e-11);
    ric_trajectory_destroy(&trajectory);
    ric_system_destroy(&system);
  }
}

/* The same pendulum as x' = F(x) with an impact map. */
static int pendulum_rate(double t, const double *x, double *rate, void *user) {
  double f[2];
  double_pendulum_force(t, x, x + 2, f, user);
  rate[0] = x[2];
  rate[1] = x[3];
  double_pendulum_solve(x, f, rate + 2);
  return 0;
}

static int wall_gradient_of_state(double t, const double *x, size_t obstacle, double *gradient, double *in_time,
                                  void *user) {
  gradient[2] = gradient[3] = 0;
  return wall_gradient(t, x, obstacle, gradient, in_time, user);
}

static int wall_impact(double t, const double *x, size_t obstacle, double *x_after, void *user) {
  (void)t, (void)obstacle;
  memcpy(x_after, x, 4 * sizeof *x);
  double_pendulum_hit(x, *(double *)user, -cos(x[0]) * x[2] - cos(x[1]) * x[3], x_after + 2);
  return 0;
}

static void pendulum_agrees_with_its_first_order_form(void **state) {
  (void)state;
  double e = 0.95, x[4] = {swing[0], swing[1], 0, 0}, end = 20;
  ric_first_order model = {.states = 4,
                           .obstacles = 1,
                           .rate = pendulum_rate,
                           .gap = wall_gap,
                           .gap_gradient = wall_gradient_of_state,
                           .impact = wall_impact,
                           .user = &e};
  ric_system *first = NULL, *second = pendulum(&e, 1);
  assert_int_equal(ric_system_create_first_order(&model, &first, NULL), RIC_OK);
  recorded_run a = record_run(first, NULL, x, NULL, end), b = record_run(second, NULL, swing, still, end);
  assert_int_equal(recorded_run_impacts(&a), recorded_run_impacts(&b));
  assert_true(recorded_run_impacts(&a) >= 4);
  for (size_t i = 0; i < a.count; i++)
    assert_close(a.events[i].time, b.events[i].time, 1e-8);
  for (size_t i = 0; i < 2; i++) {
    assert_close(a.q[i], b.q[i], 1e-8);
    assert_close(a.q[2 + i], b.u[i], 1e-8);
  }
  recorded_run_clear(&a);
  recorded_run_clear(&b);
  ric_system_destroy(&first);
  ric_system_destroy(&second);
}

/* A skate of mass 1 and inertia 0.1 that cannot slip sideways: three coordinates (x, y, heading), two speeds (forward,
 * turning). Its nose is 0.4 ahead and may not pass the wall at x = 1. */
static const double inertia = 0.1, nose = 0.4;

static int skate_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)q, (void)user;
  M[0] = 1;
  M[1] = M[2] = 0;
  M[3] = inertia;
  return 0;
}

static int skate_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = f[1] = 0;
  return 0;
}

static int skate_kinematics(double t, const double *q, double *B, double *b, void *user) {
  (void)t, (void)user;
  double columns[6] = {cos(q[2]), 0, sin(q[2]), 0, 0, 1};
  memcpy(B, columns, sizeof columns);
  b[0] = b[1] = b[2] = 0;
  return 0;
}

static int skate_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = 1 - q[0] - nose * cos(q[2]);
  return 0;
}

static int skate_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)t, (void)obstacle, (void)user;
  gradient[0] = -1;
  gradient[1] = 0;
  gradient[2] = nose * sin(q[2]);
  *in_time = 0;
  return 0;
}

/* The skate runs on circles; here they are written down, and its impacts found by bisection. */
typedef struct skate {
  double t, q[3], u[2];
} skate;

static skate skate_after(const skate *s, double dt) {
  double heading = s->q[2] + s->u[1] * dt, radius = s->u[0] / s->u[1];
  return (skate){.t = s->t + dt,
                 .q = {s->q[0] + radius * (sin(heading) - sin(s->q[2])),
                       s->q[1] - radius * (cos(heading) - cos(s->q[2])), heading},
                 .u = {s->u[0], s->u[1]}};
}

static double skate_clearance(const skate *s) {
  return 1 - s->q[0] - nose * cos(s->q[2]);
}

static void skate_hit(skate *s, double e) {
  double g[2] = {-cos(s->q[2]), nose * sin(s->q[2])}, w[2] = {g[0], g[1] / inertia};
  double p = -(1 + e) * (g[0] * s->u[0] + g[1] * s->u[1]) / (g[0] * w[0] + g[1] * w[1]);
  s->u[0] += p * w[0];
  s->u[1] += p * w[1];
}

static size_t skate_run(skate *s, double e, double end) {
  size_t hits = 0;
  while (s->t < end) {
    double dt = fmin(1e-3, end - s->t);
    skate next = skate_after(s, dt);
    if (skate_clearance(&next) >= 0) {
      *s = next;
      continue;
    }
    double low = 0, high = dt;
    for (int i = 0; i < 60; i++) {
      double middle = (low + high) / 2;
      next = skate_after(s, middle);
      *(skate_clearance(&next) >= 0 ? &low : &high) = middle;
    }
    *s = skate_after(s, low);
    skate_hit(s, e);
    hits++;
  }
  return hits;
}

static void skate_agrees_with_its_circles(void **state) {
  (void)state;
  for (int k = 0; k <= 1; k++) {
    double e = k ? 1 : 0.6, end = 6;
    skate s = {.q = {0, 0, 0.3}, .u = {1, 0.7}};
    ric_mechanical model = {.coordinates = 3,
                            .speeds = 2,
                            .obstacles = 1,
                            .restitution = &e,
                            .mass = skate_mass,
                            .force = skate_force,
                            .kinematics = skate_kinematics,
                            .gap = skate_gap,
                            .gap_gradient = k ? skate_gradient : NULL};
    ric_system *system = NULL;
    assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
    recorded_run r = record_run(system, NULL, s.q, s.u, end);
    size_t hits = skate_run(&s, e, end);
    assert_int_equal(recorded_run_impacts(&r), hits);
    assert_true(hits >= 1);
    for (size_t i = 0; i < 3; i++)
      assert_close(r.q[i], s.q[i], 1e-9);
    for (size_t i = 0; i < 2; i++)
      assert_close(r.u[i], s.u[i], 1e-9);
    double energy = (r.u[0] * r.u[0] + inertia * r.u[1] * r.u[1]) / 2;
    if (e == 1)
      assert_close(energy, (1 + inertia * 0.49) / 2, 1e-12);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pendulum_conserves_energy_through_elastic_impacts),
      cmocka_unit_test(pendulum_impulse_obeys_the_impact_law),
      cmocka_unit_test(pendulum_agrees_with_its_first_order_form),
      cmocka_unit_test(skate_agrees_with_its_circles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
