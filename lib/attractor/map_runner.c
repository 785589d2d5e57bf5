#include "ricochet/attractor.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attractor.h"
#include "cycle_growth.h"
#include "map_simd.h"
#include "numeric/constants.h"
#include "numeric/linear.h"
#include "numeric/number_block.h"
#include "ricochet/elementary.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

enum {
  PIECE_LENGTH = 16,    /* iterates at a time: their states stay in the cache */
  CHECK_INTERVAL = 64,  /* iterates between two checks of the bound */
  LONGEST_CYCLE = 64,   /* longest cycle that is searched for, with states equal in every bit */
  SEARCH_INTERVAL = 512 /* iterates between two such searches */
};

static const double rounding = 1e-12;   /* of states that return, relative to the largest number */
static const size_t align_time = 256;   /* iterates before the measured ones in which tangent vectors align */
static const size_t poll_work = 100000; /* products between two polls: well below a millisecond */

struct ric_map_runner {
  ric_attractor_options options;
  map_kernel kernel;
  map_block block;
  size_t piece;
  double *numbers;        /* owns: */
  double *trace;          /* [longest + 1][size][width] states, of which the first is the present one */
  double *checked_states; /* [size][width] at the last check */
  double *measured;       /* [size][width] after the iterates measured */
  double *impacts;        /* [width] counted at the last check, or after the iterates measured */
  double *length;         /* [exponents][width] logarithms of the lengths at the start of measuring */
  double *orbit;          /* [2 period_limit + 1][size] of one map */
  double *directions;     /* [exponents][size] initial tangent vectors */
  size_t *cycle;          /* [width] length of the cycle */
  bool *diverged;         /* [width] diverged */
  size_t *sound;          /* [width] the last iterate known before a map diverged */
  cycle_growth growth;    /* with exponents */
  /* of the present block: */
  const ric_grazing_map *const *maps; /* borrowed */
  const double *d;                    /* borrowed */
  ric_attractor *attractors;
  size_t count, left;   /* maps; those that have not diverged */
  size_t done, checked; /* iterates; at the last check */
  size_t counted;       /* iterates over which `impacts` are counted */
  size_t work;          /* since the last poll */
};

/* --- life --------------------------------------------------------------------------------------------------------- */

bool ric_map_lanes_available(ric_map_lanes lanes) {
  return map_kernel_of(lanes).advance != NULL;
}

ric_map_lanes ric_map_lanes_widest(void) {
  int lanes = RIC_MAP_LANES_KINDS - 1;
  while (!ric_map_lanes_available((ric_map_lanes)lanes))
    lanes--;
  return (ric_map_lanes)lanes;
}

static ric_status allocate_runner(ric_map_runner *r, size_t size, ric_error *error) {
  const ric_attractor_options *o = &r->options;
  size_t width = r->kernel.width, state = size * width, longest = 2 * o->period_limit;
  RIC_TRY(map_block_init(&r->block, size, width, o->exponents, error));
  if (longest < LONGEST_CYCLE)
    longest = LONGEST_CYCLE;
  size_t numbers = (longest + 3) * state + (1 + o->exponents) * width + (longest + 1 + o->exponents) * size;
  double *store = r->numbers = aligned_alloc(64, (numbers * sizeof *store / 64 + 1) * 64);
  r->diverged = calloc(width, sizeof *r->diverged);
  r->cycle = calloc(width, sizeof *r->cycle);
  r->sound = calloc(width, sizeof *r->sound);
  if (!store || !r->diverged || !r->cycle || !r->sound)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu iterates of %zu maps of size %zu", longest, width, size);
  r->trace = number_store_take(&store, (longest + 1) * state);
  r->checked_states = number_store_take(&store, state);
  r->measured = number_store_take(&store, state);
  r->impacts = number_store_take(&store, width);
  r->length = number_store_take(&store, o->exponents * width);
  r->orbit = number_store_take(&store, (longest + 1) * size);
  r->directions = number_store_take(&store, o->exponents * size);
  return RIC_OK;
}

/* Initial tangent vectors, one after another. */
static ric_status set_directions(ric_map_runner *r, ric_error *error) {
  size_t size = r->block.size, count = r->options.exponents;
  orthonormal_work work = {0};
  if (count == 0)
    return RIC_OK;
  double *x = malloc((size * count + count) * sizeof *x);
  ric_status status = x ? orthonormal_init(&work, size, count, error)
                        : ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors", count);
  if (status == RIC_OK) {
    orthonormal_scatter(&work, x, x + size * count);
    for (size_t k = 0; k < count; k++)
      for (size_t i = 0; i < size; i++)
        r->directions[k * size + i] = x[i * count + k];
  }
  orthonormal_clear(&work);
  free(x);
  return status;
}

ric_status ric_map_runner_create(size_t size, const ric_attractor_options *options, ric_map_lanes lanes,
                                 ric_map_runner **runner, ric_error *error) {
  REQUIRE(error, {"runner", runner});
  ric_attractor_options o = options ? *options : ric_attractor_options_default();
  *runner = NULL;
  if (size < 1)
    return ric_fail(error, RIC_EINVAL, "size = 0, expected at least 1");
  RIC_TRY(ric_attractor_options_check(&o, size, error));
  if (!ric_map_lanes_available(lanes))
    return ric_fail(error, RIC_EINVAL, "lanes = %s, which this processor does not have", ric_map_lanes_name(lanes));
  ric_map_runner *r = calloc(1, sizeof *r);
  if (!r)
    return ric_fail(error, RIC_ENOMEM, "no memory for a runner of maps");
  r->options = o;
  r->kernel = map_kernel_of(lanes);
  size_t fit = 4096 / (size * (1 + o.exponents)) / size; /* short pieces: the poll is called in time */
  r->piece = fit < 1 ? 1 : fit < PIECE_LENGTH ? fit : PIECE_LENGTH;
  keep_gsl_quiet();
  ric_status status = allocate_runner(r, size, error);
  if (status == RIC_OK)
    status = set_directions(r, error);
  if (status == RIC_OK && o.exponents > 0)
    status = cycle_growth_init(&r->growth, size, error);
  if (status != RIC_OK)
    ric_map_runner_destroy(&r);
  *runner = r;
  return status;
}

void ric_map_runner_destroy(ric_map_runner **runner) {
  if (!runner || !*runner)
    return;
  map_block_clear(&(*runner)->block);
  free((*runner)->numbers);
  free((*runner)->diverged);
  free((*runner)->cycle);
  free((*runner)->sound);
  cycle_growth_clear(&(*runner)->growth);
  free(*runner);
  *runner = NULL;
}

/* --- states and values of a block --------------------------------------------------------------------------------- */

/* Changes minus zero to zero: its sign may depend on whether a product of zero is omitted, and no result may. */
static double normalise_zero(double x) {
  return x + 0.0;
}

static void copy_lane(const ric_map_runner *r, const double *state, size_t lane, double *z) {
  for (size_t i = 0; i < r->block.size; i++)
    z[i] = normalise_zero(state[i * r->block.width + lane]);
}

/* Stores iterates done + 1 ... done + count. */
static void store(const ric_map_runner *r, const double *first, size_t count) {
  size_t size = r->block.size, width = r->block.width, from = r->done - r->options.transient;
  for (size_t l = 0; l < r->count; l++) {
    const ric_attractor *a = &r->attractors[l];
    for (size_t k = 0; k < count && !r->diverged[l]; k++) {
      const double *state = first + k * size * width;
      if (a->values)
        a->values[from + k] = normalise_zero(state[r->options.observe * width + l]);
      if (a->states)
        copy_lane(r, state, l, a->states + (from + k) * size);
    }
  }
}

/* Marks what is stored of a map that has diverged as unknown from there on. @returns RIC_ESTOPPED */
static ric_status erase(const ric_map_runner *r, size_t lane, ric_error *error) {
  const ric_attractor_options *o = &r->options;
  const ric_attractor *a = &r->attractors[lane];
  const size_t known = r->sound[lane] > o->transient ? r->sound[lane] - o->transient : 0;
  if (known >= o->keep)
    return RIC_OK;
  if (a->values)
    RIC_TRY(fill_unknown(a->values + known, o->keep - known, o->poll, error));
  if (a->states)
    RIC_TRY(fill_unknown(a->states + known * r->block.size, (o->keep - known) * r->block.size, o->poll, error));
  return RIC_OK;
}

/* A map has diverged: its lane gets a state that stays zero. */
static void set_diverged(ric_map_runner *r, double *state, size_t lane) {
  size_t size = r->block.size, width = r->block.width;
  r->diverged[lane] = true;
  r->block.d[lane] = -1;
  for (size_t i = 0; i < size; i++)
    state[i * width + lane] = 0;
  if (lane >= r->count)
    return;
  r->left--;
  ric_attractor *a = &r->attractors[lane];
  copy_lane(r, r->checked_states, lane, a->z);
  r->sound[lane] = r->checked;
  for (size_t k = 0; k < r->options.exponents && a->exponents; k++)
    a->exponents[k] = NAN;
  for (size_t i = 0; i < size && a->lowest; i++)
    a->lowest[i] = NAN;
  a->kind = RIC_ATTRACTOR_DIVERGED;
  a->period = 0;
  a->impacts = r->counted > 0 ? r->impacts[lane] / (double)r->counted : NAN;
  a->iterates = r->done;
  snprintf(a->reason, sizeof a->reason, "a number of the state exceeded %g by iterate %zu", r->options.bound, r->done);
}

static bool all_within(const double *numbers, size_t count, double bound) {
  size_t beyond = 0;
  for (size_t i = 0; i < count; i++)
    beyond += !(fabs(numbers[i]) <= bound);
  return beyond == 0;
}

static bool lane_within(const ric_map_runner *r, const double *state, size_t lane) {
  for (size_t i = 0; i < r->block.size; i++)
    if (!(fabs(state[i * r->block.width + lane]) <= r->options.bound))
      return false;
  return true;
}

/* Finds maps that have diverged. */
static void find_diverged(ric_map_runner *r, double *state) {
  size_t width = r->block.width, numbers = r->block.size * width, first = r->options.transient;
  if (!all_within(state, numbers, r->options.bound))
    for (size_t l = 0; l < width; l++)
      if (!lane_within(r, state, l))
        set_diverged(r, state, l);
  memcpy(r->checked_states, state, numbers * sizeof *state);
  r->checked = r->done;
  if (r->done > first && r->done - first <= r->options.measure) {
    memcpy(r->impacts, r->block.impacts, width * sizeof *r->impacts);
    r->counted = r->done - first;
  }
}

/* --- iterating a block -------------------------------------------------------------------------------------------- */

static size_t least(size_t a, size_t b) {
  return a < b ? a : b;
}

/* Iterates from a state in the trace, at most to the next check. @returns RIC_ESTOPPED */
static ric_status iterate(ric_map_runner *r, double *state, size_t count, ric_error *error) {
  size_t size = r->block.size;
  r->kernel.advance(&r->block, state, count);
  r->work += count * size * r->block.width * (size + 1) * (1 + r->block.vectors);
  if (r->work < poll_work)
    return RIC_OK;
  r->work = 0;
  return ric_poll_stops(r->options.poll) ? ric_fail(error, RIC_ESTOPPED, "stopped by the poll callback") : RIC_OK;
}

/* Iterates; afterwards the last state is the first one of the trace. @param stores  the iterates become results */
static ric_status advance_maps(ric_map_runner *r, size_t until, bool stores, ric_error *error) {
  size_t state = r->block.size * r->block.width;
  while (r->done < until && r->left > 0) {
    size_t count = least(least(r->piece, until - r->done), CHECK_INTERVAL - r->done % CHECK_INTERVAL);
    double *last = r->trace + count * state;
    RIC_TRY(iterate(r, r->trace, count, error));
    if (stores)
      store(r, r->trace + state, count);
    r->done += count;
    if (r->done % CHECK_INTERVAL == 0 || r->done == until)
      find_diverged(r, last);
    memcpy(r->trace, last, state * sizeof *last);
  }
  return RIC_OK;
}

/* Iterates at most as often as the trace has room, and leaves all states in the trace. */
static ric_status trace_maps(ric_map_runner *r, size_t count, ric_error *error) {
  size_t state = r->block.size * r->block.width;
  double *at = r->trace;
  for (size_t until = r->done + count; r->done < until && r->left > 0;) {
    size_t next = least(least(r->piece, until - r->done), CHECK_INTERVAL - r->done % CHECK_INTERVAL);
    RIC_TRY(iterate(r, at, next, error));
    r->done += next;
    at += next * state;
    if (r->done % CHECK_INTERVAL == 0 || r->done == until)
      find_diverged(r, at);
  }
  return RIC_OK;
}

/* The number of iterates after which a lane has exactly the state at the start of the trace; 0: more than
 * LONGEST_CYCLE, or a state beyond the bound in between, which a check would find. */
static size_t cycle_of_lane(const ric_map_runner *r, size_t lane) {
  size_t size = r->block.size, width = r->block.width;
  for (size_t k = 1; k <= LONGEST_CYCLE; k++) {
    const double *state = r->trace + k * size * width;
    size_t same = 0;
    while (same < size && state[same * width + lane] == r->trace[same * width + lane])
      same++;
    if (same == size)
      return k;
    if (!lane_within(r, state, lane))
      return 0;
  }
  return 0;
}

/* Where all maps of a block are on cycles, equal in every bit, their states at iterate `until` are known: skips to
 * it. */
static bool skip_cycles(ric_map_runner *r, size_t until) {
  size_t size = r->block.size, width = r->block.width, ahead = until - r->done + LONGEST_CYCLE;
  for (size_t l = 0; l < width; l++)
    if ((r->cycle[l] = cycle_of_lane(r, l)) == 0)
      return false;
  for (size_t l = 0; l < width; l++)
    for (size_t i = 0; i < size; i++)
      r->trace[i * width + l] = r->trace[(ahead % r->cycle[l] * size + i) * width + l];
  r->done = until;
  find_diverged(r, r->trace);
  return true;
}

/* Iterates without results: only the last state counts. */
static ric_status run_transient(ric_map_runner *r, size_t until, ric_error *error) {
  size_t state = r->block.size * r->block.width;
  while (r->done < until && r->left > 0) {
    RIC_TRY(advance_maps(r, least(until, r->done + SEARCH_INTERVAL - LONGEST_CYCLE), false, error));
    if (until - r->done < SEARCH_INTERVAL)
      return advance_maps(r, until, false, error);
    size_t left = r->left;
    RIC_TRY(trace_maps(r, LONGEST_CYCLE, error));
    if (r->left == left && skip_cycles(r, until))
      return RIC_OK;
    memcpy(r->trace, r->trace + LONGEST_CYCLE * state, state * sizeof *r->trace);
  }
  return RIC_OK;
}

/* Logarithm of the length of a tangent vector. */
static double length_of(const map_block *b, size_t vector, size_t lane) {
  size_t at = vector * b->width + lane;
  return ric_log(b->norm[at]) / 2 + (double)b->power[at] * ln_2;
}

static void begin_measuring(ric_map_runner *r) {
  for (size_t l = 0; l < r->block.width; l++) {
    r->block.impacts[l] = 0;
    for (size_t k = 0; k < r->block.vectors; k++)
      r->length[k * r->block.width + l] = length_of(&r->block, k, l);
  }
}

/* A vector of length zero was removed, one whose length is not finite reached the border. */
static void set_exponents(const ric_map_runner *r, size_t lane, double *exponents) {
  for (size_t k = 0; k < r->block.vectors; k++) {
    double norm = r->block.norm[k * r->block.width + lane];
    double growth = length_of(&r->block, k, lane) - r->length[k * r->block.width + lane];
    exponents[k] = norm == 0 ? -INFINITY : isfinite(norm) ? growth / (double)r->options.measure : NAN;
  }
}

static void end_measuring(ric_map_runner *r) {
  memcpy(r->measured, r->trace, r->block.size * r->block.width * sizeof *r->trace);
  for (size_t l = 0; l < r->count; l++)
    if (!r->diverged[l] && r->attractors[l].exponents)
      set_exponents(r, l, r->attractors[l].exponents);
  r->block.vectors = 0;
}

/* Of a cycle the numbers of one period. @returns RIC_ESTOPPED */
static ric_status set_cycle_results(ric_map_runner *r, size_t lane, ric_error *error) {
  const ric_attractor_options *o = &r->options;
  ric_attractor *a = &r->attractors[lane];
  a->impacts = cycle_impacts(r->maps[lane], r->d[lane], r->orbit, a->period);
  return a->exponents && o->exponents > 0 ? cycle_exponents(&r->growth, r->maps[lane], r->d[lane], r->orbit, a->period,
                                                            o->poll, a->exponents, o->exponents, error)
                                          : RIC_OK;
}

/* Results of a map at the end of its run. @returns RIC_ESTOPPED */
static ric_status set_results(ric_map_runner *r, size_t lane, ric_error *error) {
  const ric_attractor_options *o = &r->options;
  size_t size = r->block.size;
  ric_attractor *a = &r->attractors[lane];
  for (size_t k = 0; k <= 2 * o->period_limit; k++)
    copy_lane(r, r->trace + k * size * r->block.width, lane, r->orbit + k * size);
  a->period = period_find(r->orbit, size, size, o->period_limit, o->period_tol, rounding);
  a->kind = a->period > 0 ? RIC_ATTRACTOR_PERIODIC : RIC_ATTRACTOR_APERIODIC;
  a->impacts = r->impacts[lane] / (double)o->measure;
  a->iterates = o->transient + o->measure;
  a->reason[0] = 0;
  copy_lane(r, r->measured, lane, a->z);
  if (a->lowest)
    memcpy(a->lowest, r->orbit + size * period_lowest(r->orbit, size, 2 * o->period_limit + 1, o->observe),
           size * sizeof *a->lowest);
  return a->period > 0 ? set_cycle_results(r, lane, error) : RIC_OK;
}

static void begin_run(ric_map_runner *r, const ric_grazing_map *const *maps, const double *d, ric_attractor *attractors,
                      size_t count) {
  size_t width = r->block.width;
  map_block_load(&r->block, maps, d, count);
  r->maps = maps;
  r->d = d;
  r->attractors = attractors;
  r->count = r->left = count;
  r->done = r->checked = r->counted = 0;
  for (size_t l = 0; l < width; l++) {
    r->diverged[l] = false;
    r->block.impacts[l] = 0;
    for (size_t i = 0; i < r->block.size; i++)
      r->trace[i * width + l] = attractors[l < count ? l : count - 1].z[i];
  }
  memcpy(r->checked_states, r->trace, r->block.size * width * sizeof *r->trace);
}

static ric_status run_block(ric_map_runner *r, ric_error *error) {
  const ric_attractor_options *o = &r->options;
  size_t aligning = o->exponents > 0 ? least(o->transient, align_time) : 0;
  RIC_TRY(run_transient(r, o->transient - aligning, error));
  map_block_carry(&r->block, r->directions, o->exponents);
  RIC_TRY(advance_maps(r, o->transient, false, error));
  begin_measuring(r);
  RIC_TRY(advance_maps(r, o->transient + o->keep, true, error));
  RIC_TRY(advance_maps(r, o->transient + o->measure, false, error));
  end_measuring(r);
  RIC_TRY(trace_maps(r, 2 * o->period_limit, error));
  for (size_t l = 0; l < r->count; l++)
    RIC_TRY(r->diverged[l] ? erase(r, l, error) : set_results(r, l, error));
  return RIC_OK;
}

static ric_status check_run(const ric_map_runner *r, size_t i, const ric_grazing_map *map, double d,
                            const ric_attractor *a, ric_error *error) {
  size_t size = r->block.size;
  ric_error inner;
  if (map->size != size)
    return ric_fail(error, RIC_EINVAL, "maps[%zu] has the size %zu, expected %zu", i, map->size, size);
  if (ric_grazing_map_check(map, &inner) != RIC_OK)
    return ric_fail(error, inner.status, "maps[%zu]: %s", i, inner.message);
  if (!isfinite(d))
    return ric_fail(error, RIC_EINVAL, "d[%zu] = %g, expected a finite number", i, d);
  for (size_t k = 0; k < size; k++)
    if (!isfinite(a->z[k]))
      return ric_fail(error, RIC_EINVAL, "z[%zu] = %g of attractors[%zu], expected a finite number", k, a->z[k], i);
  return RIC_OK;
}

ric_status ric_map_runner_run(ric_map_runner *r, size_t count, const ric_grazing_map *const *maps, const double *d,
                              ric_attractor *attractors, ric_error *error) {
  REQUIRE(error, {"runner", r}, {"maps", unless_empty(count, maps)}, {"d", unless_empty(count, d)},
          {"attractors", unless_empty(count, attractors)});
  for (size_t i = 0; i < count; i++)
    RIC_TRY(check_run(r, i, maps[i], d[i], &attractors[i], error));
  for (size_t first = 0; first < count; first += r->block.width) {
    begin_run(r, maps + first, d + first, attractors + first, least(count - first, r->block.width));
    RIC_TRY(run_block(r, error));
  }
  return RIC_OK;
}

/* --- the fastest variant ------------------------------------------------------------------------------------------ */

/* A trial: numbers of values, of iterates of each, and of runs, the shortest of which counts. A map whose products in a
 * trial are more is iterated less often, or not at all: the trial must take no time that matters. */
enum { TRIAL_VALUES = 64, TRIAL_ITERATES = 400, TRIAL_RUNS = 3 };
static const double trial_products = 2e7;

/* @returns 0 for a map that is too large */
static size_t trial_iterates(size_t size, size_t exponents) {
  const double products = (double)TRIAL_VALUES * (double)size * (double)size * (1 + (double)exponents);
  const double fit = fmin(TRIAL_ITERATES, trial_products / products);
  return fit >= 2 ? (size_t)fit : 0;
}

typedef struct trial {
  ric_grazing_map map;
  const ric_grazing_map *maps[TRIAL_VALUES];
  double d[TRIAL_VALUES];
  ric_attractor attractors[TRIAL_VALUES];
  double *numbers; /* [TRIAL_VALUES][size + exponents] */
  ric_attractor_options options;
  double (*now)(void *user);
  void *user;
} trial;

/* A map with windows and chaos, without zero coefficients. */
static ric_status make_trial_map(ric_grazing_map *map, size_t size) {
  RIC_TRY(ric_grazing_map_init(map, size, NULL));
  for (size_t i = 0; i < size; i++) {
    map->L[i * size + i] = 0.5 / (1 + (double)i);
    map->eta[i] = i == 0;
    map->xi[i] = 1;
    map->kappa[i] = 3;
  }
  return RIC_OK;
}

static void reset_trial(trial *t) {
  const size_t size = t->map.size, piece = size + t->options.exponents;
  for (size_t i = 0; i < TRIAL_VALUES; i++) {
    double *at = t->numbers + i * piece;
    memset(at, 0, size * sizeof *at);
    t->maps[i] = &t->map;
    t->d[i] = 1e-4 * ric_exp(0.1 * (double)i);
    t->attractors[i] = (ric_attractor){.z = at, .exponents = at + size};
  }
}

/* The shortest time of several runs; INFINITY without one. */
static double time_lanes(trial *t, ric_map_lanes lanes) {
  ric_map_runner *runner = NULL;
  double best = INFINITY;
  if (!ric_map_lanes_available(lanes) ||
      ric_map_runner_create(t->map.size, &t->options, lanes, &runner, NULL) != RIC_OK)
    return INFINITY;
  for (int run = 0; run < TRIAL_RUNS; run++) {
    reset_trial(t);
    const double began = t->now(t->user);
    if (ric_map_runner_run(runner, TRIAL_VALUES, t->maps, t->d, t->attractors, NULL) == RIC_OK)
      best = fmin(best, t->now(t->user) - began);
  }
  ric_map_runner_destroy(&runner);
  return best;
}

ric_map_lanes ric_map_lanes_fastest(size_t size, size_t exponents, double (*now)(void *user), void *user) {
  trial t = {.options = ric_attractor_options_default(), .now = now, .user = user};
  ric_map_lanes fastest = RIC_MAP_LANES_ONE;
  double best = INFINITY;
  if (!now || trial_iterates(size, exponents) == 0)
    return ric_map_lanes_widest();
  t.options.transient = t.options.measure = trial_iterates(size, exponents) / 2;
  t.options.keep = 0;
  t.options.exponents = exponents;
  t.options.period_limit = 1;
  t.numbers = calloc(TRIAL_VALUES * (size + exponents), sizeof *t.numbers);
  if (t.numbers && make_trial_map(&t.map, size) == RIC_OK)
    for (int lanes = 0; lanes < RIC_MAP_LANES_KINDS; lanes++) {
      const double taken = time_lanes(&t, (ric_map_lanes)lanes);
      if (taken < best) {
        best = taken;
        fastest = (ric_map_lanes)lanes;
      }
    }
  ric_grazing_map_clear(&t.map);
  free(t.numbers);
  return fastest;
}
