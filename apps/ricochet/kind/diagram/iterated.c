#include "diagram.h"
#include "kind/fill.h"
#include "kind/keys.h"

#include <math.h>
#include <ricochet/ricochet.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "model/grazing_map.h"

/* The clock with which the library times its variants. */
static double seconds(void *user) {
  struct timespec now;
  (void)user;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

enum {
  MAP_SLOTS = 64,       /* several SIMD vectors, which hides latencies */
  MAP_LANES = 33,       /* maps that keep states to find the period, in the widest variant, and one map alone */
  MOTION_BYTES = 65536, /* of a trajectory with its flow and tangent vectors, per number of the state, roughly */
  WAIT_PERIODS = 100    /* of the force without an impact on the section, at least, before the run fails */
};

size_t iterated_slots(const study *s) {
  return model_has(s, MODEL_MAP) ? MAP_SLOTS : 1;
}

/* Iterates needed to test the longest period of all tasks. */
static double deciding(const study *s, const study_values *v) {
  double limit = value_number(v, KEY_ITERATE_PERIOD_LIMIT, 0);
  for (size_t i = 0; i < study_sweeps(s); i++) {
    const study_sweep *sweep = study_sweep_at(s, i);
    for (size_t k = 0; sweep->key == KEY_ITERATE_PERIOD_LIMIT && k < sweep->points; k++)
      limit = fmax(limit, sweep->values[k]);
  }
  return 2 * limit + 2;
}

double iterated_bytes(const study *s, const study_values *v) {
  const double size = (double)diagram_state_size(s), states = 8 * size * deciding(s, v);
  return model_has(s, MODEL_MAP) ? MAP_SLOTS * 8 * (2 * size * (size + 8)) + MAP_LANES * states
                                 : size * (MOTION_BYTES + LATTICE_MODEL_BYTES) + states;
}

/* --- storage ------------------------------------------------------------------------------------------------------ */

static size_t exponents_of(const iterated *it) {
  return value_flag(it->values, KEY_ITERATE_LYAPUNOV) ? (size_t)value_number(it->values, KEY_ITERATE_EXPONENTS, 0) : 0;
}

static bool allocate(iterated *it) {
  if (!model_has(it->study, MODEL_MAP))
    return lattice_model_init(&it->model, it->values) == 0;
  it->maps = calloc(it->slots, sizeof *it->maps);
  return it->maps != NULL;
}

int iterated_init(iterated *it, const study *s, ric_poll poll, message *why) {
  *it = (iterated){.study = s, .poll = poll, .size = diagram_state_size(s), .slots = iterated_slots(s)};
  it->values = study_values_create(s);
  if (!it->values || !allocate(it))
    return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
  if (diagram_is_beyond(s)) {
    it->beyond = calloc(1, sizeof *it->beyond);
    return it->beyond ? beyond_init(it->beyond, s, poll, why)
                      : refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
  }
  if (it->maps)
    it->lanes = ric_map_lanes_fastest(it->size, exponents_of(it), seconds, NULL);
  return 0;
}

void iterated_clear(iterated *it) {
  for (size_t i = 0; it->maps && i < it->slots; i++)
    ric_grazing_map_clear(&it->maps[i].map);
  free(it->maps);
  ric_map_runner_destroy(&it->runner);
  lattice_model_clear(&it->model);
  if (it->beyond)
    beyond_clear(it->beyond);
  free(it->beyond);
  study_values_destroy(&it->values);
  *it = (iterated){0};
}

/* --- a task ------------------------------------------------------------------------------------------------------- */

static size_t kept_of(const iterated *it) {
  const bool is_diagram = study_is_kind(it->study, "diagram");
  return is_diagram ? (size_t)value_number(it->values, KEY_ITERATE_KEEP, 0) : 0;
}

size_t iterated_measured(const iterated *it) {
  const double measure = value_number(it->values, KEY_ITERATE_MEASURE, 0);
  const size_t keep = kept_of(it);
  return measure > 0 ? (size_t)measure : keep > 0 ? keep : ric_attractor_options_default().measure;
}

static ric_attractor_options options_of(const iterated *it) {
  const study_values *v = it->values;
  ric_attractor_options o = ric_attractor_options_default();
  o.transient = (size_t)value_number(v, KEY_ITERATE_TRANSIENT, 0);
  o.keep = kept_of(it);
  o.measure = iterated_measured(it);
  o.observe = diagram_observed(it->study);
  o.exponents = exponents_of(it);
  o.period_limit = (size_t)value_number(v, KEY_ITERATE_PERIOD_LIMIT, 0);
  o.period_tol = value_number(v, KEY_ITERATE_PERIOD_TOL, 0);
  o.poll = it->poll;
  return o;
}

static void take_map(iterated *it, iterated_map *slot, double *z) {
  const study_values *v = it->values;
  slot->refused = (ric_error){0};
  slot->options = options_of(it);
  slot->d = value_number(v, KEY_MODEL_D, 0);
  if (grazing_map_read(&slot->map, v, &slot->refused) == RIC_OK)
    ric_attractor_options_check(&slot->options, it->size, &slot->refused);
  for (size_t i = 0; i < it->size; i++)
    z[i] = value_number(v, KEY_ITERATE_START, value_is_list(v, KEY_ITERATE_START) ? i : 0);
}

double iterated_period(const lattice_model *model) {
  static const double pi = 3.14159265358979323846;
  return model->lattice.frequency > 0 ? 2 * pi / model->lattice.frequency : 0;
}

ric_status iterated_read_model(iterated *it, ric_error *error) {
  const ric_status status = it->beyond ? beyond_find(it->beyond, it->values, error) : RIC_OK;
  if (it->beyond && status == RIC_OK)
    study_values_move(it->values, KEY_BRANCH_PARAMETER, beyond_parameter(it->beyond, it->values));
  lattice_model_read(&it->model, it->values);
  return status;
}

static void take_motion(iterated *it, double *z) {
  const study_values *v = it->values;
  const size_t n = it->model.lattice.particles;
  const double tolerance = value_number(v, KEY_ITERATE_TOLERANCE, 0);
  it->refused = (ric_error){0};
  iterated_read_model(it, &it->refused);
  it->options = options_of(it);
  it->section = ric_motion_section_options_default(iterated_period(&it->model));
  it->section.kind =
      strcmp(value_word(v, KEY_ITERATE_SECTION), "impact") == 0 ? RIC_SECTION_IMPACT : RIC_SECTION_STROBE;
  it->section.phase = value_number(v, KEY_ITERATE_PHASE, 0);
  it->section.wait = fmax(it->section.wait, WAIT_PERIODS * it->section.period);
  const double particle = value_number(v, KEY_ITERATE_PARTICLE, 0);
  it->section.obstacle = particle == -INFINITY ? SIZE_MAX : lattice_model_hit(&it->model, (size_t)particle);
  it->section.trajectory.flow.tolerance = tolerance > 0 ? tolerance : 0; /* null reads as minus infinity */
  it->section.trajectory.poll = it->poll;
  for (size_t i = 0; i < n; i++) {
    z[i] = value_of_particle(v, KEY_START_Q, i);
    z[n + i] = value_of_particle(v, KEY_START_V, i);
  }
  if (it->size > 2 * n) /* the time of the start */
    z[2 * n] = it->section.phase * it->section.period;
}

void iterated_take(iterated *it, size_t slot, double *z) {
  if (it->maps)
    take_map(it, &it->maps[slot], z);
  else
    take_motion(it, z);
}

/* --- a run -------------------------------------------------------------------------------------------------------- */

/* The outcome of a run that the library refuses is `failed`. @returns RIC_OK or RIC_ESTOPPED */
static ric_status fail(const iterated *it, ric_attractor *a, const ric_error *error) {
  const ric_attractor_options *o = it->maps ? &it->maps[0].options : &it->options;
  a->kind = RIC_ATTRACTOR_FAILED;
  a->period = a->iterates = 0;
  a->impacts = NAN;
  snprintf(a->reason, sizeof a->reason, "%.*s", (int)sizeof a->reason - 1, error->message);
  const bool filled = fill_nan(a->values, o->keep, it->poll) && fill_nan(a->states, o->keep * it->size, it->poll) &&
                      fill_nan(a->exponents, o->exponents, it->poll) && fill_nan(a->lowest, it->size, it->poll);
  return filled ? RIC_OK : RIC_ESTOPPED;
}

static bool is_same(const ric_attractor_options *a, const ric_attractor_options *b) {
  return a->transient == b->transient && a->measure == b->measure && a->period_limit == b->period_limit &&
         a->period_tol == b->period_tol; /* the others are those of the study */
}

/* A runner for these options. */
static ric_status prepare(iterated *it, const ric_attractor_options *options, ric_error *error) {
  if (it->runner && is_same(&it->made, options))
    return RIC_OK;
  ric_map_runner_destroy(&it->runner);
  it->made = *options;
  return ric_map_runner_create(it->size, options, it->lanes, &it->runner, error);
}

/* Runs the slots from `first` on that have the same options. @returns number of slots finished */
static ric_status run_alike(iterated *it, size_t first, size_t count, ric_attractor *attractors, size_t *done) {
  const ric_grazing_map *maps[MAP_SLOTS];
  double d[MAP_SLOTS];
  size_t alike = 0;
  ric_error error = {0};
  while (first + alike < count && it->maps[first + alike].refused.status == RIC_OK &&
         is_same(&it->maps[first].options, &it->maps[first + alike].options)) {
    maps[alike] = &it->maps[first + alike].map;
    d[alike] = it->maps[first + alike].d;
    alike++;
  }
  *done = alike > 0 ? alike : 1;
  if (alike == 0)
    return fail(it, &attractors[first], &it->maps[first].refused);
  ric_status status = prepare(it, &it->maps[first].options, &error);
  if (status == RIC_OK)
    status = ric_map_runner_run(it->runner, alike, maps, d, attractors + first, &error);
  for (size_t i = 0; i < alike && status != RIC_OK && status != RIC_ESTOPPED; i++)
    RIC_TRY(fail(it, &attractors[first + i], &error));
  return status == RIC_ESTOPPED ? status : RIC_OK;
}

static ric_status run_maps(iterated *it, size_t count, ric_attractor *attractors) {
  for (size_t first = 0, done; first < count; first += done)
    RIC_TRY(run_alike(it, first, count, attractors, &done));
  return RIC_OK;
}

static ric_status run_motion(iterated *it, ric_attractor *attractor, ric_error *error) {
  ric_system *system = NULL;
  ric_motion_section *section = NULL;
  const lattice_model *m = &it->model;
  if (!(it->section.period > 0))
    return ric_fail(error, RIC_EINVAL, "model.frequency = 0, expected > 0: a section takes its period from the force");
  ric_status status = ric_system_create_lattice(&m->lattice, m->obstacles, m->obstacle_count, &system, error);
  if (status == RIC_OK)
    status = ric_motion_section_create(system, &it->section, &section, error);
  if (status == RIC_OK)
    status = ric_motion_section_run(section, &it->options, attractor, error);
  ric_motion_section_destroy(&section);
  ric_system_destroy(&system);
  return status;
}

ric_status iterated_run(iterated *it, size_t count, ric_attractor *attractors) {
  if (it->maps)
    return run_maps(it, count, attractors);
  ric_error error = {0};
  const ric_status status = it->refused.status == RIC_OK ? run_motion(it, attractors, &error) : it->refused.status;
  if (it->refused.status != RIC_OK)
    error = it->refused;
  if (status == RIC_ESTOPPED)
    return status;
  return status == RIC_OK ? RIC_OK : fail(it, attractors, &error);
}
