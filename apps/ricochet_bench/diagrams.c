/* Scenarios of maps run to their attractors: bifurcation diagrams and maps of periods. */
#include <math.h>
#include <stdlib.h>

#include <ricochet/ricochet.h>

#include "bench.h"

enum { SIZE = 3, VALUES = 600, ITERATES = 10000 };

/* Maps and what comes of them. */
typedef struct diagram {
  size_t count;
  ric_grazing_map *own;         /* [count] */
  const ric_grazing_map **maps; /* [count] */
  double *d;                    /* [count] */
  ric_attractor *attractors;    /* [count] */
  double *numbers;              /* [count][2 SIZE] states and exponents */
} diagram;

static void diagram_clear(diagram *g) {
  for (size_t i = 0; i < g->count && g->own; i++)
    ric_grazing_map_clear(&g->own[i]);
  free(g->own);
  free(g->maps);
  free(g->d);
  free(g->attractors);
  free(g->numbers);
}

static int diagram_init(diagram *g, size_t count) {
  *g = (diagram){.count = count};
  g->own = calloc(count, sizeof *g->own);
  g->maps = calloc(count, sizeof *g->maps);
  g->d = calloc(count, sizeof *g->d);
  g->attractors = calloc(count, sizeof *g->attractors);
  g->numbers = calloc(count * 2 * SIZE, sizeof *g->numbers);
  if (!g->own || !g->maps || !g->d || !g->attractors || !g->numbers)
    return 1;
  for (size_t i = 0; i < count; i++) {
    g->maps[i] = &g->own[i];
    g->attractors[i] = (ric_attractor){.z = g->numbers + 2 * SIZE * i, .exponents = g->numbers + 2 * SIZE * i + SIZE};
  }
  return 0;
}

static int diagram_set(diagram *g, size_t i, double lambda, double omega, double d) {
  g->d[i] = d;
  return ric_grazing_map_example(&g->own[i], lambda, omega, NULL) != RIC_OK;
}

/* Times the runs from the same start, once more after others in which everything has been touched. */
static work_done diagram_run(diagram *g, const ric_attractor_options *options, int lanes, double start, int failed) {
  ric_map_runner *runner = NULL;
  double seconds = 0, iterates = 0;
  failed = failed || ric_map_runner_create(SIZE, options, (ric_map_lanes)lanes, &runner, NULL) != RIC_OK;
  for (int k = 0; k < 2 && !failed; k++) {
    for (size_t i = 0; i < g->count * 2 * SIZE; i++)
      g->numbers[i] = start;
    double began = bench_seconds();
    failed = ric_map_runner_run(runner, g->count, g->maps, g->d, g->attractors, NULL) != RIC_OK;
    seconds = bench_seconds() - began;
  }
  for (size_t i = 0; i < g->count; i++)
    iterates += (double)g->attractors[i].iterates;
  ric_map_runner_destroy(&runner);
  size_t tasks = g->count;
  diagram_clear(g);
  return (work_done){.tasks = tasks,
                     .n = SIZE,
                     .failed = failed,
                     .seconds = seconds,
                     .measure = "iterates_per_second",
                     .value = iterates / seconds};
}

/* The diagram of [FN97], nothing left out. Where a processor has not these lanes, the widest it has. */
static work_done diagram_of_example(size_t exponents, int lanes) {
  diagram g;
  ric_attractor_options o = ric_attractor_options_default();
  int failed = diagram_init(&g, VALUES);
  for (size_t i = 0; i < VALUES && !failed; i++)
    failed = diagram_set(&g, i, 0.5, 0.3, 5e-5 + (0.03 - 5e-5) * (double)i / (VALUES - 1));
  o.transient = o.keep = 0;
  o.measure = ITERATES;
  o.period_limit = 1;
  o.exponents = exponents;
  if (!ric_map_lanes_available((ric_map_lanes)lanes))
    lanes = (int)ric_map_lanes_widest();
  return diagram_run(&g, &o, lanes, 0, failed);
}

/* Periods over lambda and d > 0, or, with a sign of -1, d < 0, where all that sets out from 1 comes to rest. */
static work_done period_map(size_t side, int sign) {
  diagram g;
  ric_attractor_options o = ric_attractor_options_default();
  int failed = diagram_init(&g, side * side);
  for (size_t i = 0; i < side * side && !failed; i++) {
    double lambda = 0.05 + 0.9 * (double)(i / side) / (double)(side - 1);
    double d = sign * 1e-5 * pow(1e4, (double)(i % side) / (double)(side - 1));
    failed = diagram_set(&g, i, lambda, 0.3 * lambda, d);
  }
  o.keep = 0;
  return diagram_run(&g, &o, (int)ric_map_lanes_widest(), sign < 0, failed);
}

const benchmark diagram_benchmarks[] = {
    {"diagram_one", "600 values of d, 10 000 iterates each, one after another", 5, 0, RIC_MAP_LANES_ONE,
     diagram_of_example},
    {"diagram_four", "the same in lanes of four", 5, 0, RIC_MAP_LANES_FOUR, diagram_of_example},
    {"diagram_eight", "the same in lanes of eight", 5, 0, RIC_MAP_LANES_EIGHT, diagram_of_example},
    {"diagram_exponent", "with the largest exponent", 5, 1, RIC_MAP_LANES_EIGHT, diagram_of_example},
    {"diagram_exponents", "with all three", 5, 3, RIC_MAP_LANES_EIGHT, diagram_of_example},
    {"period_map", "periods of 100 x 100 maps, lambda from 0.05 to 0.95, d from 1e-5 to 0.1", 3, 100, 1, period_map},
    {"period_map_at_rest", "the same with d < 0", 3, 100, -1, period_map},
    {0}};
