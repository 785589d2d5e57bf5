/* The Taylor flow of lattices against exact motions, conserved quantities and itself. */
#include "support.h"

#include "witness/modal_motion.h"
#include "witness/system_flow.h"
#include "witness/random_lattice.h"

enum { MOST = 40, LONG = 1000 };

static const size_t sizes[] = {1, 2, 3, 4, 5, 8, 13, 40};

static void for_all_chains(void (*holds)(const ric_chain *chain, const system_flow *m, modal_motion *motion,
                                         const double *q, const double *v)) {
  const double couplings[] = {0, 0.1, 1.3};
  random_source source = {.state = 14};
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
      for (size_t g = 0; g < 3; g++) {
        double q[MOST], v[MOST];
        ric_chain chain = ric_chain_default(sizes[s], couplings[g]);
        chain.ends = (ric_ends)ends;
        ric_lattice lattice = ric_lattice_of_chain(&chain);
        system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
        modal_motion motion = modal_motion_create(&chain);
        random_lattice_state(&source, chain.particles, q, v);
        modal_motion_set(&motion, q, v);
        holds(&chain, &m, &motion, q, v);
        modal_motion_clear(&motion);
        system_flow_clear(&m);
      }
}

/* Rounding of 27 terms of size (omega h)^j / j!, at most exp(2.2), and of the modal sum. */
static double rounding_of(const modal_motion *motion, int order) {
  return 1e-15 * 9 * 10 * modal_motion_bound(motion, order);
}

static void check_exact(const ric_chain *chain, const system_flow *m, modal_motion *motion, const double *q,
                        const double *v) {
  double at_q[MOST], at_v[MOST], exact_q[MOST], exact_v[MOST];
  for (int direction = -1; direction <= 1; direction += 2) {
    system_flow_start(m, 7, q, v);
    assert_int_equal(ric_flow_step(m->flow, 7 + 100 * direction, NULL), RIC_OK);
    assert_int_equal(ric_flow_pieces(m->flow), 1);
    ric_segment s = ric_flow_piece(m->flow, 0);
    assert_true(s.start == 7 && s.length * direction > 0 && s.coordinates == chain->particles);
    for (int k = 0; k <= 10; k++) {
      modal_motion_state(motion, s.length * k / 10, exact_q, exact_v);
      ric_segment_state(&s, k / 10.0, at_q, at_v);
      for (size_t i = 0; i < chain->particles; i++) {
        assert_close(at_q[i], exact_q[i], rounding_of(motion, 0));
        assert_close(at_v[i], exact_v[i], rounding_of(motion, 1));
      }
    }
  }
}

static void segments_equal_the_modal_motion_to_rounding_in_both_directions(void **state) {
  (void)state;
  for_all_chains(check_exact);
}

static void check_energy(const ric_chain *chain, const system_flow *m, modal_motion *motion, const double *q,
                         const double *v) {
  double at_q[MOST], at_v[MOST], energy = ric_chain_energy(chain, q, v);
  (void)motion;
  system_flow_start(m, 0, q, v);
  assert_int_equal(ric_flow_step(m->flow, 100, NULL), RIC_OK);
  ric_segment s = ric_flow_piece(m->flow, 0);
  for (int k = 0; k <= 10; k++) {
    ric_segment_state(&s, k / 10.0, at_q, at_v);
    assert_close(ric_chain_energy(chain, at_q, at_v), energy, 1e-13 * energy);
  }
}

static void energy_is_constant_along_a_segment(void **state) {
  (void)state;
  for_all_chains(check_energy);
}

static void check_return(const ric_chain *chain, const system_flow *m, modal_motion *motion, const double *q,
                         const double *v) {
  system_flow_start(m, 0, q, v);
  system_flow_run(m, 20, 0);
  system_flow_run(m, 0, 0);
  for (size_t i = 0; i < chain->particles; i++) { /* forty steps at the most */
    assert_close(ric_flow_q(m->flow)[i], q[i], 40 * rounding_of(motion, 0));
    assert_close(ric_flow_u(m->flow)[i], v[i], 40 * rounding_of(motion, 1));
  }
}

static void motion_back_returns_to_the_start(void **state) {
  (void)state;
  for_all_chains(check_return);
}

static void long_chains_in_pieces_follow_the_modal_motion(void **state) {
  (void)state;
  static double q[LONG], v[LONG], exact_q[LONG], exact_v[LONG];
  random_source source = {.state = 16};
  random_lattice_state(&source, LONG, q, v);
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    ric_chain chain = ric_chain_default(LONG, 0.6);
    chain.ends = (ric_ends)ends;
    ric_lattice lattice = ric_lattice_of_chain(&chain);
    system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
    modal_motion motion = modal_motion_create(&chain);
    modal_motion_set(&motion, q, v);
    modal_motion_state(&motion, 10, exact_q, exact_v);
    system_flow_start(&m, 0, q, v);
    system_flow_run(&m, 10, ends % 2);
    for (size_t i = 0; i < LONG; i++) {
      assert_close(ric_flow_q(m.flow)[i], exact_q[i], 1e-13); /* the modal sum has a thousand terms */
      assert_close(ric_flow_u(m.flow)[i], exact_v[i], 1e-13 * ric_chain_frequency_max(&chain));
    }
    modal_motion_clear(&motion);
    system_flow_clear(&m);
  }
}

/* Flips a velocity once per period, as elastic impacts do, and looks at the energy. 1e4 periods of a tenth of what the
 * bound is for. */
static void energy_of_a_long_run_with_reflections_is_kept(void **state) {
  (void)state;
  enum { N = 30, PERIODS = 10000 };
  const double period = 4.71238898038469;
  ric_lattice lattice = ric_lattice_default(N, RIC_ENDS_PERIODIC);
  lattice.link.linear = 0.09;
  random_source source = {.state = 17};
  double q[N], v[N];
  system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
  random_lattice_state(&source, N, q, v);
  system_flow_start(&m, 0, q, v);
  double energy = system_flow_energy(&m);
  for (int k = 1; k <= PERIODS; k++) {
    system_flow_run(&m, k * period, 0);
    memcpy(v, ric_flow_u(m.flow), sizeof v);
    v[k % N] = -v[k % N];
    system_flow_start(&m, k * period, ric_flow_q(m.flow), v);
  }
  assert_close(system_flow_energy(&m), energy, 1e-12 * energy);
  system_flow_clear(&m);
}

static void steps_land_on_the_stop_without_a_sliver(void **state) {
  (void)state;
  const double ends[] = {1e-9, 1, 2.3, 5, 17.123456789, -3.3};
  ric_lattice lattice = ric_lattice_default(3, RIC_ENDS_FREE);
  double q[] = {1, 0, -1}, v[] = {0, 1, 0};
  system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
  for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
    double shortest = INFINITY, longest = 0;
    system_flow_start(&m, 0, q, v);
    while (ric_flow_time(m.flow) != ends[k]) {
      double before = ric_flow_time(m.flow);
      assert_int_equal(ric_flow_step(m.flow, ends[k], NULL), RIC_OK);
      ric_flow_accept(m.flow, 1);
      shortest = fmin(shortest, fabs(ric_flow_time(m.flow) - before));
      longest = fmax(longest, fabs(ric_flow_time(m.flow) - before));
    }
    assert_true(shortest > 0.49 * longest);
  }
  ric_error error;
  system_flow_start(&m, 1, q, v);
  assert_int_equal(ric_flow_step(m.flow, 1, &error), RIC_EINVAL);
  system_flow_clear(&m);
}

static void a_part_of_a_step_is_the_value_of_its_segment(void **state) {
  (void)state;
  static double q[LONG], v[LONG], at_q[LONG], at_v[LONG];
  random_source source = {.state = 18};
  ric_lattice lattice = ric_lattice_default(LONG, RIC_ENDS_PERIODIC);
  lattice.link = (ric_spring){.linear = 0.3, .cubic = 0.2};
  system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
  random_lattice_state(&source, LONG, q, v);
  system_flow_start(&m, 1, q, v);
  const double parts[] = {0.3, 1, 0};
  for (size_t k = 0; k < 3; k++) {
    assert_int_equal(ric_flow_step(m.flow, 9, NULL), RIC_OK);
    double start = ric_flow_time(m.flow), end = ric_flow_step_end(m.flow);
    for (size_t i = ric_flow_pieces(m.flow); i-- > 0;) { /* in any order */
      ric_segment s = ric_flow_piece(m.flow, i);
      ric_segment_state(&s, parts[k], at_q + s.first, at_v + s.first);
    }
    ric_flow_accept(m.flow, parts[k]);
    assert_close(ric_flow_time(m.flow), start + parts[k] * (end - start), 1e-15);
    assert_memory_equal(ric_flow_q(m.flow), at_q, sizeof at_q);
    assert_memory_equal(ric_flow_u(m.flow), at_v, sizeof at_v);
  }
  system_flow_clear(&m);
}

/* m q'' + c q' + k q = F cos(w t) + G sin(w t): the steady motion, and a free one on top of it. */
static void forced_damped_oscillator_follows_its_closed_form(void **state) {
  (void)state;
  const double mass = 2, c = 0.3, k = 1.7, w = 2.1, F = 0.4, G = -0.9, end = 40;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  lattice.mass = mass;
  lattice.on_site = (ric_spring){.linear = k, .damping = c};
  lattice.frequency = w;
  lattice.force_cos = &F;
  lattice.force_sin = &G;
  double a = k - mass * w * w, b = c * w, norm = a * a + b * b;
  double A = (a * F - b * G) / norm, B = (b * F + a * G) / norm; /* steady: A cos + B sin */
  double decay = c / (2 * mass), turn = sqrt(k / mass - decay * decay);
  double q = A + 1, v = B * w - decay; /* free part exp(-decay t) cos(turn t) */
  system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
  system_flow_start(&m, 0, &q, &v);
  system_flow_run(&m, end, 0);
  double fade = exp(-decay * end);
  assert_close(*ric_flow_q(m.flow), A * cos(w * end) + B * sin(w * end) + fade * cos(turn * end), 1e-13);
  assert_close(*ric_flow_u(m.flow),
               w * (B * cos(w * end) - A * sin(w * end)) - fade * (decay * cos(turn * end) + turn * sin(turn * end)),
               1e-13);
  system_flow_clear(&m);
}

static void a_forced_particle_starts_from_rest(void **state) {
  (void)state;
  const double G = 1e-3, zero = 0, end = 3;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  lattice.on_site = (ric_spring){0};
  lattice.frequency = 1;
  lattice.force_sin = &G;
  system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
  system_flow_start(&m, 0, &zero, &zero);
  system_flow_run(&m, end, 0);
  assert_close(*ric_flow_q(m.flow), G * (end - sin(end)), 1e-17);
  system_flow_clear(&m);
}

static void a_free_particle_flies_straight(void **state) {
  (void)state;
  const double q = 1, v = -0.25;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  lattice.on_site = (ric_spring){0};
  system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
  system_flow_start(&m, 0, &q, &v);
  system_flow_run(&m, 1000, 0);
  assert_close(*ric_flow_q(m.flow), -249, 0);
  assert_int_equal(ric_flow_counted(m.flow).steps, 1);
  system_flow_clear(&m);
}

static void duffing_oscillator_keeps_its_energy(void **state) {
  (void)state;
  const double amplitudes[] = {1e-3, 1, 100};
  for (size_t k = 0; k < 3; k++) {
    double q = amplitudes[k], v = 0;
    ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
    lattice.on_site.cubic = 1;
    system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
    system_flow_start(&m, 0, &q, &v);
    double energy = system_flow_energy(&m);
    system_flow_run(&m, 1000 / (1 + amplitudes[k]), 0); /* periods shrink like the amplitude */
    assert_close(system_flow_energy(&m), energy, 2e-13 * energy);
    assert_true(ric_flow_counted(m.flow).steps < 3000);
    system_flow_clear(&m);
  }
}

static ric_lattice quartic_chain(size_t n) {
  ric_lattice lattice = ric_lattice_default(n, RIC_ENDS_FIXED);
  lattice.on_site = (ric_spring){0};
  lattice.link = (ric_spring){.quadratic = 0.3, .cubic = 1}; /* no linear part at all */
  return lattice;
}

static void quartic_chain_returns_and_does_not_depend_on_the_step(void **state) {
  (void)state;
  enum { N = 6 };
  random_source source = {.state = 19};
  double q[N], v[N], there[N], end = 5;
  ric_lattice lattice = quartic_chain(N);
  random_lattice_state(&source, N, q, v);
  system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
  system_flow_start(&m, 0, q, v);
  system_flow_run(&m, end, 1);
  memcpy(there, ric_flow_q(m.flow), sizeof there);
  system_flow_run(&m, 0, 0);
  for (size_t i = 0; i < N; i++)
    assert_close(ric_flow_q(m.flow)[i], q[i], 1e-12); /* errors of 1e-16 per step grow with the motion's instability */
  ric_flow_options halved = ric_flow_options_default();
  halved.longest_step = end / (double)ric_flow_counted(m.flow).steps; /* half of the mean step there and back */
  system_flow fine = system_flow_of_lattice(&lattice, NULL, 0, &halved);
  system_flow_start(&fine, 0, q, v);
  system_flow_run(&fine, end, 0);
  for (size_t i = 0; i < N; i++)
    assert_close(ric_flow_q(fine.flow)[i], there[i], 1e-12);
  system_flow_clear(&m);
  system_flow_clear(&fine);
}

/* q'' = q^3 from q = 1 with the energy of a motion that escapes: q = 1 / (1 - t / sqrt 2). */
static void a_motion_that_blows_up_is_refused_with_its_time(void **state) {
  (void)state;
  const double q = 1, v = 0.7071067811865476;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  lattice.on_site = (ric_spring){.cubic = -1};
  ric_error error = {0};
  system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
  system_flow_start(&m, 0, &q, &v);
  int steps = 0;
  while (ric_flow_step(m.flow, 2, &error) == RIC_OK && steps++ < 1000)
    ric_flow_accept(m.flow, 1);
  assert_int_equal(error.status, RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "blows up"));
  assert_non_null(strstr(error.message, "q[0]"));
  assert_close(ric_flow_time(m.flow), sqrt(2), 1e-10);
  assert_true(*ric_flow_q(m.flow) > 1e9);
  system_flow_clear(&m);
}

static void an_unstable_linear_lattice_ends_before_infinity(void **state) {
  (void)state;
  const size_t particles[] = {2, 600};
  static double q[600], v[600];
  for (size_t k = 0; k < 2; k++) {
    ric_lattice lattice = ric_lattice_default(particles[k], RIC_ENDS_FREE);
    lattice.on_site.linear = -1;
    ric_error error = {0};
    for (size_t i = 0; i < particles[k]; i++)
      q[i] = 1;
    system_flow m = system_flow_of_lattice(&lattice, NULL, 0, NULL);
    system_flow_start(&m, 0, q, v);
    while (ric_flow_step(m.flow, 1e5, &error) == RIC_OK)
      ric_flow_accept(m.flow, 1);
    assert_int_equal(error.status, RIC_ENUMERIC);
    assert_true(ric_flow_time(m.flow) > 600 && ric_flow_time(m.flow) < 720); /* ln 1e308 = 709 */
    system_flow_clear(&m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(segments_equal_the_modal_motion_to_rounding_in_both_directions),
      cmocka_unit_test(energy_is_constant_along_a_segment),
      cmocka_unit_test(motion_back_returns_to_the_start),
      cmocka_unit_test(long_chains_in_pieces_follow_the_modal_motion),
      cmocka_unit_test(energy_of_a_long_run_with_reflections_is_kept),
      cmocka_unit_test(steps_land_on_the_stop_without_a_sliver),
      cmocka_unit_test(a_part_of_a_step_is_the_value_of_its_segment),
      cmocka_unit_test(forced_damped_oscillator_follows_its_closed_form),
      cmocka_unit_test(a_forced_particle_starts_from_rest),
      cmocka_unit_test(a_free_particle_flies_straight),
      cmocka_unit_test(duffing_oscillator_keeps_its_energy),
      cmocka_unit_test(quartic_chain_returns_and_does_not_depend_on_the_step),
      cmocka_unit_test(a_motion_that_blows_up_is_refused_with_its_time),
      cmocka_unit_test(an_unstable_linear_lattice_ends_before_infinity),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
