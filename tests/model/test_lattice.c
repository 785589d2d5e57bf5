/* Lattices: forces, energies, and what is refused; and the system that is made of one. */
#include "support.h"

#include "witness/random_lattice.h"

enum { MOST = 16 };

static const size_t sizes[] = {1, 2, 3, 4, 5, 12};

static void lattice_of_a_chain_has_its_acceleration_and_energy(void **state) {
  (void)state;
  random_source source = {.state = 51};
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
      ric_chain chain = ric_chain_default(sizes[s], 0.7);
      chain.ends = (ric_ends)ends;
      ric_lattice lattice = ric_lattice_of_chain(&chain);
      double q[MOST], v[MOST], expected[MOST], found[MOST];
      random_lattice_state(&source, chain.particles, q, v);
      ric_chain_acceleration(&chain, q, expected);
      ric_lattice_acceleration(&lattice, 3, q, v, found);
      for (size_t i = 0; i < chain.particles; i++)
        assert_close(found[i], expected[i], 4e-15); /* a few roundings of numbers up to 4 */
      double energy = ric_chain_energy(&chain, q, v);
      assert_close(ric_lattice_energy(&lattice, q, v), energy, 1e-14 * energy);
    }
}

static void for_random_lattices(unsigned with, void (*holds)(const ric_lattice *, double *q, double *v)) {
  random_source source = {.state = 52};
  static random_lattice r;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
      double q[MOST], v[MOST];
      random_lattice_set(&r, &source, sizes[s], (ric_ends)ends, with);
      random_lattice_state(&source, sizes[s], q, v);
      holds(&r.lattice, q, v);
    }
}

static void check_gradient(const ric_lattice *lattice, double *q, double *v) {
  double acceleration[MOST], step = 1e-4;
  ric_lattice_acceleration(lattice, 0, q, v, acceleration);
  for (size_t i = 0; i < lattice->particles; i++) {
    double here = q[i];
    q[i] = here + step;
    double above = ric_lattice_energy(lattice, q, v);
    q[i] = here - step;
    double below = ric_lattice_energy(lattice, q, v);
    q[i] = here;
    /* Third derivatives are below 20: step^2 / 6 of that, and rounding of energies up to 50. */
    assert_close(lattice->masses[i] * acceleration[i], -(above - below) / (2 * step), 1e-7);
  }
}

static void force_is_minus_the_gradient_of_the_energy(void **state) {
  (void)state;
  for_random_lattices(WITH_SITES | WITH_LINKS, check_gradient);
}

static void check_dissipation(const ric_lattice *lattice, double *q, double *v) {
  size_t n = lattice->particles;
  double damped[MOST], still[MOST], rest[MOST] = {0}, power = 0, expected = 0;
  ric_lattice_acceleration(lattice, 0, q, v, damped);
  ric_lattice_acceleration(lattice, 0, q, rest, still);
  for (size_t i = 0; i < n; i++) {
    power += lattice->masses[i] * (damped[i] - still[i]) * v[i];
    expected -= lattice->on_sites[i].damping * v[i] * v[i];
  }
  int ring = lattice->ends == RIC_ENDS_PERIODIC;
  for (size_t i = 0; i < (ring ? n : n + 1); i++) {
    double left = i > 0 ? v[i - 1] : ring ? v[n - 1] : 0, rate = (i < n ? v[i] : 0) - left;
    expected -= ric_lattice_link(lattice, i).damping * rate * rate;
  }
  assert_close(power, expected, 1e-14);
}

static void dampers_take_their_power(void **state) {
  (void)state;
  for_random_lattices(WITH_ALL - WITH_FORCING, check_dissipation);
}

static void small_rings_are_free_chains_and_ends_have_their_links(void **state) {
  (void)state;
  ric_lattice l = ric_lattice_default(2, RIC_ENDS_PERIODIC);
  l.link.linear = 0.5;
  assert_close(ric_lattice_link(&l, 0).linear, 0, 0);
  assert_close(ric_lattice_link(&l, 1).linear, 0.5, 0);
  assert_close(ric_lattice_link(&l, 2).linear, 0, 0);
  l.particles = 3;
  const ric_spring links[] = {{.linear = 1}, {.linear = 2}, {.linear = 3}, {.linear = 4}};
  l.links = links;
  assert_close(ric_lattice_link(&l, 0).linear, 1, 0);
  assert_close(ric_lattice_link(&l, 3).linear, 1, 0); /* the same link */
  l.ends = RIC_ENDS_FIXED;
  assert_close(ric_lattice_link(&l, 3).linear, 4, 0);
  l.ends = RIC_ENDS_FREE;
  assert_close(ric_lattice_link(&l, 0).linear, 0, 0);
  assert_close(ric_lattice_link(&l, 3).linear, 0, 0);
}

static void frequency_bound_is_above_every_mode_and_sharp_for_even_rings(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
      ric_chain chain = ric_chain_default(sizes[s], 0.4);
      chain.ends = (ric_ends)ends;
      ric_lattice lattice = ric_lattice_of_chain(&chain);
      double bound = ric_lattice_frequency_bound(&lattice), highest = ric_chain_frequency_max(&chain);
      assert_true(bound >= highest * (1 - 1e-15));
      if (ends == RIC_ENDS_PERIODIC && sizes[s] % 2 == 0)
        assert_close(bound, highest, 1e-15);
    }
  ric_lattice none = ric_lattice_default(3, RIC_ENDS_FREE);
  none.on_site.linear = 0;
  assert_close(ric_lattice_frequency_bound(&none), 0, 0);
}

static void refuses(const ric_lattice *lattice, const char *message) {
  ric_error error = {0};
  ric_system *system = NULL;
  assert_int_equal(ric_lattice_check(lattice, &error), RIC_EINVAL);
  if (!strstr(error.message, message))
    fail_msg("\"%s\" does not say \"%s\"", error.message, message);
  assert_int_equal(ric_system_create_lattice(lattice, NULL, 0, &system, &error), RIC_EINVAL);
  assert_null(system);
}

static void refusals_name_the_field(void **state) {
  (void)state;
  const ric_lattice good = ric_lattice_default(3, RIC_ENDS_FIXED);
  const double bad[] = {1, NAN, 1}, masses[] = {1, 2, 0};
  const ric_spring springs[] = {{.linear = 1}, {.cubic = INFINITY}, {.linear = 1}, {.damping = -1}};
  assert_int_equal(ric_lattice_check(&good, NULL), RIC_OK);
  ric_lattice l = good;
  l.particles = 0;
  refuses(&l, "particles = 0");
  l = good, l.ends = (ric_ends)7;
  refuses(&l, "ends = 7");
  l = good, l.mass = NAN;
  refuses(&l, "mass of particle 0 = nan");
  l = good, l.masses = masses;
  refuses(&l, "mass of particle 2 = 0");
  l = good, l.on_sites = springs;
  refuses(&l, "on-site spring 1: cubic = inf");
  l = good, l.links = springs + 2;
  l.particles = 1;
  refuses(&l, "link 1: damping = -1");
  l = good, l.frequency = INFINITY;
  refuses(&l, "frequency = inf");
  l = good, l.force_sin = bad;
  refuses(&l, "force_sin[1] = nan");
}

static void system_copies_the_lattice_and_has_its_rates(void **state) {
  (void)state;
  random_source source = {.state = 53};
  static random_lattice r;
  double q[MOST], v[MOST], expected[MOST], q_rate[MOST], u_rate[MOST];
  ric_system *system = NULL;
  random_lattice_set(&r, &source, 12, RIC_ENDS_FIXED, WITH_ALL);
  random_lattice_state(&source, 12, q, v);
  ric_lattice_acceleration(&r.lattice, 2, q, v, expected);
  double energy = ric_lattice_energy(&r.lattice, q, v);
  assert_int_equal(ric_system_create_lattice(&r.lattice, NULL, 0, &system, NULL), RIC_OK);
  memset(&r, 0, sizeof r);
  assert_int_equal(ric_system_rate(system, 2, q, v, q_rate, u_rate, NULL), RIC_OK);
  assert_memory_equal(q_rate, v, 12 * sizeof *v);
  assert_memory_equal(u_rate, expected, 12 * sizeof *v);
  assert_close(ric_system_energy(system, 2, q, v), energy, 0);
  ric_system_destroy(&system);
}

static void compliant_obstacles_push_by_hertz_law_and_store_its_energy(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_obstacle obstacles[] = {ric_obstacle_floor(0, -1), ric_obstacle_wall(1, 0.5), ric_obstacle_wall(0, 2)};
  for (size_t j = 0; j < 3; j++)
    obstacles[j].stiffness = 10;
  lattice.mass = 2;
  ric_system *system = NULL;
  double q[] = {-1.25, 1.5}, v[] = {0, 0}, q_rate[2], u_rate[2];
  assert_int_equal(ric_system_create_lattice(&lattice, obstacles, 3, &system, NULL), RIC_OK);
  assert_int_equal(ric_system_rate(system, 0, q, v, q_rate, u_rate, NULL), RIC_OK);
  assert_close(u_rate[0], (1.25 + 10 * 0.125) / 2, 1e-15);
  assert_close(u_rate[1], (-1.5 - 10) / 2, 1e-15);
  double springs = (1.25 * 1.25 + 1.5 * 1.5) / 2;
  assert_close(ric_system_energy(system, 0, q, v), springs + 4 * (0.03125 + 1), 1e-14);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lattice_of_a_chain_has_its_acceleration_and_energy),
      cmocka_unit_test(force_is_minus_the_gradient_of_the_energy),
      cmocka_unit_test(dampers_take_their_power),
      cmocka_unit_test(small_rings_are_free_chains_and_ends_have_their_links),
      cmocka_unit_test(frequency_bound_is_above_every_mode_and_sharp_for_even_rings),
      cmocka_unit_test(refusals_name_the_field),
      cmocka_unit_test(system_copies_the_lattice_and_has_its_rates),
      cmocka_unit_test(compliant_obstacles_push_by_hertz_law_and_store_its_energy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
