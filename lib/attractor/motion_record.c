#include "motion_record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What the observer of a run does. */
typedef struct listener {
  motion_record *record;
  size_t seen;
  bool keeps;         /* writes them down, else counts */
  bool ends_at_first; /* the run at the first impact */
  const char *what;   /* there is no motion for shooting: why, and when; NULL */
  double when;
} listener;

static int hear(const ric_event *event, void *user) {
  listener *l = user;
  if (event->kind == RIC_EVENT_CHATTER || event->kind == RIC_EVENT_REST || event->kind == RIC_EVENT_RELEASE) {
    l->what = ric_event_name(event->kind);
    l->when = event->time;
    return 1;
  }
  if (!ric_event_jumps(event))
    return 0;
  if (l->keeps) {
    l->record->sequence[l->seen] = event->obstacle;
    l->record->times[l->seen] = event->time;
  }
  l->seen++;
  return l->ends_at_first;
}

static ric_status run_to(ric_trajectory *trajectory, double end, listener *l, ric_error *error) {
  const ric_observer observer = {.event = hear, .user = l};
  ric_run run;
  RIC_TRY(ric_trajectory_run(trajectory, end, &observer, &run, error));
  if (l->what)
    return ric_fail(error, RIC_ENUMERIC, "%s at t = %.9g: no motion with impacts one by one", l->what, l->when);
  if (run.outcome == RIC_RUN_COMPLETED || (run.outcome == RIC_RUN_ENDED && l->ends_at_first))
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "the motion stops at t = %.9g: %s %.150s", run.time,
                  ric_run_outcome_name(run.outcome), run.reason);
}

static void keep_state(motion_record *record, const ric_trajectory *trajectory, const ric_system *system) {
  memcpy(record->q, ric_trajectory_q(trajectory), ric_system_coordinates(system) * sizeof *record->q);
  if (ric_system_speeds(system) > 0)
    memcpy(record->u, ric_trajectory_u(trajectory), ric_system_speeds(system) * sizeof *record->u);
}

static ric_status allocate(motion_record *record, const ric_system *system, ric_error *error) {
  record->sequence = calloc(record->count + 1, sizeof *record->sequence);
  record->times = calloc(record->count + 1, sizeof *record->times);
  record->q = calloc(ric_system_coordinates(system), sizeof *record->q);
  record->u = calloc(ric_system_speeds(system) + 1, sizeof *record->u);
  if (record->sequence && record->times && record->q && record->u)
    return RIC_OK;
  return ric_fail(error, RIC_ENOMEM, "no memory for a motion with %zu impacts", record->count);
}

/* Time counts from the beginning of the period in which the first impact is. */
static void fold_times(motion_record *record, double period) {
  const double origin = floor(record->times[0] / period) * period;
  for (size_t k = 0; k < record->count; k++)
    record->times[k] -= origin;
}

/* First the impacts are counted, then written down: runs do the same thing each time. */
static ric_status take(motion_record *record, ric_trajectory *trajectory, const ric_system *system, double period,
                       double t, const double *q, const double *u, ric_error *error) {
  listener counter = {.record = record}, writer = {.record = record, .keeps = true, .ends_at_first = true};
  RIC_TRY(ric_trajectory_start(trajectory, t, q, u, error));
  RIC_TRY(run_to(trajectory, t + period, &counter, error));
  record->count = counter.seen;
  RIC_TRY(allocate(record, system, error));
  RIC_TRY(ric_trajectory_start(trajectory, t, q, u, error));
  if (record->count == 0) {
    RIC_TRY(run_to(trajectory, ceil(t / period) * period, &counter, error));
    keep_state(record, trajectory, system);
    return RIC_OK;
  }
  RIC_TRY(run_to(trajectory, t + period, &writer, error));
  keep_state(record, trajectory, system);
  writer.ends_at_first = false;
  RIC_TRY(run_to(trajectory, t + period, &writer, error));
  fold_times(record, period);
  return RIC_OK;
}

ric_status motion_record_take(motion_record *record, const ric_system *system, const ric_shooting_problem *motion,
                              double period, double t, const double *q, const double *u, ric_error *error) {
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_trajectory *trajectory = NULL;
  *record = (motion_record){0};
  options.flow = motion->flow;
  options.poll = motion->poll;
  RIC_TRY(ric_trajectory_create(system, &options, &trajectory, error));
  ric_status status = take(record, trajectory, system, period, t, q, u, error);
  ric_trajectory_destroy(&trajectory);
  return status;
}

void motion_record_clear(motion_record *record) {
  free(record->sequence);
  free(record->times);
  free(record->q);
  free(record->u);
  *record = (motion_record){0};
}
