/* Symmetry images of a pattern have the image orbit. */
#include "support.h"

#include "witness/solved_orbit.h"

/* State of a particle at an instant: just after t = 0, or just before T/2. */
typedef struct place {
  double q, v, q_half, v_half, impulse;
} place;

static place place_of(const solved_orbit *x, size_t i) {
  const ric_orbit *o = &x->orbit;
  return (place){
      .q = o->q[i], .v = o->v[i], .q_half = o->q_half[i], .v_half = o->v_half[i], .impulse = impulse_of(x, i)};
}

/* The same motion half a period later: what was before T/2 is, reversed, after the new t = 0, and the other way round.
 */
static place exchanged(place p) {
  return (place){.q = p.q_half, .v = -p.v_half, .q_half = p.q, .v_half = -p.v, .impulse = p.impulse};
}

static void compare_image(const solved_orbit *x, ric_symmetry symmetry) {
  scenario image = {.chain = x->scenario.chain, .period = x->scenario.period};
  size_t n = x->orbit.particles;
  assert_int_equal(ric_pattern_image(x->scenario.pattern, image.chain.ends, symmetry, &image.pattern, NULL), RIC_OK);
  solved_orbit y = solve_orbit(RIC_METHOD_IMPULSE, image);
  double tolerance =
      1e-13 * fmax(1, x->orbit.condition) * fmax(1, solved_orbit_scale(x)) * ric_chain_frequency_max(&image.chain);
  assert_int_equal(y.orbit.outcome, x->orbit.outcome);
  for (size_t i = 0; i < n && solved_orbit_has_state(x); i++) {
    place a = place_of(x, i), b = place_of(&y, ((symmetry.reflect ? n - 1 - i : i) + symmetry.shift) % n);
    if (symmetry.exchange)
      a = exchanged(a);
    assert_close(b.q, a.q, tolerance);
    assert_close(b.v, a.v, tolerance);
    assert_close(b.q_half, a.q_half, tolerance);
    assert_close(b.v_half, a.v_half, tolerance);
    assert_close(b.impulse, a.impulse, tolerance);
  }
  if (solved_orbit_has_state(x) && x->orbit.clearance_particle >= 0)
    assert_close(y.orbit.clearance, x->orbit.clearance, tolerance);
  solved_orbit_clear(&y);
}

static void images_of_a_pattern_have_the_image_orbit(void **state) {
  (void)state;
  random_source source = {.state = 4};
  scenario_ranges ranges = {.most_particles = 20, .highest_gamma = 1, .shortest_period = 2, .longest_period = 6.5};
  for (int k = 0; k < 100; k++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_random(&source, &ranges));
    size_t n = x.orbit.particles, shift = x.scenario.chain.ends == RIC_ENDS_PERIODIC ? random_below(&source, n) : 0;
    for (int image = 1; image < 4; image++)
      compare_image(&x, (ric_symmetry){.shift = shift, .reflect = image & 1, .exchange = image & 2});
    compare_image(&x, (ric_symmetry){.shift = shift});
    solved_orbit_clear(&x);
  }
}

/* Equivalent patterns may be solved once: through their representative. */
static void representatives_have_the_same_outcome_and_energy(void **state) {
  (void)state;
  random_source source = {.state = 5};
  scenario_ranges ranges = {.most_particles = 16, .highest_gamma = 0.8, .shortest_period = 3, .longest_period = 6};
  for (int k = 0; k < 100; k++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_random(&source, &ranges));
    ric_symmetry symmetry;
    assert_int_equal(ric_pattern_reduce(x.scenario.pattern, x.scenario.chain.ends, &symmetry, NULL), RIC_OK);
    compare_image(&x, symmetry);
    solved_orbit_clear(&x);
  }
}

static void order_of_the_particles_in_a_pattern_orders_the_impulses_only(void **state) {
  (void)state;
  const size_t sorted[] = {1, 4, 6}, shuffled[] = {6, 1, 4}, half[] = {3};
  scenario a = {.chain = ric_chain_default(8, 0.1), .period = 5}, b = a;
  assert_int_equal(ric_pattern_create(8, sorted, 3, half, 1, &a.pattern, NULL), RIC_OK);
  assert_int_equal(ric_pattern_create(8, shuffled, 3, half, 1, &b.pattern, NULL), RIC_OK);
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, a), y = solve_orbit(RIC_METHOD_IMPULSE, b);
  for (size_t i = 0; i < 8; i++) {
    assert_close(x.orbit.q[i], y.orbit.q[i], 0);
    assert_close(impulse_of(&x, i), impulse_of(&y, i), 0);
  }
  assert_close(y.orbit.impulse[0], x.orbit.impulse[2], 0);
  assert_close(y.orbit.impulse[1], x.orbit.impulse[0], 0);
  solved_orbit_clear(&x);
  solved_orbit_clear(&y);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(images_of_a_pattern_have_the_image_orbit),
      cmocka_unit_test(representatives_have_the_same_outcome_and_energy),
      cmocka_unit_test(order_of_the_particles_in_a_pattern_orders_the_impulses_only),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
