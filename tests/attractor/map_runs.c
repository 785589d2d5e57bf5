#include "map_runs.h"

#include "support.h"

static void point_into(map_runs *r, size_t i) {
  double *piece = r->numbers + i * r->piece;
  size_t keep = r->options.keep;
  r->attractors[i] = (ric_attractor){.z = piece,
                                     .values = piece + r->size,
                                     .states = piece + r->size + keep,
                                     .exponents = piece + r->size + keep + keep * r->size};
}

static void allocate(map_runs *r) {
  r->piece = r->size + r->options.keep * (1 + r->size) + r->options.exponents;
  r->numbers = calloc(r->count * r->piece, sizeof *r->numbers);
  assert_non_null(r->numbers);
  for (size_t i = 0; i < r->count; i++)
    point_into(r, i);
}

map_runs map_runs_of(const ric_grazing_map *map, size_t count, const ric_attractor_options *options) {
  map_runs r = {.count = count, .size = map->size, .options = *options};
  assert_in_range(count, 1, MAP_RUNS_MOST);
  for (size_t i = 0; i < count; i++)
    r.maps[i] = map;
  allocate(&r);
  return r;
}

map_runs map_runs_again(const map_runs *runs, size_t from, size_t step, size_t count) {
  map_runs r = {.count = count, .size = runs->size, .options = runs->options};
  allocate(&r);
  for (size_t i = 0; i < count; i++) {
    size_t k = (from + i * step) % runs->count;
    r.maps[i] = runs->maps[k];
    r.d[i] = runs->d[k];
    memcpy(r.attractors[i].z, runs->attractors[k].z, r.size * sizeof(double));
  }
  return r;
}

void map_runs_clear(map_runs *runs) {
  free(runs->numbers);
}

void map_runs_go(map_runs *r, ric_map_lanes lanes) {
  ric_map_runner *runner = NULL;
  ric_error error = {0};
  if (ric_map_runner_create(r->size, &r->options, lanes, &runner, &error) != RIC_OK ||
      ric_map_runner_run(runner, r->count, r->maps, r->d, r->attractors, &error) != RIC_OK)
    fail_msg("%s", error.message);
  ric_map_runner_destroy(&runner);
}

static void assert_same_number(double a, double b, const char *what, size_t i) {
  if (memcmp(&a, &b, sizeof a) != 0)
    fail_msg("%s of value %zu: %.17g and %.17g", what, i, a, b);
}

void assert_same_attractor(const map_runs *a, size_t i, const map_runs *b, size_t k) {
  const ric_attractor *x = &a->attractors[i], *y = &b->attractors[k];
  assert_int_equal(a->piece, b->piece);
  assert_int_equal(x->kind, y->kind);
  assert_int_equal(x->period, y->period);
  assert_int_equal(x->iterates, y->iterates);
  assert_string_equal(x->reason, y->reason);
  assert_same_number(x->impacts, y->impacts, "impacts", i);
  for (size_t j = 0; j < a->piece; j++)
    assert_same_number(x->z[j], y->z[j], j < a->size ? "z" : "what is stored", i);
}
