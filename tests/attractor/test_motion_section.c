/* Sections of event-driven motions and their attractors: against closed forms, plain runs and multipliers. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/allocation_counter.h"
#include "witness/forced_oscillator.h"
#include "witness/grazing_family.h"
#include "witness/recorded_run.h"
#include "section_attractor.h"
#include "witness/shooting_solution.h"

static const double two_pi = 6.283185307179586;

/* --- x'' + 3 x' + x = a cos(w t) under a wall at 1, a = (1 + mu) times that of grazing -----------------------------
 */

enum { DAMPING = 3 };
static const double frequency = 4, restitution = 0.8;

static ric_system *oscillator(double mu) {
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  wall.restitution = restitution;
  double touching = hypot(1 - frequency * frequency, DAMPING * frequency);
  return section_oscillator(DAMPING, frequency, (1 + mu) * touching, &wall, 1);
}

static ric_motion_section_options strobes(void) {
  return ric_motion_section_options_default(two_pi / frequency);
}

/* Divergence of a period, and ln e^2 at every impact. */
static double sum_of_exponents(const section_attractor *f) {
  return -DAMPING * two_pi / frequency + 2 * log(restitution) * f->attractor.impacts;
}

/* How far beyond the wall the smooth motion goes is d: the middles of the windows of the map beside grazing are here
 * values of mu. */
static double middle_of_window(size_t period) {
  static const double rest[2] = {0};
  forced_oscillator o;
  forced_oscillator_init(&o);
  o.lattice.on_site.damping = DAMPING;
  ric_family_problem problem = forced_oscillator_problem(&o, 0, 1, frequency);
  ric_family_options options = grazing_family_options(0.5, 60, 5);
  grazing_family at = grazing_family_from(&problem, &options, 0.5, rest, rest + 1, NULL, two_pi / frequency);
  grazing_family_find(&at);
  ric_grazing_map map = grazing_family_map(&at, NULL);
  ric_grazing_window window;
  assert_int_equal(ric_grazing_window_find(&map, period, &window, NULL), RIC_OK);
  assert_true(window.exists);
  ric_grazing_map_clear(&map);
  grazing_family_clear(&at);
  forced_oscillator_clear(&o);
  return sqrt(window.low.d * window.high.d);
}

static void windows_have_their_periods(void **state) {
  (void)state;
  static section_attractor f;
  for (size_t n = 7; n <= 12; n++) {
    ric_system *system = oscillator(middle_of_window(n));
    ric_motion_section_options section = strobes();
    ric_attractor_options options = section_attractor_options(2000, 10 * n + 3); /* no whole periods */
    f.z[0] = f.z[1] = 0;
    section_run_on(system, &section, &options, &f);
    assert_int_equal(f.attractor.kind, RIC_ATTRACTOR_PERIODIC);
    assert_int_equal(f.attractor.period, n);
    assert_close(f.attractor.impacts, 1.0 / (double)n, 1e-15);
    assert_int_equal(f.attractor.iterates, options.transient + options.measure);
    ric_system_destroy(&system);
  }
}

static void exponents_sum_to_divergence_and_losses(void **state) {
  (void)state;
  static const double mus[] = {3e-3, 6e-4, 2e-5};
  static section_attractor f;
  for (size_t i = 0; i < 3; i++) {
    ric_system *system = oscillator(mus[i]);
    ric_motion_section_options section = strobes();
    ric_attractor_options options = section_attractor_options(500, 1500);
    options.exponents = 2;
    f.z[0] = f.z[1] = 0;
    section_run_on(system, &section, &options, &f);
    assert_true(f.attractor.impacts > 0.05);
    assert_true(f.exponents[0] > f.exponents[1]);
    assert_close(f.exponents[0] + f.exponents[1], sum_of_exponents(&f), 1e-9);
    ric_system_destroy(&system);
  }
}

/* Logarithm of the larger modulus of the multipliers of the motion with one impact in n periods: the smaller one is
 * lost in its rounding. */
static double log_of_multiplier(ric_system *system, const double *after, size_t n) {
  static const size_t wall = 0;
  ric_shooting_problem problem = {
      .kind = RIC_MOTION_FORCED, .sequence = &wall, .count = 1, .flow = ric_flow_options_default()};
  shooting_solution s = shooting_solution_of_system(system, &problem);
  ric_multipliers m;
  ric_multiplier_options judge = ric_multiplier_options_default();
  shooting_solution_guess(&s, after, after + 1, after + 2, (double)n * two_pi / frequency);
  shooting_solution_solve(&s);
  assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
  assert_int_equal(ric_multipliers_init(&m, 2, NULL), RIC_OK);
  assert_int_equal(ric_shooting_multipliers(s.shooting, s.z, s.given, &judge, &m, NULL), RIC_OK);
  double logarithm = log(m.largest);
  ric_multipliers_clear(&m);
  shooting_solution_clear(&s); /* and the system */
  return logarithm;
}

static void exponents_of_periodic_motions_are_logarithms_of_multipliers(void **state) {
  (void)state;
  static section_attractor strobe, impact;
  for (size_t n = 7; n <= 9; n++) {
    ric_system *system = oscillator(middle_of_window(n));
    ric_motion_section_options section = strobes();
    ric_attractor_options options = section_attractor_options(2000, 200 * n + 5); /* no whole periods */
    options.exponents = 2;
    strobe.z[0] = strobe.z[1] = 0;
    section_run_on(system, &section, &options, &strobe);
    section.kind = RIC_SECTION_IMPACT;
    options = section_attractor_options(400, 200);
    options.exponents = 2;
    memset(impact.z, 0, sizeof impact.z);
    section_run_on(system, &section, &options, &impact);
    assert_int_equal(impact.attractor.period, 1);
    assert_close(impact.attractor.impacts, 1, 0);
    double expected = log_of_multiplier(system, impact.z, n);
    assert_close(strobe.exponents[0], expected / (double)n, 1e-6);
    assert_close(impact.exponents[0], expected, 1e-6);
  }
}

/* --- linear motions ----------------------------------------------------------------------------------------------- */

/* After 1e5 periods the state has all the digits that it has after a few: time does not take them away. */
static void linear_motions_settle_on_their_steady_response(void **state) {
  (void)state;
  static section_attractor f;
  const double c = 0.5, w = 1.7, phase = 0.3, force = 2, k = 1 - w * w, size = k * k + c * c * w * w;
  const double x = force * (k * cos(two_pi * phase) + c * w * sin(two_pi * phase)) / size;
  const double v = force * w * (c * w * cos(two_pi * phase) - k * sin(two_pi * phase)) / size;
  ric_system *system = section_oscillator(c, w, force, NULL, 0);
  ric_motion_section_options section = ric_motion_section_options_default(two_pi / w);
  ric_attractor_options options = section_attractor_options(100000, 100);
  section.phase = phase;
  options.exponents = 2;
  f.z[0] = 3, f.z[1] = -1;
  section_run_on(system, &section, &options, &f);
  assert_int_equal(f.attractor.period, 1);
  assert_close(f.attractor.impacts, 0, 0);
  for (size_t i = 0; i < options.keep; i++) {
    assert_close(f.states[2 * i], x, 1e-13);
    assert_close(f.states[2 * i + 1], v, 1e-13);
  }
  assert_close(f.exponents[0] + f.exponents[1], -c * two_pi / w, 1e-12);
  assert_close(f.exponents[0], -c * two_pi / w / 2, 0.02); /* bounded over 100 periods */
  ric_system_destroy(&system);
}

/* A time that is no period of the forcing does not send the clock back: the states are those of one long motion. */
static void any_other_period_will_do(void **state) {
  (void)state;
  static section_attractor f;
  const double c = 0.5, w = 1.7, force = 2, k = 1 - w * w, size = k * k + c * c * w * w, period = 1.1;
  ric_system *system = section_oscillator(c, w, force, NULL, 0);
  ric_motion_section_options section = ric_motion_section_options_default(period);
  ric_attractor_options options = section_attractor_options(1000, 200);
  f.z[0] = f.z[1] = 0;
  section_run_on(system, &section, &options, &f);
  assert_int_equal(f.attractor.kind, RIC_ATTRACTOR_APERIODIC);
  for (size_t i = 0; i < options.keep; i++) {
    double angle = w * period * (double)(1001 + i);
    assert_close(f.values[i], force * (k * cos(angle) + c * w * sin(angle)) / size, 1e-12);
  }
  ric_system_destroy(&system);
}

/* --- against plain runs ------------------------------------------------------------------------------------------- */

static ric_system *five_masses(void) {
  static const double push[5] = {0, 2.5, 0, 0, 2.5};
  ric_lattice chain = ric_lattice_default(5, RIC_ENDS_FREE);
  ric_obstacle obstacles[2] = {ric_obstacle_wall(4, 0.5), ric_obstacle_floor(1, -0.6)};
  obstacles[0].restitution = obstacles[1].restitution = 0.7;
  chain.on_site.damping = 0.1;
  chain.link.linear = 0.6;
  chain.force_cos = push;
  chain.frequency = 1.3;
  return lattice_system(&chain, obstacles, 2);
}

static const double five_q[5] = {0.1, -0.2, 0, 0.3, 0.2}, five_u[5] = {0};

static void start_five(section_attractor *f) {
  memset(f->z, 0, sizeof f->z);
  memcpy(f->z, five_q, sizeof five_q);
}

/* The k-th state is that of a run to its time. @returns the impacts on the way */
static size_t check_strobe(const ric_system *system, const double *z, double time) {
  recorded_run r = record_run(system, NULL, five_q, five_u, time);
  for (size_t i = 0; i < 5; i++) {
    assert_close(z[i], r.q[i], 1e-8);
    assert_close(z[5 + i], r.u[i], 1e-8);
  }
  size_t impacts = recorded_run_impacts(&r);
  recorded_run_clear(&r);
  return impacts;
}

static void strobes_are_states_of_the_plain_motion(void **state) {
  (void)state;
  enum { KEPT = 12 };
  static section_attractor f;
  double period = two_pi / 1.3, sum = 0;
  size_t impacts = 0;
  ric_system *system = five_masses();
  ric_motion_section_options section = ric_motion_section_options_default(period);
  ric_attractor_options options = section_attractor_options(0, KEPT);
  options.observe = 4;
  options.exponents = 10;
  start_five(&f);
  section_run_on(system, &section, &options, &f);
  for (size_t k = 0; k < KEPT; k++) {
    impacts = check_strobe(system, f.states + 10 * k, period * (double)(k + 1));
    assert_close(f.values[k], f.states[10 * k + 4], 0);
  }
  assert_true(impacts > 5);
  assert_close(f.attractor.impacts * KEPT, (double)impacts, 1e-12);
  for (size_t k = 0; k < 10; k++)
    sum += f.exponents[k];
  assert_close(sum, -5 * 0.1 * period + 2 * log(0.7) * f.attractor.impacts, 1e-8);
  ric_system_destroy(&system);
}

static void check_impact(const double *z, const ric_event *e, double period) {
  double side = e->obstacle == 0 ? -1 : 1;
  assert_close(z[10], fmod(e->time, period), 1e-7);
  assert_close(z[e->coordinate], e->obstacle == 0 ? 0.5 : -0.6, 1e-12);
  assert_close(side * z[5 + e->coordinate], e->gap_rate_end, 1e-7);
}

static void check_impacts(size_t obstacle) {
  enum { KEPT = 8 };
  static section_attractor f;
  double period = two_pi / 1.3;
  ric_system *system = five_masses();
  ric_motion_section_options section = ric_motion_section_options_default(period);
  ric_attractor_options options = section_attractor_options(0, KEPT);
  section.kind = RIC_SECTION_IMPACT;
  section.obstacle = obstacle;
  options.observe = 10;
  start_five(&f);
  section_run_on(system, &section, &options, &f);
  recorded_run r = record_run(system, NULL, five_q, five_u, 150);
  size_t seen = 0, all = 0;
  for (size_t i = 0; i < r.count && seen < KEPT; i++) {
    const ric_event *e = &r.events[i];
    all += ric_event_jumps(e) ? 1 : 0;
    if (ric_event_jumps(e) && (obstacle == SIZE_MAX || e->obstacle == obstacle))
      check_impact(f.states + 11 * seen++, e, period);
  }
  assert_int_equal(seen, KEPT);
  assert_close(f.attractor.impacts * KEPT, (double)all, 1e-12);
  recorded_run_clear(&r);
  ric_system_destroy(&system);
}

static void impact_sections_see_the_events_of_the_plain_motion(void **state) {
  (void)state;
  check_impacts(0);
  check_impacts(1);
  check_impacts(SIZE_MAX);
}

/* A ball that loses nothing comes back to the floor with the same speed. */
static void autonomous_motions_need_no_period(void **state) {
  (void)state;
  static section_attractor f;
  ric_system *ball = falling_ball(1);
  ric_motion_section_options section = ric_motion_section_options_default(0);
  ric_attractor_options options = section_attractor_options(10, 400);
  section.kind = RIC_SECTION_IMPACT;
  options.exponents = 2;
  options.observe = 1;
  f.z[0] = 0.5, f.z[1] = 0;
  ric_motion_section *s = section_of(ball, &section);
  assert_int_equal(ric_motion_section_size(s), 2);
  section_run(s, &options, &f);
  assert_int_equal(f.attractor.period, 1);
  assert_close(f.attractor.impacts, 1, 0);
  assert_close(f.z[0], 0, 1e-13);
  assert_close(f.z[1], 1, 1e-11);
  assert_close(f.exponents[0] + f.exponents[1], 0, 1e-9);
  assert_close(f.exponents[0], 0, 0.05); /* neighbours part in proportion to time */
  ric_motion_section_destroy(&s);
  ric_system_destroy(&ball);
}

/* --- what is kept ------------------------------------------------------------------------------------------------- */

static void what_is_kept_follows_the_transient(void **state) {
  (void)state;
  static section_attractor all, late;
  ric_system *system = oscillator(middle_of_window(7));
  ric_motion_section_options section = strobes();
  ric_attractor_options whole = section_attractor_options(0, 330), some = section_attractor_options(300, 30);
  some.keep = 20;
  all.z[0] = all.z[1] = late.z[0] = late.z[1] = 0;
  late.values[20] = 17;
  section_run_on(system, &section, &whole, &all);
  section_run_on(system, &section, &some, &late);
  for (size_t k = 0; k < 20; k++)
    assert_close(late.values[k], all.values[300 + k], 1e-10);
  assert_close(late.values[20], 17, 0);
  for (size_t i = 0; i < 2; i++)
    assert_close(late.z[i], all.states[2 * 329 + i], 1e-10);
  ric_system_destroy(&system);
}

static void compare_bits(const section_attractor *a, const section_attractor *b, size_t states, size_t exponents) {
  assert_memory_equal(a->states, b->states, states * sizeof(double));
  assert_memory_equal(a->exponents, b->exponents, exponents * sizeof(double));
}

static void results_are_the_same_bits_again(void **state) {
  (void)state;
  static section_attractor first, again, fresh;
  ric_system *system = oscillator(3e-3);
  ric_motion_section_options section = strobes();
  ric_attractor_options options = section_attractor_options(300, 300), others = section_attractor_options(17, 100);
  ric_motion_section *s = section_of(system, &section);
  options.exponents = 2;
  memset(first.z, 0, sizeof first.z);
  memset(again.z, 0, sizeof again.z);
  memset(fresh.z, 0, sizeof fresh.z);
  section_run(s, &options, &first);
  section_run(s, &others, &again);
  memset(again.z, 0, sizeof again.z);
  section_run(s, &options, &again);
  section_run_on(system, &section, &options, &fresh);
  compare_bits(&first, &again, 600, 2);
  compare_bits(&first, &fresh, 600, 2);
  ric_motion_section_destroy(&s);
  ric_system_destroy(&system);
}

static void runs_allocate_nothing_the_second_time(void **state) {
  (void)state;
#ifdef ALLOCATIONS_ARE_COUNTED
  static section_attractor f;
  ric_system *system = oscillator(3e-3);
  ric_motion_section_options section = strobes();
  ric_attractor_options options = section_attractor_options(100, 200);
  ric_motion_section *s = section_of(system, &section);
  options.exponents = 2;
  for (int k = 0; k < 2; k++) {
    f.z[0] = f.z[1] = 0;
    size_t before = allocations;
    watching = k > 0;
    section_run(s, &options, &f);
    watching = false;
    assert_true(k == 0 || allocations == before);
  }
  ric_motion_section_destroy(&s);
  ric_system_destroy(&system);
#else
  skip();
#endif
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(windows_have_their_periods),
      cmocka_unit_test(exponents_sum_to_divergence_and_losses),
      cmocka_unit_test(exponents_of_periodic_motions_are_logarithms_of_multipliers),
      cmocka_unit_test(linear_motions_settle_on_their_steady_response),
      cmocka_unit_test(any_other_period_will_do),
      cmocka_unit_test(strobes_are_states_of_the_plain_motion),
      cmocka_unit_test(impact_sections_see_the_events_of_the_plain_motion),
      cmocka_unit_test(autonomous_motions_need_no_period),
      cmocka_unit_test(what_is_kept_follows_the_transient),
      cmocka_unit_test(results_are_the_same_bits_again),
      cmocka_unit_test(runs_allocate_nothing_the_second_time),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
