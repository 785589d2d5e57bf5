#include "family_task.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kind/trajectory/trajectory.h"

static size_t particles_of(const study_values *v) {
  return (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
}

int family_task_init(family_task *t, const study *s, ric_poll poll, message *why) {
  *t = (family_task){.values = study_values_create(s),
                     .poll = poll,
                     .from_state = study_gives(s, KEY_START_Q) || study_gives(s, KEY_START_V)};
  if (t->values && branch_family_init(&t->family, s, t->values) == 0 &&
      ric_guess_init(&t->guess, particles_of(t->values), NULL) == RIC_OK)
    return 0;
  return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
}

void family_task_clear(family_task *t) {
  ric_guess_clear(&t->guess);
  branch_family_clear(&t->family);
  study_values_destroy(&t->values);
}

ric_status family_task_open(family_task *t, ric_error *error) {
  return branch_family_open(&t->family, t->poll, error);
}

/* --- the first guess --- */

/* The initial state that the study gives, or rest. */
static void read_state(family_task *t) {
  for (size_t i = 0; i < particles_of(t->values); i++) {
    t->guess.q[i] = t->from_state ? value_of_particle(t->values, KEY_START_Q, i) : 0;
    t->guess.v[i] = t->from_state ? value_of_particle(t->values, KEY_START_V, i) : 0;
  }
  t->guess.period = branch_family_period(t->values);
  t->guess.rise = 0;
}

static ric_status excite(family_task *t, ric_error *error) {
  const size_t count = value_count(t->values, KEY_ORBIT_EXCITED);
  size_t *excited = calloc(count, sizeof *excited);
  for (size_t k = 0; excited && k < count; k++)
    excited[k] = (size_t)value_number(t->values, KEY_ORBIT_EXCITED, k);
  const ric_status status = excited ? ric_guess_particles(&t->family.model.lattice, excited, count,
                                                          branch_family_period(t->values), &t->guess, error)
                                    : ric_fail(error, RIC_ENOMEM, "no memory for %zu particles", count);
  free(excited);
  return status;
}

static ric_status find_guess(family_task *t, ric_error *error) {
  const study_values *v = t->values;
  const lattice_model *model = &t->family.model;
  const ric_shooting_problem motion = branch_family_motion(&t->family, true);
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
  return branch_family_begin(&t->family, energy, t->guess.rise, error);
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
  return branch_family_bytes(v) + TRAJECTORY_PARTICLE_BYTES * value_number(v, KEY_MODEL_PARTICLES, 0);
}
