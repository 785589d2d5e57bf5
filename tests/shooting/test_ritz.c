/* Ritz's approximations against motions found by shooting. */
#include "support.h"

#include "witness/ritz_approximation.h"
#include "witness/recorded_run.h"

static const double turn = 6.283185307179586;

static const size_t numbers[] = {8, 16, 32, 64};

enum { NUMBERS = 4 };

static void assert_within(double value, double low, double high, const char *what) {
  if (!(value >= low && value <= high))
    fail_msg("%s = %g, expected %g to %g", what, value, low, high);
}

/* --- convergence -------------------------------------------------------------------------------------------------- */

typedef struct range {
  double low, high;
} range;

static void widen(range *r, double value) {
  r->low = fmin(r->low, value);
  r->high = fmax(r->high, value);
}

typedef struct orders {
  range q, v, defect, worst;
} orders;

static void measure_orders(shooting_solution *s, orders *o) {
  double q[NUMBERS], v[NUMBERS], defect[NUMBERS];
  for (size_t k = 0; k < NUMBERS; k++) {
    ritz_approximation a = ritz_approximate(s, numbers[k], true);
    q[k] = a.error_q;
    v[k] = a.error_v;
    defect[k] = ric_ritz_defect(a.ritz, a.c, s->given);
    ritz_approximation_clear(&a);
  }
  widen(&o->q, convergence_order(numbers, q, NUMBERS));
  widen(&o->v, convergence_order(numbers, v, NUMBERS));
  widen(&o->defect, convergence_order(numbers, defect, NUMBERS));
  widen(&o->worst, q[NUMBERS - 1]);
}

static orders no_orders(void) {
  const range none = {INFINITY, -INFINITY};
  return (orders){none, none, none, none};
}

static void displacements_converge_with_the_third_power_and_residuals_with_the_first(void **state) {
  (void)state;
  static const double epsilons[4] = {0, 0.05, 0.1, 0.2};
  orders o = no_orders();
  size_t count = 0;
  for (size_t e = 0; e < 4; e++)
    for (int k = 1; k <= 13; k++, count++) {
      shooting_solution s = duffing_mode(epsilons[e], 0.05 * k, -1);
      measure_orders(&s, &o);
      shooting_solution_clear(&s);
    }
  print_message("[ %zu motions, orders %.3f-%.3f (q), %.3f-%.3f (v), %.3f-%.3f (residual), errors %.2g-%.2g ]\n", count,
                o.q.low, o.q.high, o.v.low, o.v.high, o.defect.low, o.defect.high, o.worst.low, o.worst.high);
  assert_true(count >= 50);
  assert_within(o.q.low, 2.9, 3.1, "lowest order");
  assert_within(o.q.high, 2.9, 3.1, "highest order");
  assert_within(o.v.low, 1.9, 2.1, "lowest order of velocities");
  assert_within(o.v.high, 1.9, 2.1, "highest order of velocities");
  assert_within(o.defect.low, 0.9, 1.1, "lowest order of the residual");
  assert_within(o.defect.high, 0.9, 1.1, "highest order of the residual");
  assert_true(o.worst.high < 1e-6);
}

static void longer_chains_converge_as_fast(void **state) {
  (void)state;
  static const size_t hits[3] = {0, 2, 4};
  orders o = no_orders();
  for (size_t k = 0; k < 3; k++)
    for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
      shooting_solution s = chain_mode(5, hits[k], (ric_ends)ends, 0.03, 5.6, +1);
      measure_orders(&s, &o);
      shooting_solution_clear(&s);
    }
  print_message("[ orders %.3f-%.3f (q), %.3f-%.3f (residual), errors %.2g-%.2g ]\n", o.q.low, o.q.high, o.defect.low,
                o.defect.high, o.worst.low, o.worst.high);
  assert_within(o.q.low, 2.8, 3.2, "lowest order");
  assert_within(o.q.high, 2.8, 3.2, "highest order");
  assert_within(o.defect.low, 0.85, 1.15, "lowest order of the residual");
  assert_within(o.defect.high, 0.85, 1.15, "highest order of the residual");
}

/* The slower mode of the linear springs has w_1^2 = (5 - 13^(1/2)) / 2. */
static void the_frequency_is_that_without_the_impact_and_stays_in_place(void **state) {
  (void)state;
  static const double slow = 0.8349996;
  shooting_solution s = duffing_mode(0, 0.525, -1);
  double before = 0;
  for (size_t n = 1; n <= 32; n *= 2) {
    ritz_approximation a = ritz_approximate(&s, n, true);
    double w = a.c[ric_ritz_unknowns(a.ritz) - 1];
    print_message("[ N %zu: w %.5f, without impact %.5f, 2 pi / T %.5f ]\n", n, w, slow, turn / s.given);
    assert_close(w, slow, 0.02);
    if (n > 4)
      assert_close(w, before, 1e-3);
    before = w;
    ritz_approximation_clear(&a);
  }
  shooting_solution_clear(&s);
}

/* The impact's impulse 2 V per period presses on the spring to the ground: the mean of q_1 is -2 V / (3 T). */
static void without_constants_errors_stall_at_the_mean_of_the_motion(void **state) {
  (void)state;
  static const double epsilons[3] = {0, 0.1, 0.2};
  for (size_t e = 0; e < 3; e++) {
    shooting_solution s = duffing_mode(epsilons[e], 0.525, -1);
    double mean = 2 * fabs(s.orbit.v[1]) / (3 * s.given);
    for (size_t k = 0; k < NUMBERS; k++) {
      ritz_approximation a = ritz_approximate(&s, numbers[k], false), b = ritz_approximate(&s, numbers[k], true);
      print_message("[ eps %g, T %.4f, N %zu: error %.3g without constants, %.3g with; mean of q_1 %.3g ]\n",
                    epsilons[e], s.given, numbers[k], a.error_q, b.error_q, mean);
      assert_within(a.error_q, 0.9 * mean, 1.6 * mean, "error");
      assert_true(b.error_q < 0.01 * a.error_q);
      ritz_approximation_clear(&a);
      ritz_approximation_clear(&b);
    }
    shooting_solution_clear(&s);
  }
}

/* Nothing jumps but what w makes jump. */
static void a_single_oscillator_converges_faster_than_any_power(void **state) {
  (void)state;
  shooting_solution s = chain_mode(1, 0, RIC_ENDS_FREE, 0, 5, +1);
  double before = 1;
  for (size_t n = 1; n <= 8; n *= 2) {
    ritz_approximation a = ritz_approximate(&s, n, true);
    print_message("[ N %zu: error %.3g ]\n", n, a.error_q);
    assert_true(a.error_q < pow(0.1, (double)n));
    assert_true(a.error_q < before);
    before = a.error_q;
    ritz_approximation_clear(&a);
  }
  shooting_solution_clear(&s);
}

/* q = b cos(T/2 - t) / cos(T/2) is one function with w = 1, the frequency without the impact. */
static void a_linear_oscillator_is_represented_exactly(void **state) {
  (void)state;
  const ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  const ric_obstacle floor = ric_obstacle_floor(0, -1);
  static const size_t zero = 0;
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_EVEN, .at_start = &zero, .start_count = 1, .flow = ric_flow_options_default()};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_lattice(&lattice, &floor, 1, &system, NULL), RIC_OK);
  shooting_solution s = shooting_solution_of_system(system, &problem);
  const double q = -1, u = 1;
  shooting_solution_guess(&s, &q, &u, NULL, 5);
  shooting_solution_solve(&s);
  ritz_approximation a = ritz_approximate(&s, 1, true);
  assert_close(a.c[0], 0, 1e-12);
  assert_close(a.c[1], -1 / cos(2.5), 1e-12);
  assert_close(a.c[2], 1, 1e-12);
  assert_close(a.error_q, 0, 1e-12);
  ritz_approximation_clear(&a);
  shooting_solution_clear(&s);
}

static void refining_takes_as_many_functions_as_the_tolerance_needs(void **state) {
  (void)state;
  shooting_solution s = duffing_mode(0.1, 0.4, -1);
  const ric_ritz_options options = {.functions = 64, .constants = true};
  ric_ritz *ritz = NULL;
  double c[2 * 65 + 1], error_q = 0, again = 0;
  ric_error error;
  size_t last = 0;
  assert_int_equal(ric_ritz_create(s.system, 0, &options, &ritz, NULL), RIC_OK);
  for (double tolerance = 1e-2; tolerance > 1e-6; tolerance /= 10) {
    assert_int_equal(ric_ritz_refine(ritz, s.shooting, s.z, s.given, tolerance, c, &error_q, NULL), RIC_OK);
    assert_true(error_q <= tolerance && error_q > tolerance / 30);
    assert_true(ric_ritz_functions(ritz) > last);
    last = ric_ritz_functions(ritz);
    assert_int_equal(ric_ritz_error(ritz, c, s.given, s.shooting, s.z, &again, NULL, NULL), RIC_OK);
    assert_close(again, error_q, 0);
  }
  assert_int_equal(ric_ritz_refine(ritz, s.shooting, s.z, s.given, 1e-12, c, &error_q, &error), RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "with 64 functions, expected at most 1e-12"));
  assert_true(error_q < 1e-6);
  ric_ritz_destroy(&ritz);
  shooting_solution_clear(&s);
}

/* --- the motion --------------------------------------------------------------------------------------------------- */

/* How much the energy of the approximated motion varies, and how much its errors allow. */
static void measure_energy(shooting_solution *s, const ritz_approximation *a, double *spread, double *allowed) {
  double low = INFINITY, high = -INFINITY, force = 0, speed = 0, q[2], v[2], rate[2], acceleration[2];
  for (int k = 0; k <= 400; k++) {
    ric_ritz_state(a->ritz, a->c, s->given, s->given * k / 400, q, v);
    double energy = ric_system_energy(s->system, 0, q, v);
    assert_int_equal(ric_system_rate(s->system, 0, q, v, rate, acceleration, NULL), RIC_OK);
    low = fmin(low, energy);
    high = fmax(high, energy);
    force = fmax(force, fabs(acceleration[0]) + fabs(acceleration[1]));
    speed = fmax(speed, fabs(v[0]) + fabs(v[1]));
  }
  *spread = high - low;
  *allowed = 2 * (force * a->error_q + speed * a->error_v);
}

static void the_energy_varies_by_no_more_than_the_error(void **state) {
  (void)state;
  shooting_solution s = duffing_mode(0.2, 0.5, -1);
  double spread[NUMBERS], allowed;
  for (size_t k = 0; k < NUMBERS; k++) {
    ritz_approximation a = ritz_approximate(&s, numbers[k], true);
    measure_energy(&s, &a, &spread[k], &allowed);
    print_message("[ N %zu: energy varies by %.3g, errors allow %.3g ]\n", numbers[k], spread[k], allowed);
    assert_true(spread[k] <= allowed);
    ritz_approximation_clear(&a);
  }
  assert_true(convergence_order(numbers, spread, NUMBERS) > 1.9);
  shooting_solution_clear(&s);
}

static void a_floor_mirrors_a_wall(void **state) {
  (void)state;
  shooting_solution wall = duffing_mode(0.1, 0.4, -1), floor = duffing_mode(0.1, 0.4, +1);
  ritz_approximation a = ritz_approximate(&wall, 16, true), b = ritz_approximate(&floor, 16, true);
  size_t last = ric_ritz_unknowns(a.ritz) - 1;
  for (size_t i = 0; i < last; i++)
    assert_close(a.c[i], -b.c[i], 1e-9);
  assert_close(a.c[last], b.c[last], 1e-9);
  ritz_approximation_clear(&a);
  ritz_approximation_clear(&b);
  shooting_solution_clear(&wall);
  shooting_solution_clear(&floor);
}

static void chains_are_mirrored_with_their_quadratic_springs(void **state) {
  (void)state;
  shooting_solution floor = chain_mode(5, 2, RIC_ENDS_FIXED, 0.03, 5.6, +1),
                    wall = chain_mode(5, 2, RIC_ENDS_FIXED, 0.03, 5.6, -1);
  ritz_approximation a = ritz_approximate(&wall, 12, true), b = ritz_approximate(&floor, 12, true);
  assert_close(a.error_q, b.error_q, 1e-3 * b.error_q);
  ritz_approximation_clear(&a);
  ritz_approximation_clear(&b);
  shooting_solution_clear(&wall);
  shooting_solution_clear(&floor);
}

/* --- units ------------------------------------------------------------------------------------------------------- */

/* A motion of duffing_masses(0.1, -1) with lengths and rates in other units. */
static shooting_solution in_units(const shooting_solution *s, double length, double rate) {
  static const size_t zero = 0;
  const double stiff = rate * rate;
  const ric_spring links[3] = {{.linear = 3 * stiff}, {.linear = stiff, .cubic = 0.1 * stiff / length / length}};
  const ric_obstacle wall = ric_obstacle_wall(1, 2 * length);
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_EVEN, .at_start = &zero, .start_count = 1, .flow = ric_flow_options_default()};
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  lattice.on_site = (ric_spring){0};
  lattice.links = links;
  shooting_solution other = shooting_solution_of_system(lattice_system(&lattice, &wall, 1), &problem);
  other.given = s->given / rate;
  other.z[0] = s->z[0] * length;
  other.z[1] = s->z[1] * length * rate;
  return other;
}

static void units_of_length_and_time_change_nothing(void **state) {
  (void)state;
  static const double lengths[] = {1, 1e-9, 1e-100, 1e9, 1, 1, 1e-12}, rates[] = {1, 1, 1, 1, 1e-6, 1e6, 1e-9};
  shooting_solution s = duffing_mode(0.1, 0.4, -1);
  ritz_approximation a = ritz_approximate(&s, 16, true);
  size_t last = ric_ritz_unknowns(a.ritz) - 1;
  for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
    shooting_solution other = in_units(&s, lengths[k], rates[k]);
    ritz_approximation b = ritz_approximate(&other, 16, true);
    for (size_t i = 0; i < last; i++)
      assert_close(b.c[i] / lengths[k], a.c[i], 1e-11);
    assert_close(b.c[last] / rates[k], a.c[last], 1e-10);
    assert_close(b.error_q / lengths[k] / a.error_q, 1, 1e-6);
    ritz_approximation_clear(&b);
    shooting_solution_clear(&other);
  }
  ritz_approximation_clear(&a);
  shooting_solution_clear(&s);
}

static void rest_has_no_defect(void **state) {
  (void)state;
  const ric_ritz_options options = {.functions = 2, .constants = true};
  ric_system *system = duffing_masses(0.1, -1);
  ric_ritz *ritz = NULL;
  const double c[7] = {[6] = 0.8};
  assert_int_equal(ric_ritz_create(system, 0, &options, &ritz, NULL), RIC_OK);
  assert_close(ric_ritz_defect(ritz, c, 7), 0, 0);
  ric_ritz_destroy(&ritz);
  ric_system_destroy(&system);
}

/* --- families ----------------------------------------------------------------------------------------------------- */

typedef struct walk_state {
  ric_ritz *ritz;
  shooting_solution *shooting_solution;
  size_t points;
  double worst_q, worst_v, w_low, w_high;
} walk_state;

static ric_status residual(const double *c, double period, double *F, double *J, double *F_period, void *user,
                           ric_error *error) {
  return ric_ritz_residual(((walk_state *)user)->ritz, c, period, F, J, F_period, error);
}

/* Shooting from the state of the approximated motion. */
static int see(const ric_curve_point *point, void *user) {
  walk_state *w = user;
  double q[2], v[2], error_q, error_v, g = point->u[ric_ritz_unknowns(w->ritz) - 1] * point->p / turn;
  assert_int_equal(point->kind, RIC_CURVE_REGULAR);
  ric_ritz_state(w->ritz, point->u, point->p, 0, q, v);
  shooting_solution_guess(w->shooting_solution, q, v, NULL, point->p);
  shooting_solution_solve(w->shooting_solution);
  assert_int_equal(w->shooting_solution->orbit.outcome, RIC_ADMISSIBLE);
  assert_int_equal(ric_ritz_error(w->ritz, point->u, point->p, w->shooting_solution->shooting, w->shooting_solution->z,
                                  &error_q, &error_v, NULL),
                   RIC_OK);
  w->worst_q = fmax(w->worst_q, error_q);
  w->worst_v = fmax(w->worst_v, error_v);
  w->w_low = fmin(w->w_low, g);
  w->w_high = fmax(w->w_high, g);
  w->points++;
  return 0;
}

static void families_along_the_period_agree_with_shooting(void **state) {
  (void)state;
  shooting_solution s = duffing_mode(0.1, 0.05, -1);
  double start = s.given;
  ritz_approximation a = ritz_approximate(&s, 16, true);
  walk_state w = {.ritz = a.ritz, .shooting_solution = &s, .w_low = 1};
  const ric_curve_problem problem = {.unknowns = ric_ritz_unknowns(a.ritz), .residual = residual, .user = &w};
  ric_curve_options options = ric_curve_options_default();
  ric_curve *curve = NULL;
  ric_curve_run run;
  ric_error error;
  options.p_low = 6.5;
  options.direction = -1;
  options.step_most = 0.03;
  assert_int_equal(ric_curve_create(&problem, &options, &curve, NULL), RIC_OK);
  if (ric_curve_follow(curve, a.c, start, NULL, see, &w, &run, &error) != RIC_OK)
    fail_msg("%s", error.message);
  print_message("[ %zu points to T = 6.5 (%s %s), error %.3g (q), %.3g (v), w T / (2 pi) %.3f-%.3f ]\n", w.points,
                ric_curve_end_name(run.end), run.reason, w.worst_q, w.worst_v, w.w_low, w.w_high);
  assert_int_equal(run.end, RIC_CURVE_BOUND);
  assert_true(w.points > 20);
  assert_true(w.worst_q < 6e-5 && w.worst_v < 1.2e-3);
  assert_true(w.w_high < 1);
  ric_curve_destroy(&curve);
  ritz_approximation_clear(&a);
  shooting_solution_clear(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(displacements_converge_with_the_third_power_and_residuals_with_the_first),
      cmocka_unit_test(longer_chains_converge_as_fast),
      cmocka_unit_test(the_frequency_is_that_without_the_impact_and_stays_in_place),
      cmocka_unit_test(without_constants_errors_stall_at_the_mean_of_the_motion),
      cmocka_unit_test(a_single_oscillator_converges_faster_than_any_power),
      cmocka_unit_test(a_linear_oscillator_is_represented_exactly),
      cmocka_unit_test(refining_takes_as_many_functions_as_the_tolerance_needs),
      cmocka_unit_test(the_energy_varies_by_no_more_than_the_error),
      cmocka_unit_test(a_floor_mirrors_a_wall),
      cmocka_unit_test(chains_are_mirrored_with_their_quadratic_springs),
      cmocka_unit_test(units_of_length_and_time_change_nothing),
      cmocka_unit_test(rest_has_no_defect),
      cmocka_unit_test(families_along_the_period_agree_with_shooting),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
