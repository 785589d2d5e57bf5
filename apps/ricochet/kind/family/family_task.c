#include "family_task.h"

#include <float.h>
#include <math.h>
#include <ricochet/elementary.h>
#include <stdlib.h>
#include <string.h>

#include "family_check.h"
#include "kind/keys.h"
#include "kind/trajectory/trajectory.h"

static const double pi = 3.14159265358979323846;

/* Steps where the study gives none, as parts of the way from the start to the other end. */
static const double first_part = 0.02, most_part = 0.1, least_part = 1e-6 /* of the first step */;
/* Of curves in two parameters, as parts of the range of the second one: shorter, so that their points draw smoothly.
 * They often end where the motions do, at a period without end or a point that is special twice: there, steps that
 * shrink further cost much and show nothing. */
static const double trace_first_part = 0.01, trace_most_part = 0.02, trace_least_part = 1e-3 /* of the first step */;

/* --- parameters --- */

double branch_family_parameter(const branch_family *b, double value) {
  return b->log ? ric_log(value) : value;
}

/* The values that the study names come back as the same bits, whatever rounding does to the curve's parameter: a bound
 * may be the end of what the model takes. */
double branch_family_value(const branch_family *b, double parameter) {
  static const study_key named[] = {KEY_BRANCH_FROM, KEY_BRANCH_TO, KEY_BRANCH_LOW, KEY_BRANCH_HIGH};
  for (size_t i = 0; i < sizeof named / sizeof *named; i++) {
    const double value = value_number(b->values, named[i], 0), at = branch_family_parameter(b, value);
    if (isfinite(at) && fabs(parameter - at) <= 4 * DBL_EPSILON * (1 + fabs(at)))
      return value;
  }
  return b->log ? ric_exp(parameter) : parameter;
}

/* Whether nothing is given but the energy; then the period is a guess. */
static bool gives_energy(const study_values *v) {
  return value_number(v, KEY_ORBIT_ENERGY, 0) > -INFINITY;
}

static ric_motion_kind motion_of(const study_values *v) {
  const char *word = value_word(v, KEY_ORBIT_MOTION);
  if (strcmp(word, "forced") == 0)
    return RIC_MOTION_FORCED;
  if (strcmp(word, "autonomous") == 0)
    return RIC_MOTION_AUTONOMOUS;
  return strcmp(word, "conservative") == 0 ? RIC_MOTION_CONSERVATIVE : RIC_MOTION_EVEN;
}

/* The period that the values say: of the force, or orbit.period. */
static double period_of(const study_values *v) {
  const double multiple = value_number(v, KEY_ORBIT_FORCING_PERIODS, 0);
  if (multiple > 0 || !value_present(v, KEY_ORBIT_PERIOD))
    return (multiple > 0 ? multiple : 1) * (2 * pi / value_number(v, KEY_MODEL_FREQUENCY, 0));
  return value_number(v, KEY_ORBIT_PERIOD, 0);
}

static double given_of(const study_values *v) {
  return gives_energy(v) ? value_number(v, KEY_ORBIT_ENERGY, 0) : period_of(v);
}

static double second_of(const branch_family *b) {
  return b->traced ? value_number(b->values, b->traced->key, b->traced->item < 0 ? 0 : (size_t)b->traced->item) : 0;
}

static bool is_of_model(const study_parameter *p) {
  return p && p->key != KEY_ORBIT_PERIOD && p->key != KEY_ORBIT_ENERGY;
}

/* Puts the parameters into the values. */
static ric_status move(branch_family *b, const double *p, ric_error *error) {
  const double value = branch_family_value(b, p[0]);
  if (schema_check(b->followed->key, value) != FIT_OK)
    return ric_fail(error, RIC_ENUMERIC, "%s = %g is out of range", b->followed->name, value);
  if (b->traced && schema_check(b->traced->key, p[1]) != FIT_OK)
    return ric_fail(error, RIC_ENUMERIC, "%s = %g is out of range", b->traced->name, p[1]);
  study_values_move(b->values, KEY_BRANCH_PARAMETER, value);
  if (b->traced)
    study_values_move(b->values, KEY_BRANCH_TRACE_PARAMETER, p[1]);
  return RIC_OK;
}

/* Puts the parameters into the values, and these into the system. */
static ric_status set(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  branch_family *b = user;
  RIC_TRY(move(b, p, error));
  *given = given_of(b->values);
  if (motion_of(b->values) != RIC_MOTION_AUTONOMOUS && !isfinite(*given))
    return ric_fail(error, RIC_ENUMERIC, "model.frequency = %g: the force has no period",
                    value_number(b->values, KEY_MODEL_FREQUENCY, 0));
  if (!is_of_model(b->followed) && !is_of_model(b->traced))
    return RIC_OK;
  lattice_model_read(&b->model, b->values);
  RIC_TRY(ric_system_set_lattice(system, &b->model.lattice, error));
  return ric_system_set_obstacles(system, b->model.obstacles, b->model.obstacle_count, error);
}

/* --- life --- */

static size_t count_hits(const study_values *v) {
  return value_count(v, KEY_ORBIT_AT_START) + value_count(v, KEY_ORBIT_AT_HALF) + value_count(v, KEY_ORBIT_SEQUENCE);
}

static int init_family(branch_family *b, const study *s, study_values *v) {
  *b = (branch_family){.values = v,
                       .followed = family_followed(s),
                       .traced = family_traced(s),
                       .log = strcmp(value_word(v, KEY_BRANCH_SCALE), "log") == 0,
                       .multipliers = strcmp(value_word(v, KEY_BRANCH_MULTIPLIERS), "false") != 0,
                       .hits = calloc(count_hits(v) + 1, sizeof *b->hits),
                       .times = calloc(value_count(v, KEY_ORBIT_TIMES) + 1, sizeof *b->times)};
  return b->hits && b->times ? lattice_model_init(&b->model, v) : -1;
}

static void close_family(branch_family *b) {
  ric_family_destroy(&b->family);
  ric_shooting_destroy(&b->first);
  ric_system_destroy(&b->system);
}

static void clear_family(branch_family *b) {
  close_family(b);
  lattice_model_clear(&b->model);
  free(b->hits);
  free(b->times);
  *b = (branch_family){0};
}

/* --- the problem --- */

/* Nothing jumps at a Hertz contact: the particles that press it are part of the guess only. */
static bool is_compliant(const study_values *v) {
  return value_number(v, KEY_MODEL_HERTZ, 0) > 0;
}

static ric_status read_impacts(branch_family *b, ric_error *error) {
  const study_values *v = b->values;
  const size_t starts = value_count(v, KEY_ORBIT_AT_START), halves = value_count(v, KEY_ORBIT_AT_HALF);
  RIC_TRY(lattice_model_hits(&b->model, b->values, KEY_ORBIT_AT_START, b->hits, error));
  RIC_TRY(lattice_model_hits(&b->model, b->values, KEY_ORBIT_AT_HALF, b->hits + starts, error));
  RIC_TRY(lattice_model_hits(&b->model, b->values, KEY_ORBIT_SEQUENCE, b->hits + starts + halves, error));
  for (size_t i = 0; i < value_count(v, KEY_ORBIT_TIMES); i++)
    b->times[i] = value_number(v, KEY_ORBIT_TIMES, i);
  return RIC_OK;
}

/* The task's motions with the period given, on its obstacles; arrays are those of the family.
 * @param impacts  with those of the study; else, as with Hertz contacts, without any */
static ric_shooting_problem motion_of_study(const branch_family *b, bool impacts) {
  const study_values *v = b->values;
  const size_t starts = value_count(v, KEY_ORBIT_AT_START), halves = value_count(v, KEY_ORBIT_AT_HALF);
  return (ric_shooting_problem){.kind = motion_of(v),
                                .at_start = b->hits,
                                .start_count = impacts ? starts : 0,
                                .at_half = b->hits + starts,
                                .half_count = impacts ? halves : 0,
                                .sequence = b->hits + starts + halves,
                                .count = impacts ? value_count(v, KEY_ORBIT_SEQUENCE) : 0,
                                .flow = ric_flow_options_default(),
                                .poll = b->poll};
}

static ric_family_problem describe(branch_family *b) {
  const study_values *v = b->values;
  ric_family_problem problem = {.system = b->system,
                                .motion = motion_of_study(b, !is_compliant(v)),
                                .set = set,
                                .user = b,
                                .parameters = b->traced ? 2 : 1,
                                .second = second_of(b),
                                .given = given_of(v)};
  problem.motion.energy_given = gives_energy(v);
  return problem;
}

static double bound(const branch_family *b, study_key key, double fallback) {
  const double value = value_number(b->values, key, 0);
  return branch_family_parameter(b, value > -INFINITY ? value : fallback);
}

static double step(const study_values *v, study_key key, double fallback) {
  const double value = value_number(v, key, 0);
  return value > -INFINITY ? value : fallback;
}

/* @param rise  sign of the first step; 0: towards branch.to */
static ric_family_options options_of(const branch_family *b, int rise) {
  const study_values *v = b->values;
  const double from = value_number(v, KEY_BRANCH_FROM, 0), to = value_number(v, KEY_BRANCH_TO, 0);
  const double way = fabs(branch_family_parameter(b, to) - branch_family_parameter(b, from));
  ric_family_options o = ric_family_options_default();
  o.multipliers = b->multipliers;
  o.curve.natural = value_flag(v, KEY_BRANCH_NATURAL);
  o.curve.p_low = bound(b, KEY_BRANCH_LOW, fmin(from, to));
  o.curve.p_high = bound(b, KEY_BRANCH_HIGH, fmax(from, to));
  o.curve.direction = rise ? rise : to > from ? 1 : -1;
  o.curve.points = (size_t)value_number(v, KEY_BRANCH_POINTS, 0);
  o.curve.newton_tol = value_number(v, KEY_BRANCH_TOLERANCE, 0);
  o.curve.poll = b->poll;
  /* A step that is given moves the defaults of the others. */
  const double least = step(v, KEY_BRANCH_STEP_LEAST, 0), most = step(v, KEY_BRANCH_STEP_MOST, INFINITY);
  o.curve.step = step(v, KEY_BRANCH_STEP, fmax(least, fmin(most, first_part * way)));
  o.curve.step_least = least > 0 ? least : least_part * o.curve.step;
  o.curve.step_most = most < INFINITY ? most : fmax(o.curve.step, most_part * way);
  return o;
}

ric_curve_options branch_family_curve_options(const branch_family *b, int direction) {
  const study_values *v = b->values;
  ric_curve_options o = ric_curve_options_default();
  o.p_low = value_number(v, KEY_BRANCH_TRACE_LOW, 0);
  o.p_high = value_number(v, KEY_BRANCH_TRACE_HIGH, 0);
  o.direction = direction;
  o.points = (size_t)value_number(v, KEY_BRANCH_TRACE_POINTS, 0);
  o.newton_tol = value_number(v, KEY_BRANCH_TOLERANCE, 0);
  o.poll = b->poll;
  const double way = o.p_high - o.p_low, most = step(v, KEY_BRANCH_TRACE_STEP_MOST, INFINITY);
  o.step = step(v, KEY_BRANCH_TRACE_STEP, fmin(most, trace_first_part * way));
  o.step_least = trace_least_part * o.step;
  o.step_most = most < INFINITY ? most : fmax(o.step, trace_most_part * way);
  return o;
}

static ric_status make_family(branch_family *b, int rise, ric_error *error) {
  const ric_family_problem problem = describe(b);
  const ric_family_options options = options_of(b, rise);
  return ric_family_create(&problem, &options, &b->family, error);
}

static ric_status open_family(branch_family *b, ric_poll poll, ric_error *error) {
  b->poll = poll;
  lattice_model_read(&b->model, b->values);
  RIC_TRY(ric_system_create_lattice(&b->model.lattice, b->model.obstacles, b->model.obstacle_count, &b->system, error));
  RIC_TRY(read_impacts(b, error));
  if (value_number(b->values, KEY_BRANCH_FROM, 0) > -INFINITY)
    return make_family(b, 0, error);
  const ric_shooting_problem motion = motion_of_study(b, !is_compliant(b->values));
  return ric_shooting_create(b->system, &motion, &b->first, error);
}

/* The energy at which a branch starts lies within the bounds that the study gives. */
static ric_status check_energy(const branch_family *b, double energy, ric_error *error) {
  const double low = value_number(b->values, KEY_BRANCH_LOW, 0), high = value_number(b->values, KEY_BRANCH_HIGH, 0);
  if (energy < low)
    return ric_fail(error, RIC_EINVAL, "the branch would start at the energy %g, expected at least branch.low = %g",
                    energy, low);
  if (high > -INFINITY && energy > high)
    return ric_fail(error, RIC_EINVAL, "the branch would start at the energy %g, expected at most branch.high = %g",
                    energy, high);
  return RIC_OK;
}

/* The family at an energy.
 * @param rise  sign of the energy's change with which it starts; 0: towards branch.to */
static ric_status begin_family(branch_family *b, double energy, int rise, ric_error *error) {
  if (b->log && !(energy > 0))
    return ric_fail(error, RIC_EINVAL, "the branch would start at the energy %g, expected a number > 0 with scale: log",
                    energy);
  RIC_TRY(check_energy(b, energy, error));
  study_values_move(b->values, KEY_BRANCH_FROM, energy);
  study_values_move(b->values, KEY_BRANCH_PARAMETER, energy);
  return make_family(b, rise, error);
}

/* Matrices of the unknowns, of which every arc of a motion that is not even brings a state, tangent vectors, and
 * matrices of the multipliers. */
static double family_bytes(const study_values *v) {
  const double n = value_number(v, KEY_MODEL_PARTICLES, 0);
  const bool extends = value_flag(v, KEY_BRANCH_CROSS) || value_flag(v, KEY_BRANCH_SWITCH);
  const bool traces = value_present(v, KEY_BRANCH_TRACE_PARAMETER); /* a curve takes as much as a segment */
  const double segments = (extends ? value_number(v, KEY_BRANCH_SEGMENTS, 0) : 1) + (traces ? 1 : 0);
  const double arcs = 1 + (double)value_count(v, KEY_ORBIT_SEQUENCE) + (extends ? 1 : 0);
  const double unknowns = 2 * n * arcs + 8;
  return 8 * segments * (8 * unknowns * unknowns + 12 * (2 * n) * (2 * n)) + n * LATTICE_MODEL_BYTES;
}

/* --- the task --- */

static size_t particles_of(const study_values *v) {
  return (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
}

int family_task_init(family_task *t, const study *s, ric_poll poll, message *why) {
  *t = (family_task){.values = study_values_create(s),
                     .poll = poll,
                     .from_state = study_gives(s, KEY_START_Q) || study_gives(s, KEY_START_V)};
  if (t->values && init_family(&t->family, s, t->values) == 0 &&
      ric_guess_init(&t->guess, particles_of(t->values), NULL) == RIC_OK)
    return 0;
  return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
}

void family_task_clear(family_task *t) {
  ric_guess_clear(&t->guess);
  clear_family(&t->family);
  study_values_destroy(&t->values);
}

ric_status family_task_open(family_task *t, ric_error *error) {
  return open_family(&t->family, t->poll, error);
}

void family_task_close(family_task *t) {
  close_family(&t->family);
}

/* --- the first guess --- */

/* The initial state that the study gives, or rest. */
static void read_state(family_task *t) {
  for (size_t i = 0; i < particles_of(t->values); i++) {
    t->guess.q[i] = t->from_state ? value_of_particle(t->values, KEY_START_Q, i) : 0;
    t->guess.v[i] = t->from_state ? value_of_particle(t->values, KEY_START_V, i) : 0;
  }
  t->guess.period = period_of(t->values);
  t->guess.rise = 0;
}

static ric_status excite(family_task *t, ric_error *error) {
  const size_t count = value_count(t->values, KEY_ORBIT_EXCITED);
  size_t *excited = calloc(count, sizeof *excited);
  for (size_t k = 0; excited && k < count; k++)
    excited[k] = (size_t)value_number(t->values, KEY_ORBIT_EXCITED, k);
  const ric_status status =
      excited ? ric_guess_particles(&t->family.model.lattice, excited, count, period_of(t->values), &t->guess, error)
              : ric_fail(error, RIC_ENOMEM, "no memory for %zu particles", count);
  free(excited);
  return status;
}

static ric_status find_guess(family_task *t, ric_error *error) {
  const study_values *v = t->values;
  const lattice_model *model = &t->family.model;
  const ric_shooting_problem motion = motion_of_study(&t->family, true);
  const ric_guess_problem problem = {&model->lattice, model->obstacles, model->obstacle_count, &motion};
  const size_t starts = value_count(v, KEY_ORBIT_AT_START), halves = value_count(v, KEY_ORBIT_AT_HALF);
  const double mode = value_number(v, KEY_ORBIT_MODE, 0);
  read_state(t);
  if (t->from_state)
    return RIC_OK;
  if (value_count(v, KEY_ORBIT_EXCITED) > 0)
    return excite(t, error);
  if (mode > -INFINITY && starts > 0)
    return ric_guess_grazing_mode(&problem, (size_t)mode, (size_t)value_number(v, KEY_ORBIT_SWINGS, 0), &t->guess,
                                  error);
  if (mode > -INFINITY)
    return ric_guess_mode(&model->lattice, (size_t)mode, value_number(v, KEY_ORBIT_ENERGY, 0), &t->guess, error);
  return starts + halves > 0 ? ric_guess_even(&problem, t->guess.period, &t->guess, error) : RIC_OK;
}

ric_status family_task_begin(family_task *t, ric_error *error) {
  double energy = 0;
  RIC_TRY(find_guess(t, error));
  if (t->family.family)
    return RIC_OK;
  RIC_TRY(ric_guess_solve(t->family.first, t->family.times, &t->guess, &energy, error));
  return begin_family(&t->family, energy, t->guess.rise, error);
}

ric_status family_task_solve(const family_task *t, double *z, double *parameter, int *iterations, ric_error *error) {
  const branch_family *b = &t->family;
  *parameter = branch_family_parameter(b, value_number(t->values, KEY_BRANCH_FROM, 0));
  return ric_family_start(b->family, *parameter, t->guess.q, t->guess.v, b->times, t->guess.period, z, iterations,
                          error);
}

/* --- before the tasks --- */

int family_task_check(const study *s, message *why) {
  family_task t;
  ric_error error = {0};
  if (study_tasks(s) != 1)
    return 0;
  int code = family_task_init(&t, s, (ric_poll){0}, why);
  if (!code && family_task_open(&t, &error) != RIC_OK)
    code = refuse(why, error.status == RIC_ENOMEM ? EXIT_RUN : EXIT_USAGE, "%s: %s", study_name(s), error.message);
  family_task_clear(&t);
  return code;
}

double family_task_bytes(const study_values *v) {
  return family_bytes(v) + TRAJECTORY_PARTICLE_BYTES * value_number(v, KEY_MODEL_PARTICLES, 0);
}
