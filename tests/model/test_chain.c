/* Spectrum, modes, accelerations and energy of the chain. */
#include "support.h"

#include <gsl/gsl_eigen.h>

#include <ricochet/ricochet.h>

#include "scenario/random_source.h"

enum { MOST = 13 };

static const double pi = 3.14159265358979323846;
static const size_t sizes[] = {1, 2, 3, 4, 5, 8, 13};
static const double couplings[] = {0, 0.05, 0.7, 3};

typedef void (*property)(const ric_chain *chain);

static void for_all_chains(property holds) {
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
      for (size_t g = 0; g < sizeof couplings / sizeof *couplings; g++) {
        ric_chain chain = ric_chain_default(sizes[s], couplings[g]);
        chain.ends = (ric_ends)ends;
        holds(&chain);
      }
}

static void check_orthonormal(const ric_chain *chain) {
  for (size_t a = 0; a < chain->particles; a++)
    for (size_t b = 0; b < chain->particles; b++) {
      double product = 0;
      for (size_t i = 0; i < chain->particles; i++)
        product += ric_chain_mode_shape(chain, a, i) * ric_chain_mode_shape(chain, b, i);
      assert_close(product, a == b, 1e-14);
    }
}

static void modes_are_orthonormal(void **state) {
  (void)state;
  for_all_chains(check_orthonormal);
}

static void check_eigenvectors(const ric_chain *chain) {
  double q[MOST], acceleration[MOST];
  for (size_t j = 0; j < chain->particles; j++) {
    double w = ric_chain_frequency(chain, j);
    for (size_t i = 0; i < chain->particles; i++)
      q[i] = ric_chain_mode_shape(chain, j, i);
    ric_chain_acceleration(chain, q, acceleration);
    for (size_t i = 0; i < chain->particles; i++)
      assert_close(acceleration[i], -w * w * q[i], 1e-14 * (1 + 4 * chain->gamma));
  }
}

static void modes_are_eigenvectors_of_the_accelerations(void **state) {
  (void)state;
  for_all_chains(check_eigenvectors);
}

/* Stiffness matrix of (1) written down spring by spring: the witness of everything else here. */
static void stiffness(const ric_chain *chain, double k[MOST][MOST]) {
  size_t n = chain->particles;
  memset(k, 0, MOST * sizeof *k);
  for (size_t i = 0; i < n; i++)
    k[i][i] = 1;
  for (size_t i = 0; i < n; i++) {
    size_t next = (i + 1) % n;
    if (i + 1 == n && (chain->ends != RIC_ENDS_PERIODIC || n <= 2))
      break;
    k[i][i] += chain->gamma;
    k[next][next] += chain->gamma;
    k[i][next] -= chain->gamma;
    k[next][i] -= chain->gamma;
  }
  if (chain->ends == RIC_ENDS_FIXED) {
    k[0][0] += chain->gamma;
    k[n - 1][n - 1] += chain->gamma;
  }
}

static int increasing(const void *a, const void *b) {
  const double *x = a, *y = b;
  return (*x > *y) - (*x < *y);
}

static void check_spectrum(const ric_chain *chain) {
  size_t n = chain->particles;
  double k[MOST][MOST], found[MOST], dense[MOST * MOST], values[MOST];
  stiffness(chain, k);
  for (size_t i = 0; i < n * n; i++)
    dense[i] = k[i / n][i % n];
  gsl_matrix_view a = gsl_matrix_view_array(dense, n, n);
  gsl_vector_view e = gsl_vector_view_array(values, n);
  gsl_eigen_symm_workspace *w = gsl_eigen_symm_alloc(n);
  assert_int_equal(gsl_eigen_symm(&a.matrix, &e.vector, w), 0);
  gsl_eigen_symm_free(w);
  for (size_t j = 0; j < n; j++)
    found[j] = ric_chain_frequency(chain, j) * ric_chain_frequency(chain, j);
  qsort(found, n, sizeof *found, increasing);
  qsort(values, n, sizeof *values, increasing);
  for (size_t j = 0; j < n; j++)
    assert_close(found[j], values[j], 1e-13 * (1 + 4 * chain->gamma));
  assert_close(ric_chain_frequency_max(chain), sqrt(values[n - 1]), 1e-13 * (1 + 4 * chain->gamma));
}

static void frequencies_are_the_dense_eigenvalues(void **state) {
  (void)state;
  for_all_chains(check_spectrum);
}

static void check_accelerations(const ric_chain *chain) {
  random_source source = {.state = 6};
  double k[MOST][MOST], q[MOST], acceleration[MOST];
  stiffness(chain, k);
  for (size_t i = 0; i < chain->particles; i++)
    q[i] = random_uniform(&source, -1, 1);
  ric_chain_acceleration(chain, q, acceleration);
  for (size_t i = 0; i < chain->particles; i++) {
    double force = 0;
    for (size_t j = 0; j < chain->particles; j++)
      force -= k[i][j] * q[j];
    assert_close(acceleration[i], force, 1e-14 * (1 + 4 * chain->gamma));
  }
}

static void accelerations_are_those_of_the_springs(void **state) {
  (void)state;
  for_all_chains(check_accelerations);
}

static void check_energy(const ric_chain *chain) {
  random_source source = {.state = 7};
  double q[MOST], v[MOST], acceleration[MOST], expected = 0;
  for (size_t i = 0; i < chain->particles; i++) {
    q[i] = random_uniform(&source, -1, 1);
    v[i] = random_uniform(&source, -1, 1);
  }
  ric_chain_acceleration(chain, q, acceleration);
  for (size_t i = 0; i < chain->particles; i++)
    expected += (v[i] * v[i] - q[i] * acceleration[i]) / 2;
  assert_close(ric_chain_energy(chain, q, v), expected, 1e-14 * (double)chain->particles * (1 + 4 * chain->gamma));
}

static void energy_is_half_the_quadratic_forms(void **state) {
  (void)state;
  for_all_chains(check_energy);
}

static void ring_of_two_is_the_free_chain_of_two(void **state) {
  (void)state;
  ric_chain ring = ric_chain_default(2, 0.3), chain = ring;
  const double q[] = {0.4, -1.1}, v[] = {0.2, 0.9};
  double on_ring[2], on_chain[2];
  chain.ends = RIC_ENDS_FREE;
  ric_chain_acceleration(&ring, q, on_ring);
  ric_chain_acceleration(&chain, q, on_chain);
  assert_close(on_ring[0], on_chain[0], 1e-16);
  assert_close(on_ring[1], on_chain[1], 1e-16);
  assert_close(on_ring[0], -q[0] + 0.3 * (q[1] - q[0]), 1e-15);
  assert_close(ric_chain_energy(&ring, q, v), ric_chain_energy(&chain, q, v), 1e-16);
  assert_close(ric_chain_frequency(&ring, 1), ric_chain_frequency(&chain, 1), 1e-15);
  assert_close(ric_chain_frequency(&ring, 1), sqrt(1 + 2 * 0.3), 1e-15);
}

static void ring_of_one_is_the_single_oscillator(void **state) {
  (void)state;
  ric_chain ring = ric_chain_default(1, 0.3);
  const double q = 0.7, v = 0.2;
  double acceleration;
  ric_chain_acceleration(&ring, &q, &acceleration);
  assert_close(acceleration, -q, 1e-16);
  assert_close(ric_chain_frequency(&ring, 0), 1, 0);
  assert_close(ric_chain_energy(&ring, &q, &v), (q * q + v * v) / 2, 1e-16);
}

static void check_wave_numbers(const ric_chain *chain) {
  for (size_t j = 0; j < chain->particles; j++) {
    double p = ric_chain_wave_number(chain, j);
    assert_true(p >= 0 && p <= pi * (1 + 1e-15));
    if (chain->ends != RIC_ENDS_PERIODIC || chain->particles > 2)
      assert_close(ric_chain_frequency(chain, j), ric_dispersion(chain->gamma, p), 0);
  }
}

static void frequencies_follow_the_dispersion_relation(void **state) {
  (void)state;
  for_all_chains(check_wave_numbers);
}

static void dispersion_has_its_closed_form_values(void **state) {
  (void)state;
  assert_close(ric_dispersion(0.3, 0), 1, 0);
  assert_close(ric_dispersion(0.3, pi), sqrt(1 + 4 * 0.3), 1e-15);
  assert_close(ric_dispersion(0.3, pi / 3), sqrt(1 + 0.3), 1e-15);
  assert_close(ric_dispersion(0, 1.234), 1, 0);
}

static void gamma_c_has_its_published_values(void **state) {
  (void)state;
  assert_close(ric_gamma_c(1.5 * pi), 7.0 / 36, 1e-15);
  assert_close(ric_gamma_c(4.69756390941), 0.19725, 5e-6);
  assert_close(ric_gamma_c(2 * pi), 0, 1e-16);
  assert_true(ric_gamma_c(7) < 0);
  assert_close(ric_dispersion(ric_gamma_c(4), pi) * 4, 2 * pi, 1e-14);
}

static void modes_of_long_chains_lose_no_digits(void **state) {
  (void)state;
  ric_chain chain = ric_chain_default(1000000, 0.2);
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    chain.ends = (ric_ends)ends;
    const size_t modes[] = {1, 499999, 777777, 999999};
    for (size_t k = 0; k < 4; k++) {
      double w = ric_chain_frequency(&chain, modes[k]), scale = sqrt(2.0 / 1e6);
      for (size_t i = 999990; i < 999998; i++) {
        double left = ric_chain_mode_shape(&chain, modes[k], i - 1), own = ric_chain_mode_shape(&chain, modes[k], i);
        double right = ric_chain_mode_shape(&chain, modes[k], i + 1);
        assert_close(-own + 0.2 * (left - 2 * own + right), -w * w * own, 4e-15 * scale);
      }
    }
  }
}

static void refuse(ric_chain chain, const char *part) {
  ric_error error = {0};
  assert_int_equal(ric_chain_check(&chain, &error), RIC_EINVAL);
  if (!strstr(error.message, part))
    fail_msg("'%s' not in '%s'", part, error.message);
  assert_int_equal(ric_chain_check(&chain, NULL), RIC_EINVAL);
}

static void fields_out_of_range_are_refused_by_name(void **state) {
  (void)state;
  const double floors[] = {-1, NAN, -1}, high[] = {-1, -1, INFINITY};
  const ric_chain good = ric_chain_default(3, 0.1);
  ric_chain bad[10];
  for (int k = 0; k < 10; k++)
    bad[k] = good;
  bad[0].particles = 0;
  bad[1].gamma = -0.5;
  bad[2].gamma = NAN;
  bad[3].gamma = INFINITY;
  bad[4].floor = NAN;
  bad[5].floor = INFINITY;
  bad[6].floors = floors;
  bad[7].floors = high;
  bad[8].ends = (ric_ends)3;
  bad[9].ends = (ric_ends)-1;
  const char *parts[] = {"particles = 0", "gamma = -0.5", "gamma = ",   "gamma = inf", "floor",
                         "floor",         "particle 1",   "particle 2", "ends = 3",    "ends = -1"};
  assert_int_equal(ric_chain_check(&good, NULL), RIC_OK);
  for (int k = 0; k < 10; k++)
    refuse(bad[k], parts[k]);
}

static void chains_without_some_floors_or_with_any_height_are_allowed(void **state) {
  (void)state;
  const double floors[] = {-INFINITY, 0.4, 0};
  ric_chain chain = ric_chain_default(3, 0);
  assert_int_equal(ric_chain_check(&chain, NULL), RIC_OK);
  assert_close(ric_chain_floor(&chain, 2), -1, 0);
  chain.floor = -INFINITY;
  assert_int_equal(ric_chain_check(&chain, NULL), RIC_OK);
  chain.floor = NAN; /* replaced by the floors */
  chain.floors = floors;
  assert_int_equal(ric_chain_check(&chain, NULL), RIC_OK);
  assert_close(ric_chain_floor(&chain, 1), 0.4, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(modes_are_orthonormal),
      cmocka_unit_test(modes_are_eigenvectors_of_the_accelerations),
      cmocka_unit_test(frequencies_are_the_dense_eigenvalues),
      cmocka_unit_test(accelerations_are_those_of_the_springs),
      cmocka_unit_test(energy_is_half_the_quadratic_forms),
      cmocka_unit_test(ring_of_two_is_the_free_chain_of_two),
      cmocka_unit_test(ring_of_one_is_the_single_oscillator),
      cmocka_unit_test(frequencies_follow_the_dispersion_relation),
      cmocka_unit_test(dispersion_has_its_closed_form_values),
      cmocka_unit_test(gamma_c_has_its_published_values),
      cmocka_unit_test(modes_of_long_chains_lose_no_digits),
      cmocka_unit_test(fields_out_of_range_are_refused_by_name),
      cmocka_unit_test(chains_without_some_floors_or_with_any_height_are_allowed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
