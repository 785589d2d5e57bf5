/* Motions that do not come to an attractor on a section, and what is refused. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/recorded_run.h"
#include "section_attractor.h"

static const double two_pi = 6.283185307179586;

static ric_motion_section_options strobes(void) {
  return ric_motion_section_options_default(two_pi / 4);
}

/* Under a wall that its motions touch. */
static ric_system *oscillator(void) {
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  return section_oscillator(3, 4, hypot(15, 12), &wall, 1);
}

/* --- what goes wrong ---------------------------------------------------------------------------------------------- */

static void motions_that_grow_have_diverged(void **state) {
  (void)state;
  static section_attractor f;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  mass.on_site.linear = -1; /* x = e^t: 1e100 after 230 */
  ric_system *system = lattice_system(&mass, NULL, 0);
  ric_motion_section_options section = ric_motion_section_options_default(1);
  ric_attractor_options options = section_attractor_options(200, 100);
  f.z[0] = f.z[1] = 1;
  section_run_on(system, &section, &options, &f);
  assert_int_equal(f.attractor.kind, RIC_ATTRACTOR_DIVERGED);
  assert_int_equal(f.attractor.iterates, 230);
  assert_string_not_equal(f.attractor.reason, "");
  assert_close(f.z[0] / exp(230), 1, 1e-9);
  assert_close(f.values[29] / exp(230), 1, 1e-9);
  assert_true(isnan(f.values[30]) && isnan(f.values[99]) && isnan(f.states[60]));
  assert_close(f.attractor.impacts, 0, 0);
  ric_system_destroy(&system);
}

static void motions_that_cannot_go_on_have_failed(void **state) {
  (void)state;
  static section_attractor f;
  ric_obstacle far = ric_obstacle_wall(0, 50);
  ric_system *system = section_oscillator(0.5, 1.7, 2, &far, 1), *ball = falling_ball(0.5);
  ric_motion_section_options section = ric_motion_section_options_default(two_pi / 1.7);
  ric_attractor_options options = section_attractor_options(10, 10);
  section.kind = RIC_SECTION_IMPACT;
  section.wait = 70;
  memset(f.z, 0, sizeof f.z);
  section_run_on(system, &section, &options, &f);
  assert_int_equal(f.attractor.kind, RIC_ATTRACTOR_FAILED);
  assert_string_equal(f.attractor.reason, "no impact for 70");
  assert_int_equal(f.attractor.iterates, 0);
  assert_true(isnan(f.attractor.impacts) && isnan(f.values[0]));
  section = ric_motion_section_options_default(1);
  section.trajectory.events_per_time = 3;
  f.z[0] = 0.1, f.z[1] = 0;
  section_run_on(ball, &section, &options, &f);
  assert_int_equal(f.attractor.kind, RIC_ATTRACTOR_FAILED);
  assert_memory_equal(f.attractor.reason, "event_limit: ", 13);
  ric_system_destroy(&system);
  ric_system_destroy(&ball);
}

/* The steady motion comes as near to the wall as what counts as grazing: its tangent vectors have no way on, the
 * iterates do. */
static void motions_that_graze_have_no_exponents(void **state) {
  (void)state;
  static section_attractor f;
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  const double c = 3, w = 4, k = 1 - w * w, size = k * k + c * c * w * w, force = (1 - 5e-11) * sqrt(size);
  ric_system *system = section_oscillator(c, w, force, &wall, 1);
  ric_motion_section_options section = ric_motion_section_options_default(two_pi / w);
  ric_attractor_options options = section_attractor_options(5, 30);
  options.exponents = 2;
  f.z[0] = force * k / size;
  f.z[1] = force * w * c * w / size;
  section_run_on(system, &section, &options, &f);
  assert_int_equal(f.attractor.kind, RIC_ATTRACTOR_PERIODIC);
  assert_int_equal(f.attractor.period, 1);
  assert_true(isnan(f.exponents[0]) && isnan(f.exponents[1]));
  for (size_t i = 0; i < options.keep; i++)
    assert_close(f.values[i], force * k / size, 1e-13);
  ric_system_destroy(&system);
}

static int stop_at_once(void *user) {
  (void)user;
  return 1;
}

static void runs_stop_when_asked_to(void **state) {
  (void)state;
  double z[2] = {0};
  ric_attractor a = {.z = z};
  ric_system *system = oscillator();
  ric_motion_section_options section = strobes();
  ric_attractor_options options = section_attractor_options(100, 100);
  ric_motion_section *s = section_of(system, &section);
  options.poll.call = stop_at_once;
  assert_int_equal(ric_motion_section_run(s, &options, &a, NULL), RIC_ESTOPPED);
  options.poll.call = NULL;
  assert_int_equal(ric_motion_section_run(s, &options, &a, NULL), RIC_OK);
  ric_motion_section_destroy(&s);
  ric_system_destroy(&system);
}

/* --- refusals ----------------------------------------------------------------------------------------------------- */

static void refuse(const ric_system *system, const ric_motion_section_options *options, const char *message) {
  ric_motion_section *section = NULL;
  ric_error error = {0};
  assert_int_equal(ric_motion_section_create(system, options, &section, &error), RIC_EINVAL);
  assert_null(section);
  assert_string_equal(error.message, message);
}

static void sections_that_make_no_sense_are_refused(void **state) {
  (void)state;
  ric_system *system = oscillator(), *free_mass = section_oscillator(1, 1, 1, NULL, 0);
  ric_motion_section_options strobe = ric_motion_section_options_default(0), impact = strobes();
  refuse(system, &strobe, "period = 0, expected a finite number > 0");
  strobe.period = NAN;
  refuse(system, &strobe, "period = nan, expected a finite number > 0");
  strobe.period = 1;
  strobe.phase = 1;
  refuse(system, &strobe, "phase = 1, expected 0 <= phase < 1");
  impact.kind = RIC_SECTION_IMPACT;
  refuse(free_mass, &impact, "section = impact, expected a system with obstacles");
  impact.obstacle = 1;
  refuse(system, &impact, "obstacle = 1, expected at most 0");
  impact.obstacle = 0;
  impact.wait = INFINITY;
  refuse(system, &impact, "wait = inf, expected a finite number > 0");
  impact.wait = 1;
  impact.period = -1;
  refuse(system, &impact, "period = -1, expected a finite number > 0 (or 0: none)");
  impact.kind = (ric_section_kind)7;
  refuse(system, &impact, "section = 7, expected strobe or impact");
  ric_system_destroy(&system);
  ric_system_destroy(&free_mass);
}

static void runs_that_make_no_sense_are_refused(void **state) {
  (void)state;
  double z[3] = {2, 0, 0};
  ric_attractor a = {.z = z};
  ric_error error = {0};
  ric_system *system = oscillator();
  ric_motion_section_options options = strobes();
  options.kind = RIC_SECTION_IMPACT;
  ric_motion_section *s = section_of(system, &options);
  ric_attractor_options o = section_attractor_options(1, 1);
  assert_int_equal(ric_motion_section_size(s), 3);
  assert_int_equal(ric_motion_section_run(s, &o, &a, &error), RIC_EINVAL);
  assert_string_equal(error.message, "start: the gap of obstacle 0 (a wall) is -1, expected >= 0");
  z[0] = 0;
  o.exponents = 3;
  assert_int_equal(ric_motion_section_run(s, &o, &a, &error), RIC_EINVAL);
  assert_string_equal(error.message, "exponents = 3, expected at most 2");
  o = section_attractor_options(1, 0);
  assert_int_equal(ric_motion_section_run(s, &o, &a, &error), RIC_EINVAL);
  assert_int_equal(ric_motion_section_set_period(s, NAN, NULL), RIC_EINVAL);
  assert_int_equal(ric_motion_section_set_period(s, 0, NULL), RIC_EINVAL);
  assert_int_equal(ric_motion_section_set_period(s, 2, NULL), RIC_OK);
  ric_motion_section_destroy(&s);
  ric_motion_section_destroy(&s);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(motions_that_grow_have_diverged),
      cmocka_unit_test(motions_that_cannot_go_on_have_failed),
      cmocka_unit_test(motions_that_graze_have_no_exponents),
      cmocka_unit_test(runs_stop_when_asked_to),
      cmocka_unit_test(sections_that_make_no_sense_are_refused),
      cmocka_unit_test(runs_that_make_no_sense_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
