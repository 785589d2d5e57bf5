/* Ritz's equations as such: derivatives, quadrature, numbers of functions, states. */
#include "support.h"

#include "witness/ritz_approximation.h"
#include "witness/random_lattice.h"
#include "witness/recorded_run.h"

static const double turn = 6.283185307179586;

/* A random lattice with nonlinear springs, an obstacle at one of its particles, and random coefficients that fall. */
typedef struct random_case {
  ric_system *system;
  ric_ritz *ritz;
  size_t unknowns, hit;
  double period, *c, *F, *J, *F_period; /* F, J, F_period: of two evaluations */
} random_case;

static void fill(random_case *r, random_source *source) {
  size_t width = (r->unknowns - 1) / ric_system_coordinates(r->system);
  for (size_t i = 0; i + 1 < r->unknowns; i++)
    r->c[i] = random_uniform(source, -1, 1) / (1 + pow((double)(i % width), 2));
  r->period = random_uniform(source, 3, 8);
  r->c[r->unknowns - 1] = random_uniform(source, 0.5, 0.98) * turn / r->period;
}

static random_case made(random_source *source, size_t n, const ric_ritz_options *options) {
  random_lattice lattice;
  random_case r = {.hit = random_below(source, n)};
  const ric_obstacle wall = ric_obstacle_wall(r.hit, random_uniform(source, 0.5, 2));
  random_lattice_set(&lattice, source, n, (ric_ends)random_below(source, 3), WITH_SITES | WITH_LINKS);
  r.system = lattice_system(&lattice.lattice, &wall, 1);
  assert_int_equal(ric_ritz_create(r.system, 0, options, &r.ritz, NULL), RIC_OK);
  r.unknowns = ric_ritz_unknowns(r.ritz);
  r.c = malloc((5 * r.unknowns + 2 * r.unknowns * r.unknowns) * sizeof *r.c);
  assert_non_null(r.c);
  r.F = r.c + r.unknowns;
  r.F_period = r.F + 2 * r.unknowns;
  r.J = r.F_period + 2 * r.unknowns;
  fill(&r, source);
  return r;
}

static void clear(random_case *r) {
  ric_ritz_destroy(&r->ritz);
  ric_system_destroy(&r->system);
  free(r->c);
}

static void evaluate(const random_case *r, ric_ritz *ritz, size_t which, bool derivatives) {
  double *J = r->J + which * r->unknowns * r->unknowns, *F_period = r->F_period + which * r->unknowns;
  assert_int_equal(ric_ritz_residual(ritz, r->c, r->period, r->F + which * r->unknowns, derivatives ? J : NULL,
                                     derivatives ? F_period : NULL, NULL),
                   RIC_OK);
}

/* --- derivatives -------------------------------------------------------------------------------------------------- */

/* Fourth-order differences of F along a number against a column of derivatives. */
static double column_error(random_case *r, double *number, const double *column, size_t stride) {
  static const double step = 1e-3, weight[4] = {1. / 12, -2. / 3, 2. / 3, -1. / 12}, at[4] = {-2, -1, 1, 2};
  double kept = *number, worst = 0, *sum = calloc(r->unknowns, sizeof *sum);
  assert_non_null(sum);
  for (size_t k = 0; k < 4; k++) {
    *number = kept + at[k] * step;
    evaluate(r, r->ritz, 1, false);
    for (size_t i = 0; i < r->unknowns; i++)
      sum[i] += weight[k] / step * r->F[r->unknowns + i];
  }
  *number = kept;
  for (size_t i = 0; i < r->unknowns; i++)
    worst = fmax(worst, fabs(sum[i] - column[i * stride]) / (1 + fabs(sum[i])));
  free(sum);
  return worst;
}

static void derivatives_are_those_of_differences(void **state) {
  (void)state;
  random_source source = {.state = 21};
  double worst = 0, worst_period = 0;
  for (int k = 0; k < 24; k++) {
    const ric_ritz_options options = {.functions = 1 + random_below(&source, 6), .constants = k % 2};
    random_case r = made(&source, 1 + random_below(&source, 5), &options);
    evaluate(&r, r.ritz, 0, true);
    for (size_t j = 0; j < r.unknowns; j++)
      worst = fmax(worst, column_error(&r, &r.c[j], r.J + j, r.unknowns));
    worst_period = fmax(worst_period, column_error(&r, &r.period, r.F_period, 1));
    clear(&r);
  }
  print_message("[ Jacobian off by %.3g, derivative by the period by %.3g ]\n", worst, worst_period);
  assert_true(worst < 1e-8 && worst_period < 1e-8);
}

/* --- quadrature --------------------------------------------------------------------------------------------------- */

/* Largest difference of two evaluations with other numbers of points, over the largest value, of F, F_period or J. */
static double difference(const random_case *r) {
  double most = 0;
  size_t count[3] = {r->unknowns, r->unknowns, r->unknowns * r->unknowns};
  const double *values[3] = {r->F, r->F_period, r->J};
  for (size_t v = 0; v < 3; v++) {
    double worst = 0, size = 0;
    for (size_t i = 0; i < count[v]; i++) {
      worst = fmax(worst, fabs(values[v][i] - values[v][count[v] + i]));
      size = fmax(size, fabs(values[v][i]));
    }
    most = fmax(most, worst / size);
  }
  return most;
}

static double change_by_points(size_t functions, size_t points, size_t other) {
  random_source source = {.state = functions};
  const ric_ritz_options options = {.functions = functions, .constants = true, .points = points},
                         others = {.functions = functions, .constants = true, .points = other};
  random_case r = made(&source, 3, &options);
  ric_ritz *ritz = NULL;
  assert_int_equal(ric_ritz_create(r.system, 0, &others, &ritz, NULL), RIC_OK);
  assert_true(ric_ritz_points(ritz) != ric_ritz_points(r.ritz));
  evaluate(&r, r.ritz, 0, true);
  evaluate(&r, ritz, 1, true);
  double change = difference(&r);
  ric_ritz_destroy(&ritz);
  clear(&r);
  return change;
}

/* Rules have 32, 64, 96, 100, 128, 256, 512 or 1024 points. */
static void twice_the_points_change_nothing_but_rounding(void **state) {
  (void)state;
  static const size_t numbers[] = {1, 2, 4, 8, 12, 16, 24, 32, 48, 64};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
    const ric_ritz_options options = {.functions = numbers[k], .constants = true};
    random_source source = {.state = 1};
    random_case r = made(&source, 1, &options);
    size_t points = ric_ritz_points(r.ritz);
    double change = change_by_points(numbers[k], 0, 2 * points);
    print_message("[ N %zu: %zu points, twice as many change F and J by %.3g ]\n", numbers[k], points, change);
    assert_true(change < 1e-13);
    clear(&r);
  }
}

static void too_few_points_are_seen(void **state) {
  (void)state;
  assert_true(change_by_points(32, 64, 256) > 1e-6);
}

/* --- numbers of functions ----------------------------------------------------------------------------------------- */

static void more_functions_with_zeros_are_the_same_motion(void **state) {
  (void)state;
  random_source source = {.state = 4};
  for (int constants = 0; constants < 2; constants++) {
    const ric_ritz_options options = {.functions = 9, .constants = constants};
    random_case r = made(&source, 3, &options);
    double before[3], after[3], v_before[3], v_after[3], first[31];
    assert_int_equal(ric_ritz_use(r.ritz, 4, r.c, NULL), RIC_OK);
    assert_int_equal(ric_ritz_functions(r.ritz), 4);
    assert_int_equal(ric_ritz_unknowns(r.ritz), 3 * (4 + (size_t)constants) + 1);
    memcpy(first, r.c, ric_ritz_unknowns(r.ritz) * sizeof *first);
    ric_ritz_state(r.ritz, r.c, r.period, 0.3 * r.period, before, v_before);
    assert_int_equal(ric_ritz_use(r.ritz, 9, r.c, NULL), RIC_OK);
    ric_ritz_state(r.ritz, r.c, r.period, 0.3 * r.period, after, v_after);
    for (size_t i = 0; i < 3; i++) {
      assert_close(after[i], before[i], 1e-14);
      assert_close(v_after[i], v_before[i], 1e-14);
    }
    assert_int_equal(ric_ritz_use(r.ritz, 4, r.c, NULL), RIC_OK);
    assert_memory_equal(first, r.c, ric_ritz_unknowns(r.ritz) * sizeof *first);
    clear(&r);
  }
}

/* --- states ------------------------------------------------------------------------------------------------------- */

static void motions_are_even_and_only_the_one_that_hits_jumps(void **state) {
  (void)state;
  random_source source = {.state = 8};
  const ric_ritz_options options = {.functions = 5, .constants = true};
  random_case r = made(&source, 4, &options);
  double q[4], v[4], mirrored[4], v_mirrored[4];
  for (int k = 0; k <= 10; k++) {
    double t = 0.05 * k * r.period;
    ric_ritz_state(r.ritz, r.c, r.period, t, q, v);
    ric_ritz_state(r.ritz, r.c, r.period, r.period - t, mirrored, v_mirrored);
    for (size_t i = 0; i < 4; i++) {
      assert_close(q[i], mirrored[i], 1e-13);
      assert_close(v[i], -v_mirrored[i], 1e-13);
      if (k == 0)
        assert_true(i == r.hit ? fabs(v[i]) > 1e-3 : fabs(v[i]) < 1e-13);
    }
  }
  clear(&r);
}

static void velocities_are_derivatives(void **state) {
  (void)state;
  random_source source = {.state = 9};
  const ric_ritz_options options = {.functions = 5, .constants = true};
  random_case r = made(&source, 4, &options);
  static const double step = 1e-5;
  double v[4], below[4], above[4];
  for (int k = 1; k < 10; k++) {
    double t = 0.1 * k * r.period;
    ric_ritz_state(r.ritz, r.c, r.period, t, NULL, v);
    ric_ritz_state(r.ritz, r.c, r.period, t - step, below, NULL);
    ric_ritz_state(r.ritz, r.c, r.period, t + step, above, NULL);
    for (size_t i = 0; i < 4; i++)
      assert_close(v[i], (above[i] - below[i]) / (2 * step), 1e-8);
  }
  clear(&r);
}

/* --- numbers of the system ---------------------------------------------------------------------------------------- */

static void equations_follow_the_numbers_of_their_system(void **state) {
  (void)state;
  shooting_solution s = duffing_mode(0.1, 0.4, -1);
  ritz_approximation a = ritz_approximate(&s, 8, true);
  ric_system *other = duffing_masses(0.2, -1);
  const ric_spring links[3] = {[0] = {.linear = 3}, [1] = {.linear = 1, .cubic = 0.2}};
  const ric_ritz_options options = {.functions = 8, .constants = true};
  const ric_obstacle nearer = ric_obstacle_wall(1, 1.9);
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  ric_ritz *fresh = NULL;
  double F[19], expected[19];
  lattice.on_site = (ric_spring){0};
  lattice.links = links;
  assert_int_equal(ric_ritz_create(other, 0, &options, &fresh, NULL), RIC_OK);
  assert_int_equal(ric_system_set_lattice(s.system, &lattice, NULL), RIC_OK);
  assert_int_equal(ric_ritz_residual(a.ritz, a.c, s.given, F, NULL, NULL, NULL), RIC_OK);
  assert_int_equal(ric_ritz_residual(fresh, a.c, s.given, expected, NULL, NULL, NULL), RIC_OK);
  assert_memory_equal(F, expected, sizeof F);
  assert_int_equal(ric_system_set_obstacles(s.system, &nearer, 1, NULL), RIC_OK);
  assert_int_equal(ric_ritz_residual(a.ritz, a.c, s.given, F, NULL, NULL, NULL), RIC_OK);
  assert_close(F[18] - expected[18], 0.1, 1e-14);
  ric_ritz_destroy(&fresh);
  ric_system_destroy(&other);
  ritz_approximation_clear(&a);
  shooting_solution_clear(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(derivatives_are_those_of_differences),
      cmocka_unit_test(twice_the_points_change_nothing_but_rounding),
      cmocka_unit_test(too_few_points_are_seen),
      cmocka_unit_test(more_functions_with_zeros_are_the_same_motion),
      cmocka_unit_test(motions_are_even_and_only_the_one_that_hits_jumps),
      cmocka_unit_test(velocities_are_derivatives),
      cmocka_unit_test(equations_follow_the_numbers_of_their_system),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
