/* Many maps side by side, run to their attractors. */
#include "support.h"

#include "witness/allocation_counter.h"
#include "witness/grazing_maps.h"
#include "map_runs.h"

enum { MOST_SIZE = 6, MAPS = 75 };

static ric_attractor_options short_run(size_t transient, size_t keep, size_t measure) {
  ric_attractor_options o = ric_attractor_options_default();
  o.transient = transient;
  o.keep = keep;
  o.measure = measure;
  o.period_limit = 16;
  return o;
}

/* Some coefficients become zero. */
static void thin_out(ric_grazing_map *map, random_source *source) {
  for (size_t i = 0; i < map->size * map->size; i++)
    if (random_below(source, 3) == 0)
      map->L[i] = 0;
  for (size_t i = 1; i < map->size; i++)
    if (random_below(source, 2) == 0)
      map->eta[i] = map->xi[i] = 0;
}

/* Maps that contract or not, dense or not, from starts of all sizes. */
static map_runs random_runs(random_source *source, size_t size, const ric_attractor_options *options,
                            ric_grazing_map *maps) {
  for (size_t i = 0; i < MAPS; i++) {
    maps[i] = random_map(source, size, random_uniform(source, 0.02, i % 5 == 0 ? 1.3 : 0.99));
    if (i % 3 == 0)
      thin_out(&maps[i], source);
  }
  map_runs runs = map_runs_of(&maps[0], MAPS, options);
  for (size_t i = 0; i < MAPS; i++) {
    runs.maps[i] = &maps[i];
    runs.d[i] = random_below(source, 20) == 0 ? 0 : exp(random_uniform(source, -12, 1)) * (i % 4 == 0 ? -1 : 1);
    for (size_t k = 0; k < size; k++)
      runs.attractors[i].z[k] = random_below(source, 4) == 0 ? 0 : random_uniform(source, -1, 1);
  }
  return runs;
}

/* What comes of the same runs in another order, some at a time. */
static void check_regrouped(const map_runs *starts, const map_runs *expected, ric_map_lanes lanes) {
  static const size_t from[] = {0, 7, 40}, steps[] = {1, 7, 26}, counts[] = {MAPS, 33, 3};
  for (size_t g = 0; g < 3; g++) {
    map_runs again = map_runs_again(starts, from[g], steps[g], counts[g]);
    map_runs_go(&again, lanes);
    for (size_t i = 0; i < counts[g]; i++)
      assert_same_attractor(&again, i, expected, (from[g] + i * steps[g]) % MAPS);
    map_runs_clear(&again);
  }
}

static void results_are_the_same_bits_in_every_variant_and_order(void **state) {
  (void)state;
  random_source source = {21};
  size_t seen[RIC_ATTRACTOR_KINDS] = {0};
  for (size_t k = 0; k < 4 * MOST_SIZE; k++) {
    size_t size = 1 + k % MOST_SIZE;
    ric_attractor_options o = short_run(k % 2 ? 1400 : 37, 40, 100);
    o.exponents = k / MOST_SIZE % 4 == 0 ? 0 : k / MOST_SIZE % 4 == 1 ? 1 : random_below(&source, size + 1);
    o.bound = k % 3 == 0 ? 100 : 1e100;
    ric_grazing_map maps[MAPS];
    map_runs starts = random_runs(&source, size, &o, maps), one = map_runs_again(&starts, 0, 1, MAPS);
    map_runs_go(&one, RIC_MAP_LANES_ONE);
    for (int lanes = 0; lanes < RIC_MAP_LANES_KINDS; lanes++)
      if (ric_map_lanes_available((ric_map_lanes)lanes))
        check_regrouped(&starts, &one, (ric_map_lanes)lanes);
    for (size_t i = 0; i < MAPS; i++) {
      seen[one.attractors[i].kind]++;
      ric_grazing_map_clear(&maps[i]);
    }
    map_runs_clear(&starts);
    map_runs_clear(&one);
  }
  assert_true(seen[RIC_ATTRACTOR_PERIODIC] > 100 && seen[RIC_ATTRACTOR_APERIODIC] > 100);
  assert_true(seen[RIC_ATTRACTOR_DIVERGED] > 100);
}

/* A contraction from a start of random size: rounding stays rounding where the attractor is a stable cycle. */
static void iterates_are_those_of_the_map(void **state) {
  (void)state;
  random_source source = {22};
  size_t compared = 0;
  for (size_t k = 0; k < 20 * MOST_SIZE; k++) {
    enum { TRANSIENT = 600, KEEP = 30 };
    ric_grazing_map map = random_map(&source, 1 + k % MOST_SIZE, random_uniform(&source, 0.05, 0.6));
    ric_attractor_options o = short_run(TRANSIENT, KEEP, KEEP + 3);
    double z[MOST_SIZE], work[MOST_SIZE];
    o.observe = map.size - 1;
    map_runs runs = map_runs_of(&map, 1, &o);
    ric_attractor *a = &runs.attractors[0];
    runs.d[0] = random_uniform(&source, 0.01, 1);
    for (size_t i = 0; i < map.size; i++)
      z[i] = a->z[i] = random_uniform(&source, -1, 1);
    map_runs_go(&runs, ric_map_lanes_widest());
    map_iterate(&map, runs.d[0], z, TRANSIENT, work);
    for (size_t j = 0; j < KEEP && a->kind == RIC_ATTRACTOR_PERIODIC; j++) {
      map_iterate(&map, runs.d[0], z, 1, work);
      assert_close(relative_distance(a->states + j * map.size, z, map.size), 0, 1e-9);
      assert_close(a->values[j], a->states[j * map.size + o.observe], 0);
      compared++;
    }
    map_iterate(&map, runs.d[0], z, 3, work);
    if (a->kind == RIC_ATTRACTOR_PERIODIC)
      assert_close(relative_distance(a->z, z, map.size), 0, 1e-9);
    map_runs_clear(&runs);
    ric_grazing_map_clear(&map);
  }
  assert_true(compared > 1000);
}

/* The example at 150 values of d, in windows and chaos. */
static map_runs example_runs(const ric_grazing_map *map, size_t count, const ric_attractor_options *options) {
  map_runs runs = map_runs_of(map, count, options);
  for (size_t i = 0; i < count; i++)
    runs.d[i] = 5e-5 * pow(600, (double)i / (double)count);
  return runs;
}

/* Iterates that are measured are all computed; of those before, known ones are left out. */
static void what_is_left_out_of_a_transient_changes_no_bit(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  static const double signs[] = {1, -1};
  for (size_t k = 0; k < 2; k++) {
    ric_attractor_options left_out = short_run(5000, 0, 1), all = short_run(0, 0, 5001);
    map_runs a = example_runs(&map, 150, &left_out), b = example_runs(&map, 150, &all);
    for (size_t i = 0; i < 150; i++)
      a.d[i] = b.d[i] *= signs[k];
    for (size_t i = 0; i < 150 && k == 1; i++)
      a.attractors[i].z[0] = b.attractors[i].z[0] = 1;
    map_runs_go(&a, ric_map_lanes_widest());
    map_runs_go(&b, ric_map_lanes_widest());
    for (size_t i = 0; i < 150; i++) {
      assert_memory_equal(a.attractors[i].z, b.attractors[i].z, 3 * sizeof(double));
      assert_int_equal(a.attractors[i].period, b.attractors[i].period);
    }
    map_runs_clear(&a);
    map_runs_clear(&b);
  }
  ric_grazing_map_clear(&map);
}

static void runs_go_on_from_where_they_ended(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  ric_attractor_options whole = short_run(700, 50, 50), part = short_run(300, 0, 1), rest = short_run(399, 50, 50);
  map_runs a = example_runs(&map, 40, &whole), b = example_runs(&map, 40, &part);
  map_runs_go(&a, ric_map_lanes_widest());
  map_runs_go(&b, ric_map_lanes_widest());
  map_runs c = example_runs(&map, 40, &rest);
  for (size_t i = 0; i < 40; i++)
    memcpy(c.attractors[i].z, b.attractors[i].z, 3 * sizeof(double));
  map_runs_go(&c, ric_map_lanes_widest());
  for (size_t i = 0; i < 40; i++)
    assert_memory_equal(a.attractors[i].z, c.attractors[i].z, a.piece * sizeof(double));
  map_runs_clear(&a);
  map_runs_clear(&b);
  map_runs_clear(&c);
  ric_grazing_map_clear(&map);
}

static void example_has_the_periods_of_the_source(void **state) {
  (void)state;
  static const double d[] = {0.03, 0.0277, 0.0138, 0.0043, 1.5e-4};
  static const size_t periods[] = {4, 0, 5, 5, 0};
  ric_grazing_map map = example_map(0.5, 0.3);
  ric_attractor_options o = ric_attractor_options_default();
  o.transient = 100000; /* near the edges motions come to their attractor slowly */
  map_runs runs = map_runs_of(&map, 5, &o);
  memcpy(runs.d, d, sizeof d);
  map_runs_go(&runs, ric_map_lanes_widest());
  for (size_t i = 0; i < 5; i++) {
    const ric_attractor *a = &runs.attractors[i];
    assert_int_equal(a->kind, periods[i] ? RIC_ATTRACTOR_PERIODIC : RIC_ATTRACTOR_APERIODIC);
    assert_int_equal(a->period, periods[i]);
    assert_int_equal(a->iterates, 101000);
    if (periods[i])
      assert_close(a->impacts, 1.0 / (double)periods[i], 1e-3); /* one impact each */
  }
  map_runs_clear(&runs);
  ric_grazing_map_clear(&map);
}

/* z doubles from 1 and crosses 2^280 with iterate 281; the next look is at 300, where storing ends. */
static void divergence_is_found_and_stays_alone(void **state) {
  (void)state;
  ric_grazing_map away = map_of_size_1(2, 1, 0), back = map_of_size_1(0.5, 1, 0);
  ric_attractor_options o = short_run(250, 50, 100);
  o.bound = 0x1p280;
  map_runs runs = map_runs_of(&back, 40, &o);
  for (size_t i = 0; i < 40; i++)
    runs.d[i] = 0.1 + 0.01 * (double)i;
  map_runs alone = map_runs_again(&runs, 0, 1, 40);
  runs.maps[11] = &away;
  runs.d[11] = 0.5;
  runs.attractors[11].z[0] = 1;
  map_runs_go(&runs, ric_map_lanes_widest());
  map_runs_go(&alone, ric_map_lanes_widest());
  for (size_t i = 0; i < 40; i++)
    if (i != 11)
      assert_same_attractor(&runs, i, &alone, i);
  const ric_attractor *a = &runs.attractors[11];
  assert_int_equal(a->kind, RIC_ATTRACTOR_DIVERGED);
  assert_int_equal(a->iterates, 300);
  assert_close(a->z[0], 0x1p256, 0); /* at the look before */
  for (size_t j = 0; j < 50; j++)
    assert_true(j < 6 ? a->values[j] == ldexp(1, 251 + (int)j) : isnan(a->values[j]) && isnan(a->states[j]));
  assert_close(a->impacts, 0, 0);
  assert_string_equal(a->reason, "a number of the state exceeded 1.94267e+84 by iterate 300");
  map_runs_clear(&runs);
  map_runs_clear(&alone);
  ric_grazing_map_clear(&away);
  ric_grazing_map_clear(&back);
}

static void running_allocates_nothing(void **state) {
  (void)state;
#ifndef ALLOCATIONS_ARE_COUNTED
  skip();
#else
  ric_grazing_map map = example_map(0.5, 0.3);
  ric_attractor_options o = short_run(2000, 10, 10);
  o.exponents = 3;
  map_runs runs = example_runs(&map, 70, &o);
  for (int lanes = 0; lanes < RIC_MAP_LANES_KINDS; lanes++) {
    ric_map_runner *runner;
    if (ric_map_runner_create(3, &o, (ric_map_lanes)lanes, &runner, NULL) != RIC_OK)
      continue;
    size_t before = allocations;
    watching = true;
    assert_int_equal(ric_map_runner_run(runner, 70, runs.maps, runs.d, runs.attractors, NULL), RIC_OK);
    watching = false;
    assert_int_equal(allocations, before);
    ric_map_runner_destroy(&runner);
  }
  map_runs_clear(&runs);
  ric_grazing_map_clear(&map);
#endif
}

static int stop_at_last(void *user) {
  return --*(int *)user <= 0;
}

static void poll_is_asked_and_obeyed(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3);
  ric_error error;
  for (int lanes = 0; lanes < RIC_MAP_LANES_KINDS; lanes++) {
    int left = 5;
    ric_attractor_options o = short_run(100000, 0, 1);
    o.poll = (ric_poll){.call = stop_at_last, .user = &left};
    map_runs runs = map_runs_of(&map, 1, &o);
    ric_map_runner *runner;
    runs.d[0] = 1.5e-4; /* chaos: nothing is left out */
    if (ric_map_runner_create(3, &o, (ric_map_lanes)lanes, &runner, NULL) == RIC_OK) {
      assert_int_equal(ric_map_runner_run(runner, 1, runs.maps, runs.d, runs.attractors, &error), RIC_ESTOPPED);
      assert_int_equal(left, 0);
      assert_string_equal(error.message, "stopped by the poll callback");
    }
    ric_map_runner_destroy(&runner);
    map_runs_clear(&runs);
  }
  ric_grazing_map_clear(&map);
}

static void check_refused(size_t size, const ric_attractor_options *o, int lanes, const char *message) {
  ric_map_runner *runner = NULL;
  ric_error error = {0};
  assert_int_equal(ric_map_runner_create(size, o, (ric_map_lanes)lanes, &runner, &error), RIC_EINVAL);
  assert_string_equal(error.message, message);
  assert_null(runner);
}

static void options_out_of_range_are_refused(void **state) {
  (void)state;
  const ric_attractor_options fine = ric_attractor_options_default();
  ric_attractor_options o = fine;
  assert_int_equal(ric_attractor_options_check(&o, 1, NULL), RIC_OK);
#define REFUSED(member, value, message)                                                                                \
  o = fine;                                                                                                            \
  o.member = value;                                                                                                    \
  check_refused(3, &o, RIC_MAP_LANES_ONE, message)
  REFUSED(measure, 0, "measure = 0, expected 1 to 4503599627370496");
  REFUSED(keep, 1001, "keep = 1001, expected at most measure = 1000");
  REFUSED(observe, 3, "observe = 3, expected a number of a state of 3");
  REFUSED(exponents, 4, "exponents = 4, expected at most 3, the size of the state");
  REFUSED(period_limit, 0, "period_limit = 0, expected 1 to 100000");
  REFUSED(period_limit, 100001, "period_limit = 100001, expected 1 to 100000");
  REFUSED(period_tol, NAN, "period_tol = nan, expected 0 < period_tol < 1");
  REFUSED(bound, NAN, "bound = nan, expected a finite number > 0");
  REFUSED(bound, INFINITY, "bound = inf, expected a finite number > 0");
#undef REFUSED
  check_refused(0, &fine, RIC_MAP_LANES_ONE, "size = 0, expected at least 1");
  check_refused(3, &fine, RIC_MAP_LANES_KINDS, "lanes = unknown, which this processor does not have");
}

static void maps_and_starts_that_are_not_finite_are_refused(void **state) {
  (void)state;
  ric_grazing_map map = example_map(0.5, 0.3), small = map_of_size_1(0.5, 1, 0);
  ric_attractor_options o = short_run(10, 0, 10);
  map_runs runs = map_runs_of(&map, 3, &o);
  ric_map_runner *runner;
  ric_error error;
  assert_int_equal(ric_map_runner_create(3, &o, RIC_MAP_LANES_ONE, &runner, NULL), RIC_OK);
#define REFUSED(text)                                                                                                  \
  assert_int_equal(ric_map_runner_run(runner, 3, runs.maps, runs.d, runs.attractors, &error), RIC_EINVAL);             \
  assert_string_equal(error.message, text)
  runs.d[1] = NAN;
  REFUSED("d[1] = nan, expected a finite number");
  runs.d[1] = 0.03;
  runs.attractors[2].z[1] = INFINITY;
  REFUSED("z[1] = inf of attractors[2], expected a finite number");
  runs.attractors[2].z[1] = 0;
  runs.maps[2] = &small;
  REFUSED("maps[2] has the size 1, expected 3");
  runs.maps[2] = &map;
  map.L[4] = NAN;
  REFUSED("maps[0]: L[1][1] = nan, expected a finite number");
#undef REFUSED
  ric_map_runner_destroy(&runner);
  assert_null(runner);
  ric_map_runner_destroy(&runner);
  map_runs_clear(&runs);
  ric_grazing_map_clear(&map);
  ric_grazing_map_clear(&small);
}

static void kinds_and_lanes_have_names(void **state) {
  (void)state;
  assert_string_equal(ric_attractor_kind_name(RIC_ATTRACTOR_APERIODIC), "aperiodic");
  assert_string_equal(ric_attractor_kind_name(RIC_ATTRACTOR_KINDS), "unknown");
  assert_string_equal(ric_map_lanes_name(RIC_MAP_LANES_EIGHT), "eight");
  assert_true(ric_map_lanes_available(RIC_MAP_LANES_ONE) && ric_map_lanes_available(ric_map_lanes_widest()));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(results_are_the_same_bits_in_every_variant_and_order),
      cmocka_unit_test(iterates_are_those_of_the_map),
      cmocka_unit_test(what_is_left_out_of_a_transient_changes_no_bit),
      cmocka_unit_test(runs_go_on_from_where_they_ended),
      cmocka_unit_test(example_has_the_periods_of_the_source),
      cmocka_unit_test(divergence_is_found_and_stays_alone),
      cmocka_unit_test(running_allocates_nothing),
      cmocka_unit_test(poll_is_asked_and_obeyed),
      cmocka_unit_test(options_out_of_range_are_refused),
      cmocka_unit_test(maps_and_starts_that_are_not_finite_are_refused),
      cmocka_unit_test(kinds_and_lanes_have_names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
