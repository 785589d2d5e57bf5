/* The bypass map against closed forms, its own leading order, and the full motion with impacts. */
#include "support.h"

#include "grazing_point.h"

static const double restitutions[3] = {0, 0.8, 1};

/* NULL for the default flow. */
static ric_bypass *bypass_by(ric_system *system, const ric_flow_options *flow) {
  ric_bypass *bypass = NULL;
  ric_bypass_options options = ric_bypass_options_default();
  ric_error error = {0};
  if (flow)
    options.flow = *flow;
  if (ric_bypass_create(system, 0, &options, &bypass, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return bypass;
}

static ric_bypass *bypass_of(ric_system *system) {
  return bypass_by(system, NULL);
}

static ric_bypass_seen mapped(ric_bypass *b, double t, const double *x, double *image) {
  ric_bypass_seen seen = {0};
  ric_error error = {0};
  if (ric_bypass_map(b, t, x, image, &seen, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return seen;
}

/* --- closed forms ------------------------------------------------------------------------------------------------- */

/* q'' = pull, gap q: a parabola. Impact at t_C = tau - sqrt(-2 psi / pull), and the way back from there. */
static int constant_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u;
  f[0] = *(double *)user;
  return 0;
}

static int height(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = q[0];
  return 0;
}

static ric_system *flying(double *pull, const double *restitution) {
  ric_mechanical model = {.coordinates = 1,
                          .speeds = 1,
                          .obstacles = 1,
                          .restitution = restitution,
                          .force = constant_force,
                          .gap = height,
                          .user = pull};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  return system;
}

static void check_parabola(ric_bypass *b, double pull, double e, double q, double v) {
  double x[2] = {q, v}, image[2], tau = -v / pull, psi = q - v * v / (2 * pull);
  ric_bypass_seen seen = mapped(b, 3, x, image);
  double depth = fmax(-psi, 0), noise = 4e-16 * fmax(1, v * v); /* of psi */
  double expected[2] = {q, v}, speed = sqrt(2 * pull * depth), t_C = tau - speed / pull;
  if (psi < 0) { /* the way back from t_C with the speed e `speed` */
    expected[1] = e * speed - pull * t_C;
    expected[0] = -e * speed * t_C + pull * t_C * t_C / 2;
  }
  double off = fmin(sqrt(noise), noise / sqrt(depth + noise)); /* of sqrt(-psi) */
  assert_close(seen.psi, psi, noise);
  assert_close(seen.tau, tau, 1e-15 * fmax(1, 3 / pull));
  assert_close(seen.curvature, pull, 1e-10);
  if (psi < -noise)
    assert_close(seen.t_C, t_C, 4 * off + 1e-14);
  assert_close(image[0], expected[0], 8 * off + 1e-15);
  assert_close(image[1], expected[1], 8 * off + 1e-15);
}

static void free_flight_agrees_with_its_parabola(void **state) {
  (void)state;
  random_source source = {1};
  for (size_t k = 0; k < 3; k++)
    for (int i = 0; i < 100; i++) {
      double e = restitutions[k], pull = random_uniform(&source, 0.5, 3), v = random_uniform(&source, -0.3, 0.3);
      double depth = pow(10, random_uniform(&source, -14, -1)) * (i % 4 ? 1 : -1);
      ric_system *system = flying(&pull, &e);
      ric_bypass *b = bypass_of(system);
      check_parabola(b, pull, e, v * v / (2 * pull) - depth, v);
      ric_bypass_destroy(&b);
      ric_system_destroy(&system);
    }
}

/* Pulled into the obstacle the gap has a maximum only. */
static void flight_towards_the_obstacle_has_no_minimum(void **state) {
  (void)state;
  double pull = -1, x[2] = {0.1, 0.2}, image[2] = {7, 7};
  ric_system *system = flying(&pull, NULL);
  ric_bypass *b = bypass_of(system);
  ric_error error = {0};
  assert_int_equal(ric_bypass_map(b, 0, x, image, NULL, &error), RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "no minimum within 1"));
  assert_true(image[0] == 7);
  ric_bypass_destroy(&b);
  ric_system_destroy(&system);
}

/* --- orders ------------------------------------------------------------------------------------------------------- */

typedef struct errors {
  double leading, second;
} errors;

/* What the expansion misses at a depth, without and with kappa. */
static errors missed(ric_bypass *b, const grazing_point *p, const double *kappa, double depth) {
  double x[GRAZING_MOST], image[GRAZING_MOST], leading[GRAZING_MOST];
  ric_bypass_seen seen;
  errors e;
  grazing_point_behind(p, depth, x);
  double psi = mapped(b, p->t, x, image).psi;
  assert_int_equal(ric_bypass_leading(b, &p->local, p->t, x, leading, &seen, NULL), RIC_OK);
  assert_close(seen.psi, psi, 1e-15);
  e.leading = largest_difference(image, leading, p->numbers);
  for (size_t i = 0; i < p->numbers; i++)
    leading[i] -= psi * kappa[i];
  e.second = largest_difference(image, leading, p->numbers);
  return e;
}

/* From 1e-8 to 1e-4: below, the rounding of psi shows in the error of third order in sqrt(-psi), above, the next
 * order. That of the leading order is clean from 1e-10 on. */
static void check_orders(grazing_kind kind, double restitution, uint64_t seed) {
  grazing_point p;
  double kappa[GRAZING_MOST];
  grazing_point_make(&p, kind, restitution, seed);
  ric_bypass *b = bypass_of(p.system);
  assert_int_equal(ric_bypass_second(b, &p.local, p.t, p.x, kappa, NULL), RIC_OK);
  errors least = missed(b, &p, kappa, 1e-10), low = missed(b, &p, kappa, 1e-8), high = missed(b, &p, kappa, 1e-4);
  errors most = missed(b, &p, kappa, 1e-2);
  assert_close(log10(high.leading / least.leading) / 6, 1, 0.01);
  assert_close(log10(most.leading / least.leading) / 8, 1, 0.06);
  assert_close(log10(high.second / low.second) / 4, 1.5, 0.02);
  ric_bypass_destroy(&b);
  grazing_point_clear(&p);
}

static void leading_order_errs_in_first_order_and_with_kappa_in_the_third_of_its_root(void **state) {
  (void)state;
  for (int kind = 0; kind < GRAZING_KINDS; kind++)
    for (uint64_t seed = 7; seed < 10; seed++)
      check_orders((grazing_kind)kind, 0.8, seed);
}

/* Beside the ray, the error is y |x - x*|: as large in all directions. */
static void leading_order_errs_in_first_order_in_the_distance_beside_the_ray(void **state) {
  (void)state;
  grazing_point p;
  random_source source = {5};
  grazing_point_make(&p, GRAZING_FIVE_MASSES, 0.8, 11);
  ric_bypass *b = bypass_of(p.system);
  for (int i = 0; i < 50; i++) {
    double x[GRAZING_MOST], image[GRAZING_MOST], leading[GRAZING_MOST], far = pow(10, random_uniform(&source, -4, -2));
    for (size_t k = 0; k < p.numbers; k++)
      x[k] = p.x[k] + far * random_uniform(&source, -1, 1);
    double y = sqrt(fmax(-mapped(b, p.t, x, image).psi, 0));
    assert_int_equal(ric_bypass_leading(b, &p.local, p.t, x, leading, NULL, NULL), RIC_OK);
    assert_true(largest_difference(image, leading, p.numbers) <= 20 * y * (y + far));
  }
  ric_bypass_destroy(&b);
  grazing_point_clear(&p);
}

/* kappa = 2 DF xi - 2 xi' - (2 h''' / 3 A_g) xi, where xi' is the derivative of xi along the motion: put
 * t_C = -y sqrt(2 / A_g) + O(y^2) and h' = -y sqrt(2 A_g) + y^2 (2 h''' / 3 A_g) into (4.2). Derivatives by central
 * differences. */
static void add_closed_kappa(const grazing_point *p, double step, double weight, double *kappa) {
  size_t n = ric_system_coordinates(p->system), size = p->numbers;
  double F[GRAZING_MOST], x[GRAZING_MOST], rate[GRAZING_MOST], A = p->local.acceleration;
  ric_grazing_local at;
  assert_int_equal(ric_grazing_local_init(&at, size, NULL), RIC_OK);
  assert_int_equal(ric_system_rate(p->system, p->t, p->x, p->x + n, F, F + n, NULL), RIC_OK);
  for (double h = -step; h <= step; h += 2 * step) {
    for (size_t i = 0; i < size; i++)
      x[i] = p->x[i] + h * p->local.xi[i];
    assert_int_equal(ric_system_rate(p->system, p->t, x, x + n, rate, rate + n, NULL), RIC_OK);
    for (size_t i = 0; i < size; i++)
      x[i] = p->x[i] + h * F[i];
    assert_int_equal(ric_grazing_local_find(p->system, 0, p->t + h, x, &at, NULL), RIC_OK);
    double third = at.acceleration / (2 * h);
    for (size_t i = 0; i < size; i++)
      kappa[i] += weight * (2 * (rate[i] - at.xi[i]) / (2 * h) - 2 * third / (3 * A) * p->local.xi[i]);
  }
  ric_grazing_local_clear(&at);
}

static void kappa_agrees_with_its_closed_form(void **state) {
  (void)state;
  for (int kind = 0; kind < GRAZING_KINDS; kind++)
    for (size_t k = 0; k < 3; k++) {
      grazing_point p;
      double kappa[GRAZING_MOST], expected[GRAZING_MOST] = {0};
      grazing_point_make(&p, (grazing_kind)kind, restitutions[k], 3 + k);
      ric_bypass *b = bypass_of(p.system);
      assert_int_equal(ric_bypass_second(b, &p.local, p.t, p.x, kappa, NULL), RIC_OK);
      add_closed_kappa(&p, 2e-3, -1.0 / 3, expected);
      add_closed_kappa(&p, 1e-3, 4.0 / 3, expected);
      for (size_t i = 0; i < p.numbers; i++)
        assert_close(kappa[i], expected[i], 3e-7); /* of numbers up to 6; the differences err by 1e-7 */
      ric_bypass_destroy(&b);
      grazing_point_clear(&p);
    }
}

/* Without differences, for x'' + c x' + x = a cos w t and the wall: xi' = 0, h''' = -(F_t - c F). */
static void kappa_of_the_linear_oscillator_has_eight_digits(void **state) {
  (void)state;
  grazing_point p;
  double kappa[GRAZING_MOST], c = 0.1, a = 0.7, w = 1.4, xi = -1.8;
  grazing_point_make(&p, GRAZING_ONE_MASS, 0.8, 1);
  ric_bypass *b = bypass_of(p.system);
  assert_int_equal(ric_bypass_second(b, &p.local, p.t, p.x, kappa, NULL), RIC_OK);
  double F = a * cos(w * p.t) - p.x[0], third = a * w * sin(w * p.t) + c * F;
  assert_close(p.local.acceleration, -F, 1e-14);
  assert_close(kappa[0], 2 * xi, 2e-8);
  assert_close(kappa[1], -2 * c * xi + 2 * third / (3 * F) * xi, 2e-8);
  ric_bypass_destroy(&b);
  grazing_point_clear(&p);
}

/* --- continuity --------------------------------------------------------------------------------------------------- */

static void states_that_do_not_reach_the_obstacle_stay(void **state) {
  (void)state;
  for (int kind = 0; kind < GRAZING_KINDS; kind++) {
    grazing_point p;
    double x[GRAZING_MOST], image[GRAZING_MOST];
    grazing_point_make(&p, (grazing_kind)kind, 0.8, 21);
    ric_bypass *b = bypass_of(p.system);
    for (int k = 2; k <= 14; k++) {
      grazing_point_behind(&p, -pow(10, -k), x);
      ric_bypass_seen seen = mapped(b, p.t, x, image);
      assert_true(seen.psi > 0);
      assert_memory_equal(x, image, p.numbers * sizeof *x);
      assert_true(isnan(seen.t_C));
      assert_true(seen.gap_rate == 0);
    }
    ric_bypass_destroy(&b);
    grazing_point_clear(&p);
  }
}

static void the_map_is_continuous_at_grazing(void **state) {
  (void)state;
  for (int kind = 0; kind < GRAZING_KINDS; kind++)
    for (size_t k = 0; k < 3; k++) {
      grazing_point p;
      double x[GRAZING_MOST], image[GRAZING_MOST], most = 0;
      grazing_point_make(&p, (grazing_kind)kind, restitutions[k], 31);
      ric_bypass *b = bypass_of(p.system);
      for (size_t i = 0; i < p.numbers; i++)
        most = fmax(most, sqrt(2 * p.local.acceleration) * fabs(p.local.xi[i]));
      for (int j = 4; j <= 17; j++) {
        double depth = pow(10, -j);
        grazing_point_behind(&p, depth, x);
        ric_bypass_seen seen = mapped(b, p.t, x, image);
        double y = sqrt(depth + 1e-15); /* with the rounding of gaps */
        assert_true(largest_difference(x, image, p.numbers) <= 1.5 * most * y);
        if (depth >= 1e-14) { /* on the way in, and not by subtraction: the gap rate is that of the way */
          double rate = -sqrt(2 * p.local.acceleration * depth);
          assert_close(seen.gap_rate / rate, 1, 2 * y + 3e-16 / depth);
          assert_close((seen.t_C - seen.tau) / (rate / p.local.acceleration), 1, 2 * y + 3e-16 / depth);
        }
      }
      ric_bypass_destroy(&b);
      grazing_point_clear(&p);
    }
}

/* --- the full motion ---------------------------------------------------------------------------------------------- */

/* The finest that both kinds of flow have. */
static ric_flow_options fine_flow(void) {
  ric_flow_options flow = ric_flow_options_default();
  flow.tolerance = 1e-14;
  return flow;
}

static void flow_to(const ric_system *system, double from, double to, double *x) {
  ric_flow_options options = fine_flow();
  ric_flow *flow = NULL;
  size_t n = ric_system_coordinates(system), m = ric_system_speeds(system);
  assert_int_equal(ric_flow_create(system, &options, &flow, NULL), RIC_OK);
  assert_int_equal(ric_flow_start(flow, from, x, x + n, NULL), RIC_OK);
  while (ric_flow_time(flow) != to) {
    assert_int_equal(ric_flow_step(flow, to, NULL), RIC_OK);
    ric_flow_accept(flow, 1);
  }
  memcpy(x, ric_flow_q(flow), n * sizeof *x);
  if (m)
    memcpy(x + n, ric_flow_u(flow), m * sizeof *x);
  ric_flow_destroy(&flow);
}

/* Event by event, to the same end. @returns the number of impacts and rests: without restitution, an impact where the
 * gap's acceleration is below zero brings the ball to rest on the table, which is not the map's to know */
static unsigned long long run_to(const ric_system *system, double from, double to, double *x) {
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_trajectory *trajectory = NULL;
  ric_run run;
  size_t n = ric_system_coordinates(system), m = ric_system_speeds(system);
  options.flow = fine_flow();
  options.grazing_tol = 1e-14;
  assert_int_equal(ric_trajectory_create(system, &options, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, from, x, x + n, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, to, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  memcpy(x, ric_trajectory_q(trajectory), n * sizeof *x);
  if (m)
    memcpy(x + n, ric_trajectory_u(trajectory), m * sizeof *x);
  ric_trajectory_destroy(&trajectory);
  return run.events[RIC_EVENT_TRANSVERSAL] + run.events[RIC_EVENT_CHATTER] + run.events[RIC_EVENT_REST];
}

typedef struct tally {
  size_t impacts, free_motions, others;
} tally;

/* Phi_t2 C Phi_t1 from the state that Phi_t1 takes to x.
 * @param off  error of the flow: in the gap, the root of its depth makes it larger */
static void check_motion(const grazing_point *p, ric_bypass *b, const double *x, double off, tally *count) {
  const double ahead = 0.3, after = 0.35;
  size_t bytes = p->numbers * sizeof *x;
  double full[GRAZING_MOST], parts[GRAZING_MOST];
  ric_bypass_seen seen = mapped(b, p->t, x, parts);
  memcpy(full, x, bytes);
  flow_to(p->system, p->t, p->t - ahead, full);
  if (!(ric_system_gap(p->system, 0, p->t - ahead, full) > 0)) { /* another contact at the start */
    count->others++;
    return;
  }
  flow_to(p->system, p->t, p->t + after, parts);
  unsigned long long impacts = run_to(p->system, p->t - ahead, p->t + after, full);
  if (impacts > 1) { /* another contact after this one */
    count->others++;
    return;
  }
  assert_int_equal(impacts, seen.psi < 0);
  double tolerance = 10 * off + (impacts ? off / sqrt(-seen.psi) : 0);
  if (!(largest_difference(full, parts, p->numbers) <= tolerance))
    fail_msg("off by %.3g, expected %.3g, psi = %.3g", largest_difference(full, parts, p->numbers), tolerance,
             seen.psi);
  *(impacts ? &count->impacts : &count->free_motions) += 1;
}

static void check_motions(grazing_kind kind, double restitution, size_t states, random_source *source, tally *count) {
  grazing_point p;
  ric_flow_options flow = fine_flow();
  grazing_point_make(&p, kind, restitution, source->state);
  ric_bypass *b = bypass_by(p.system, &flow);
  double off = kind <= GRAZING_FIVE_MASSES ? 1e-15 : 2e-13; /* rounding of a few steps; tolerance of some 20 */
  for (size_t k = 0; k < states; k++) {
    double x[GRAZING_MOST], far = pow(10, random_uniform(source, -6, -2.2));
    for (size_t i = 0; i < p.numbers; i++)
      x[i] = p.x[i] + far * random_uniform(source, -1, 1);
    check_motion(&p, b, x, off, count);
  }
  ric_bypass_destroy(&b);
  grazing_point_clear(&p);
}

static void the_full_motion_is_the_free_one_with_the_map_put_in(void **state) {
  (void)state;
  random_source source = {17};
  tally count = {0};
  for (int kind = 0; kind < GRAZING_KINDS; kind++)
    for (size_t k = 0; k < 3; k++)
      check_motions((grazing_kind)kind, restitutions[k], 50, &source, &count);
  assert_true(count.impacts + count.free_motions >= 1000);
  assert_true(count.impacts >= 400 && count.free_motions >= 400);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(free_flight_agrees_with_its_parabola),
      cmocka_unit_test(flight_towards_the_obstacle_has_no_minimum),
      cmocka_unit_test(leading_order_errs_in_first_order_and_with_kappa_in_the_third_of_its_root),
      cmocka_unit_test(leading_order_errs_in_first_order_in_the_distance_beside_the_ray),
      cmocka_unit_test(kappa_agrees_with_its_closed_form),
      cmocka_unit_test(kappa_of_the_linear_oscillator_has_eight_digits),
      cmocka_unit_test(states_that_do_not_reach_the_obstacle_stay),
      cmocka_unit_test(the_map_is_continuous_at_grazing),
      cmocka_unit_test(the_full_motion_is_the_free_one_with_the_map_put_in),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
