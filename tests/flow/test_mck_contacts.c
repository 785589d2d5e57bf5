/* Contacts in the Taylor flow of M-C-K systems: held ones and their reactions, Hertz contacts and their closed forms.
 */
#include "mck_motion.h"

#include <float.h>

#include "flow/flow_method.h"
#include "witness/random_mck.h"

enum { MOST = RANDOM_MCK_MOST, COUNT = 4 };

/* A random system in which the first COUNT obstacles, at random coordinates, are held. */
typedef struct held_case {
  random_mck m;
  double q[MOST], u[MOST];
  ric_obstacle obstacles[COUNT];
  ric_system *system;
  ric_flow *flow;
} held_case;

static void held_case_make(held_case *h, size_t n, int diagonal, random_source *source) {
  random_mck_make(&h->m, n, diagonal, source);
  random_state(source, n, h->q, h->u);
  for (size_t j = 0; j < COUNT; j++) {
    size_t at = random_below(source, n);
    h->obstacles[j] = j % 2 ? ric_obstacle_floor(at, h->q[at]) : ric_obstacle_wall(at, h->q[at]);
    h->u[at] = 0;
  }
  h->system = mck_system_made(&h->m.model, h->obstacles, COUNT);
  h->flow = mck_flow_made(h->system, ric_flow_options_default());
  for (size_t j = 0; j < COUNT; j++)
    flow_set_contact(h->flow, j, CONTACT_HELD);
  assert_int_equal(ric_flow_start(h->flow, 0.3, h->q, h->u, NULL), RIC_OK);
}

static void held_case_clear(held_case *h) {
  ric_flow_destroy(&h->flow);
  ric_system_destroy(&h->system);
}

static void held_contacts_keep_their_coordinates(void **state) {
  (void)state;
  random_source source = {.state = 1};
  static held_case h;
  for (size_t k = 0; k < 40; k++) {
    held_case_make(&h, 1 + k % 12, k % 3 == 0, &source);
    mck_move(h.flow, 6);
    for (size_t j = 0; j < COUNT; j++) {
      size_t at = h.obstacles[j].coordinate;
      assert_true(ric_flow_q(h.flow)[at] == h.q[at] && ric_flow_u(h.flow)[at] == 0);
    }
    held_case_clear(&h);
  }
}

/* Reactions contain second derivatives, of polynomials whose last coefficients are 1e-16 of the size: times order
 * squared over h squared. Sizes and masses are of order one. */
static void reactions_along_a_step_are_those_of_the_states(void **state) {
  (void)state;
  random_source source = {.state = 2};
  static held_case h;
  for (size_t k = 0; k < 40; k++) {
    held_case_make(&h, 1 + k % 12, k % 3 == 0, &source);
    mck_step_once(h.flow, 10);
    ric_segment piece = ric_flow_piece(h.flow, 0);
    double tolerance = 4e-16 * piece.degree * piece.degree / (piece.length * piece.length);
    for (double x = 0; x <= 1; x += 0.125)
      for (size_t j = 0; j < COUNT; j++) {
        double q[MOST], u[MOST], c[RIC_POLY_DEGREE + 1], lambda;
        ric_segment_state(&piece, x, q, u);
        int degree = h.flow->method->reaction(h.flow, j, c);
        assert_true(degree >= 0 && degree <= piece.degree - 2);
        assert_null(
            h.system->model->reaction(h.system, h.flow->contact, j, piece.start + x * piece.length, q, u, &lambda));
        assert_close(ric_poly_value(c, degree, x, NULL), lambda, tolerance);
      }
    held_case_clear(&h);
  }
}

/* With a diagonal mass the other coordinates move as if the held one were a constant force. */
static void neighbours_of_a_held_coordinate_move_on(void **state) {
  (void)state;
  const double mass[] = {1, 0, 0, 1}, stiffness[] = {2, -1, -1, 2};
  ric_mck model = {.coordinates = 2, .mass.values = mass, .stiffness.values = stiffness};
  ric_obstacle wall = ric_obstacle_wall(0, 0.5);
  ric_system *system = mck_system_made(&model, &wall, 1);
  ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
  double q[] = {0.5, 1}, u[] = {0, 0}, t = 7, c[RIC_POLY_DEGREE + 1];
  flow_set_contact(flow, 0, CONTACT_HELD);
  mck_run(flow, 0, q, u, t);
  double expected = 0.25 + 0.75 * cos(sqrt(2) * t); /* q'' = 0.5 - 2 q */
  assert_close(ric_flow_q(flow)[1], expected, 1e-14);
  mck_step_once(flow, 10);
  flow->method->reaction(flow, 0, c);
  assert_close(c[0], expected - 1, 1e-14); /* q_0'' = 0 = -1 + q_1 - lambda */
  flow_set_contact(flow, 0, CONTACT_OPEN);
  assert_int_equal(ric_flow_start(flow, t, ric_flow_q(flow), ric_flow_u(flow), NULL), RIC_OK);
  mck_step_once(flow, 10);
  assert_int_equal(flow->method->reaction(flow, 0, c), 0);
  assert_true(c[0] == 0);
  ric_flow_accept(flow, 1);
  assert_true(ric_flow_q(flow)[0] != 0.5);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

/* --- Hertz ----------------------------------------------------------------------------------------------------- */

/* A free mass on a compliant floor or wall at 0. */
typedef struct bounce {
  double mass, stiffness, force;
  ric_obstacle obstacle;
  ric_system *system;
  ric_flow *flow;
} bounce;

static void bounce_make(bounce *b, double mass, double stiffness, double force, int side) {
  *b = (bounce){.mass = mass, .stiffness = stiffness, .force = side * force};
  b->obstacle = side > 0 ? ric_obstacle_floor(0, 0) : ric_obstacle_wall(0, 0);
  b->obstacle.stiffness = stiffness;
  ric_mck model = {.coordinates = 1, .mass.values = &b->mass, .force_cos = &b->force};
  b->system = mck_system_made(&model, &b->obstacle, 1);
  b->flow = mck_flow_made(b->system, ric_flow_options_default());
  flow_set_contact(b->flow, 0, CONTACT_PRESSED);
}

static void bounce_clear(bounce *b) {
  ric_flow_destroy(&b->flow);
  ric_system_destroy(&b->system);
}

/* m u'' = -k u^{3/2}, u'(0) = v: deepest u = (5 m v^2 / (4 k))^{2/5} after sqrt(pi) Gamma(1.4) / Gamma(0.9) u / v. */
static void free_mass_bounces_as_hertz_says(void **state) {
  (void)state;
  const double stiffnesses[] = {1e-2, 1, 1e3, 1e6};
  for (size_t k = 0; k < 8; k++) {
    bounce b;
    int side = k % 2 ? 1 : -1;
    double mass = 2, v = 0.7, stiffness = stiffnesses[k / 2];
    bounce_make(&b, mass, stiffness, 0, side);
    double deepest = pow(5 * mass * v * v / (4 * stiffness), 0.4);
    double time = sqrt(acos(-1)) * tgamma(1.4) / tgamma(0.9) * deepest / v;
    mck_run(b.flow, 0, (double[]){0}, (double[]){-side * v}, time);
    assert_close(-side * ric_flow_q(b.flow)[0] / deepest, 1, 1e-13);
    assert_close(ric_flow_u(b.flow)[0] / v, 0, 1e-13);
    mck_move(b.flow, 2 * time * (1 - 1e-6)); /* just before it leaves, at the speed it came with */
    assert_close(side * ric_flow_u(b.flow)[0] / v, 1, 1e-12);
    print_message("k = %g: %llu steps\n", stiffness, ric_flow_counted(b.flow).steps);
    bounce_clear(&b);
  }
}

/* Located times are exact up to rounding only: the penetration there is some 1e-17 of either sign, or more. */
static void beginning_does_not_depend_on_rounding(void **state) {
  (void)state;
  bounce b;
  bounce_make(&b, 1, 100, 0, 1);
  mck_run(b.flow, 10, (double[]){0}, (double[]){-1}, 10.1);
  double q = ric_flow_q(b.flow)[0], u = ric_flow_u(b.flow)[0];
  for (double off = -1e-14; off < 1e-13; off = off < 0 ? (off < -1e-30 ? off / 10 : 1e-30) : off * 10) {
    mck_run(b.flow, 10, &off, (double[]){-1}, 10.1);
    assert_close(ric_flow_q(b.flow)[0], q, 1e-14 + 3 * fabs(off));
    assert_close(ric_flow_u(b.flow)[0], u, 1e-13 + 1000 * fabs(off));
  }
  bounce_clear(&b);
}

/* Put down at rest under a force F: potential 0.4 k u^{5/2} = F u at the deepest point. */
static void resting_mass_sinks_in(void **state) {
  (void)state;
  bounce b;
  bounce_make(&b, 1, 50, -0.3, 1);
  double deepest = pow(2.5 * 0.3 / 50, 2.0 / 3), most = 0, energy = 0;
  assert_int_equal(ric_flow_start(b.flow, 0, (double[]){0}, (double[]){0}, NULL), RIC_OK);
  for (int k = 0; k < 2000 && ric_flow_u(b.flow)[0] <= 0; k++) {
    mck_step_once(b.flow, 10);
    ric_segment piece = ric_flow_piece(b.flow, 0);
    for (double x = 0; x <= 1; x += 0.001) {
      double q, u;
      ric_segment_state(&piece, x, &q, &u);
      most = fmax(most, -q);
      energy = fmax(energy, fabs(ric_system_energy(b.system, 0, &q, &u) + 0.3 * q));
    }
    ric_flow_accept(b.flow, 1);
  }
  assert_close(most, deepest, 1e-6 * deepest); /* sampled */
  assert_close(energy, 0, 1e-15);
  bounce_clear(&b);
}

/* A chain of three with a dense mass matrix pressed into a wall: energy with Hertz's potential stays. */
static void pressed_contact_keeps_the_energy_of_a_coupled_system(void **state) {
  (void)state;
  const double mass[] = {2, 0.5, 0, 0.5, 1, 0.3, 0, 0.3, 1.5}, stiffness[] = {2, -1, 0, -1, 2, -1, 0, -1, 2};
  ric_mck model = {.coordinates = 3, .mass.values = mass, .stiffness.values = stiffness};
  ric_obstacle obstacles[] = {ric_obstacle_wall(1, 0.2), ric_obstacle_floor(2, 0.5)};
  obstacles[0].stiffness = obstacles[1].stiffness = 20;
  ric_system *system = mck_system_made(&model, obstacles, 2);
  ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
  double q[] = {0.3, 0.2, 0.4}, u[] = {-0.2, 1, 0.1}, energy = ric_system_energy(system, 0, q, u);
  flow_set_contact(flow, 0, CONTACT_PRESSED); /* begins */
  flow_set_contact(flow, 1, CONTACT_PRESSED); /* is under way */
  assert_int_equal(ric_flow_start(flow, 0, q, u, NULL), RIC_OK);
  int steps = 0;
  for (double gap = -1; gap < 0; steps++) { /* until one leaves; a step errs by tolerance times order in the speeds */
    assert_close(ric_system_energy(system, 0, ric_flow_q(flow), ric_flow_u(flow)), energy, 24e-16 * (1 + steps));
    mck_step_once(flow, 10);
    ric_flow_accept(flow, 1);
    gap = fmax(ric_system_gap(system, 0, 0, ric_flow_q(flow)), ric_system_gap(system, 1, 0, ric_flow_q(flow)));
  }
  assert_true(ric_flow_time(flow) > 0.1);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

/* Through the end of a contact: the step that crosses it does so where the force no longer matters, and a contact that
 * is still called pressed in the air has no force. */
static void leaving_costs_no_accuracy(void **state) {
  (void)state;
  bounce b;
  bounce_make(&b, 1, 10, 0, 1);
  double deepest = pow(1.25 / 10, 0.4), time = 2 * sqrt(acos(-1)) * tgamma(1.4) / tgamma(0.9) * deepest;
  mck_run(b.flow, 0, (double[]){0}, (double[]){-1}, time);
  assert_close(ric_flow_q(b.flow)[0], 0, 1e-13);
  assert_close(ric_flow_u(b.flow)[0], 1, 1e-13);
  mck_move(b.flow, time + 1);
  assert_close(ric_flow_q(b.flow)[0], 1, 2e-13);
  assert_close(ric_flow_u(b.flow)[0], 1, 1e-13);
  bounce_clear(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(held_contacts_keep_their_coordinates),
      cmocka_unit_test(reactions_along_a_step_are_those_of_the_states),
      cmocka_unit_test(neighbours_of_a_held_coordinate_move_on),
      cmocka_unit_test(free_mass_bounces_as_hertz_says),
      cmocka_unit_test(beginning_does_not_depend_on_rounding),
      cmocka_unit_test(resting_mass_sinks_in),
      cmocka_unit_test(pressed_contact_keeps_the_energy_of_a_coupled_system),
      cmocka_unit_test(leaving_costs_no_accuracy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
