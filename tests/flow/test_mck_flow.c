/* The Taylor flow of M-C-K systems: closed forms, the matrix exponential, orders, energy, steps. */
#include "mck_motion.h"

#include <complex.h>
#include <float.h>

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_blas.h>

#include "witness/random_mck.h"

enum { MOST = RANDOM_MCK_MOST };

/* Errors of a step are some 1e-16 of the size and of rounding; motions here take some tens of steps. */
static const double flow_error = 2e-13;

/* x'' + c x' + x = 0, underdamped and overdamped, through both roots of s^2 + c s + 1. */
static void damped_oscillator_follows_its_closed_form(void **state) {
  (void)state;
  const double dampings[] = {0, 0.1, 1, 3, 10};
  for (size_t k = 0; k < sizeof dampings / sizeof *dampings; k++) {
    double one = 1, c = dampings[k], q = 0.7, u = -1.3;
    ric_mck model = {.coordinates = 1, .mass.values = &one, .damping.values = &c, .stiffness.values = &one};
    ric_system *system = mck_system_made(&model, NULL, 0);
    ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
    double complex root = csqrt(c * c / 4 - 1), s1 = -c / 2 + root, s2 = -c / 2 - root;
    double complex a = (u - s2 * q) / (s1 - s2), b = q - a;
    mck_run(flow, 0, &q, &u, 50);
    assert_close(ric_flow_q(flow)[0], creal(a * cexp(s1 * 50) + b * cexp(s2 * 50)), flow_error);
    assert_close(ric_flow_u(flow)[0], creal(a * s1 * cexp(s1 * 50) + b * s2 * cexp(s2 * 50)), flow_error);
    ric_flow_destroy(&flow);
    ric_system_destroy(&system);
  }
}

/* x'' + x = cos(w t) or sin(w t) from rest at zero. */
static void forced_oscillator_starts_from_rest(void **state) {
  (void)state;
  double one = 1, zero = 0, w = 1.7, t = 40, d = 1 - w * w;
  for (int k = 0; k < 2; k++) {
    ric_mck model = {.coordinates = 1, .mass.values = &one, .stiffness.values = &one, .frequency = w};
    *(k ? &model.force_sin : &model.force_cos) = &one;
    ric_system *system = mck_system_made(&model, NULL, 0);
    ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
    mck_run(flow, 0, &zero, &zero, t);
    assert_close(ric_flow_q(flow)[0], (k ? sin(w * t) - w * sin(t) : cos(w * t) - cos(t)) / d, flow_error);
    assert_close(ric_flow_u(flow)[0], (k ? w * cos(w * t) - w * cos(t) : sin(t) - w * sin(w * t)) / d, flow_error);
    ric_flow_destroy(&flow);
    ric_system_destroy(&system);
  }
}

/* State (q, u, cos, sin) under one matrix, whose exponential carries it over a time. */
static void exponential(const random_mck *m, double start, double time, const double *q, const double *u,
                        double *result) {
  size_t n = m->n, size = 2 * n + 2;
  double a[(2 * MOST + 2) * (2 * MOST + 2)] = {0}, e[(2 * MOST + 2) * (2 * MOST + 2)], x[2 * MOST + 2];
  gsl_matrix_view mass = gsl_matrix_view_array(e, n, n);
  memcpy(e, m->mass, n * n * sizeof *e);
  gsl_linalg_cholesky_decomp1(&mass.matrix);
  for (size_t j = 0; j < size; j++) { /* columns of M^-1 (-K, -C, F, G) */
    double column[MOST];
    for (size_t i = 0; i < n; i++)
      column[i] = j < n        ? -m->stiffness[i * n + j]
                  : j < 2 * n  ? -m->damping[i * n + j - n]
                  : j == 2 * n ? m->force_cos[i]
                               : m->force_sin[i];
    gsl_vector_view v = gsl_vector_view_array(column, n);
    gsl_linalg_cholesky_svx(&mass.matrix, &v.vector);
    for (size_t i = 0; i < n; i++) {
      a[(n + i) * size + j] = column[i] * time;
      a[i * size + j] = j == n + i ? time : 0;
    }
  }
  a[2 * n * size + 2 * n + 1] = -m->model.frequency * time;
  a[(2 * n + 1) * size + 2 * n] = m->model.frequency * time;
  gsl_matrix_view av = gsl_matrix_view_array(a, size, size), ev = gsl_matrix_view_array(e, size, size);
  gsl_linalg_exponential_ss(&av.matrix, &ev.matrix, GSL_MODE_DEFAULT);
  memcpy(x, q, n * sizeof *x);
  memcpy(x + n, u, n * sizeof *x);
  x[2 * n] = cos(m->model.frequency * start);
  x[2 * n + 1] = sin(m->model.frequency * start);
  gsl_vector_view xv = gsl_vector_view_array(x, size), rv = gsl_vector_view_array(result, size);
  gsl_blas_dgemv(CblasNoTrans, 1, &ev.matrix, &xv.vector, 0, &rv.vector);
}

static void random_systems_follow_the_matrix_exponential(void **state) {
  (void)state;
  random_source source = {.state = 1};
  static random_mck m;
  for (size_t k = 0; k < 60; k++) {
    size_t n = 1 + k % 12;
    double q[MOST], u[MOST], expected[2 * MOST + 2], start = random_uniform(&source, -5, 5);
    double end = start + random_uniform(&source, -3, 8);
    random_mck_make(&m, n, k % 3 == 0, &source);
    random_state(&source, n, q, u);
    ric_system *system = mck_system_made(&m.model, NULL, 0);
    ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
    mck_run(flow, start, q, u, end);
    exponential(&m, start, end - start, q, u, expected);
    double size = 1; /* motions grow backwards in time */
    for (size_t i = 0; i < 2 * n; i++)
      size = fmax(size, fabs(expected[i]));
    /* GSL's exponential squares a matrix of norm 1/2 or so up to 7 times: its own error is some 1e-13 */
    assert_true(mck_difference(ric_flow_q(flow), expected, n) <= 2e-12 * size);
    assert_true(mck_difference(ric_flow_u(flow), expected + n, n) <= 2e-12 * size);
    ric_flow_destroy(&flow);
    ric_system_destroy(&system);
  }
}

/* Largest error of the speeds and coordinates at t = 2 with fixed steps. */
static double error_of(const ric_system *system, int order, double step, const double *q, const double *u,
                       const double *expected) {
  size_t n = ric_system_coordinates(system);
  ric_flow_options options = ric_flow_options_default();
  options.order = order;
  options.step = step;
  ric_flow *flow = mck_flow_made(system, options);
  mck_run(flow, 0, q, u, 2);
  double error = fmax(mck_difference(ric_flow_q(flow), expected, n), mck_difference(ric_flow_u(flow), expected + n, n));
  ric_flow_destroy(&flow);
  return error;
}

/* Coordinates of degree p leave out h^(p+1) a step and their derivatives h^p: speeds converge like h^(p-1). */
static void error_falls_with_the_order(void **state) {
  (void)state;
  random_source source = {.state = 2};
  static random_mck m;
  double q[MOST], u[MOST], expected[2 * MOST + 2];
  random_mck_make(&m, 3, 0, &source);
  random_state(&source, 3, q, u);
  ric_system *system = mck_system_made(&m.model, NULL, 0);
  exponential(&m, 0, 2, q, u, expected);
  for (int order = 4; order <= 10; order++) {
    double step = order < 8 ? 1.0 / 16 : 1.0 / 6; /* errors between 1e-13 and 1e-2 */
    double coarse = error_of(system, order, step, q, u, expected);
    double fine = error_of(system, order, step / 2, q, u, expected);
    print_message("order %d: %.2e, %.2e: %.2f\n", order, coarse, fine, log2(coarse / fine));
    assert_close(log2(coarse / fine), order - 1, 0.15);
  }
  ric_system_destroy(&system);
}

static void error_follows_the_tolerance(void **state) {
  (void)state;
  random_source source = {.state = 3};
  static random_mck m;
  double q[MOST], u[MOST], expected[2 * MOST + 2];
  random_mck_make(&m, 6, 0, &source);
  random_state(&source, 6, q, u);
  ric_system *system = mck_system_made(&m.model, NULL, 0);
  exponential(&m, 0, 5, q, u, expected);
  for (double tolerance = 1e-3; tolerance > 1e-15; tolerance /= 10) {
    ric_flow_options options = ric_flow_options_default();
    options.tolerance = tolerance;
    ric_flow *flow = mck_flow_made(system, options);
    mck_run(flow, 0, q, u, 5);
    double error =
        fmax(mck_difference(ric_flow_q(flow), expected, 6), mck_difference(ric_flow_u(flow), expected + 6, 6));
    print_message("tolerance %.0e: error %.1e, %llu steps\n", tolerance, error, ric_flow_counted(flow).steps);
    /* per step: tolerance in coordinates, up to order / h times it in speeds; some ten steps */
    assert_true(error <= 200 * tolerance + 2e-12);
    ric_flow_destroy(&flow);
  }
  ric_system_destroy(&system);
}

static void forms_of_matrices_give_the_same_motion(void **state) {
  (void)state;
  random_source source = {.state = 4};
  static random_mck m;
  static random_sparse mass, damping, stiffness;
  for (size_t k = 0; k < 20; k++) {
    size_t n = 1 + k;
    double q[MOST], u[MOST];
    random_mck_make(&m, n, k % 2 == 0, &source);
    random_state(&source, n, q, u);
    ric_mck other = m.model;
    if (k % 2 == 0)
      other.mass = random_sparse_of(&mass, m.mass, n);
    other.damping = random_sparse_of(&damping, m.damping, n);
    other.stiffness = random_sparse_of(&stiffness, m.stiffness, n);
    ric_system *a = mck_system_made(&m.model, NULL, 0), *b = mck_system_made(&other, NULL, 0);
    ric_flow *fa = mck_flow_made(a, ric_flow_options_default()), *fb = mck_flow_made(b, ric_flow_options_default());
    mck_run(fa, 0, q, u, 10);
    mck_run(fb, 0, q, u, 10);
    assert_true(mck_difference(ric_flow_q(fa), ric_flow_q(fb), n) <= 1e-13);
    assert_true(mck_difference(ric_flow_u(fa), ric_flow_u(fb), n) <= 1e-13);
    ric_flow_destroy(&fa);
    ric_flow_destroy(&fb);
    ric_system_destroy(&a);
    ric_system_destroy(&b);
  }
}

/* Errors of 1e-16 a step add up: 1e4 time units are some 2e4 steps of this system. */
static void undamped_systems_keep_their_energy(void **state) {
  (void)state;
  random_source source = {.state = 5};
  static random_mck m;
  double q[MOST], u[MOST];
  random_mck_make(&m, 4, 0, &source);
  random_state(&source, 4, q, u);
  m.model.damping.values = NULL;
  m.model.force_cos = m.model.force_sin = NULL;
  ric_system *system = mck_system_made(&m.model, NULL, 0);
  ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
  double energy = ric_system_energy(system, 0, q, u);
  assert_int_equal(ric_flow_start(flow, 0, q, u, NULL), RIC_OK);
  int steps = mck_move(flow, 10000);
  double drift = ric_system_energy(system, 0, ric_flow_q(flow), ric_flow_u(flow)) / energy - 1;
  print_message("energy drifts by %.1e in %d steps\n", drift, steps);
  assert_close(drift, 0, steps * 4e-16);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

static void motion_back_in_time_returns(void **state) {
  (void)state;
  random_source source = {.state = 6};
  static random_mck m;
  double q[MOST], u[MOST];
  random_mck_make(&m, 5, 0, &source);
  random_state(&source, 5, q, u);
  ric_system *system = mck_system_made(&m.model, NULL, 0);
  ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
  mck_run(flow, 2, q, u, 4.5);
  mck_move(flow, 2);
  assert_true(ric_flow_time(flow) == 2);
  assert_true(mck_difference(ric_flow_q(flow), q, 5) <= 1e-12);
  assert_true(mck_difference(ric_flow_u(flow), u, 5) <= 1e-12);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

static void pieces_and_accepted_states_are_one_motion(void **state) {
  (void)state;
  random_source source = {.state = 7};
  static random_mck m;
  double q[MOST], u[MOST], x = 0.37, expected[2 * MOST + 2];
  random_mck_make(&m, 5, 0, &source);
  random_state(&source, 5, q, u);
  ric_system *system = mck_system_made(&m.model, NULL, 0);
  ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
  assert_int_equal(ric_flow_start(flow, 1, q, u, NULL), RIC_OK);
  mck_step_once(flow, 100);
  assert_int_equal(ric_flow_pieces(flow), 1);
  ric_segment piece = ric_flow_piece(flow, 0);
  assert_true(piece.first == 0 && piece.coordinates == 5 && piece.speeds == 0 && piece.start == 1);
  double length = piece.length;
  ric_flow_accept(flow, x);
  assert_close(ric_flow_time(flow), 1 + x * length, 1e-15);
  exponential(&m, 1, x * length, q, u, expected);
  assert_true(mck_difference(ric_flow_q(flow), expected, 5) <= flow_error);
  assert_true(mck_difference(ric_flow_u(flow), expected + 5, 5) <= flow_error);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

static void steps_obey_the_options(void **state) {
  (void)state;
  double one = 1, q = 1, u = 0;
  ric_mck model = {.coordinates = 1, .mass.values = &one, .stiffness.values = &one};
  ric_system *system = mck_system_made(&model, NULL, 0);
  ric_flow_options options = ric_flow_options_default();
  options.step = 0.125;
  ric_flow *flow = mck_flow_made(system, options);
  mck_run(flow, 0, &q, &u, 4);
  assert_int_equal(ric_flow_counted(flow).steps, 32);
  ric_flow_destroy(&flow);
  options = (ric_flow_options){.longest_step = 0.3, .order = 7, .tolerance = 1e-3};
  flow = mck_flow_made(system, options);
  assert_int_equal(ric_flow_start(flow, 0, &q, &u, NULL), RIC_OK);
  mck_step_once(flow, 10);
  assert_int_equal(ric_flow_piece(flow, 0).degree, 7);
  assert_close(ric_flow_piece(flow, 0).length, 0.3, 0);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

/* Nothing moves it, or only a constant force: polynomials of low degree over any time. */
static void free_particles_take_one_step(void **state) {
  (void)state;
  double one = 1, q = 1, u = 2;
  ric_mck model = {.coordinates = 1, .mass.values = &one, .force_cos = &one};
  ric_system *system = mck_system_made(&model, NULL, 0);
  ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
  assert_int_equal(ric_flow_start(flow, 0, &q, &u, NULL), RIC_OK);
  assert_int_equal(mck_move(flow, 1000), 1);
  assert_close(ric_flow_q(flow)[0], 1 + 2000 + 500000, 1e-9);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

static void a_system_at_rest_stays(void **state) {
  (void)state;
  double one = 1, zero = 0;
  ric_mck model = {.coordinates = 1, .mass.values = &one, .stiffness.values = &one};
  ric_system *system = mck_system_made(&model, NULL, 0);
  ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
  mck_run(flow, 0, &zero, &zero, 100);
  assert_true(ric_flow_q(flow)[0] == 0 && ric_flow_u(flow)[0] == 0);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

/* q'' = q grows until numbers end. */
static void blow_up_is_reported_and_keeps_the_state(void **state) {
  (void)state;
  double one = 1, minus = -1;
  ric_error error = {0};
  ric_mck model = {.coordinates = 1, .mass.values = &one, .stiffness.values = &minus};
  ric_system *system = mck_system_made(&model, NULL, 0);
  ric_flow *flow = mck_flow_made(system, ric_flow_options_default());
  assert_int_equal(ric_flow_start(flow, 0, &one, &one, NULL), RIC_OK);
  ric_status status = RIC_OK;
  while (status == RIC_OK && ric_flow_time(flow) < 1000) {
    status = ric_flow_step(flow, 1000, &error);
    if (status == RIC_OK)
      ric_flow_accept(flow, 1);
  }
  assert_int_equal(status, RIC_ENUMERIC);
  assert_close(ric_flow_time(flow), log(DBL_MAX), 20);
  assert_true(isfinite(ric_flow_q(flow)[0]));
  assert_int_equal(ric_flow_step(flow, ric_flow_time(flow), &error), RIC_EINVAL);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damped_oscillator_follows_its_closed_form),
      cmocka_unit_test(forced_oscillator_starts_from_rest),
      cmocka_unit_test(random_systems_follow_the_matrix_exponential),
      cmocka_unit_test(error_falls_with_the_order),
      cmocka_unit_test(error_follows_the_tolerance),
      cmocka_unit_test(forms_of_matrices_give_the_same_motion),
      cmocka_unit_test(undamped_systems_keep_their_energy),
      cmocka_unit_test(motion_back_in_time_returns),
      cmocka_unit_test(pieces_and_accepted_states_are_one_motion),
      cmocka_unit_test(steps_obey_the_options),
      cmocka_unit_test(free_particles_take_one_step),
      cmocka_unit_test(a_system_at_rest_stays),
      cmocka_unit_test(blow_up_is_reported_and_keeps_the_state),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
