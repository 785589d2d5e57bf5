/* Grazing motions of any size and speed, and of any phase: x'' + 3 x' + x = a cos(w t + phase) before a wall, whose
 * coefficients are known in closed form and do not depend on the unit of length. */
#include "support.h"

#include <ricochet/ricochet.h>

static const double two_pi = 6.283185307179586;
static const double damping = 3;

typedef struct driven {
  ric_lattice lattice;
  ric_system *system;
  double phase, cosine, sine;
  ric_family *family;
  ric_grazing grazing;
} driven;

static ric_status set_force(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  driven *d = user;
  d->cosine = p[0] * cos(d->phase);
  d->sine = -p[0] * sin(d->phase);
  *given = two_pi / d->lattice.frequency;
  return ric_system_set_lattice(system, &d->lattice, error);
}

/* The force at which the amplitude is 1. */
static double stiffness(double frequency) {
  return hypot(1 - frequency * frequency, damping * frequency);
}

/* The motion that grazes a wall at `size`; at zero phase of the force it does so at the time `lag`. */
static void graze(driven *d, double size, double frequency, double phase) {
  const double grazing = size * stiffness(frequency), guess[2] = {0.1 * size};
  ric_obstacle wall = ric_obstacle_wall(0, size);
  ric_error error;
  double z[2];
  wall.restitution = 0.8;
  *d = (driven){.lattice = ric_lattice_default(1, RIC_ENDS_FREE), .phase = phase};
  d->lattice.on_site = (ric_spring){1, 0, 0, damping};
  d->lattice.force_cos = &d->cosine;
  d->lattice.force_sin = &d->sine;
  d->lattice.frequency = frequency;
  assert_int_equal(ric_system_create_lattice(&d->lattice, &wall, 1, &d->system, NULL), RIC_OK);
  const ric_family_problem problem = {.system = d->system,
                                      .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                      .set = set_force,
                                      .user = d,
                                      .parameters = 1};
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.p_low = grazing / 3;
  options.curve.p_high = 2 * grazing;
  options.curve.step = options.curve.step_most = grazing / 7;
  options.curve.step_least = 1e-3 * grazing;
  assert_int_equal(ric_family_create(&problem, &options, &d->family, NULL), RIC_OK);
  assert_int_equal(ric_grazing_init(&d->grazing, ric_family_shooting(d->family), NULL), RIC_OK);
  if (ric_family_start(d->family, grazing / 2, guess, guess + 1, NULL, two_pi / frequency, z, NULL, &error) != RIC_OK ||
      ric_grazing_find(d->family, z, grazing / 2, NULL, &d->grazing, &error) != RIC_OK)
    fail_msg("size %g, frequency %g, phase %g: %s", size, frequency, phase, error.message);
}

static void clear(driven *d) {
  ric_grazing_clear(&d->grazing);
  ric_family_destroy(&d->family);
  ric_system_destroy(&d->system);
}

/* exp(A t) v of x'' + 3 x' + x = 0. */
static void decay(double t, const double *v, double *moved) {
  const double root = sqrt(damping * damping / 4 - 1), slow = -damping / 2 + root, fast = -damping / 2 - root;
  const double a = (v[1] - fast * v[0]) / (slow - fast), b = v[0] - a;
  moved[0] = a * exp(slow * t) + b * exp(fast * t);
  moved[1] = a * slow * exp(slow * t) + b * fast * exp(fast * t);
}

/* xi = (0, -1.8) and kappa = 2 DF xi at the touch, brought to a stroboscopic section by the linear motion. */
static void check_map(driven *d, double time) {
  const ric_grazing *g = &d->grazing;
  const ric_grazing_plane plane = {.time = time};
  const double after = time > g->time ? time - g->time : time - g->time + g->period;
  const double xi[2] = {0, -1.8}, kappa[2] = {2 * xi[1], -2 * damping * xi[1]};
  double expected[2];
  ric_error error;
  ric_grazing_map map;
  assert_int_equal(ric_grazing_map_init(&map, 2, NULL), RIC_OK);
  if (ric_grazing_section(d->family, g, &plane, &map, NULL, &error) != RIC_OK)
    fail_msg("%s", error.message);
  decay(after, xi, expected);
  for (int i = 0; i < 2; i++)
    assert_close(map.xi[i], expected[i], 1e-11);
  decay(after, kappa, expected);
  for (int i = 0; i < 2; i++)
    assert_close(map.kappa[i], expected[i], 2e-7);
  ric_grazing_map_clear(&map);
}

static void the_unit_of_length_does_not_matter(void **state) {
  (void)state;
  for (double size = 1e-6; size < 2e3; size *= 1e3) {
    driven d;
    graze(&d, size, 4, 0);
    assert_close(d.grazing.parameter / (size * stiffness(4)), 1, 3e-14);
    assert_close(d.grazing.slope * stiffness(4), -1, 1e-9);
    assert_close(d.grazing.local.acceleration / size, 16, 1e-10);
    for (int k = 0; k < 5; k++)
      check_map(&d, 0.3 * k);
    clear(&d);
  }
}

/* The speed of the state, (x', x'', 1), leaves the last one far behind. */
static void fast_motions_cross_stroboscopic_sections(void **state) {
  (void)state;
  driven d;
  ric_error error;
  ric_grazing_map map;
  graze(&d, 1, 2e4, 0);
  assert_int_equal(ric_grazing_map_init(&map, 2, NULL), RIC_OK);
  if (ric_grazing_section(d.family, &d.grazing, NULL, &map, NULL, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_close(map.stretch / (sqrt(2) * 2e4), 1, 1e-6);
  ric_grazing_map_clear(&map);
  clear(&d);
}

/* The motion is cos(w t + phase - lag). */
static void touches_at_the_ends_of_the_period_are_found(void **state) {
  (void)state;
  const double lag = atan2(4 * damping, 1 - 16.0);
  static const double late[] = {0, 1e-16, -1e-16, 1e-15, -1e-15, 1e-14, -1e-14, 1e-13, -1e-13, 1e-11, -1e-11, 1e-3};
  for (size_t k = 0; k < sizeof late / sizeof *late; k++) {
    driven d;
    graze(&d, 1, 4, lag + late[k]);
    const ric_grazing *g = &d.grazing;
    assert_true(g->time >= 0 && g->time < g->period);
    assert_close(remainder(g->time + late[k] / 4, g->period), 0, 1e-12);
    assert_close(g->parameter / stiffness(4), 1, 3e-14);
    check_map(&d, g->time);
    check_map(&d, 0.7);
    clear(&d);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_unit_of_length_does_not_matter),
                                     cmocka_unit_test(fast_motions_cross_stroboscopic_sections),
                                     cmocka_unit_test(touches_at_the_ends_of_the_period_are_found)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
