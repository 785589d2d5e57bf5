/* The criterion of grazing bifurcations: signs of all coefficients eta L^i xi from finitely many. */
#include "support.h"

#include "witness/grazing_maps.h"
#include "criterion_map.h"
#include "scenario/random_source.h"

static const double pi = 3.14159265358979323846;

/* --- brute force -------------------------------------------------------------------------------------------------- */

enum { looked_at = 2000 };

/* What the first coefficients say, in long double. */
typedef struct brute_signs {
  size_t first_negative; /* SIZE_MAX: none */
  double closest;        /* the smallest |c_i| up to there, over the sum of the moduli of its terms */
} brute_signs;

static brute_signs brute(const ric_grazing_map *map) {
  brute_signs signs = {SIZE_MAX, INFINITY};
  size_t n = map->size;
  long double x[most_size], next[most_size];
  for (size_t k = 0; k < n; k++)
    x[k] = map->xi[k];
  for (size_t i = 0; i < looked_at && signs.first_negative == SIZE_MAX; i++) {
    long double sum = 0, terms = 0, size = 0;
    for (size_t k = 0; k < n; k++) {
      sum += map->eta[k] * x[k];
      terms += fabsl(map->eta[k] * x[k]);
      next[k] = 0;
      for (size_t l = 0; l < n; l++)
        next[k] += map->L[k * n + l] * x[l];
      size = fmaxl(size, fabsl(next[k]));
    }
    signs.closest = fmin(signs.closest, (double)(fabsl(sum) / terms));
    if (sum < 0)
      signs.first_negative = i;
    for (size_t k = 0; k < n; k++)
      x[k] = next[k] / size;
  }
  return signs;
}

/* Entries from [low, 1), rows of L divided by their number so that it contracts. */
static ric_grazing_map any_map(random_source *source, size_t n, double low) {
  ric_grazing_map map = empty_map(n);
  for (size_t i = 0; i < n * n; i++)
    map.L[i] = random_uniform(source, low, 1) / (double)n;
  for (size_t i = 0; i < n; i++) {
    map.eta[i] = random_uniform(source, low, 1);
    map.xi[i] = random_uniform(source, low, 1);
  }
  return map;
}

/* --- the source, and oscillators in closed form ------------------------------------------------------------------- */

static void example_of_the_source_is_continuous(void **state) {
  (void)state;
  const struct {
    double lambda, omega;
    ric_grazing_regime regime;
  } cases[] = {{0.5, 0.3, RIC_REGIME_WINDOWS},       {0.8, 0.3, RIC_REGIME_CHAOS},      {0.2, 0.1, RIC_REGIME_OVERLAP},
               {0.25, 0.1, RIC_REGIME_BORDER},       {2.0 / 3, 0.3, RIC_REGIME_BORDER}, {0.26, 0.2, RIC_REGIME_WINDOWS},
               {0.6666, -0.6665, RIC_REGIME_WINDOWS}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    ric_grazing_map map = example_map(cases[k].lambda, cases[k].omega);
    double coefficients[50], departure[3] = {0};
    ric_grazing_criterion c;
    assert_int_equal(ric_grazing_criterion_find(&map, NULL, &c, coefficients, 50, departure, NULL), RIC_OK);
    assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
    assert_int_equal(c.regime, cases[k].regime);
    assert_close(c.alpha, 1, 1e-12);
    assert_close(c.dominant.re, cases[k].lambda, 1e-15);
    assert_close(c.second, fabs(cases[k].omega), 1e-15);
    assert_int_equal(c.settled, 0); /* eta sees nothing but the dominant multiplier */
    assert_true(isnan(departure[0]) && isnan(departure[1]) && isnan(departure[2]));
    for (size_t i = 0; i < 50; i++)
      assert_close(coefficients[i] / pow(cases[k].lambda, (double)i), 1, 1e-13);
    ric_grazing_map_clear(&map);
  }
}

/* [exp(A t)]_01 of x'' + c x' + x = 0. */
static double displacement(double c, double t) {
  double square = 1 - c * c / 4, root = sqrt(fabs(square));
  return exp(-c * t / 2) * (square > 0 ? sin(root * t) : sinh(root * t)) / root;
}

/* Its map on the section at the grazing point, wall x <= 1, after a full turn: eta exp(A T), exp(A T), xi. With
 * s = displacement, exp(A t) = [[s' + c s, s], [-s, s']]. */
static ric_grazing_map oscillator(double c, double w, double restitution) {
  double T = 2 * pi / w, s = displacement(c, T), square = 1 - c * c / 4, root = sqrt(fabs(square));
  double rate = exp(-c * T / 2) * (square > 0 ? cos(root * T) : cosh(root * T)) - c / 2 * s;
  return map_of(2, (double[]){rate + c * s, s, -s, rate}, (double[]){-rate - c * s, -s},
                (double[]){0, -1 - restitution});
}

static void coefficients_of_an_oscillator_have_a_closed_form(void **state) {
  (void)state;
  const double cases[][2] = {{3, 6}, {3, 4}, {3, 1.5}, {0.1, 2}, {0.5, 7}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    ric_grazing_map map = oscillator(cases[k][0], cases[k][1], 0.8);
    ric_grazing_criterion c;
    double coefficients[12];
    assert_int_equal(ric_grazing_criterion_find(&map, NULL, &c, coefficients, 12, NULL, NULL), RIC_OK);
    for (size_t i = 0; i < 12; i++) {
      double expected = 1.8 * displacement(cases[k][0], 2 * pi / cases[k][1] * (double)(i + 1));
      assert_close(coefficients[i], expected, 1e-14 + 1e-11 * fabs(expected));
    }
    ric_grazing_map_clear(&map);
  }
}

static void overdamped_oscillators_pass(void **state) {
  (void)state;
  const struct {
    double w, lambda;
    ric_grazing_regime regime;
  } cases[] = {{6, 0.670324, RIC_REGIME_CHAOS}, {4, 0.549, RIC_REGIME_WINDOWS}, {1.5, 0.202, RIC_REGIME_OVERLAP}};
  for (size_t k = 0; k < 3; k++) {
    ric_grazing_criterion c = find_criterion_once(oscillator(3, cases[k].w, 0.8));
    double rate = (3 - sqrt(5)) / 2, T = 2 * pi / cases[k].w;
    assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
    assert_int_equal(c.regime, cases[k].regime);
    assert_close(c.dominant.re, cases[k].lambda, 5e-4);
    assert_close(c.dominant.re, exp(-rate * T), 1e-13);
    assert_close(c.alpha, 1.8 * exp(-rate * T) / sqrt(5), 1e-12);
  }
}

static void underdamped_oscillators_fail(void **state) {
  (void)state;
  ric_grazing_map map = oscillator(0.1, 2, 0.8);
  ric_grazing_criterion c;
  double departure[2], coefficients[2];
  assert_int_equal(ric_grazing_criterion_find(&map, NULL, &c, coefficients, 2, departure, NULL), RIC_OK);
  assert_int_equal(c.verdict, RIC_GRAZING_DISCONTINUOUS);
  assert_int_equal(c.first_negative, 1);
  assert_int_equal(c.first_zero, SIZE_MAX); /* c_0 is small, and decided */
  assert_true(coefficients[0] > 0 && coefficients[1] < 0);
  assert_true(c.dominant.im > 0 && c.second == 0 && isnan(c.alpha));
  double x[2] = {map.L[1] * map.xi[1], map.L[3] * map.xi[1]}, length = hypot(x[0], x[1]);
  assert_close(departure[0], x[0] / length, 1e-14);
  assert_close(departure[1], x[1] / length, 1e-14);
  ric_grazing_map_clear(&map);
}

/* --- invariance --------------------------------------------------------------------------------------------------- */

static void assert_same(const ric_grazing_criterion *a, const ric_grazing_criterion *b) {
  assert_int_equal(a->verdict, b->verdict);
  assert_int_equal(a->regime, b->regime);
  assert_int_equal(a->first_negative, b->first_negative);
  assert_int_equal(a->first_zero, b->first_zero);
  assert_close(a->dominant.re, b->dominant.re, 1e-7);
  if (a->verdict == RIC_GRAZING_CONTINUOUS)
    assert_close(a->alpha / b->alpha, 1, 1e-6);
}

static void coordinates_do_not_matter(void **state) {
  (void)state;
  random_source source = {11};
  double S[most_size * most_size];
  for (size_t trial = 0; trial < 400; trial++) {
    size_t n = 1 + random_below(&source, most_size);
    ric_grazing_map map = any_map(&source, n, trial % 2 ? 0 : -0.4);
    if (brute(&map).closest > 1e-4) {
      ric_grazing_criterion before = find_criterion(&map);
      random_coordinates(&source, trial % 4 < 2 ? 0 : 6, n, S);
      change_coordinates(&map, S);
      ric_grazing_criterion after = find_criterion(&map);
      assert_same(&before, &after);
    }
    ric_grazing_map_clear(&map);
  }
}

/* A section before the point where rows go through L has what another one after it has. */
static void sections_do_not_matter(void **state) {
  (void)state;
  random_source source = {12};
  double a[20], b[20], row[most_size], column[most_size];
  for (size_t trial = 0; trial < 100; trial++) {
    size_t n = 1 + random_below(&source, most_size);
    ric_grazing_map map = any_map(&source, n, trial % 2 ? 0 : -0.2), other = map_of(n, map.L, map.eta, map.xi);
    ric_grazing_criterion of_map, of_other;
    for (size_t i = 0; i < n; i++) {
      row[i] = column[i] = 0;
      for (size_t k = 0; k < n; k++) {
        row[i] += map.eta[k] * map.L[k * n + i];
        column[i] += map.L[i * n + k] * map.xi[k];
      }
    }
    memcpy(map.eta, row, n * sizeof *row);
    memcpy(other.xi, column, n * sizeof *column);
    assert_int_equal(ric_grazing_criterion_find(&map, NULL, &of_map, a, 20, NULL, NULL), RIC_OK);
    assert_int_equal(ric_grazing_criterion_find(&other, NULL, &of_other, b, 20, NULL, NULL), RIC_OK);
    for (size_t i = 0; i < 20; i++)
      assert_close(a[i], b[i], 1e-14 * (double)n);
    if (brute(&map).closest > 1e-4)
      assert_same(&of_map, &of_other);
    ric_grazing_map_clear(&map);
    ric_grazing_map_clear(&other);
  }
}

/* Units of time, of length, of each coordinate, as far as numbers reach. */
static void sizes_of_numbers_do_not_matter(void **state) {
  (void)state;
  ric_grazing_map map =
      diagonal_map(3, (double[]){0.5, 0.4, -0.3}, (double[]){1, 1e9, 1e-12}, (double[]){1, 1e-9, 1e12});
  ric_grazing_criterion c = find_criterion(&map);
  assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
  assert_true(c.settled <= 16); /* as with ones: 0.8^i sinks below 0.9 / 2 */
  for (size_t k = 0; k < 3; k++) {
    map.eta[k] *= 1e-200;
    map.xi[k] *= 1e-90;
  }
  c = find_criterion_once(map);
  assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
  assert_close(c.alpha / 1e-290, 1, 1e-10);
  c = find_criterion_once(diagonal_map(2, (double[]){1e-300, 1e-301}, (double[]){1, 1}, (double[]){1, 1}));
  assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
  assert_int_equal(c.regime, RIC_REGIME_OVERLAP);
}

/* --- the proof of the rest ---------------------------------------------------------------------------------------- */

static void verdicts_agree_with_brute_force(void **state) {
  (void)state;
  random_source source = {13};
  size_t seen[RIC_GRAZING_VERDICTS] = {0};
  for (size_t trial = 0; trial < 2000; trial++) {
    size_t n = 1 + trial % most_size;
    ric_grazing_map map = any_map(&source, n, random_uniform(&source, -0.8, 0.1));
    brute_signs signs = brute(&map);
    ric_grazing_criterion c = find_criterion(&map);
    if (signs.closest > 1e-7) {
      seen[c.verdict]++;
      assert_int_equal(c.first_negative, signs.first_negative);
    }
    ric_grazing_map_clear(&map);
  }
  assert_true(seen[RIC_GRAZING_CONTINUOUS] > 400 && seen[RIC_GRAZING_DISCONTINUOUS] > 400);
  assert_int_equal(seen[RIC_GRAZING_UNDECIDED], 0);
}

/* Perron and Frobenius: a positive matrix between positive vectors. */
static void positive_maps_are_continuous(void **state) {
  (void)state;
  random_source source = {14};
  for (size_t trial = 0; trial < 200; trial++) {
    ric_grazing_criterion c = find_criterion_once(any_map(&source, 1 + trial % most_size, 1e-3));
    assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
    assert_true(c.alpha > 0 && c.dominant.re > c.second);
  }
}

/* c_i = l^i + b m^i, in skew coordinates: from `settled` on |b| (m / l)^i is below alpha = 1. */
static void settled_index_is_honest(void **state) {
  (void)state;
  const double cases[][3] = {{0.5, -0.45, 1.05}, {0.9, 0.8, -0.99}, {0.5, 0.49, 100},     {0.7, -0.69993, 0.99},
                             {0.3, 0.299, 5},    {0.6, 0.1, 1e6},   {0.999, 0.998, -0.95}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    double l = cases[k][0], m = cases[k][1], b = cases[k][2];
    ric_grazing_map map = diagonal_map(2, (double[]){l, m}, (double[]){1, 1}, (double[]){1, b});
    change_coordinates(&map, (double[]){1, 2, -0.5, 3});
    ric_grazing_criterion c = find_criterion_once(map);
    assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
    assert_close(c.alpha, 1, 1e-9);
    assert_true(fabs(b) * pow(fabs(m) / l, (double)c.settled) < 0.9000001);
    /* and sharp: the ellipse of X lies along the axes of L within a few steps */
    double sharp = log(fabs(b) / 0.9) / log(l / fabs(m));
    assert_true((double)c.settled < 1.2 * fmax(sharp, 0) + 60);
  }
}

/* The rest may be large for long before it sinks: Jordan blocks. */
static void defective_rest_is_proved(void **state) {
  (void)state;
  ric_grazing_map map = map_of(4, (double[]){0.9, 0, 0, 0, 0, 0.8, 1, 0, 0, 0, 0.8, 1, 0, 0, 0, 0.8},
                               (double[]){1, 1, 1, 1}, (double[]){1e-3, 1, 1, 1});
  double coefficients[looked_at];
  ric_grazing_criterion c;
  assert_int_equal(ric_grazing_criterion_find(&map, NULL, &c, coefficients, looked_at, NULL, NULL), RIC_OK);
  assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
  assert_close(c.alpha, 1e-3, 1e-12);
  assert_in_range(c.settled, 140, 400);
  for (size_t i = c.settled; i < looked_at; i++)
    assert_true(fabs(coefficients[i] / pow(0.9, (double)i) - c.alpha) < c.alpha);
  ric_grazing_map_clear(&map);
}

static void late_negative_coefficients_are_found(void **state) {
  (void)state;
  const double weights[] = {1, 1};
  ric_grazing_criterion c = find_criterion_once(diagonal_map(2, (double[]){0.8, 0.9}, weights, (double[]){1, -1e-3}));
  assert_int_equal(c.verdict, RIC_GRAZING_DISCONTINUOUS);
  assert_int_equal(c.first_negative, 59); /* (9/8)^i > 1000 */
  assert_close(c.alpha, -1e-3, 1e-12);
  double re = 0.9 * cos(0.01), im = 0.9 * sin(0.01);
  c = find_criterion_once(map_of(2, (double[]){re, -im, im, re}, (double[]){1, 0}, (double[]){1, 0}));
  assert_int_equal(c.verdict, RIC_GRAZING_DISCONTINUOUS);
  assert_int_equal(c.first_negative, 158); /* 0.01 i > pi / 2 */
  c = find_criterion_once(diagonal_map(2, (double[]){0.5, -0.6}, weights, (double[]){1, 1e-3}));
  assert_int_equal(c.verdict, RIC_GRAZING_DISCONTINUOUS);
  assert_int_equal(c.first_negative, 39); /* odd, 1.2^i > 1000 */
  assert_close(c.dominant.re, -0.6, 1e-15);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(example_of_the_source_is_continuous),
      cmocka_unit_test(coefficients_of_an_oscillator_have_a_closed_form),
      cmocka_unit_test(overdamped_oscillators_pass),
      cmocka_unit_test(underdamped_oscillators_fail),
      cmocka_unit_test(coordinates_do_not_matter),
      cmocka_unit_test(sections_do_not_matter),
      cmocka_unit_test(sizes_of_numbers_do_not_matter),
      cmocka_unit_test(verdicts_agree_with_brute_force),
      cmocka_unit_test(positive_maps_are_continuous),
      cmocka_unit_test(settled_index_is_honest),
      cmocka_unit_test(defective_rest_is_proved),
      cmocka_unit_test(late_negative_coefficients_are_found),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
