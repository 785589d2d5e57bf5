#include "family_task.h"

#include "kind/trajectory/trajectory.h"

int family_task_init(family_task *t, const study *s, ric_poll poll, message *why) {
  *t = (family_task){.values = study_values_create(s),
                     .poll = poll,
                     .from_state = study_gives(s, KEY_START_Q) || study_gives(s, KEY_START_V)};
  if (t->values && branch_family_init(&t->family, s, t->values) == 0 &&
      branch_guess_init(&t->guess, (size_t)value_number(t->values, KEY_MODEL_PARTICLES, 0)) == 0)
    return 0;
  return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
}

void family_task_clear(family_task *t) {
  branch_guess_clear(&t->guess);
  branch_family_clear(&t->family);
  study_values_destroy(&t->values);
}

ric_status family_task_open(family_task *t, ric_error *error) {
  return branch_family_open(&t->family, t->poll, error);
}

ric_status family_task_begin(family_task *t, ric_error *error) {
  double energy = 0;
  RIC_TRY(branch_guess_find(&t->guess, &t->family, t->from_state, error));
  if (t->family.family)
    return RIC_OK;
  RIC_TRY(branch_guess_settle(&t->guess, &t->family, &energy, error));
  return branch_family_begin(&t->family, energy, t->guess.rise, error);
}

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
