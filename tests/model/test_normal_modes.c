/* Normal modes: their equation, their orthogonality, closed forms, and what has none. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/double_pendulum.h"
#include "witness/random_lattice.h"
#include "witness/random_mck.h"

enum { MOST = 40 };

static double frequency[MOST], shape[MOST * MOST];

static void find(const ric_system *system) {
  ric_error error;
  if (ric_normal_modes(system, frequency, shape, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

/* Accelerations of the free motion at phi are -M^-1 K phi. */
static void check_equation(const ric_system *system) {
  size_t n = ric_system_coordinates(system);
  double rest[MOST] = {0}, q_rate[MOST], u_rate[MOST];
  double largest = frequency[n - 1] * frequency[n - 1];
  ric_error error;
  for (size_t j = 0; j < n; j++) {
    const double *phi = shape + j * n;
    assert_int_equal(ric_system_rate(system, 0, phi, rest, q_rate, u_rate, &error), RIC_OK);
    for (size_t i = 0; i < n; i++)
      assert_close(u_rate[i], -frequency[j] * frequency[j] * phi[i], 1e-13 * largest);
    assert_true(j == 0 || frequency[j] >= frequency[j - 1]);
  }
}

/* phi_i^T M phi_j by kinetic energies: of a sum of speeds and of a difference. */
static void check_orthonormal(const ric_system *system) {
  size_t n = ric_system_coordinates(system);
  double rest[MOST] = {0}, sum[MOST], difference[MOST];
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j <= i; j++) {
      for (size_t k = 0; k < n; k++) {
        sum[k] = shape[i * n + k] + shape[j * n + k];
        difference[k] = shape[i * n + k] - shape[j * n + k];
      }
      double product = ric_system_energy(system, 0, rest, sum) - ric_system_energy(system, 0, rest, difference);
      assert_close(product / 2, i == j ? 1 : 0, 1e-13);
    }
}

static void for_random_systems(void (*holds)(const ric_system *)) {
  static random_lattice lattice;
  static random_mck mck;
  random_source source = {.state = 71};
  for (int trial = 0; trial < 60; trial++) {
    size_t n = 1 + random_below(&source, MOST);
    int kind = trial % 6;
    ric_system *system;
    random_lattice_set(&lattice, &source, n, (ric_ends)(kind % 3), 0);
    random_mck_make(&mck, n, kind == 3, &source);
    mck.model.damping.values = mck.model.force_cos = mck.model.force_sin = NULL;
    random_sparse sparse;
    if (kind == 4) /* a dense mass beside a stiffness in compressed rows */
      mck.model.stiffness = random_sparse_of(&sparse, mck.stiffness, n);
    ric_status status = kind < 3 ? ric_system_create_lattice(&lattice.lattice, NULL, 0, &system, NULL)
                                 : ric_system_create_mck(&mck.model, NULL, 0, &system, NULL);
    assert_int_equal(status, RIC_OK);
    find(system);
    holds(system);
    ric_system_destroy(&system);
  }
}

static void modes_solve_their_equation(void **state) {
  (void)state;
  for_random_systems(check_equation);
}

static void modes_are_orthonormal_in_the_mass(void **state) {
  (void)state;
  for_random_systems(check_orthonormal);
}

static int rising(const void *a, const void *b) {
  const double *x = a, *y = b;
  return *x < *y ? -1 : *x > *y;
}

static void uniform_chains_have_their_dispersion_relation(void **state) {
  (void)state;
  static const size_t sizes[] = {1, 2, 3, 4, 7, 30};
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
      ric_chain chain = ric_chain_default(sizes[s], 0.3);
      double expected[MOST];
      ric_system *system;
      chain.ends = (ric_ends)ends;
      assert_int_equal(ric_system_create_chain(&chain, &system, NULL), RIC_OK);
      find(system);
      for (size_t j = 0; j < sizes[s]; j++)
        expected[j] = ric_chain_frequency(&chain, j);
      qsort(expected, sizes[s], sizeof *expected, rising);
      for (size_t j = 0; j < sizes[s]; j++)
        assert_close(frequency[j], expected[j], 1e-14 * expected[sizes[s] - 1]);
      ric_system_destroy(&system);
    }
}

/* Up to where the sum of two of them overflows, down to where they lose digits. */
static void stiffnesses_of_any_size_scale_frequencies(void **state) {
  (void)state;
  static const double sizes[] = {1e-322, 1e-308, 1e-160, 1e160, 1e300, 4e307};
  for (size_t n = 3; n <= 20; n += 17)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
      ric_lattice lattice = ric_lattice_default(n, RIC_ENDS_FIXED);
      ric_system *system;
      lattice.on_site = (ric_spring){0};
      lattice.link.linear = sizes[s];
      assert_int_equal(ric_system_create_lattice(&lattice, NULL, 0, &system, NULL), RIC_OK);
      find(system);
      for (size_t j = 0; j < n; j++) {
        double angle = 1.5707963267948966 * (double)(j + 1) / (double)(n + 1);
        assert_close(frequency[j] / sqrt(sizes[s]), 2 * sin(angle), 1e-13);
      }
      ric_system_destroy(&system);
    }
}

/* Modes of a chain with fixed ends are simple: sines, whichever sign they have. */
static void shapes_of_a_fixed_chain_are_sines_with_a_positive_largest_component(void **state) {
  (void)state;
  ric_chain chain = ric_chain_default(7, 0.3);
  ric_system *system;
  chain.ends = RIC_ENDS_FIXED;
  assert_int_equal(ric_system_create_chain(&chain, &system, NULL), RIC_OK);
  find(system);
  for (size_t j = 0; j < 7; j++) {
    double most = 0, along = 0;
    size_t first = 0;
    for (size_t i = 0; i < 7; i++)
      most = fmax(most, fabs(shape[j * 7 + i]));
    while (fabs(shape[j * 7 + first]) < most - 1e-9)
      first++;
    for (size_t i = 0; i < 7; i++)
      along += shape[j * 7 + i] * ric_chain_mode_shape(&chain, j, i);
    assert_true(shape[j * 7 + first] > 0);
    assert_close(fabs(along), 1, 1e-14);
  }
  ric_system_destroy(&system);
}

static void damping_forcing_and_nonlinear_terms_are_left_aside(void **state) {
  (void)state;
  static random_lattice r;
  random_source source = {.state = 72};
  double with[6];
  ric_system *system;
  random_lattice_set(&r, &source, 6, RIC_ENDS_PERIODIC, WITH_ALL);
  assert_int_equal(ric_system_create_lattice(&r.lattice, NULL, 0, &system, NULL), RIC_OK);
  find(system);
  memcpy(with, frequency, sizeof with);
  ric_system_destroy(&system);
  for (size_t i = 0; i <= 6; i++) {
    r.links[i] = (ric_spring){.linear = r.links[i].linear};
    if (i < 6)
      r.on_sites[i] = (ric_spring){.linear = r.on_sites[i].linear};
  }
  r.lattice.force_cos = r.lattice.force_sin = NULL;
  assert_int_equal(ric_system_create_lattice(&r.lattice, NULL, 0, &system, NULL), RIC_OK);
  find(system);
  assert_memory_equal(with, frequency, sizeof with);
  check_equation(system);
  ric_system_destroy(&system);
}

static ric_system *two_coordinates(double a, double b, double c, double d) {
  const double unit[] = {1, 0, 0, 1}, stiffness[] = {a, b, c, d};
  ric_mck mck = {.coordinates = 2, .mass.values = unit, .stiffness.values = stiffness};
  ric_system *system;
  assert_int_equal(ric_system_create_mck(&mck, NULL, 0, &system, NULL), RIC_OK);
  return system;
}

static void free_body_has_a_mode_of_frequency_zero(void **state) {
  (void)state;
  ric_system *system = two_coordinates(1, -1, -1, 1);
  find(system);
  assert_true(frequency[0] == 0);
  assert_close(frequency[1], sqrt(2), 1e-15);
  ric_system_destroy(&system);
}

static void check_refused(ric_system *system, ric_status expected, const char *named) {
  ric_error error;
  double untouched = frequency[0] = 17;
  assert_int_equal(ric_normal_modes(system, frequency, shape, &error), expected);
  if (!strstr(error.message, named))
    fail_msg("'%s' does not name '%s'", error.message, named);
  assert_true(frequency[0] == untouched);
  ric_system_destroy(&system);
}

static void what_has_no_modes_is_refused_by_name(void **state) {
  (void)state;
  check_refused(two_coordinates(1, 2, 2, 1), RIC_ENUMERIC, "w^2 = -1");
  check_refused(two_coordinates(2, 1, 0, 2), RIC_EINVAL, "stiffness[1][0] = 0");
  const ric_mechanical pendulum = {
      .coordinates = 2, .speeds = 2, .mass = double_pendulum_mass, .force = double_pendulum_force};
  ric_system *system;
  assert_int_equal(ric_system_create_mechanical(&pendulum, &system, NULL), RIC_OK);
  check_refused(system, RIC_EINVAL, "user system");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(modes_solve_their_equation),
      cmocka_unit_test(modes_are_orthonormal_in_the_mass),
      cmocka_unit_test(uniform_chains_have_their_dispersion_relation),
      cmocka_unit_test(stiffnesses_of_any_size_scale_frequencies),
      cmocka_unit_test(shapes_of_a_fixed_chain_are_sines_with_a_positive_largest_component),
      cmocka_unit_test(damping_forcing_and_nonlinear_terms_are_left_aside),
      cmocka_unit_test(free_body_has_a_mode_of_frequency_zero),
      cmocka_unit_test(what_has_no_modes_is_refused_by_name),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
