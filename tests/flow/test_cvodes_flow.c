/* The flow of CVODES against closed forms, and how it goes on, stops and turns round. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "flow/flow_method.h"

/* q'' = -2 d q' - q + a cos(w t), with its closed form from (q, u) = (1, 0.5) at t = 0. */
typedef struct oscillator {
  double damping, amplitude, frequency;
} oscillator;

static int oscillator_force(double t, const double *q, const double *u, double *f, void *user) {
  const oscillator *o = user;
  f[0] = -2 * o->damping * u[0] - q[0] + o->amplitude * cos(o->frequency * t);
  return 0;
}

/* Steady response p cos + r sin, and what the start leaves to the damped free motion. */
static void oscillator_state(const oscillator *o, double t, double *q, double *u) {
  double w = o->frequency, d = o->damping, stiff = 1 - w * w, drag = 2 * d * w;
  double p = o->amplitude * stiff / (stiff * stiff + drag * drag);
  double r = o->amplitude * drag / (stiff * stiff + drag * drag), free = sqrt(1 - d * d);
  double a = 1 - p, b = (0.5 - r * w + d * a) / free;
  double c = cos(free * t), s = sin(free * t), decay = exp(-d * t);
  *q = decay * (a * c + b * s) + p * cos(w * t) + r * sin(w * t);
  *u = decay * ((b * free - d * a) * c - (a * free + d * b) * s) - p * w * sin(w * t) + r * w * cos(w * t);
}

static const oscillator oscillators[] = {{0, 0, 0}, {0.05, 0.7, 1.7}, {0.3, 1, 0.4}};

static ric_system *mechanical(const ric_mechanical *model) {
  ric_system *s = NULL;
  assert_int_equal(ric_system_create_mechanical(model, &s, NULL), RIC_OK);
  return s;
}

static ric_system *first_order(const ric_first_order *model) {
  ric_system *s = NULL;
  assert_int_equal(ric_system_create_first_order(model, &s, NULL), RIC_OK);
  return s;
}

static ric_system *oscillator_system(const oscillator *o) {
  const ric_mechanical model = {.coordinates = 1, .speeds = 1, .force = oscillator_force, .user = (void *)o};
  return mechanical(&model);
}

static ric_flow *flow_of(const ric_system *s, double tolerance) {
  ric_flow_options options = ric_flow_options_default();
  ric_flow *flow = NULL;
  options.tolerance = tolerance;
  assert_int_equal(ric_flow_create(s, &options, &flow, NULL), RIC_OK);
  return flow;
}

static void begin(ric_flow *flow, double t, const double *q, const double *u) {
  assert_int_equal(ric_flow_start(flow, t, q, u, NULL), RIC_OK);
}

static void make_step(ric_flow *flow, double stop) {
  ric_error error = {0};
  if (ric_flow_step(flow, stop, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

static void move(ric_flow *flow, double end) {
  while (ric_flow_time(flow) != end) {
    make_step(flow, end);
    ric_flow_accept(flow, 1);
  }
}

/* Every step may add its tolerance times the size of the state, here below 2 in each number, and the motion does not
 * make errors grow; rounding adds 1e-16 in the same way. */
static double bound(const ric_flow *flow, double tolerance) {
  return 2 * (double)ric_flow_counted(flow).steps * (tolerance + 1e-15);
}

static void for_all_oscillators(void (*holds)(const oscillator *o, ric_flow *flow, double tolerance)) {
  const double q = 1, u = 0.5;
  for (size_t k = 0; k < sizeof oscillators / sizeof *oscillators; k++) {
    ric_system *s = oscillator_system(&oscillators[k]);
    for (double tolerance = 1e-6; tolerance > 0.5e-13; tolerance /= 10) {
      ric_flow *flow = flow_of(s, tolerance);
      begin(flow, 0, &q, &u);
      holds(&oscillators[k], flow, tolerance);
      ric_flow_destroy(&flow);
      assert_null(flow);
    }
    ric_system_destroy(&s);
  }
}

static void check_end(const oscillator *o, ric_flow *flow, double tolerance) {
  double q, u;
  move(flow, 20);
  oscillator_state(o, 20, &q, &u);
  assert_close(*ric_flow_q(flow), q, bound(flow, tolerance));
  assert_close(*ric_flow_u(flow), u, bound(flow, tolerance));
}

static void error_is_in_proportion_to_the_tolerance(void **state) {
  (void)state;
  for_all_oscillators(check_end);
}

/* Between the ends of a step the polynomial may err by a few times the error of the step. */
static void check_segments(const oscillator *o, ric_flow *flow, double tolerance) {
  double last = 0, q = 1, u = 0.5;
  while (ric_flow_time(flow) < 12) {
    make_step(flow, 12);
    assert_int_equal(ric_flow_pieces(flow), 1);
    ric_segment piece = ric_flow_piece(flow, 0);
    assert_true(piece.start == last && piece.length > 0);
    assert_int_equal(piece.coordinates, 1);
    assert_int_equal(piece.speeds, 1);
    double found_q, found_u;
    ric_segment_state(&piece, 0, &found_q, &found_u);
    assert_true(found_q == q && found_u == u);
    for (int k = 1; k <= 8; k++) {
      double exact_q, exact_u;
      ric_segment_state(&piece, k / 8.0, &found_q, &found_u);
      oscillator_state(o, piece.start + piece.length * k / 8.0, &exact_q, &exact_u);
      assert_close(found_q, exact_q, bound(flow, tolerance) + 10 * tolerance);
      assert_close(found_u, exact_u, bound(flow, tolerance) + 10 * tolerance);
    }
    last = ric_flow_step_end(flow);
    ric_flow_accept(flow, 1);
    q = *ric_flow_q(flow);
    u = *ric_flow_u(flow);
    assert_close(found_q, q, 1e-14); /* the polynomial ends in the state of the solver */
    assert_close(found_u, u, 1e-14);
  }
  assert_true(ric_flow_time(flow) == 12);
}

static void segments_join_and_follow_the_motion(void **state) {
  (void)state;
  for_all_oscillators(check_segments);
}

static void check_return(const oscillator *o, ric_flow *flow, double tolerance) {
  double grown = exp(o->damping * 4 * 2); /* errors grow backwards where damping shrinks them */
  move(flow, 4);
  make_step(flow, 0);
  assert_true(ric_flow_piece(flow, 0).length < 0);
  ric_flow_accept(flow, 1);
  move(flow, 0);
  assert_close(*ric_flow_q(flow), 1, grown * bound(flow, tolerance));
  assert_close(*ric_flow_u(flow), 0.5, grown * bound(flow, tolerance));
}

static void motion_backwards_returns_to_the_start(void **state) {
  (void)state;
  for_all_oscillators(check_return);
}

static void check_parts(const oscillator *o, ric_flow *flow, double tolerance) {
  double q, u;
  const double parts[] = {0.3, 1, 0.999, 0, 1, 1, 0.5};
  for (size_t k = 0; k < 70; k++) {
    make_step(flow, 10);
    double part = parts[k % 7], at = ric_flow_time(flow) + part * ric_flow_piece(flow, 0).length;
    ric_flow_accept(flow, part);
    assert_close(ric_flow_time(flow), at, 1e-15 * (1 + at));
    oscillator_state(o, ric_flow_time(flow), &q, &u);
    assert_close(*ric_flow_q(flow), q, bound(flow, tolerance) + 10 * tolerance);
    assert_close(*ric_flow_u(flow), u, bound(flow, tolerance) + 10 * tolerance);
  }
}

static void parts_of_steps_can_be_accepted(void **state) {
  (void)state;
  for_all_oscillators(check_parts);
}

static void check_stops(const oscillator *o, ric_flow *flow, double tolerance) {
  double q, u;
  unsigned long long before;
  move(flow, 1);
  before = ric_flow_counted(flow).force_evaluations;
  move(flow, nextafter(1, 2)); /* a way that is lost in rounding */
  assert_true(ric_flow_counted(flow).force_evaluations - before == 1);
  for (double stop = 1.05; stop < 4; stop += 0.05) {
    move(flow, stop);
    oscillator_state(o, stop, &q, &u);
    assert_close(*ric_flow_q(flow), q, bound(flow, tolerance));
    assert_close(*ric_flow_u(flow), u, bound(flow, tolerance));
  }
  make_step(flow, 1e6); /* given up: the next step begins where this one did */
  make_step(flow, 5);
  assert_true(ric_flow_piece(flow, 0).start == ric_flow_time(flow));
  ric_flow_accept(flow, 1);
  oscillator_state(o, ric_flow_time(flow), &q, &u);
  assert_close(*ric_flow_q(flow), q, bound(flow, tolerance));
}

static void stops_are_met_and_unused_steps_forgotten(void **state) {
  (void)state;
  for_all_oscillators(check_stops);
}

/* A chain of eight masses, the first of them driven. */
enum { CHAIN = 8 };

static int chain_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)user;
  for (int i = 0; i < CHAIN; i++) {
    double left = i > 0 ? q[i] - q[i - 1] : 0, right = i + 1 < CHAIN ? q[i + 1] - q[i] : 0;
    f[i] = -q[i] - 0.02 * u[i] + 0.1 * (right - left) + (i == 0 ? 0.5 * cos(1.3 * t) : 0);
  }
  return 0;
}

static void a_restart_costs_few_evaluations_of_the_force(void **state) {
  (void)state;
  const ric_mechanical model = {.coordinates = CHAIN, .speeds = CHAIN, .force = chain_force};
  ric_system *s = mechanical(&model);
  ric_flow *flow = flow_of(s, 1e-12);
  for (int k = 0; k < 50; k++) {
    double q[CHAIN], u[CHAIN];
    for (int i = 0; i < CHAIN; i++) {
      q[i] = sin(3 * k + i);
      u[i] = cos(5 * k + 2 * i);
    }
    unsigned long long before = ric_flow_counted(flow).force_evaluations;
    begin(flow, k, q, u);
    move(flow, k + 3);
    assert_in_range(ric_flow_counted(flow).force_evaluations - before, 20, 300);
  }
  assert_int_equal(ric_flow_counted(flow).starts, 50);
  ric_flow_destroy(&flow);
  ric_system_destroy(&s);
}

/* A skate (x, y, angle) with speeds along its blade and about itself goes round in circles: it cannot slip. */
static int skate_kinematics(double t, const double *q, double *B, double *b, void *user) {
  const double values[] = {cos(q[2]), 0, sin(q[2]), 0, 0, 1};
  (void)t, (void)user;
  memcpy(B, values, sizeof values);
  memset(b, 0, 3 * sizeof *b);
  return 0;
}

static int skate_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = f[1] = 0;
  return 0;
}

static void free_skate_goes_round_in_circles(void **state) {
  (void)state;
  const ric_mechanical model = {.coordinates = 3, .speeds = 2, .force = skate_force, .kinematics = skate_kinematics};
  const double q[] = {1, 2, 0.3}, u[] = {1.5, 0.8}, r = 1.5 / 0.8, tolerance = 1e-11;
  ric_system *s = mechanical(&model);
  ric_flow *flow = flow_of(s, tolerance);
  begin(flow, 0, q, u);
  while (ric_flow_time(flow) != 10) {
    make_step(flow, 10);
    ric_segment piece = ric_flow_piece(flow, 0);
    assert_int_equal(piece.coordinates, 3);
    assert_int_equal(piece.speeds, 2);
    double x[3], v[2], angle = 0.3 + 0.8 * (piece.start + 0.6 * piece.length);
    double error = 4 * bound(flow, tolerance); /* the angle grows to 8, and so does the size of the state */
    ric_segment_state(&piece, 0.6, x, v);
    assert_close(x[0], 1 + r * (sin(angle) - sin(0.3)), error);
    assert_close(x[1], 2 - r * (cos(angle) - cos(0.3)), error);
    assert_close(x[2], angle, error);
    assert_close(v[0], 1.5, error);
    ric_flow_accept(flow, 1);
  }
  ric_flow_destroy(&flow);
  ric_system_destroy(&s);
}

/* A bead inside a circle, held on it. */
static int bead_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = 0, f[1] = -1;
  return 0;
}

static int bead_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = 1 - hypot(q[0], q[1]);
  return 0;
}

static int bead_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)t, (void)obstacle, (void)user;
  gradient[0] = -q[0] / hypot(q[0], q[1]);
  gradient[1] = -q[1] / hypot(q[0], q[1]);
  *in_time = 0;
  return 0;
}

/* From rest at the height of the centre: v^2 = 2 cos a at the angle a from the bottom, and the force is 3 cos a. */
static void held_contact_stays_and_its_force_is_that_of_a_pendulum(void **state) {
  (void)state;
  const ric_mechanical model = {.coordinates = 2,
                                .speeds = 2,
                                .obstacles = 1,
                                .force = bead_force,
                                .gap = bead_gap,
                                .gap_gradient = bead_gradient};
  const double q[] = {1, 0}, u[] = {0, 0};
  ric_system *s = mechanical(&model);
  ric_flow *flow = flow_of(s, 1e-10);
  flow->contact[0] = CONTACT_HELD;
  begin(flow, 0, q, u);
  while (ric_flow_time(flow) != 6) {
    double place[2], speed[2], force;
    make_step(flow, 6);
    ric_segment piece = ric_flow_piece(flow, 0);
    for (int k = 0; k <= 7; k++) {
      ric_segment_state(&piece, k / 7.0, place, speed);
      assert_null(s->model->reaction(s, flow->contact, 0, piece.start, place, speed, &force));
      assert_close(force, -3 * place[1], 1e-7);
      assert_close(hypot(place[0], place[1]), 1, 1e-7);
    }
    ric_flow_accept(flow, 1);
  }
  ric_flow_destroy(&flow);
  ric_system_destroy(&s);
}

/* A state passes through zero, and rests at it, at ordinary cost. */
static int cosine(double t, const double *x, double *rate, void *user) {
  (void)x, (void)user;
  rate[0] = cos(t);
  return 0;
}

static void states_may_pass_through_zero(void **state) {
  (void)state;
  const ric_first_order model = {.states = 1, .rate = cosine};
  const double x = 0;
  ric_system *s = first_order(&model);
  ric_flow *flow = flow_of(s, 1e-12);
  begin(flow, 0, &x, NULL);
  move(flow, 20);
  assert_close(*ric_flow_q(flow), sin(20), bound(flow, 1e-12));
  assert_in_range(ric_flow_counted(flow).steps, 10, 400);
  ric_flow_destroy(&flow);
  ric_system_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(error_is_in_proportion_to_the_tolerance),
      cmocka_unit_test(segments_join_and_follow_the_motion),
      cmocka_unit_test(motion_backwards_returns_to_the_start),
      cmocka_unit_test(parts_of_steps_can_be_accepted),
      cmocka_unit_test(stops_are_met_and_unused_steps_forgotten),
      cmocka_unit_test(a_restart_costs_few_evaluations_of_the_force),
      cmocka_unit_test(free_skate_goes_round_in_circles),
      cmocka_unit_test(held_contact_stays_and_its_force_is_that_of_a_pendulum),
      cmocka_unit_test(states_may_pass_through_zero),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
