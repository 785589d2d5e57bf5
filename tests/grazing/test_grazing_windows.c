/* Windows of d in which one-impact orbits of the map beside grazing are admissible and stable. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/grazing_maps.h"

enum { MOST_SIZE = 6 };

static ric_grazing_window window_of(const ric_grazing_map *map, size_t period) {
  ric_grazing_window window;
  ric_error error = {0};
  if (ric_grazing_window_find(map, period, &window, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_int_equal(window.period, period);
  return window;
}

static double modulus(ric_complex z) {
  return hypot(z.re, z.im);
}

/* --- windows of the example --------------------------------------------------------------------------------------- */

static double border_of(double lambda, double n) {
  double bracket = 1 - pow(lambda, n - 2) * (3 - 2 * lambda);
  return (1 - lambda) * pow(lambda, 2 * (n - 2)) / (bracket * bracket);
}

static double flip_of(double lambda, double n) {
  double c = pow(lambda, n - 1), s = c / 2 / (1 - 3 * c);
  return (s * s * (1 + 3 * c) + c * s) / (1 - c * lambda);
}

/* The flip comes before the border, going down from there, where lambda^(n-1) < (2 - 3 lambda) / (3 - 4 lambda). */
static bool example_has_window(double lambda, double n) {
  return lambda < 2.0 / 3 && pow(lambda, n - 1) < fmin(1.0 / 3, (2 - 3 * lambda) / (3 - 4 * lambda));
}

static void check_example(double lambda, double omega, size_t n) {
  ric_grazing_map map = example_map(lambda, omega);
  ric_grazing_window w = window_of(&map, n);
  assert_int_equal(w.exists, example_has_window(lambda, (double)n));
  if (w.exists) {
    assert_int_equal(w.low.kind, RIC_EDGE_FLIP);
    assert_close(w.low.d / flip_of(lambda, (double)n), 1, 1e-13);
    bool is_open = pow(lambda, (double)n - 2) * (3 - 2 * lambda) >= 1;
    assert_int_equal(w.high.kind, is_open ? RIC_EDGE_OPEN : RIC_EDGE_BORDER);
    assert_int_equal(w.high.iterate, is_open ? 0 : n - 1);
    if (!is_open)
      assert_close(w.high.d / border_of(lambda, (double)n), 1, 1e-13);
  }
  ric_grazing_map_clear(&map);
}

static void windows_of_the_example_have_their_closed_edges(void **state) {
  (void)state;
  random_source source = {13};
  for (int k = 0; k < 300; k++) {
    double lambda = random_uniform(&source, 0.02, 0.72);
    check_example(lambda, lambda * random_uniform(&source, 0.01, 0.99), 2 + random_below(&source, 40));
  }
  ric_grazing_map map = example_map(0.5, 0.3);
  assert_close(window_of(&map, 5).high.d, 1.0 / 72, 1e-16);
  assert_close(window_of(&map, 4).low.d, 0.028, 1e-16);
  ric_grazing_map_clear(&map);
}

/* Windows n and n + 1 overlap as d tends to 0 below lambda = 1/4; chaos parts them above. */
static void windows_of_the_example_overlap_below_a_quarter(void **state) {
  (void)state;
  static const double lambdas[] = {0.1, 0.2, 0.24, 0.26, 0.3, 0.5, 0.6};
  for (size_t i = 0; i < 7; i++) {
    ric_grazing_map map = example_map(lambdas[i], lambdas[i] / 2);
    for (size_t n = 6; n < 20; n++)
      assert_int_equal(window_of(&map, n).low.d < window_of(&map, n + 1).high.d, lambdas[i] < 0.25);
    ric_grazing_map_clear(&map);
  }
}

static void the_example_has_no_window_above_two_thirds(void **state) {
  (void)state;
  for (double lambda = 0.67; lambda < 0.99; lambda += 0.02) {
    ric_grazing_map map = example_map(lambda, 0.3);
    for (size_t n = 1; n <= 200; n += n < 40 ? 1 : 40)
      assert_false(window_of(&map, n).exists);
    ric_grazing_map_clear(&map);
  }
}

static void windows_scale_with_lambda_squared(void **state) {
  (void)state;
  static const double lambdas[] = {0.15, 0.35, 0.5, 0.62};
  for (size_t i = 0; i < 4; i++) {
    double lambda = lambdas[i];
    ric_grazing_map map = example_map(lambda, lambda / 3);
    for (size_t n = 12; n < 40; n += 3) {
      ric_grazing_window w = window_of(&map, n), next = window_of(&map, n + 1);
      double off = 20 * pow(lambda, (double)n - 2); /* the brackets of the closed forms */
      assert_close(next.low.d / w.low.d / (lambda * lambda), 1, off + 1e-14);
      assert_close(next.high.d / w.high.d / (lambda * lambda), 1, off + 1e-14);
    }
    ric_grazing_map_clear(&map);
  }
}

/* How far P^n carries a state beside the impact of an orbit, of this d, away from it in so many rounds. */
static double strays(const ric_grazing_map *map, size_t n, double d, const double *z, size_t rounds) {
  double x[3] = {z[0] * (1 + 1e-7), z[1], z[2]}, work[3];
  map_iterate(map, d, x, n * rounds, work);
  return relative_distance(x, z, 3);
}

static void motion_stays_in_a_window_and_leaves_beside_it(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  for (size_t n = 4; n <= 9; n++) {
    ric_grazing_window w = window_of(&map, n);
    for (double part = 0.01; part < 1; part += 0.07) {
      double z[3], d = w.low.d + part * (w.high.d - w.low.d);
      ric_grazing_cycle cycles[2];
      size_t count;
      assert_int_equal(ric_grazing_cycles(&map, n, d, cycles, &count, NULL), RIC_OK);
      assert_int_equal(count, 1);
      cycle_of(&map, n, cycles[0].y, z);
      assert_close(strays(&map, n, d, z, 2000), 0, 1e-9);
    }
    double z[3];
    ric_grazing_cycle c = cycle_of(&map, n, w.low.y * (1 - 1e-2), z);
    assert_true(c.admissible && !c.stable && c.largest.re < -1 && c.largest.im == 0);
    assert_true(strays(&map, n, c.d, z, 2000) > 1e-2);
    c = cycle_of(&map, n, w.high.y * (1 + 1e-2), z);
    assert_true(!c.admissible && c.nearest == n - 1);
    assert_true(strays(&map, n, c.d, z, 1) > 1e-3);
  }
  ric_grazing_map_clear(&map);
}

/* --- windows of random maps --------------------------------------------------------------------------------------- */

static void check_edge(const ric_grazing_map *map, size_t n, const ric_grazing_edge *edge) {
  if (edge->kind == RIC_EDGE_ZERO || edge->kind == RIC_EDGE_OPEN)
    return;
  ric_grazing_cycle c = cycle_of(map, n, edge->y, NULL);
  double size = fabs(c.d) + c.y * c.y;
  assert_close(edge->d, c.d, 0);
  switch (edge->kind) {
  case RIC_EDGE_BORDER:
    assert_int_equal(edge->iterate, c.nearest);
    assert_close(c.clearance, 0, 1e-12 * (size + c.y));
    break;
  case RIC_EDGE_FLIP:
    assert_close(hypot(c.largest.re + 1, c.largest.im), 0, 1e-10);
    break;
  case RIC_EDGE_FOLD:
    assert_close(hypot(c.largest.re - 1, c.largest.im), 0, 1e-10);
    break;
  default:
    assert_true(c.largest.im > 0);
    assert_close(modulus(c.largest), 1, 1e-11);
  }
}

static bool is_good(const ric_grazing_map *map, size_t n, double y) {
  ric_grazing_cycle c = cycle_of(map, n, y, NULL);
  return c.admissible && c.stable;
}

enum { SAMPLES = 300 };

/* Whether y, which is not next to an edge, lies in a window. */
static bool holds(const ric_grazing_window *w, double y) {
  double low = fmin(w->low.y, w->high.y), high = fmax(w->low.y, w->high.y);
  return w->exists && y > low && y < high;
}

static double width(const ric_grazing_map *map, size_t n, double low, double high) {
  double a = cycle_of(map, n, low, NULL).d, b = cycle_of(map, n, high, NULL).d;
  return a * b > 0 ? fabs(log(b / a)) : 0;
}

/* Orbits along y: all those in the window are good, and no run of good ones beside it is wider. */
static void check_against_samples(const ric_grazing_map *map, size_t n, const ric_grazing_window *w) {
  double from = NAN, before = NAN;
  double found = w->exists && w->low.d * w->high.d > 0 ? log(w->high.d / w->low.d) : INFINITY;
  found = w->exists ? fabs(found) : 0;
  for (int k = 0; k < SAMPLES; k++) {
    double y = exp(-9 + 12 * (k + 0.5) / SAMPLES);
    bool good = is_good(map, n, y);
    if (holds(w, y))
      assert_true(good);
    if (!good || holds(w, y)) {
      from = NAN;
      continue;
    }
    assert_true(w->exists);
    from = isnan(from) ? y : from;
    before = y;
    assert_true(width(map, n, from, before) <= found);
  }
}

static void windows_of_random_maps_hold_what_they_say(void **state) {
  (void)state;
  random_source source = {14};
  size_t kinds[RIC_GRAZING_EDGES] = {0}, windows = 0;
  for (size_t k = 0; k < 400; k++) {
    size_t n = 1 + random_below(&source, 5);
    ric_grazing_map map = random_map(&source, 1 + k % MOST_SIZE, random_uniform(&source, 0.3, 0.99));
    ric_grazing_window w = window_of(&map, n);
    if (w.exists) {
      assert_true(w.low.d < w.high.d);
      check_edge(&map, n, &w.low);
      check_edge(&map, n, &w.high);
      kinds[w.low.kind]++;
      kinds[w.high.kind]++;
      windows++;
      double low = fmin(w.low.y, w.high.y), high = fmax(w.low.y, w.high.y);
      if (low > 0)
        assert_false(is_good(&map, n, low * (1 - 1e-6)));
      if (high < INFINITY)
        assert_false(w.low.kind != RIC_EDGE_FOLD && w.high.kind != RIC_EDGE_FOLD &&
                     is_good(&map, n, high * (1 + 1e-6)));
    }
    check_against_samples(&map, n, &w);
    ric_grazing_map_clear(&map);
  }
  print_message("%zu windows; edges:", windows);
  for (int kind = 0; kind < RIC_GRAZING_EDGES; kind++)
    print_message(" %s %zu", ric_grazing_edge_name((ric_grazing_edge_kind)kind), kinds[kind]);
  print_message("\n");
  assert_true(kinds[RIC_EDGE_BORDER] > 10 && kinds[RIC_EDGE_FLIP] > 10 && kinds[RIC_EDGE_FOLD] > 10);
  assert_true(kinds[RIC_EDGE_COMPLEX] > 10);
}

/* Of a map of size 1: the fold of d = 3/4 y^2 - y, and with L = 0 every orbit of period 2 down to y = 0. */
static void windows_end_at_folds_and_at_0(void **state) {
  (void)state;
  ric_grazing_map map = map_of_size_1(0.5, -0.5, -0.125);
  ric_grazing_window w = window_of(&map, 1);
  assert_true(w.exists && w.low.kind == RIC_EDGE_FOLD && w.high.kind == RIC_EDGE_OPEN);
  assert_close(w.low.d, -1.0 / 3, 1e-15);
  assert_close(w.low.y, 2.0 / 3, 1e-15);
  assert_true(w.high.d == INFINITY && w.high.y == INFINITY);
  ric_grazing_map_clear(&map);
  map = map_of_size_1(0, 1, 0.5);
  w = window_of(&map, 2);
  assert_true(w.exists && w.low.kind == RIC_EDGE_ZERO && w.high.kind == RIC_EDGE_BORDER);
  assert_true(w.low.d == 0 && w.low.y == 0 && w.high.iterate == 1);
  assert_close(w.high.d, 4, 1e-15);
  ric_grazing_map_clear(&map);
}

static void nothing_depends_on_coordinates(void **state) {
  (void)state;
  random_source source = {15};
  size_t windows = 0;
  for (size_t k = 0; k < 200; k++) {
    size_t n = 1 + random_below(&source, 5);
    ric_grazing_map map = random_map(&source, 1 + k % MOST_SIZE, random_uniform(&source, 0.3, 0.9));
    ric_grazing_window w = window_of(&map, n), other;
    ric_grazing_cycle c = cycle_of(&map, n, 0.3, NULL), changed;
    map_change_coordinates(&map, &source);
    other = window_of(&map, n);
    changed = cycle_of(&map, n, 0.3, NULL);
    assert_close(changed.d, c.d, 1e-11 * (fabs(c.d) + 1));
    if (n > 1)
      assert_close(changed.clearance, c.clearance, 1e-11 * (fabs(c.clearance) + 1));
    assert_close(modulus(changed.largest), modulus(c.largest), 1e-9 * (modulus(c.largest) + 1));
    assert_int_equal(w.exists, other.exists);
    if (w.exists) {
      windows++;
      assert_int_equal(w.low.kind, other.low.kind);
      assert_int_equal(w.high.kind, other.high.kind);
      if (isfinite(w.high.d))
        assert_close(other.high.d, w.high.d, 1e-10 * (fabs(w.high.d) + 1));
      if (isfinite(w.low.d))
        assert_close(other.low.d, w.low.d, 1e-10 * (fabs(w.low.d) + 1));
    }
    ric_grazing_map_clear(&map);
  }
  assert_true(windows > 20);
}

/* --- refusals ----------------------------------------------------------------------------------------------------- */

static void bad_arguments_are_refused(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  ric_grazing_window window;
  ric_error error;
  assert_int_equal(ric_grazing_window_find(&map, 0, &window, &error), RIC_EINVAL);
  assert_string_equal(error.message, "period = 0, expected 1 to 10000");
  map.L[4] = NAN;
  assert_int_equal(ric_grazing_window_find(&map, 4, &window, &error), RIC_EINVAL);
  assert_string_equal(error.message, "L[1][1] = nan, expected a finite number");
  ric_grazing_map_clear(&map);
}

static void singular_and_overflowing_maps_are_told(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 1); /* L^6 has the eigenvalue -1 */
  ric_grazing_window window;
  ric_error error;
  assert_int_equal(ric_grazing_window_find(&map, 6, &window, &error), RIC_ENUMERIC);
  assert_string_equal(error.message, "period = 6: I + L^n is singular");
  ric_grazing_map_clear(&map);
  map = example_map(2, 0.3);
  assert_int_equal(ric_grazing_window_find(&map, 2000, &window, &error), RIC_ENUMERIC);
  assert_string_equal(error.message, "period = 2000: L^n overflows");
  ric_grazing_map_clear(&map);
}

/* Long periods of a slow map are no harder; those whose d is below the smallest double have no window. */
static void long_periods_keep_their_accuracy(void **state) {
  (void)state;
  check_example(0.5, 0.3, 300);
  check_example(0.65, 0.3, 500);
  check_example(0.9, 0.3, 5000);
  ric_grazing_map map = example_map(0.5, 0.3);
  assert_false(window_of(&map, 10000).exists);
  ric_grazing_map_clear(&map);
}

static void edges_have_names(void **state) {
  (void)state;
  assert_string_equal(ric_grazing_edge_name(RIC_EDGE_BORDER), "border");
  assert_string_equal(ric_grazing_edge_name(RIC_EDGE_OPEN), "open");
  assert_string_equal(ric_grazing_edge_name(RIC_GRAZING_EDGES), "unknown edge");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(windows_of_the_example_have_their_closed_edges),
      cmocka_unit_test(windows_of_the_example_overlap_below_a_quarter),
      cmocka_unit_test(the_example_has_no_window_above_two_thirds),
      cmocka_unit_test(windows_scale_with_lambda_squared),
      cmocka_unit_test(motion_stays_in_a_window_and_leaves_beside_it),
      cmocka_unit_test(windows_of_random_maps_hold_what_they_say),
      cmocka_unit_test(windows_end_at_folds_and_at_0),
      cmocka_unit_test(nothing_depends_on_coordinates),
      cmocka_unit_test(bad_arguments_are_refused),
      cmocka_unit_test(singular_and_overflowing_maps_are_told),
      cmocka_unit_test(long_periods_keep_their_accuracy),
      cmocka_unit_test(edges_have_names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
