/* Windows of periodic motions along a parameter: x'' + 3 x' + x = a cos w t, x <= 1, e = 0.8, a = a_g (1 + mu). */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/grazing_family.h"

static const double two_pi = 6.283185307179586, restitution = 0.8, damping = 3;

typedef struct oscillator {
  ric_lattice lattice;
  ric_system *system;
  double force, grazing, w; /* grazing: a_g */
  bool along_force;         /* the parameter is a, not mu */
} oscillator;

static ric_status set(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  oscillator *o = user;
  o->force = o->along_force ? p[0] : o->grazing * (1 + p[0]);
  *given = two_pi / o->w;
  return ric_system_set_lattice(system, &o->lattice, error);
}

static void oscillator_init(oscillator *o, double w) {
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  wall.restitution = restitution;
  *o = (oscillator){.lattice = ric_lattice_default(1, RIC_ENDS_FREE), .w = w, .grazing = hypot(1 - w * w, damping * w)};
  o->lattice.on_site.damping = damping;
  o->lattice.force_cos = &o->force;
  o->lattice.frequency = w;
  assert_int_equal(ric_system_create_lattice(&o->lattice, &wall, 1, &o->system, NULL), RIC_OK);
}

static ric_family_problem problem_of(oscillator *o) {
  return (ric_family_problem){.system = o->system,
                              .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                              .set = set,
                              .user = o,
                              .parameters = 1};
}

/* A state on the attractor, from rest. */
typedef struct settled {
  double t, q, u;
} settled;

static settled settle(oscillator *o, double p) {
  ric_trajectory *trajectory = NULL;
  ric_run run;
  double given;
  settled s = {.t = 3000 * two_pi / o->w};
  assert_int_equal(set(o->system, &p, &given, o, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_create(o->system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, &s.q, &s.u, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, s.t, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  s.q = *ric_trajectory_q(trajectory);
  s.u = *ric_trajectory_u(trajectory);
  ric_trajectory_destroy(&trajectory);
  return s;
}

static ric_motion_window window_of(oscillator *o, size_t periods, double p, double low, double high) {
  const ric_family_problem problem = problem_of(o);
  const settled s = settle(o, p);
  ric_motion_window window;
  ric_error error = {0};
  if (ric_motion_window_find(&problem, periods, p, low, high, s.t, &s.q, &s.u, NULL, &window, &error) != RIC_OK)
    fail_msg("period %zu at %g: %s", periods, p, error.message);
  assert_int_equal(window.periods, periods);
  assert_true(window.stable && window.low.p < p && p < window.high.p);
  return window;
}

/* --- the motion in closed form ------------------------------------------------------------------------------------ */

/* One impact in n periods, at the phase theta of the smooth motion (1 + mu) cos(phase): that and the response to a
 * kick J that comes back every N = n T, with x = 1 and u = -e u there. */
typedef struct kicked {
  double w, N, theta, mu, J, before; /* speed before the impact */
} kicked;

static const double slow = 0.38196601125010515, fast = 2.6180339887498949; /* the roots of r^2 - 3 r + 1 */

static double response(double t, double N) {
  return (exp(-slow * t) / -expm1(-slow * N) - exp(-fast * t) / -expm1(-fast * N)) / (fast - slow);
}

static double response_rate(double t, double N) {
  return (-slow * exp(-slow * t) / -expm1(-slow * N) + fast * exp(-fast * t) / -expm1(-fast * N)) / (fast - slow);
}

/* 1 - x counts for small mu, and comes without cancellation: 1 - cos theta = 2 sin^2(theta / 2). */
static kicked kicked_at(double w, size_t n, double theta) {
  kicked k = {.w = w, .N = (double)n * two_pi / w, .theta = theta};
  const double kick = (1 + restitution) * w * sin(theta) / (1 + (1 + restitution) * response_rate(k.N, k.N));
  const double lost = 2 * pow(sin(theta / 2), 2) - kick * response(k.N, k.N);
  k.mu = lost / (1 - lost); /* (1 + mu) (1 - lost) = 1 */
  k.J = kick * (1 + k.mu);
  k.before = -k.J / (1 + restitution);
  return k;
}

static double speed(const kicked *k, double t) {
  return -(1 + k->mu) * k->w * sin(k->theta + k->w * t) + k->J * response_rate(t, k->N);
}

/* The gap at its minimum near the peak j of the forced motion. */
static double gap_at(const kicked *k, size_t j) {
  double t = ((double)j * two_pi - k->theta) / k->w;
  for (int i = 0; i < 30; i++) {
    const double acceleration = -(1 + k->mu) * k->w * k->w * cos(k->theta + k->w * t);
    t -= speed(k, t) / acceleration;
  }
  return -k->mu + (1 + k->mu) * 2 * pow(sin((k->theta + k->w * t) / 2), 2) - k->J * response(t, k->N);
}

static double clearance(double w, size_t n, double theta) {
  const kicked k = kicked_at(w, n, theta);
  double least = INFINITY;
  for (size_t j = 1; j < n; j++)
    least = fmin(least, gap_at(&k, j));
  return least;
}

/* det(M + I), M = exp(A N) S with the saltation S = (-e, 0; (a+ + e a-) / u-, -e). */
static double flip(double w, size_t n, double theta) {
  const kicked k = kicked_at(w, n, theta);
  const double pull = (1 + k.mu) * ((1 - w * w) * cos(theta) - damping * w * sin(theta)), e = restitution;
  const double a_before = pull - 1 - damping * k.before, a_after = pull - 1 + damping * e * k.before;
  const double h = (exp(-slow * k.N) - exp(-fast * k.N)) / (fast - slow);
  const double rate = (fast * exp(-fast * k.N) - slow * exp(-slow * k.N)) / (fast - slow);
  const double trace = -e * (2 * rate + damping * h) + h * (a_after + e * a_before) / k.before;
  return 1 + trace + e * e * exp(-damping * k.N);
}

/* mu where a function of theta < 0 changes its sign. */
static double mu_where(double (*f)(double, size_t, double), double w, size_t n) {
  double near = -1e-6, far = -0.7;
  const bool sign = f(w, n, near) > 0;
  assert_true(sign != (f(w, n, far) > 0));
  for (int i = 0; i < 200; i++) {
    const double middle = -sqrt(near * far);
    *((f(w, n, middle) > 0) == sign ? &near : &far) = middle;
  }
  return kicked_at(w, n, near).mu;
}

/* Of motions of size 1, which mu is a small part of. */
static const double rounding = 3e-13;

/* --- windows ------------------------------------------------------------------------------------------------------ */

/* The map beside grazing, on the section t = 0. */
static ric_grazing_map map_of(oscillator *o, double *slope) {
  const ric_family_problem problem = problem_of(o);
  const ric_family_options options = grazing_family_options(-0.5, 0.5, 0.1);
  const ric_grazing_plane plane = {.time = 0};
  const double rest[2] = {0};
  grazing_family g = grazing_family_from(&problem, &options, -0.2, rest, rest + 1, NULL, two_pi / o->w);
  grazing_family_find(&g);
  assert_close(g.grazing.parameter, 0, 1e-13);
  const ric_grazing_map map = grazing_family_map(&g, &plane);
  *slope = g.grazing.slope;
  grazing_family_clear(&g);
  return map;
}

/* A mu in the window that the map predicts for period n. */
static double middle_of(const ric_grazing_map *map, double slope, size_t n, double *low, double *high) {
  ric_grazing_window w;
  assert_int_equal(ric_grazing_window_find(map, n, &w, NULL), RIC_OK);
  assert_true(w.exists);
  *low = -w.low.d / slope;
  *high = isfinite(w.high.d) ? -w.high.d / slope : NAN;
  return isfinite(*high) ? sqrt(*low * *high) : 2 * *low;
}

static void check_window(oscillator *o, const ric_grazing_map *map, double slope, size_t n, ric_motion_window *w) {
  double low, high;
  const double p = middle_of(map, slope, n, &low, &high);
  *w = window_of(o, n, p, p / 100, p * 100);
  const double flip_at = mu_where(flip, o->w, n), border_at = mu_where(clearance, o->w, n);
  assert_int_equal(w->impacts, 1);
  assert_int_equal(w->low.kind, RIC_FAMILY_PERIOD_DOUBLING);
  assert_int_equal(w->high.kind, RIC_FAMILY_GRAZING);
  print_message("[ w = %g, n = %zu: %.10g to %.10g; off the closed form by %.1e, %.1e, the map by %.1e, %.1e ]\n", o->w,
                n, w->low.p, w->high.p, w->low.p / flip_at - 1, w->high.p / border_at - 1, low / w->low.p - 1,
                high / w->high.p - 1);
  assert_close(w->low.p, flip_at, 1e-9 * flip_at + rounding);
  assert_close(w->high.p, border_at, 1e-9 * border_at + rounding);
  assert_close(low / w->low.p, 1, 0.1 * sqrt(w->low.p)); /* what the map leaves out */
  assert_close(high / w->high.p, 1, 0.25 * sqrt(w->high.p));
}

/* Ratios of successive windows tend to the square of the larger multiplier, exp(-slow T). */
static void windows_of_four_have_their_exact_edges(void **state) {
  (void)state;
  oscillator o;
  double slope;
  oscillator_init(&o, 4);
  ric_grazing_map map = map_of(&o, &slope);
  const double square = exp(-2 * slow * two_pi / o.w);
  ric_motion_window last = {0};
  for (size_t n = 7; n <= 14; n++) {
    ric_motion_window w;
    check_window(&o, &map, slope, n, &w);
    if (n > 7) {
      assert_close(w.low.p / last.low.p / square, 1, sqrt(w.low.p));
      assert_close(w.high.p / last.high.p / square, 1, sqrt(w.high.p));
      assert_true(w.high.p < last.low.p); /* chaos between them */
    }
    last = w;
  }
  assert_close(square, pow(0.549, 2), 1e-3);
  ric_grazing_map_clear(&map);
  ric_system_destroy(&o.system);
}

static void windows_of_a_strongly_damped_motion_overlap(void **state) {
  (void)state;
  oscillator o;
  double slope;
  oscillator_init(&o, 1.5);
  ric_grazing_map map = map_of(&o, &slope);
  ric_motion_window last = {0};
  for (size_t n = 2; n <= 5; n++) {
    ric_motion_window w;
    check_window(&o, &map, slope, n, &w);
    assert_true(n == 2 || last.low.p < w.high.p);
    last = w;
  }
  ric_grazing_map_clear(&map);
  ric_system_destroy(&o.system);
}

/* From anywhere in it, and along the force itself, whose changes are small beside it. */
static void a_window_is_the_same_from_all_its_points(void **state) {
  (void)state;
  oscillator o;
  oscillator_init(&o, 4);
  const double low = mu_where(flip, 4, 9), high = mu_where(clearance, 4, 9);
  for (double part = 0.1; part < 1; part += 0.2) {
    const ric_motion_window w = window_of(&o, 9, low + part * (high - low), 1e-6, 0.1);
    assert_close(w.low.p / low, 1, 1e-9);
    assert_close(w.high.p / high, 1, 1e-9);
  }
  o.along_force = true;
  const ric_motion_window w = window_of(&o, 9, o.grazing * (1 + 0.5 * (low + high)), o.grazing, 1.1 * o.grazing);
  assert_close(w.low.p / (o.grazing * (1 + low)), 1, 1e-10);
  assert_close(w.high.p / (o.grazing * (1 + high)), 1, 1e-10);
  ric_system_destroy(&o.system);
}

static void bounds_end_a_window_without_an_edge(void **state) {
  (void)state;
  oscillator o;
  oscillator_init(&o, 4);
  const double low = mu_where(flip, 4, 8), high = mu_where(clearance, 4, 8), p = 0.5 * (low + high);
  const ric_motion_window w = window_of(&o, 8, p, 0.5 * (low + p), 0.5 * (high + p));
  assert_int_equal(w.low.kind, RIC_FAMILY_REGULAR);
  assert_int_equal(w.high.kind, RIC_FAMILY_REGULAR);
  assert_close(w.low.p, 0.5 * (low + p), 1e-15);
  assert_close(w.high.p, 0.5 * (high + p), 1e-15);
  assert_string_equal(w.low.reason, "");
  assert_string_equal(w.high.reason, "");
  ric_system_destroy(&o.system);
}

/* The motion without impacts, whose largest multiplier is exp(-slow T), up to a_g. */
static void the_smooth_motion_ends_at_grazing(void **state) {
  (void)state;
  oscillator o;
  oscillator_init(&o, 4);
  o.along_force = true;
  const ric_motion_window w = window_of(&o, 1, 0.7 * o.grazing, 0.1, 30);
  assert_int_equal(w.impacts, 0);
  assert_int_equal(w.high.kind, RIC_FAMILY_GRAZING);
  assert_close(w.high.p / o.grazing, 1, 1e-12);
  assert_int_equal(w.low.kind, RIC_FAMILY_REGULAR);
  assert_close(w.largest.re, exp(-slow * two_pi / 4), 1e-10);
  ric_system_destroy(&o.system);
}

/* --- a chain ------------------------------------------------------------------------------------------------------ */

enum { MASSES = 5 };

/* Five masses, the first one driven, the third one at a wall. */
typedef struct chain {
  ric_lattice lattice;
  ric_system *system;
  double forces[MASSES];
} chain;

static ric_status set_chain(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  chain *c = user;
  c->forces[0] = p[0];
  *given = two_pi / c->lattice.frequency;
  return ric_system_set_lattice(system, &c->lattice, error);
}

static void chain_init(chain *c) {
  ric_obstacle wall = ric_obstacle_wall(2, 0.5);
  wall.restitution = 0.7;
  *c = (chain){.lattice = ric_lattice_default(MASSES, RIC_ENDS_FIXED)};
  c->lattice.on_site.damping = 0.3;
  c->lattice.link.linear = 1;
  c->lattice.force_cos = c->forces;
  c->lattice.frequency = 0.9;
  assert_int_equal(ric_system_create_lattice(&c->lattice, &wall, 1, &c->system, NULL), RIC_OK);
}

/* Runs it for some periods at a force; returns by how much the state changes in the last one. */
static double run_chain(chain *c, double force, int periods, double *q, double *u) {
  ric_trajectory *trajectory = NULL;
  ric_run run;
  double given, change = 0;
  assert_int_equal(set_chain(c->system, &force, &given, c, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_create(c->system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, q, u, NULL), RIC_OK);
  for (int k = 1; k <= periods; k++) {
    assert_int_equal(ric_trajectory_run(trajectory, k * given, NULL, &run, NULL), RIC_OK);
    change = 0;
    for (size_t i = 0; i < MASSES; i++)
      change = fmax(change, fabs(ric_trajectory_q(trajectory)[i] - q[i]));
    memcpy(q, ric_trajectory_q(trajectory), MASSES * sizeof *q);
    memcpy(u, ric_trajectory_u(trajectory), MASSES * sizeof *u);
  }
  ric_trajectory_destroy(&trajectory);
  return change;
}

static ric_motion_window chain_window(chain *c, double force, double *q, double *u) {
  const ric_family_problem problem = {.system = c->system,
                                      .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                      .set = set_chain,
                                      .user = c,
                                      .parameters = 1};
  ric_motion_window w;
  ric_error error = {0};
  assert_close(run_chain(c, force, 600, q, u), 0, 1e-9);
  if (ric_motion_window_find(&problem, 1, force, 0.1, 30, 0, q, u, NULL, &w, &error) != RIC_OK)
    fail_msg("force %g: %s", force, error.message);
  return w;
}

/* A motion of one impact in a period, and beyond its grazing, where there is a second one, a motion of two. Near that
 * edge a pair of multipliers leaves the circle, becomes real, and one of them infinite, all within one step of a walk
 * from far away. Runs settle inside of the windows only. */
static void windows_of_a_chain_are_the_same_from_all_their_points(void **state) {
  (void)state;
  static const double forces[2][4] = {{2.5, 2.8, 3, 3.5}, {4, 4.5, 6, 7}};
  static const ric_family_kind lows[] = {RIC_FAMILY_PERIOD_DOUBLING, RIC_FAMILY_TORUS};
  const double edge = 0.004;
  chain c;
  chain_init(&c);
  for (size_t k = 0; k < 2; k++) {
    ric_motion_window first = {0};
    for (size_t i = 0; i < 4; i++) {
      double q[MASSES] = {0}, u[MASSES] = {0};
      const ric_motion_window w = chain_window(&c, forces[k][i], q, u);
      first = i == 0 ? w : first;
      assert_int_equal(w.impacts, k + 1);
      assert_int_equal(w.low.kind, lows[k]);
      assert_int_equal(w.high.kind, RIC_FAMILY_GRAZING);
      assert_close(w.low.p / first.low.p, 1, 1e-10);
      assert_close(w.high.p / first.high.p, 1, 1e-10);
      if (i > 0)
        continue;
      for (double above = forces[k][0] / w.low.p - 1; above > edge; above *= 0.8) /* on the motion itself */
        run_chain(&c, (1 + above) * w.low.p, 200, q, u);
      assert_close(run_chain(&c, (1 + edge) * w.low.p, 2000, q, u), 0, 1e-8);
      assert_true(run_chain(&c, (1 - edge) * w.low.p, 2000, q, u) > 1e-4);
    }
    print_message("[ %zu impacts: %.10g to %.10g ]\n", first.impacts, first.low.p, first.high.p);
  }
  ric_system_destroy(&c.system);
}

/* --- refusals ----------------------------------------------------------------------------------------------------- */

static void assert_told(ric_status status, ric_status expected, const ric_error *error, const char *text) {
  assert_int_equal(status, expected);
  if (!strstr(error->message, text))
    fail_msg("\"%s\", expected \"%s\" in it", error->message, text);
}

static int stop(void *user) {
  (void)user;
  return 1;
}

static void bad_arguments_are_refused(void **state) {
  (void)state;
  oscillator o;
  ric_motion_window w;
  ric_error e;
  oscillator_init(&o, 4);
  ric_family_problem problem = problem_of(&o);
  const double p = 0.0014;
  const settled s = settle(&o, p);
  const double q = s.q, u = s.u, t = s.t;
  assert_told(ric_motion_window_find(&problem, 0, p, 0, 1, t, &q, &u, NULL, &w, &e), RIC_EINVAL, &e, "periods = 0");
  assert_told(ric_motion_window_find(&problem, 8, p, p, 1, t, &q, &u, NULL, &w, &e), RIC_EINVAL, &e, "low = ");
  assert_told(ric_motion_window_find(&problem, 8, p, 0, NAN, t, &q, &u, NULL, &w, &e), RIC_EINVAL, &e, "high = ");
  assert_told(ric_motion_window_find(&problem, 8, NAN, 0, 1, t, &q, &u, NULL, &w, &e), RIC_EINVAL, &e, "p = ");
  assert_told(ric_motion_window_find(&problem, 8, p, 0, 1, NAN, &q, &u, NULL, &w, &e), RIC_EINVAL, &e, "t = ");
  assert_told(ric_motion_window_find(&problem, 16, p, 0, 1, t, &q, &u, NULL, &w, &e), RIC_EINVAL, &e,
              "repeats after 8");
  problem.motion.kind = RIC_MOTION_AUTONOMOUS;
  assert_told(ric_motion_window_find(&problem, 8, p, 0, 1, t, &q, &u, NULL, &w, &e), RIC_EINVAL, &e, "motion.kind");
  problem.motion.kind = RIC_MOTION_FORCED;
  problem.motion.poll = (ric_poll){stop, NULL};
  assert_int_equal(ric_motion_window_find(&problem, 8, p, 0, 1, t, &q, &u, NULL, &w, &e), RIC_ESTOPPED);
  ric_system_destroy(&o.system);
}

/* A motion of chaos does not repeat: what shooting makes of it does not attract; and motions that chatter are none
 * with impacts one by one. */
static void motions_that_do_not_attract_are_refused(void **state) {
  (void)state;
  oscillator o;
  ric_motion_window w;
  ric_error e;
  oscillator_init(&o, 4);
  const ric_family_problem problem = problem_of(&o);
  const double p = 0.5 * (mu_where(flip, 4, 8) + mu_where(clearance, 4, 9)); /* between two windows */
  const settled s = settle(&o, p);
  for (size_t n = 4; n < 10; n++)
    assert_told(ric_motion_window_find(&problem, n, p, 0, 1, s.t, &s.q, &s.u, NULL, &w, &e), RIC_ENUMERIC, &e,
                "is not a stable one");
  o.w = 0.1;
  o.lattice.frequency = 0.1;
  o.grazing = hypot(1 - 0.01, 0.3);
  const settled slow_one = settle(&o, 0.2);
  assert_told(ric_motion_window_find(&problem, 1, 0.2, 0, 1, slow_one.t, &slow_one.q, &slow_one.u, NULL, &w, &e),
              RIC_ENUMERIC, &e, "expected a motion with isolated impacts");
  ric_system_destroy(&o.system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(windows_of_four_have_their_exact_edges),
      cmocka_unit_test(windows_of_a_strongly_damped_motion_overlap),
      cmocka_unit_test(a_window_is_the_same_from_all_its_points),
      cmocka_unit_test(bounds_end_a_window_without_an_edge),
      cmocka_unit_test(the_smooth_motion_ends_at_grazing),
      cmocka_unit_test(windows_of_a_chain_are_the_same_from_all_their_points),
      cmocka_unit_test(bad_arguments_are_refused),
      cmocka_unit_test(motions_that_do_not_attract_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
