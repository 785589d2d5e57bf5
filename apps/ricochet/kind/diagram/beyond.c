#include "diagram.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kind/grazing/grazing.h"

int beyond_init(beyond *b, const study *s, ric_poll poll, message *why) {
  *b = (beyond){.study = s, .swept = calloc(study_sweeps(s) + 1, sizeof *b->swept)};
  if (!b->swept)
    return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
  const int code = family_task_init(&b->task, s, poll, why);
  b->task.family.multipliers = false; /* the multipliers of L are used instead */
  b->task.from_state = false;         /* the section `start` is the first state of the iterates */
  return code;
}

static void forget(beyond *b) {
  ric_grazing_map_clear(&b->map);
  ric_grazing_clear(&b->grazing);
  family_task_close(&b->task);
  b->known = false;
}

void beyond_clear(beyond *b) {
  forget(b);
  family_task_clear(&b->task);
  free(b->swept);
  *b = (beyond){0};
}

/* --- the grazing point -------------------------------------------------------------------------------------------- */

static double swept_value(const study_values *v, const study_sweep *sweep) {
  return value_number(v, sweep->key, sweep->item < 0 ? 0 : (size_t)sweep->item);
}

/* Whether the grazing point found last is that of these values. */
static bool is_same(const beyond *b, const study_values *v) {
  bool same = b->known;
  for (size_t i = 0; i < study_sweeps(b->study); i++) {
    const study_sweep *sweep = study_sweep_at(b->study, i);
    same = same && (sweep->key == KEY_GRAZING_BEYOND || b->swept[i] == swept_value(v, sweep));
  }
  return same;
}

/* The values of the task for the family, whose parameter starts at branch.from. */
static void put_values(beyond *b, const study_values *v) {
  study_values_at(b->task.values, 0);
  for (size_t i = 0; i < study_sweeps(b->study); i++) {
    b->swept[i] = swept_value(v, study_sweep_at(b->study, i));
    study_values_sweep(b->task.values, i, b->swept[i]);
  }
}

/* A grazing_task whose row is not stored. */
static ric_status find_point(beyond *b, ric_error *error) {
  static const kind_plan no_row = {0};
  branch_family *family = &b->task.family;
  grazing_task g = {.b = family, .plan = &no_row, .grazing = b->grazing};
  double parameter, *z = calloc(ric_shooting_unknowns(ric_family_shooting(family->family)), sizeof *z);
  if (!z)
    return ric_fail(error, RIC_ENOMEM, "no memory for a motion");
  ric_status status = family_task_solve(&b->task, z, &parameter, NULL, error);
  if (status == RIC_OK)
    status = grazing_find(&g, z, parameter);
  if (status == RIC_OK && g.outcome != GRAZING_FOUND)
    status = ric_fail(error, RIC_ENUMERIC, "%s", g.reason);
  b->grazing = g.grazing;
  free(z);
  return status;
}

static ric_status find(beyond *b, ric_error *error) {
  RIC_TRY(family_task_open(&b->task, error));
  RIC_TRY(family_task_begin(&b->task, error));
  branch_family *family = &b->task.family;
  ric_shooting *shooting = ric_family_shooting(family->family);
  RIC_TRY(ric_grazing_init(&b->grazing, shooting, error));
  RIC_TRY(find_point(b, error));
  const double phase = value_number(b->task.values, KEY_ITERATE_PHASE, 0);
  const ric_grazing_plane plane = {.time = phase * b->grazing.period};
  RIC_TRY(ric_grazing_map_init(&b->map, ric_grazing_coordinates(&b->grazing, shooting), error));
  RIC_TRY(ric_grazing_section(family->family, &b->grazing, &plane, &b->map, NULL, error));
  b->period = b->grazing.period;
  b->parameter = branch_family_value(family, b->grazing.parameter);
  b->slope = b->grazing.slope / (family->log ? b->parameter : 1);
  return RIC_OK;
}

ric_status beyond_find(beyond *b, const study_values *v, ric_error *error) {
  if (!is_same(b, v)) {
    forget(b);
    put_values(b, v);
    b->error = (ric_error){0};
    const ric_status status = find(b, &b->error);
    if (status == RIC_ESTOPPED)
      return status;
    b->known = true;
  }
  if (error)
    *error = b->error;
  return b->error.status;
}

/* --- beyond it ---------------------------------------------------------------------------------------------------- */

double beyond_parameter(const beyond *b, const study_values *v) {
  return b->parameter * (1 + value_number(v, KEY_GRAZING_BEYOND, 0));
}

double beyond_d(const beyond *b, const study_values *v) {
  return -b->slope * b->parameter * value_number(v, KEY_GRAZING_BEYOND, 0);
}

ric_status beyond_motion(beyond *b, const study_values *v, double parameter, double *x, ric_error *error) {
  branch_family *family = &b->task.family;
  ric_shooting *shooting = ric_family_shooting(family->family);
  const double time = value_number(v, KEY_ITERATE_PHASE, 0) * b->period;
  const size_t n = b->grazing.numbers / 2;
  double *z = calloc(b->grazing.unknowns, sizeof *z);
  ric_status status = z ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for a motion");
  if (status == RIC_OK)
    status = ric_family_start(family->family, branch_family_parameter(family, parameter), b->grazing.z,
                              b->grazing.z + n, family->times, b->period, z, NULL, error);
  if (status == RIC_OK)
    status = ric_shooting_transfer(shooting, z, b->period, time, time, x, NULL, error);
  free(z);
  return status;
}

ric_status beyond_run(const beyond *b, const study_values *v, const ric_attractor_options *options,
                      ric_attractor *attractor, ric_error *error) {
  ric_map_runner *runner = NULL;
  const ric_grazing_map *map = &b->map;
  const double d = beyond_d(b, v);
  ric_status status = ric_map_runner_create(b->map.size, options, RIC_MAP_LANES_ONE, &runner, error);
  if (status == RIC_OK)
    status = ric_map_runner_run(runner, 1, &map, &d, attractor, error);
  ric_map_runner_destroy(&runner);
  return status;
}
