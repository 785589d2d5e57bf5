/* Grazing motions and their coefficients: forced oscillators against closed forms, chains and self-excited ones by the
 * independence of c_i = eta L^i xi from the section, motions with impacts of their own; what is refused. */
#include "support.h"

#include "witness/forced_oscillator.h"
#include "witness/grazing_family.h"
#include "witness/van_der_pol.h"

static const double two_pi = 6.283185307179586;

enum { COEFFICIENTS = 12 };

static ric_grazing_criterion judge(const ric_grazing_map *map, double *c) {
  ric_grazing_criterion k;
  assert_int_equal(ric_grazing_criterion_find(map, NULL, &k, c, COEFFICIENTS, NULL, NULL), RIC_OK);
  return k;
}

/* --- x'' + c x' + x = a cos(w t), wall at 1, e = 0.8 --- */

typedef struct expectation {
  double damping, frequency, amplitude, lambda;
  ric_grazing_verdict verdict;
  size_t first_negative;
} expectation;

static void forced_oscillators_graze_where_their_closed_form_says(void **state) {
  (void)state;
  static const expectation all[] = {{3, 6, 39.35733730830885, 0.67032415, RIC_GRAZING_CONTINUOUS, SIZE_MAX},
                                    {3, 4, 19.209372712298546, 0.549, RIC_GRAZING_CONTINUOUS, SIZE_MAX},
                                    {3, 1.5, NAN, 0.202, RIC_GRAZING_CONTINUOUS, SIZE_MAX},
                                    {0.1, 2, 3.006659275674582, NAN, RIC_GRAZING_DISCONTINUOUS, 1}};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
    const expectation *x = &all[k];
    const double w = x->frequency, amplitude = hypot(1 - w * w, x->damping * w), period = two_pi / w, rest[2] = {0};
    forced_oscillator o;
    forced_oscillator_init(&o);
    o.lattice.on_site.damping = x->damping;
    ric_family_problem problem = forced_oscillator_problem(&o, 0, 1, w);
    const ric_family_options options = grazing_family_options(0.5, 60, 5);
    grazing_family at = grazing_family_from(&problem, &options, 0.5, rest, rest + 1, NULL, period);
    double c[COEFFICIENTS];
    grazing_family_find(&at);
    const ric_grazing g = at.grazing;
    ric_grazing_map map = grazing_family_map(&at, NULL);
    const ric_grazing_criterion verdict = judge(&map, c);
    assert_close(g.parameter / amplitude, 1, 3e-14);
    if (!isnan(x->amplitude))
      assert_close(amplitude / x->amplitude, 1, 1e-15);
    assert_close(g.slope, -1 / amplitude, 1e-9);
    assert_close(g.local.acceleration, w * w, 1e-12 * w * w);
    assert_close(g.local.eta[0], -1, 0);
    assert_close(g.local.eta[1], 0, 0);
    assert_close(g.local.xi[1], -1.8, 1e-14);
    assert_close(map.stretch, sqrt(2) * w, 1e-12 * w);
    assert_int_equal(verdict.verdict, x->verdict);
    assert_int_equal(verdict.first_negative, x->first_negative);
    if (!isnan(x->lambda))
      assert_close(verdict.dominant.re, x->lambda, x->lambda == 0.67032415 ? 1e-8 : 1e-3);
    ric_grazing_map_clear(&map);
    grazing_family_clear(&at);
    forced_oscillator_clear(&o);
  }
}

/* c_i from any section. */
static void compare_sections(grazing_family *g, size_t state, double tolerance) {
  double first[COEFFICIENTS], c[COEFFICIENTS];
  double *normal = calloc(state, sizeof *normal);
  unsigned long long seed = 11;
  for (int k = 0; k < 12; k++) {
    ric_grazing_plane plane = {.time = g->grazing.period * k / 12.0, .normal = k % 3 == 2 ? normal : NULL};
    if (k == 11)
      plane.time = g->grazing.time;
    for (size_t i = 0; i < state; i++) {
      seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
      normal[i] = (double)(seed >> 11) / 9007199254740992.0 - 0.5;
    }
    ric_grazing_map map = grazing_family_map(g, &plane);
    judge(&map, k == 0 ? first : c);
    for (int i = 0; k > 0 && i < COEFFICIENTS; i++)
      assert_close(c[i], first[i], tolerance * (1 + fabs(first[0])));
    ric_grazing_map_clear(&map);
  }
  free(normal);
}

static void coefficients_do_not_depend_on_the_section(void **state) {
  (void)state;
  forced_oscillator o;
  forced_oscillator_init(&o);
  ric_family_problem problem = forced_oscillator_problem(&o, 0, 1, 1.7);
  ric_family_options options = grazing_family_options(0.1, 60, 5);
  const double rest[2] = {0};
  grazing_family at = grazing_family_from(&problem, &options, 0.1, rest, rest + 1, NULL, two_pi / 1.7);
  grazing_family_find(&at);
  compare_sections(&at, 3, 1e-12);
  grazing_family_clear(&at);
  forced_oscillator_clear(&o);
}

/* --- curves in two parameters --- */

typedef struct seen_curve {
  double worst, phase_worst; /* of the force, of a sign change against the nearest of the closed form */
  size_t points, zeros;
} seen_curve;

/* c_i is proportional to sin(2 pi (i + 1) w_d / w): it vanishes where 2 (i + 1) w_d / w is an integer. */
static double off_zero(size_t i, double w) {
  const double natural = sqrt(1 - 0.0025), turns = 2 * (double)(i + 1) * natural / w;
  return fabs(turns - round(turns));
}

static int see_curve(const ric_grazing_curve_point *p, void *user) {
  seen_curve *s = user;
  const double w = p->grazing->second;
  s->points++;
  s->worst = fmax(s->worst, fabs(p->grazing->parameter / forced_oscillator_grazing(w) - 1));
  assert_close(p->grazing->local.acceleration, w * w, 1e-9);
  if (p->zero != SIZE_MAX) {
    s->zeros++;
    s->phase_worst = fmax(s->phase_worst, off_zero(p->zero, w));
  }
  for (size_t i = 0; i < p->count && p->zero == SIZE_MAX; i++) {
    const double expected = sin(two_pi * (double)(i + 1) * sqrt(1 - 0.0025) / w);
    assert_true(p->coefficients[i] * expected > 0);
  }
  return 0;
}

static void signs_change_along_a_curve_where_the_closed_form_says(void **state) {
  (void)state;
  enum { COUNT = 4 };
  forced_oscillator o;
  forced_oscillator_init(&o);
  ric_family_problem problem = forced_oscillator_problem(&o, 0, 1, 1.33);
  ric_family_options options = grazing_family_options(0.01, 60, 5);
  const double rest[2] = {0};
  grazing_family at = grazing_family_from(&problem, &options, 0.01, rest, rest + 1, NULL, two_pi / 1.33);
  ric_curve_options curve = ric_curve_options_default();
  ric_curve_run run;
  ric_error error;
  seen_curve seen = {0};
  size_t expected = 0;
  grazing_family_find(&at);
  curve.p_high = 3.3;
  curve.step = curve.step_most = 0.05;
  curve.newton_tol = 1e-11;
  if (ric_grazing_trace(at.family, &at.grazing, &curve, COUNT, see_curve, &seen, &run, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_int_equal(run.end, RIC_CURVE_BOUND);
  for (size_t i = 0; i < COUNT; i++) {
    const double turns = 2 * (double)(i + 1) * sqrt(1 - 0.0025);
    expected += (size_t)(floor(turns / 1.33) - floor(turns / 3.3));
  }
  print_message("[ %zu points, %zu sign changes, worst %.2g and %.2g ]\n", seen.points, seen.zeros, seen.worst,
                seen.phase_worst);
  assert_int_equal(seen.zeros, expected);
  assert_int_equal(run.missed, 0);
  assert_true(seen.worst < 1e-10 && seen.phase_worst < 1e-8);
  grazing_family_clear(&at);
  forced_oscillator_clear(&o);
}

/* --- a self-excited oscillator before a wall --- */

static double wall_at = 3;

static ric_status move_wall(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  (void)system, (void)given, (void)error;
  *(double *)user = p[0];
  return RIC_OK;
}

enum { SAMPLES = 6001 };

static void a_limit_cycle_grazes_at_its_amplitude(void **state) {
  (void)state;
  ric_family_problem problem = {
      .system = van_der_pol_system(&wall_at),
      .motion = {.kind = RIC_MOTION_AUTONOMOUS, .flow = {.tolerance = 1e-13, .longest_step = INFINITY}},
      .set = move_wall,
      .user = &wall_at,
      .parameters = 1};
  ric_family_options options = grazing_family_options(1, 3, 0.3);
  options.curve.direction = -1;
  const double x[2] = {2, 0};
  grazing_family at = grazing_family_from(&problem, &options, 3, x, NULL, NULL, 6.4);
  double amplitude = 0;
  static double samples[SAMPLES][2];
  assert_int_equal(ric_shooting_states(ric_family_shooting(at.family), at.z, 0, SAMPLES, samples[0], NULL, NULL),
                   RIC_OK);
  for (size_t k = 0; k < SAMPLES; k++)
    amplitude = fmax(amplitude, samples[k][0]);
  grazing_family_find(&at);
  assert_close(at.grazing.parameter, amplitude, 1e-6); /* of the order of the square of the distance of samples */
  assert_close(at.grazing.slope, 1, 1e-9);
  assert_close(at.grazing.x[0], at.grazing.parameter, 1e-12);
  assert_close(at.grazing.x[1], 0, 1e-11);
  assert_close(at.grazing.local.acceleration, at.grazing.parameter, 1e-8); /* h'' = x at the turning point */
  assert_close(at.grazing.local.xi[1], -1.8, 1e-8);
  compare_sections(&at, 2, 1e-8);
  grazing_family_clear(&at);
  ric_system_destroy(&problem.system);
}

/* --- motions with impacts --- */

typedef struct two_masses {
  ric_lattice lattice;
  ric_obstacle walls[2];
} two_masses;

/* The wall before the first mass, which is not hit, comes nearer. */
static ric_status move_first(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  two_masses *m = user;
  m->walls[0].position = p[0];
  *given = two_pi;
  return ric_system_set_obstacles(system, m->walls, 2, error);
}

static void a_motion_that_hits_one_wall_grazes_another(void **state) {
  (void)state;
  static const ric_spring links[3] = {{3, 0, 0, 0.2}, {1, 0, 0.1, 0.1}, {0, 0, 0, 0}};
  static const double force[2] = {0.2, 0.9};
  static const size_t hit = 1;
  two_masses m = {.lattice = ric_lattice_default(2, RIC_ENDS_FIXED),
                  .walls = {ric_obstacle_wall(0, 5), ric_obstacle_wall(1, 1)}};
  m.walls[0].restitution = 0.5;
  m.walls[1].restitution = 0.7;
  m.lattice.on_site = (ric_spring){0};
  m.lattice.links = links;
  m.lattice.force_cos = force;
  m.lattice.frequency = 1;
  ric_family_problem problem = {
      .motion = {.kind = RIC_MOTION_FORCED, .sequence = &hit, .count = 1, .flow = ric_flow_options_default()},
      .set = move_first,
      .user = &m,
      .parameters = 1};
  assert_int_equal(ric_system_create_lattice(&m.lattice, m.walls, 2, &problem.system, NULL), RIC_OK);
  ric_family_options options = grazing_family_options(0.01, 5, 0.2);
  options.curve.direction = -1;
  const double q[2] = {0.1, 1}, u[2] = {0.1, -0.5}, time = 0.5;
  grazing_family at = grazing_family_from(&problem, &options, 5, q, u, &time, two_pi);
  grazing_family_find(&at);
  assert_int_equal(at.grazing.local.obstacle, 0);
  assert_close(at.grazing.slope, 1, 1e-9);
  assert_close(at.grazing.x[0], at.grazing.parameter, 1e-13);
  assert_close(at.grazing.x[2], 0, 1e-12);
  assert_close(at.grazing.local.xi[2], -1.5, 1e-14);
  compare_sections(&at, 5, 1e-9);
  grazing_family_clear(&at);
  ric_system_destroy(&problem.system);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(forced_oscillators_graze_where_their_closed_form_says),
                                     cmocka_unit_test(coefficients_do_not_depend_on_the_section),
                                     cmocka_unit_test(signs_change_along_a_curve_where_the_closed_form_says),
                                     cmocka_unit_test(a_limit_cycle_grazes_at_its_amplitude),
                                     cmocka_unit_test(a_motion_that_hits_one_wall_grazes_another)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
