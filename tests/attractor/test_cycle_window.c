/* Windows of cycles along a parameter of the map beside grazing. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/grazing_maps.h"
#include "map_lines.h"

enum { MOST_SIZE = 5 };

static const ric_poll never = {NULL, NULL};

/* --- lines of maps ------------------------------------------------------------------------------------------------ */

/* The example along one of its numbers. */
typedef struct example_line {
  double lambda, omega, d;
  enum { LAMBDA, OMEGA, D } along;
} example_line;

static ric_status example_at(double p, ric_grazing_map *map, double *d, void *user, ric_error *error) {
  const example_line *l = user;
  ric_grazing_map made;
  RIC_TRY(ric_grazing_map_example(&made, l->along == LAMBDA ? p : l->lambda, l->along == OMEGA ? p : l->omega, error));
  map_copy(&made, map);
  ric_grazing_map_clear(&made);
  *d = l->along == D ? p : l->d;
  return RIC_OK;
}

static ric_map_line line_of(example_line *l) {
  return (ric_map_line){.size = 3, .at = example_at, .user = l};
}

/* --- one impact, along d: the closed form ------------------------------------------------------------------------- */

/* Which iterate it is, counted from a state that is `from` iterates after the impact. */
static size_t iterate_from(size_t after_impact, size_t from, size_t period) {
  return (after_impact + period - from) % period;
}

static void check_edge(const ric_cycle_edge *found, const ric_grazing_edge *exact, size_t from, size_t period) {
  assert_int_equal(found->kind, exact->kind);
  assert_close(found->p / exact->d, 1, 1e-12);
  if (exact->kind == RIC_EDGE_BORDER)
    assert_int_equal(found->iterate, iterate_from(exact->iterate, from, period));
}

/* From any state of the cycle and any place in the window. */
static void check_example(double lambda, double omega, size_t n, random_source *source) {
  ric_grazing_map map = example_map(lambda, omega);
  const ric_map_line line = map_line_along_d(&map);
  ric_grazing_window exact;
  double z[3], work[3];
  assert_int_equal(ric_grazing_window_find(&map, n, &exact, NULL), RIC_OK);
  assert_true(exact.exists);
  const double y = exact.low.y + random_uniform(source, 0.1, 0.9) * (exact.high.y - exact.low.y);
  const size_t from = random_below(source, n);
  const ric_grazing_cycle cycle = cycle_of(&map, n, y, z);
  map_iterate(&map, cycle.d, z, from, work);
  const ric_cycle_window window = cycle_window_of(&line, cycle.d, n, cycle.d * 1e-3, cycle.d * 1e3, z);
  assert_int_equal(window.impacts, 1);
  assert_close(window.largest.re, cycle.largest.re, 1e-9);
  assert_close(window.largest.im, cycle.largest.im, 1e-9);
  check_edge(&window.low, &exact.low, from, n);
  check_edge(&window.high, &exact.high, from, n);
  ric_grazing_map_clear(&map);
}

static void windows_of_the_example_are_the_closed_ones(void **state) {
  (void)state;
  random_source source = {21};
  for (size_t n = 4; n <= 13; n++)
    for (int k = 0; k < 5; k++) {
      check_example(0.5, 0.3, n, &source);
      check_example(0.1, 0.05, n, &source);
    }
  example_line l = {.lambda = 0.5, .omega = 0.3, .along = D};
  const ric_map_line line = line_of(&l);
  double z[3] = {0}, work[3];
  ric_grazing_map map = example_map(0.5, 0.3);
  map_iterate(&map, 0.01, z, 5000, work);
  const ric_cycle_window window = cycle_window_of(&line, 0.01, 5, 0, 1, z);
  assert_close(window.low.p, 0.0042947127, 1e-10);
  assert_close(window.high.p, 1.0 / 72, 1e-15);
  ric_grazing_map_clear(&map);
}

/* Limits (3/4) lambda^(2(n-1)) of the flip and (1 - lambda) lambda^(2(n-1)) of the next border: the two windows have
 * a part in common below 1/4. */
static void windows_overlap_below_a_quarter(void **state) {
  (void)state;
  const double lambda = 0.1;
  ric_grazing_map map = example_map(lambda, 0.05);
  const ric_map_line line = map_line_along_d(&map);
  ric_cycle_window last = {0};
  for (size_t n = 5; n <= 13; n++) {
    const double unit = pow(lambda, 2 * (double)(n - 1)), off = 10 * pow(lambda, (double)n - 2);
    ric_grazing_cycle cycles[2];
    size_t count;
    double z[3];
    assert_int_equal(ric_grazing_cycles(&map, n, 2 * unit, cycles, &count, NULL), RIC_OK);
    cycle_of(&map, n, cycles[0].y, z);
    const ric_cycle_window window = cycle_window_of(&line, 2 * unit, n, 0, INFINITY, z);
    assert_close(window.low.p / (0.75 * unit), 1, off);
    assert_close(window.high.p * lambda * lambda / ((1 - lambda) * unit), 1, off);
    assert_true(n == 5 || last.low.p < window.high.p);
    last = window;
  }
  ric_grazing_map_clear(&map);
}

/* Whether the closed form has a window that ends at both sides at an edge that the cycle can have along d: where y =
 * 0, or d tends to infinity, there is no state to start from. */
static bool has_two_edges(const ric_grazing_window *w) {
  return w->exists && w->low.kind != RIC_EDGE_ZERO && w->high.kind != RIC_EDGE_ZERO && isfinite(w->high.d) &&
         isfinite(w->low.d);
}

static void windows_of_random_maps_are_the_closed_ones(void **state) {
  (void)state;
  random_source source = {22};
  size_t kinds[RIC_GRAZING_EDGES] = {0}, windows = 0;
  for (size_t k = 0; k < 1500; k++) {
    const size_t n = 1 + random_below(&source, 8), size = 1 + k % MOST_SIZE;
    ric_grazing_map map = random_map(&source, size, random_uniform(&source, 0.3, 0.99));
    const ric_map_line line = map_line_along_d(&map);
    ric_grazing_window exact;
    double z[MOST_SIZE];
    assert_int_equal(ric_grazing_window_find(&map, n, &exact, NULL), RIC_OK);
    if (has_two_edges(&exact)) {
      const ric_grazing_cycle c = cycle_of(&map, n, 0.5 * exact.low.y + 0.5 * exact.high.y, z);
      const double width = exact.high.d - exact.low.d;
      if (c.d > exact.low.d + 1e-6 * width && c.d < exact.high.d - 1e-6 * width && c.stable && c.admissible) {
        const ric_cycle_window window = cycle_window_of(&line, c.d, n, exact.low.d - 1, exact.high.d + 1, z);
        const double size_of_d = fmax(fabs(exact.low.d), fabs(exact.high.d));
        assert_int_equal(window.low.kind, exact.low.kind);
        assert_int_equal(window.high.kind, exact.high.kind);
        assert_close(window.low.p, exact.low.d, 1e-11 * size_of_d);
        assert_close(window.high.p, exact.high.d, 1e-11 * size_of_d);
        kinds[window.low.kind]++;
        kinds[window.high.kind]++;
        windows++;
      }
    }
    ric_grazing_map_clear(&map);
  }
  print_message("[ %zu windows; edges:", windows);
  for (int kind = 0; kind < RIC_GRAZING_EDGES; kind++)
    print_message(" %s %zu", ric_grazing_edge_name((ric_grazing_edge_kind)kind), kinds[kind]);
  print_message(" ]\n");
  assert_true(kinds[RIC_EDGE_BORDER] > 30 && kinds[RIC_EDGE_FLIP] > 30);
  assert_true(kinds[RIC_EDGE_FOLD] > 10 && kinds[RIC_EDGE_COMPLEX] > 10);
}

/* Of a map of size 1: d = 3/4 y^2 - y with the fold -1/3 at y = 2/3; and with L = 0 a cycle that is there down to d =
 * y = 0, where its impact comes to the border. */
static void folds_and_the_border_of_an_impact_are_edges(void **state) {
  (void)state;
  ric_grazing_map map = map_of_size_1(0.5, -0.5, -0.125);
  ric_map_line line = map_line_along_d(&map);
  double z[1];
  const ric_grazing_cycle c = cycle_of(&map, 1, 1.2, z);
  ric_cycle_window window = cycle_window_of(&line, c.d, 1, -1, 2, z);
  assert_int_equal(window.low.kind, RIC_EDGE_FOLD);
  assert_close(window.low.p, -1.0 / 3, 1e-14);
  assert_int_equal(window.high.kind, RIC_EDGE_OPEN);
  assert_close(window.high.p, 2, 0);
  ric_grazing_map_clear(&map);
  map = map_of_size_1(0, 1, 0.5);
  line = map_line_along_d(&map);
  const ric_grazing_cycle at = cycle_of(&map, 2, 0.5, z);
  window = cycle_window_of(&line, at.d, 2, -1, 10, z);
  assert_int_equal(window.low.kind, RIC_EDGE_BORDER);
  assert_close(window.low.p, 0, 1e-16); /* the other iterate comes to the border there, too */
  assert_int_equal(window.high.kind, RIC_EDGE_BORDER);
  ric_grazing_map_clear(&map);
}

/* The motion at 0 without impacts, up to grazing. */
static void the_motion_without_impacts_ends_at_grazing(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  const ric_map_line line = map_line_along_d(&map);
  double z[3] = {1e-3, 1e-3, 0};
  const ric_cycle_window window = cycle_window_of(&line, -0.3, 1, -1, 1, z);
  assert_int_equal(window.impacts, 0);
  assert_close(window.largest.re, 0.5, 1e-14);
  assert_int_equal(window.low.kind, RIC_EDGE_OPEN);
  assert_int_equal(window.high.kind, RIC_EDGE_BORDER);
  assert_close(window.high.p, 0, 1e-16);
  ric_grazing_map_clear(&map);
}

/* --- along lambda and omega: bisection on the closed form --------------------------------------------------------- */

static bool attracts(const example_line *l, double p, size_t n) {
  ric_grazing_map map = example_map(l->along == LAMBDA ? p : l->lambda, l->along == OMEGA ? p : l->omega);
  ric_grazing_cycle cycles[2];
  size_t count;
  assert_int_equal(ric_grazing_cycles(&map, n, l->d, cycles, &count, NULL), RIC_OK);
  ric_grazing_map_clear(&map);
  return count > 0 && cycles[0].admissible && cycles[0].stable;
}

/* Where it stops to attract on the way from p to a bound, in many small steps; the bound where it does not. */
static double end_by_bisection(const example_line *l, double p, double bound, size_t n) {
  enum { STEPS = 2000 };
  for (int k = 1; k <= STEPS; k++) {
    double good = p + (bound - p) * (k - 1) / STEPS, bad = k == STEPS ? bound : p + (bound - p) * k / STEPS;
    if (attracts(l, bad, n))
      continue;
    for (int i = 0; i < 60; i++) {
      const double middle = 0.5 * (good + bad);
      *(attracts(l, middle, n) ? &good : &bad) = middle;
    }
    return good;
  }
  return bound;
}

static void check_line(example_line l, double p, size_t n, double low, double high, size_t *ends) {
  const ric_map_line line = line_of(&l);
  ric_grazing_map map = example_map(l.along == LAMBDA ? p : l.lambda, l.along == OMEGA ? p : l.omega);
  ric_grazing_cycle cycles[2];
  size_t count;
  double z[3];
  assert_int_equal(ric_grazing_cycles(&map, n, l.d, cycles, &count, NULL), RIC_OK);
  cycle_of(&map, n, cycles[0].y, z);
  ric_grazing_map_clear(&map);
  const ric_cycle_window window = cycle_window_of(&line, p, n, low, high, z);
  const ric_cycle_edge edges[] = {window.low, window.high};
  for (int k = 0; k < 2; k++) {
    assert_close(edges[k].p / end_by_bisection(&l, p, k ? high : low, n), 1, 1e-12);
    ends[edges[k].kind]++;
  }
}

static void windows_along_lambda_and_omega_agree_with_bisection(void **state) {
  (void)state;
  random_source source = {23};
  size_t ends[RIC_GRAZING_EDGES] = {0}, lines = 0;
  for (int k = 0; k < 2000 && lines < 60; k++) {
    example_line l = {.lambda = random_uniform(&source, 0.1, 0.65), .omega = random_uniform(&source, 0.02, 0.95)};
    l.along = k % 2 ? LAMBDA : OMEGA;
    l.d = exp(random_uniform(&source, -12, 0));
    const size_t n = 2 + random_below(&source, 8);
    const double p = l.along == LAMBDA ? l.lambda : l.omega;
    if (!attracts(&l, p, n))
      continue;
    check_line(l, p, n, l.along == LAMBDA ? 0.01 : -0.5, 0.999, ends);
    lines++;
  }
  print_message("[ %zu lines; edges: border %zu, flip %zu, complex %zu, open %zu ]\n", lines, ends[RIC_EDGE_BORDER],
                ends[RIC_EDGE_FLIP], ends[RIC_EDGE_COMPLEX], ends[RIC_EDGE_OPEN]);
  assert_true(lines >= 60 && ends[RIC_EDGE_BORDER] > 5 && ends[RIC_EDGE_FLIP] > 5);
}

/* --- refusals ----------------------------------------------------------------------------------------------------- */

static int stop(void *user) {
  ++*(int *)user;
  return 1;
}

static void assert_refused(ric_status status, ric_status expected, const ric_error *error, const char *text) {
  assert_int_equal(status, expected);
  if (!strstr(error->message, text))
    fail_msg("\"%s\", expected \"%s\" in it", error->message, text);
}

static void bad_arguments_are_refused(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  const ric_map_line line = map_line_along_d(&map);
  ric_cycle_window w;
  ric_error e;
  double z[3], bad[3] = {NAN, 0, 0};
  ric_grazing_window exact;
  assert_int_equal(ric_grazing_window_find(&map, 5, &exact, NULL), RIC_OK);
  const double p = cycle_of(&map, 5, 0.5 * (exact.low.y + exact.high.y), z).d;
  assert_refused(ric_cycle_find(&line, p, 0, z, &w, &e), RIC_EINVAL, &e, "period = 0, expected 1 to 10000");
  assert_refused(ric_cycle_find(&line, p, 10001, z, &w, &e), RIC_EINVAL, &e, "period = 10001");
  assert_refused(ric_cycle_find(&line, p, 5, bad, &w, &e), RIC_EINVAL, &e, "z[0] = ");
  assert_refused(ric_cycle_find(&line, NAN, 5, z, &w, &e), RIC_EINVAL, &e, "p = ");
  assert_refused(ric_cycle_window_find(&line, p, 5, p, 1, 0, z, never, &w, &e), RIC_EINVAL, &e, "low = ");
  assert_refused(ric_cycle_window_find(&line, p, 5, NAN, 1, 0, z, never, &w, &e), RIC_EINVAL, &e, "low = ");
  assert_refused(ric_cycle_window_find(&line, p, 5, 0, p, 0, z, never, &w, &e), RIC_EINVAL, &e, "high = ");
  assert_refused(ric_cycle_window_find(&line, p, 5, 0, 1, -1, z, never, &w, &e), RIC_EINVAL, &e, "step = -1");
  int asked = 0;
  const ric_poll poll = {stop, &asked};
  assert_refused(ric_cycle_window_find(&line, p, 5, 0, 1, 0, z, poll, &w, &e), RIC_ESTOPPED, &e, "stopped at p = ");
  assert_int_equal(asked, 1);
  assert_int_equal(ric_cycle_find(&line, p, 5, z, &w, NULL), RIC_OK);
  assert_refused(ric_cycle_find(&line, p, 10, z, &w, &e), RIC_EINVAL, &e, "period = 10: the cycle at p = ");
  map.eta[0] = 0;
  assert_refused(ric_cycle_find(&line, p, 5, z, &w, &e), RIC_EINVAL, &e, "eta = 0");
  ric_grazing_map_clear(&map);
}

static void cycles_that_are_none_are_refused(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  const ric_map_line line = map_line_along_d(&map);
  ric_grazing_window exact;
  ric_cycle_window w;
  ric_error e;
  double z[3];
  assert_int_equal(ric_grazing_window_find(&map, 5, &exact, NULL), RIC_OK);
  /* Of an unstable one, and one that has another impact. */
  double p = cycle_of(&map, 5, 0.99 * exact.low.y, z).d;
  assert_int_equal(ric_cycle_find(&line, p, 5, z, &w, NULL), RIC_OK);
  assert_false(w.stable);
  assert_true(w.largest.re < -1);
  assert_refused(ric_cycle_window_find(&line, p, 5, p / 2, 1, 0, z, never, &w, &e), RIC_EINVAL, &e, "is not stable");
  p = cycle_of(&map, 5, 0.999 * exact.high.y, z).d;
  assert_refused(ric_cycle_find(&line, 1.01 * exact.high.d, 5, z, &w, &e), RIC_ENUMERIC, &e, "another itinerary");
  ric_grazing_map_clear(&map);
}

/* The line's own refusal is told where the way to the bound ends there. */
static ric_status ends_at_twelve(double p, ric_grazing_map *map, double *d, void *user, ric_error *error) {
  if (!(p <= 0.012))
    return ric_fail(error, RIC_EINVAL, "p = %g, expected at most 0.012", p);
  map_copy(user, map);
  *d = p;
  return RIC_OK;
}

static void lines_that_end_are_told(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  const ric_map_line line = {.size = 3, .at = ends_at_twelve, .user = &map};
  ric_cycle_window w;
  ric_error e;
  double z[3] = {0}, work[3];
  map_iterate(&map, 0.01, z, 5000, work);
  assert_refused(ric_cycle_window_find(&line, 0.01, 5, 0, 1, 0, z, never, &w, &e), RIC_ENUMERIC, &e,
                 "cannot be followed beyond p = 0.0119");
  w = cycle_window_of(&line, 0.01, 5, 0, 0.012, z);
  assert_int_equal(w.high.kind, RIC_EDGE_OPEN);
  assert_close(w.high.p, 0.012, 0);
  ric_grazing_map_clear(&map);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(windows_of_the_example_are_the_closed_ones),
      cmocka_unit_test(windows_overlap_below_a_quarter),
      cmocka_unit_test(windows_of_random_maps_are_the_closed_ones),
      cmocka_unit_test(folds_and_the_border_of_an_impact_are_edges),
      cmocka_unit_test(the_motion_without_impacts_ends_at_grazing),
      cmocka_unit_test(windows_along_lambda_and_omega_agree_with_bisection),
      cmocka_unit_test(bad_arguments_are_refused),
      cmocka_unit_test(cycles_that_are_none_are_refused),
      cmocka_unit_test(lines_that_end_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
