/* Contacts of the Taylor flow of lattices: coordinates that are held, and Hertz contacts that press. The states of
 * contacts are set through the internal table, as trajectories do. */
#include "support.h"

#include <gsl/gsl_integration.h>

#include "flow/flow_method.h"
#include "witness/system_flow.h"
#include "witness/random_lattice.h"

enum { MOST = 600 };

static void set(const system_flow *m, size_t obstacle, contact_state state) {
  m->flow->contact[obstacle] = (unsigned char)state;
}

static double reaction_of(const system_flow *m, size_t obstacle, double t, const double *q, const double *v) {
  double lambda = NAN;
  const ric_system *s = m->system;
  assert_null(s->model->reaction(s, m->flow->contact, obstacle, t, q, v, &lambda));
  return lambda;
}

/* A ring with one particle held at 0 is a chain of the others between walls. */
static void a_held_particle_is_a_wall(void **state) {
  (void)state;
  enum { N = 7 };
  random_source source = {.state = 81};
  double q[N], v[N];
  random_lattice_state(&source, N, q, v);
  q[0] = v[0] = 0;
  ric_lattice ring = ric_lattice_default(N, RIC_ENDS_PERIODIC);
  ring.link = (ric_spring){.linear = 0.4, .quadratic = 0.1, .cubic = 0.3, .damping = 0.05};
  ring.on_site.cubic = 0.2;
  ric_lattice chain = ring;
  chain.particles = N - 1;
  chain.ends = RIC_ENDS_FIXED;
  ric_obstacle floor = ric_obstacle_floor(0, 0);
  system_flow a = system_flow_of_lattice(&ring, &floor, 1, NULL), b = system_flow_of_lattice(&chain, NULL, 0, NULL);
  set(&a, 0, CONTACT_HELD);
  system_flow_start(&a, 0, q, v);
  system_flow_start(&b, 0, q + 1, v + 1);
  system_flow_run(&a, 20, 0);
  system_flow_run(&b, 20, 0);
  assert_true(ric_flow_q(a.flow)[0] == 0 && ric_flow_u(a.flow)[0] == 0);
  for (size_t i = 1; i < N; i++) {
    assert_close(ric_flow_q(a.flow)[i], ric_flow_q(b.flow)[i - 1], 1e-13);
    assert_close(ric_flow_u(a.flow)[i], ric_flow_u(b.flow)[i - 1], 1e-13);
  }
  system_flow_clear(&a);
  system_flow_clear(&b);
}

static void check_reaction(const system_flow *m, size_t obstacle) {
  static double q[MOST], v[MOST];
  double c[RIC_POLY_DEGREE + 1];
  int degree = m->flow->method->reaction(m->flow, obstacle, c);
  assert_in_range(degree, 4, RIC_POLY_DEGREE);
  for (int k = 0; k <= 4; k++) {
    double x = k / 4.0, t = 0;
    for (size_t i = 0; i < ric_flow_pieces(m->flow); i++) {
      ric_segment s = ric_flow_piece(m->flow, i);
      ric_segment_state(&s, x, q + s.first, v + s.first);
      t = s.start + x * s.length;
    }
    assert_close(ric_poly_value(c, degree, x, NULL), reaction_of(m, obstacle, t, q, v), 1e-13);
  }
}

/* At both ends of a lattice, where pieces meet, beside another held particle, on both sides. */
static void reaction_polynomial_is_the_force_on_a_held_particle(void **state) {
  (void)state;
  static random_lattice r;
  static double q[MOST], v[MOST];
  const size_t sizes[] = {1, 2, 3, 5, 256, 257, 600};
  random_source source = {.state = 82};
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
      size_t n = sizes[k], at[] = {0, n / 2, n - 1, n > 200 ? n / 2 - 1 : 0, n > 200 ? 200 : 0};
      ric_obstacle obstacles[5];
      random_lattice_set(&r, &source, n, (ric_ends)ends, WITH_ALL);
      random_lattice_state(&source, n, q, v);
      for (size_t j = 0; j < 5; j++) {
        obstacles[j] = j % 2 ? ric_obstacle_wall(at[j], q[at[j]]) : ric_obstacle_floor(at[j], q[at[j]]);
        v[at[j]] = 0;
      }
      system_flow m = system_flow_of_lattice(&r.lattice, obstacles, 5, NULL);
      for (size_t j = 0; j < 5; j++)
        set(&m, j, CONTACT_HELD);
      system_flow_start(&m, 0.5, q, v);
      for (int step = 0; step < 2; step++) {
        assert_int_equal(ric_flow_step(m.flow, 9, NULL), RIC_OK);
        for (size_t j = 0; j < 5; j++)
          check_reaction(&m, j);
        ric_flow_accept(m.flow, 1);
      }
      system_flow_clear(&m);
    }
}

static void a_held_contact_has_no_rates_and_feels_what_presses_beside_it(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  lattice.link.linear = 0.5;
  ric_obstacle obstacles[] = {ric_obstacle_floor(0, -1), ric_obstacle_wall(0, -2)};
  obstacles[1].stiffness = 4; /* pressed by 1: pushes down with 4 */
  double q[] = {-1, 1}, v[] = {0, 2}, q_rate[2], u_rate[2], c[RIC_POLY_DEGREE + 1];
  system_flow m = system_flow_of_lattice(&lattice, obstacles, 2, NULL);
  set(&m, 0, CONTACT_HELD);
  set(&m, 1, CONTACT_PRESSED);
  assert_null(m.system->model->rate(m.system, m.flow->contact, 0, q, v, q_rate, u_rate));
  assert_true(q_rate[0] == 0 && u_rate[0] == 0 && q_rate[1] == 2);
  assert_close(u_rate[1], -1 - 0.5 * 2, 1e-15);
  double force = 1 + 0.5 * 2 - 4; /* spring, link, Hertz */
  assert_close(reaction_of(&m, 0, 0, q, v), -force, 1e-15);
  system_flow_start(&m, 0, q, v);
  assert_int_equal(ric_flow_step(m.flow, 1, NULL), RIC_OK);
  m.flow->method->reaction(m.flow, 0, c);
  assert_close(c[0], -force, 1e-15);
  system_flow_clear(&m);
}

/* Oscillator on a Hertz contact, approached with the speed 1: v^2 = 1 - 2 u - u^2 - 0.8 k u^{5/2}. */
static double square_of_speed(double k, double u) {
  return 1 - 2 * u - u * u - 0.8 * k * u * u * sqrt(u);
}

static double deepest(double k) {
  double low = 0, high = 1;
  for (int i = 0; i < 100; i++) {
    double middle = (low + high) / 2;
    *(square_of_speed(k, middle) > 0 ? &low : &high) = middle;
  }
  return low;
}

/* dt = du / v with u = deepest cos^2, which makes the integrand analytic up to both ends. */
static double duration_by_quadrature(double k) {
  enum { PANELS = 20, POINTS = 12 };
  double most = deepest(k), sum = 0, width = 1.5707963267948966 / PANELS;
  gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(POINTS);
  for (int panel = 0; panel < PANELS; panel++)
    for (size_t i = 0; i < POINTS; i++) {
      double angle, weight;
      gsl_integration_glfixed_point(panel * width, (panel + 1) * width, i, &angle, &weight, rule);
      double u = most * cos(angle) * cos(angle);
      sum += weight * most * sin(2 * angle) / sqrt(square_of_speed(k, u));
    }
  gsl_integration_glfixed_table_free(rule);
  return 2 * sum;
}

/* Steps until the gap opens; returns that time. The first step begins at a gap of zero. */
static double run_to_parting(const system_flow *m, const ric_obstacle *o) {
  ric_error error = {0};
  for (int steps = 0; steps < 300; steps++) {
    double c[RIC_POLY_DEGREE + 1], at = 1;
    if (ric_flow_step(m->flow, ric_flow_time(m->flow) + 10, &error) != RIC_OK)
      fail_msg("%s", error.message);
    ric_segment s = ric_flow_piece(m->flow, 0);
    ric_segment_gap(&s, o->coordinate, o->position, c);
    for (int j = 0; j <= s.degree; j++)
      c[j] *= -o->side;
    int parts = steps > 0 && ric_poly_first_root(c, s.degree, &at);
    ric_flow_accept(m->flow, parts ? at : 1);
    if (parts)
      return ric_flow_time(m->flow);
  }
  fail_msg("the contact does not open");
  return NAN;
}

static void hertz_contact_lasts_as_long_as_its_quadrature_says(void **state) {
  (void)state;
  const double stiffness[] = {0.1, 10, 1e3, 1e6};
  const double gaps[] = {0, -1e-17, 1e-17}; /* contacts are found up to rounding */
  for (size_t k = 0; k < 4; k++)
    for (size_t g = 0; g < 3; g++)
      for (int side = -1; side <= 1; side += 2) {
        ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
        ric_obstacle o = {.side = side, .position = -side, .restitution = 1, .stiffness = stiffness[k]};
        double q = o.position + side * gaps[g], v = -side;
        system_flow m = system_flow_of_lattice(&lattice, &o, 1, NULL);
        set(&m, 0, CONTACT_PRESSED);
        system_flow_start(&m, 0, &q, &v);
        double energy = system_flow_energy(&m), duration = run_to_parting(&m, &o);
        assert_close(duration, duration_by_quadrature(stiffness[k]), 1e-12);
        assert_close(system_flow_energy(&m), energy, 1e-13 * energy);
        assert_close(*ric_flow_u(m.flow), side, 1e-12);
        system_flow_clear(&m);
      }
}

static void hertz_contact_at_a_late_time_keeps_its_energy(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle o = ric_obstacle_floor(0, -1);
  o.stiffness = 1e3;
  const double q = -1, v = -1, start = 1e5;
  system_flow m = system_flow_of_lattice(&lattice, &o, 1, NULL);
  set(&m, 0, CONTACT_PRESSED);
  system_flow_start(&m, start, &q, &v);
  double energy = system_flow_energy(&m);
  /* The time itself is known to 1.5e-11; a step without force of 4e-12 (1 + t) changes the energy by less than 1e-12.
   */
  assert_close(run_to_parting(&m, &o) - start, duration_by_quadrature(1e3), 2e-9);
  assert_close(system_flow_energy(&m), energy, 1e-11 * energy);
  system_flow_clear(&m);
}

/* Deep enough never to part: a static load. */
static void a_pressed_contact_swings_about_its_load(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle o = ric_obstacle_floor(0, 1);
  o.stiffness = 100;
  const double q = 0.97, v = 0;
  system_flow m = system_flow_of_lattice(&lattice, &o, 1, NULL);
  set(&m, 0, CONTACT_PRESSED);
  system_flow_start(&m, 0, &q, &v);
  double energy = system_flow_energy(&m);
  system_flow_run(&m, 200, 1);
  assert_close(system_flow_energy(&m), energy, 1e-13 * energy);
  system_flow_clear(&m);
}

/* Many contacts that press in a long lattice, also in the halos of its pieces and around the ring, against the same
 * flow at a quarter of its steps, and energy. */
static void pressed_contacts_of_a_long_ring_keep_its_energy(void **state) {
  (void)state;
  static double q[MOST], v[MOST], there[MOST];
  static ric_obstacle obstacles[MOST];
  random_source source = {.state = 83};
  ric_lattice lattice = ric_lattice_default(MOST, RIC_ENDS_PERIODIC);
  lattice.link.linear = 0.2;
  for (size_t i = 0; i < MOST; i++) {
    q[i] = random_uniform(&source, -0.1, 0.1);
    v[i] = random_uniform(&source, -0.1, 0.1);
    obstacles[i] = i % 2 ? ric_obstacle_floor(i, 2) : ric_obstacle_wall(i, -2); /* pressed by about 2 */
    obstacles[i].stiffness = random_uniform(&source, 0.02, 0.2);                /* not so strong that they part */
  }
  system_flow m = system_flow_of_lattice(&lattice, obstacles, MOST, NULL);
  for (size_t i = 0; i < MOST; i++)
    set(&m, i, CONTACT_PRESSED);
  system_flow_start(&m, 0, q, v);
  double energy = system_flow_energy(&m);
  system_flow_run(&m, 1, 1);
  assert_close(system_flow_energy(&m), energy, 1e-13 * energy);
  memcpy(there, ric_flow_q(m.flow), sizeof there);
  system_flow_run(&m, 0, 0);
  for (size_t i = 0; i < MOST; i++)
    assert_close(ric_flow_q(m.flow)[i], q[i], 1e-13);
  system_flow_clear(&m);
  ric_flow_options fine = {.longest_step = 0.05};
  m = system_flow_of_lattice(&lattice, obstacles, MOST, &fine);
  for (size_t i = 0; i < MOST; i++)
    set(&m, i, CONTACT_PRESSED);
  system_flow_start(&m, 0, q, v);
  system_flow_run(&m, 1, 0);
  for (size_t i = 0; i < MOST; i++)
    assert_close(ric_flow_q(m.flow)[i], there[i], 1e-13);
  system_flow_clear(&m);
}

/* Contacts of a neighbour that opens and closes do not disturb one that goes on; and steps recover after both. */
static void steps_recover_after_a_contact(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  lattice.link.linear = 0.1;
  ric_obstacle o = ric_obstacle_floor(1, -1);
  o.stiffness = 1e4;
  double q[] = {0.2, -1}, v[] = {0, -0.5};
  system_flow m = system_flow_of_lattice(&lattice, &o, 1, NULL);
  set(&m, 0, CONTACT_PRESSED);
  system_flow_start(&m, 0, q, v);
  run_to_parting(&m, &o);
  set(&m, 0, CONTACT_OPEN);
  system_flow_start(&m, ric_flow_time(m.flow), ric_flow_q(m.flow), ric_flow_u(m.flow));
  unsigned long long before = ric_flow_counted(m.flow).steps;
  system_flow_run(&m, ric_flow_time(m.flow) + 4, 0);
  assert_true(ric_flow_counted(m.flow).steps - before <= 3);
  system_flow_clear(&m);
}

/* Energy of a contact that begins with no speed at all, pushed in by the spring. */
static void a_contact_that_begins_at_rest_is_pushed_in(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle o = ric_obstacle_floor(0, 1);
  o.stiffness = 100;
  const double q = 1, v = 0;
  system_flow m = system_flow_of_lattice(&lattice, &o, 1, NULL);
  set(&m, 0, CONTACT_PRESSED);
  system_flow_start(&m, 0, &q, &v);
  double energy = system_flow_energy(&m), lowest = 1;
  for (int i = 0; i < 200 && ric_flow_time(m.flow) < 0.3; i++) {
    assert_int_equal(ric_flow_step(m.flow, 0.3, NULL), RIC_OK);
    ric_flow_accept(m.flow, 1);
    lowest = fmin(lowest, *ric_flow_q(m.flow));
    assert_close(system_flow_energy(&m), energy, 1e-13 * energy);
  }
  assert_close(ric_flow_time(m.flow), 0.3, 0);
  assert_true(lowest < 0.96);
  system_flow_clear(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_held_particle_is_a_wall),
      cmocka_unit_test(reaction_polynomial_is_the_force_on_a_held_particle),
      cmocka_unit_test(a_held_contact_has_no_rates_and_feels_what_presses_beside_it),
      cmocka_unit_test(hertz_contact_lasts_as_long_as_its_quadrature_says),
      cmocka_unit_test(hertz_contact_at_a_late_time_keeps_its_energy),
      cmocka_unit_test(a_pressed_contact_swings_about_its_load),
      cmocka_unit_test(pressed_contacts_of_a_long_ring_keep_its_energy),
      cmocka_unit_test(steps_recover_after_a_contact),
      cmocka_unit_test(a_contact_that_begins_at_rest_is_pushed_in),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
