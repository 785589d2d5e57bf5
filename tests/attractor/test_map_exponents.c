/* Lyapunov exponents of maps beside grazing. */
#include "support.h"

#include "witness/grazing_maps.h"
#include "map_runs.h"

enum { MOST_SIZE = 6 };

static ric_attractor_options with_exponents(size_t transient, size_t measure, size_t exponents) {
  ric_attractor_options o = ric_attractor_options_default();
  o.transient = transient;
  o.measure = measure;
  o.keep = 0;
  o.exponents = exponents;
  return o;
}

/* A run of one map. @param z  start, set  @returns what came of it; exponents set */
static ric_attractor run_one(const ric_grazing_map *map, double d, ric_attractor_options o, double *z,
                             double *exponents) {
  map_runs runs = map_runs_of(map, 1, &o);
  runs.d[0] = d;
  memcpy(runs.attractors[0].z, z, map->size * sizeof *z);
  map_runs_go(&runs, ric_map_lanes_widest());
  ric_attractor a = runs.attractors[0];
  memcpy(z, a.z, map->size * sizeof *z);
  memcpy(exponents, a.exponents, o.exponents * sizeof *exponents);
  map_runs_clear(&runs);
  return a;
}

/* ln |det| of the derivative by elimination with pivots. @param D  [size][size] overwritten */
static double log_determinant(long double *D, size_t size) {
  long double sum = 0;
  for (size_t c = 0; c < size; c++) {
    size_t pivot = c;
    for (size_t i = c + 1; i < size; i++)
      if (fabsl(D[i * size + c]) > fabsl(D[pivot * size + c]))
        pivot = i;
    for (size_t j = 0; j < size; j++) {
      long double x = D[c * size + j];
      D[c * size + j] = D[pivot * size + j];
      D[pivot * size + j] = x;
    }
    sum += logl(fabsl(D[c * size + c]));
    for (size_t i = c + 1; i < size; i++) {
      long double factor = D[i * size + c] / D[c * size + c];
      for (size_t j = c; j < size; j++)
        D[i * size + j] -= factor * D[c * size + j];
    }
  }
  return (double)sum;
}

/* The iterates of a run, from the state it begins to measure at, by the runner itself: chaos parts from any others. */
static double *states_of(const ric_grazing_map *map, double d, double *z, size_t transient, size_t measure) {
  ric_attractor_options o = with_exponents(transient, measure, 0);
  o.keep = measure;
  map_runs runs = map_runs_of(map, 1, &o);
  double *states = malloc(measure * map->size * sizeof *states);
  runs.d[0] = d;
  memcpy(runs.attractors[0].z, z, map->size * sizeof *z);
  map_runs_go(&runs, ric_map_lanes_widest());
  memcpy(states, runs.attractors[0].states, measure * map->size * sizeof *states);
  bool fine = runs.attractors[0].kind <= RIC_ATTRACTOR_APERIODIC;
  map_runs_clear(&runs);
  if (fine)
    return states;
  free(states);
  return NULL;
}

/* By the book, in long double: vectors made orthonormal after every iterate, logarithms added up. */
static void by_the_book(const ric_grazing_map *map, double d, const double *states, size_t align, size_t measure,
                        double *exponents) {
  size_t n = map->size;
  long double v[MOST_SIZE][MOST_SIZE] = {0}, next[MOST_SIZE], sum[MOST_SIZE] = {0};
  double D[MOST_SIZE * MOST_SIZE];
  for (size_t k = 0; k < n; k++)
    for (size_t i = 0; i < n; i++)
      v[k][i] = cosl(1 + (long double)(3 * k * k + 7 * i));
  for (size_t t = 0; t + 1 < align + measure; t++) {
    ric_grazing_map_derivative(map, d, states + t * n, D);
    for (size_t k = 0; k < n; k++) {
      for (size_t i = 0; i < n; i++) {
        next[i] = 0;
        for (size_t j = 0; j < n; j++)
          next[i] += D[i * n + j] * v[k][j];
      }
      for (size_t twice = 0; twice < 2; twice++)
        for (size_t l = 0; l < k; l++) {
          long double part = 0;
          for (size_t i = 0; i < n; i++)
            part += next[i] * v[l][i];
          for (size_t i = 0; i < n; i++)
            next[i] -= part * v[l][i];
        }
      long double length = 0;
      for (size_t i = 0; i < n; i++)
        length += next[i] * next[i];
      length = sqrtl(length);
      sum[k] += t >= align ? logl(length) : 0;
      for (size_t i = 0; i < n; i++)
        v[k][i] = next[i] / length;
    }
  }
  for (size_t k = 0; k < n; k++)
    exponents[k] = (double)(sum[k] / (measure - 1));
}

static double random_start(random_source *source, double *z) {
  for (size_t i = 0; i < MOST_SIZE; i++)
    z[i] = random_uniform(source, -1, 1);
  return exp(random_uniform(source, -8, 0));
}

static void exponents_are_those_of_the_book(void **state) {
  (void)state;
  random_source source = {31};
  size_t compared = 0;
  for (size_t k = 0; k < 40 * MOST_SIZE; k++) {
    enum { TRANSIENT = 700, ALIGN = 300, MEASURE = 4000 };
    ric_grazing_map map = random_map(&source, 1 + k % MOST_SIZE, random_uniform(&source, 0.1, 0.99));
    double start[MOST_SIZE], z[MOST_SIZE], exponents[MOST_SIZE], expected[MOST_SIZE];
    double d = random_start(&source, start);
    memcpy(z, start, sizeof z);
    double *states = states_of(&map, d, z, TRANSIENT - ALIGN, ALIGN + MEASURE);
    if (states) {
      const ric_attractor a = run_one(&map, d, with_exponents(TRANSIENT, MEASURE, map.size), start, exponents);
      by_the_book(&map, d, states, ALIGN, MEASURE, expected);
      for (size_t i = 0; i < map.size; i++) /* the book counts parts of a period */
        assert_close(exponents[i], expected[i], (a.period ? 2e-2 : 3e-3) * (1 + fabs(expected[i])));
      compared++;
    }
    free(states);
    ric_grazing_map_clear(&map);
  }
  assert_true(compared > 100);
}

static void their_sum_is_the_mean_of_the_determinants_logarithm(void **state) {
  (void)state;
  random_source source = {32};
  size_t compared = 0;
  for (size_t k = 0; k < 20 * MOST_SIZE; k++) {
    enum { TRANSIENT = 600, MEASURE = 1000 };
    ric_grazing_map map = random_map(&source, 1 + k % MOST_SIZE, random_uniform(&source, 0.1, 0.99));
    size_t n = map.size;
    double start[MOST_SIZE], exponents[MOST_SIZE], mean = 0, sum = 0, D[MOST_SIZE * MOST_SIZE];
    long double E[MOST_SIZE * MOST_SIZE];
    double d = random_start(&source, start);
    double *states = states_of(&map, d, start, TRANSIENT - 1, MEASURE + 1);
    if (states) {
      const ric_attractor a = run_one(&map, d, with_exponents(TRANSIENT, MEASURE, n), start, exponents);
      const size_t first = a.period ? MEASURE - a.period : 0; /* of a cycle one period */
      for (size_t t = first; t < MEASURE; t++) {
        ric_grazing_map_derivative(&map, d, states + t * n, D);
        for (size_t i = 0; i < n * n; i++)
          E[i] = D[i];
        mean += log_determinant(E, n) / (double)(MEASURE - first);
      }
      for (size_t i = 0; i < n; i++)
        sum += exponents[i];
      assert_close(sum, mean, (a.period ? 1e-5 : 1e-9) * (1 + fabs(mean)));
      compared++;
    }
    free(states);
    ric_grazing_map_clear(&map);
  }
  assert_true(compared > 50);
}

/* The turning part of L is hidden from what z_1 does: its exponents are ln omega, in chaos too. */
static void example_has_one_exponent_of_its_own(void **state) {
  (void)state;
  static const double ds[] = {0.03, 0.0277, 1.5e-4};
  static const int signs[] = {-1, 1, 1};
  ric_grazing_map map = example_map(0.5, 0.3);
  for (size_t i = 0; i < 3; i++) {
    double z[3] = {0}, exponents[3];
    run_one(&map, ds[i], with_exponents(20000, 20000, 3), z, exponents);
    assert_true(exponents[0] * signs[i] > 0.005);
    assert_close(exponents[1], log(0.3), 1e-3);
    assert_close(exponents[2], log(0.3), 1e-3);
  }
  ric_grazing_map_clear(&map);
}

/* Far smaller ones are not lost behind the largest. */
static void directions_that_part_by_far_keep_their_exponents(void **state) {
  (void)state;
  static const double omegas[] = {1e-2, 1e-5, 1e-8};
  for (size_t i = 0; i < 3; i++) {
    ric_grazing_map map = example_map(0.5, omegas[i]);
    double z[3] = {0}, exponents[3];
    run_one(&map, 1.5e-4, with_exponents(2000, 10000, 3), z, exponents);
    assert_close(exponents[1] + exponents[2], 2 * log(omegas[i]), 1e-4 * fabs(log(omegas[i])));
    assert_close(exponents[1], log(omegas[i]), 1e-3 * fabs(log(omegas[i])));
    ric_grazing_map_clear(&map);
  }
}

static void stable_cycles_have_those_of_their_multipliers(void **state) {
  (void)state;
  static const double ds[] = {0.0295, 0.0105, 0.0023};
  static const size_t periods[] = {4, 5, 6};
  ric_grazing_map map = example_map(0.5, 0.3);
  for (size_t i = 0; i < 3; i++) {
    double z[3] = {0}, exponent;
    ric_grazing_cycle cycles[2];
    size_t count;
    assert_int_equal(ric_grazing_cycles(&map, periods[i], ds[i], cycles, &count, NULL), RIC_OK);
    assert_true(count == 1 && cycles[0].stable && cycles[0].admissible);
    ric_attractor a = run_one(&map, ds[i], with_exponents(30000, 60 * periods[i], 1), z, &exponent);
    assert_int_equal(a.period, periods[i]);
    double modulus = hypot(cycles[0].largest.re, cycles[0].largest.im);
    assert_close(exponent, log(modulus) / (double)periods[i], 1e-9);
  }
  ric_grazing_map_clear(&map);
}

/* d -> lambda^2 d makes the period longer by one; the largest exponent times the mean time between impacts comes to be
 * the same: that of the limit map. */
static void chaos_repeats_itself_as_d_falls(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.8, 0.3);
  double last = NAN;
  for (int k = 0; k < 3; k++) {
    double z[3] = {0}, exponent, d = 1e-12 * pow(0.8, 2 * k);
    ric_attractor a = run_one(&map, d, with_exponents(10000, 4000000, 1), z, &exponent);
    double per_impact = exponent / a.impacts;
    assert_true(per_impact > 1);
    assert_true(k == 0 || fabs(per_impact - last) < 0.03); /* 70 000 impacts */
    last = per_impact;
  }
  ric_grazing_map_clear(&map);
}

static void directions_that_are_put_out_have_none(void **state) {
  (void)state;
  ric_grazing_map still = map_of_size_1(0, 1, 0), line = example_map(0.5, 0);
  double z[3] = {1, 0.5, 0.5}, exponents[3];
  run_one(&still, -1, with_exponents(10, 100, 1), z, exponents);
  assert_true(exponents[0] == -INFINITY);
  z[0] = 0;
  run_one(&line, 1.5e-4, with_exponents(1000, 1000, 3), z, exponents);
  assert_true(isfinite(exponents[0]) && exponents[1] == -INFINITY && exponents[2] == -INFINITY);
  ric_grazing_map_clear(&still);
  ric_grazing_map_clear(&line);
}

/* z = d = 0 stays there. */
static void there_are_none_at_the_border(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  for (size_t count = 1; count <= 3; count++) {
    double z[3] = {0}, exponents[3];
    ric_attractor a = run_one(&map, 0, with_exponents(100, 100, count), z, exponents);
    assert_int_equal(a.period, 1);
    for (size_t i = 0; i < count; i++)
      assert_true(isnan(exponents[i]));
  }
  ric_grazing_map_clear(&map);
}

/* A cycle of the example: its largest exponent by the book over many whole periods. */
static double of_whole_periods(const ric_grazing_map *map, double d, size_t period) {
  double z[3] = {0}, exponents[MOST_SIZE];
  const size_t half = 100 * period;
  double *states = states_of(map, d, z, 9000, 2 * half);
  assert_non_null(states);
  by_the_book(map, d, states, half, half, exponents);
  free(states);
  return fmax(exponents[0], fmax(exponents[1], exponents[2]));
}

/* However many iterates are measured: a part of a period more or less had the wrong sign near edges of windows. */
static void cycles_have_those_of_one_period(void **state) {
  (void)state;
  size_t cycles = 0;
  for (int i = 0; i < 200; i++) {
    ric_grazing_map map;
    assert_int_equal(ric_grazing_map_example(&map, 0.3 + 0.35 * (i % 4) / 3, i % 3 ? 0.1 * (i % 3) : 0, NULL), RIC_OK);
    const double d = 1e-3 * exp(4 * i / 200.0);
    double z[3] = {0}, exponents[3];
    const ric_attractor a = run_one(&map, d, with_exponents(9000, 1 + (size_t)i % 37, 3), z, exponents);
    if (a.kind == RIC_ATTRACTOR_PERIODIC) {
      const double impacts = a.impacts * (double)a.period;
      cycles++;
      assert_close(impacts, round(impacts), 1e-12);
      assert_true(exponents[0] <= 1e-9 && exponents[0] >= exponents[1]);
      assert_close(exponents[0], of_whole_periods(&map, d, a.period),
                   0.1 / (double)a.period); /* a turning direction swings */
    }
    ric_grazing_map_clear(&map);
  }
  printf("%zu cycles\n", cycles);
  assert_true(cycles > 60);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exponents_are_those_of_the_book),
      cmocka_unit_test(their_sum_is_the_mean_of_the_determinants_logarithm),
      cmocka_unit_test(example_has_one_exponent_of_its_own),
      cmocka_unit_test(directions_that_part_by_far_keep_their_exponents),
      cmocka_unit_test(stable_cycles_have_those_of_their_multipliers),
      cmocka_unit_test(cycles_have_those_of_one_period),
      cmocka_unit_test(chaos_repeats_itself_as_d_falls),
      cmocka_unit_test(directions_that_are_put_out_have_none),
      cmocka_unit_test(there_are_none_at_the_border),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
