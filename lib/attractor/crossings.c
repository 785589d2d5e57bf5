#include "crossings.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "impact/trajectory_state.h"

static bool at_impacts(const crossings *c) {
  return c->options.kind == RIC_SECTION_IMPACT;
}

ric_status crossings_init(crossings *c, const ric_system *system, const ric_motion_section_options *options,
                          ric_error *error) {
  *c = (crossings){.options = *options, .system = system, .n = system->coordinates, .m = system->speeds};
  c->size = c->n + c->m + (at_impacts(c) && options->period > 0 ? 1 : 0);
  RIC_TRY(ric_trajectory_create(system, &options->trajectory, &c->trajectory, error));
  c->store = malloc(CROSSINGS_MOST * (c->size + c->n + c->m + 1) * sizeof *c->store);
  if (!c->store)
    return ric_fail(error, RIC_ENOMEM, "no memory for states of %zu numbers on a section", c->size);
  c->states = c->store;
  c->times = c->states + CROSSINGS_MOST * c->size;
  c->sampler = (ric_sampler){.times = c->times, .coordinates = c->n, .speeds = c->m};
  c->sampler.q = c->times + CROSSINGS_MOST;
  c->sampler.u = c->sampler.q + CROSSINGS_MOST * c->n;
  return RIC_OK;
}

void crossings_clear(crossings *c) {
  ric_trajectory_destroy(&c->trajectory);
  free(c->store);
  *c = (crossings){0};
}

/* Where the forcing is, in [0, T). */
static double remainder_of(double t, double period) {
  double left = fmod(t, period);
  return left < 0 ? left + period : left;
}

ric_status crossings_start(crossings *c, const double *z, ric_error *error) {
  double t = c->size > c->n + c->m ? z[c->n + c->m] : at_impacts(c) ? 0 : c->options.phase * c->options.period;
  RIC_TRY(ric_trajectory_start(c->trajectory, t, z, c->m ? z + c->n : NULL, error));
  c->last = t;
  c->done = 0;
  c->pending = false;
  return RIC_OK;
}

/* --- what is seen of the motion ----------------------------------------------------------------------------------- */

static void put_state(crossings *c, size_t k, const double *q, const double *u) {
  double *z = c->states + k * c->size;
  memcpy(z, q, c->n * sizeof *z);
  if (c->m)
    memcpy(z + c->n, u, c->m * sizeof *z);
}

/* The state after an impact is that at the start of the next step: all that happens at its time is done. */
static void take_pending(crossings *c) {
  if (!c->pending)
    return;
  c->pending = false;
  put_state(c, c->found, ric_trajectory_q(c->trajectory), ric_trajectory_u(c->trajectory));
  if (c->size > c->n + c->m)
    c->states[c->found * c->size + c->n + c->m] = remainder_of(c->last, c->options.period);
  c->found++;
}

static int see_segment(const ric_segment *piece, double end, void *user) {
  crossings *c = user;
  if (!at_impacts(c))
    return ric_sampler_segment(piece, end, &c->sampler);
  take_pending(c);
  return 0;
}

static int see_event(const ric_event *event, void *user) {
  crossings *c = user;
  if (!ric_event_jumps(event))
    return 0;
  c->impacts++;
  if (!at_impacts(c) || (c->options.obstacle != SIZE_MAX && c->options.obstacle != event->obstacle))
    return 0;
  c->pending = true;
  c->last = event->time;
  return c->found + 1 >= c->wanted;
}

/* --- running ------------------------------------------------------------------------------------------------------ */

static bool loses_vectors(const ric_run *run) {
  return run->outcome == RIC_RUN_GRAZING || run->outcome == RIC_RUN_NOT_DIFFERENTIABLE;
}

/* Runs on, without the tangent vectors from where they are lost. */
static ric_status run_to(crossings *c, double end, ric_run *run, ric_error *error) {
  const ric_observer observer = {.segment = see_segment, .event = see_event, .user = c};
  if (c->course) {
    c->course->options.observer = &observer;
    ric_status status = lyapunov_course_run(c->course, end, run, error);
    c->course->options.observer = NULL;
    if (status != RIC_OK || !loses_vectors(run))
      return status;
    c->course = NULL;
    if (c->pending && c->found + 1 >= c->wanted) { /* the observer's end came with it */
      run->outcome = RIC_RUN_ENDED;
      return RIC_OK;
    }
  }
  return ric_trajectory_run(c->trajectory, end, &observer, run, error);
}

static ric_status next_strobes(crossings *c, size_t count, ric_run *run, ric_error *error) {
  for (size_t k = 0; k < count; k++)
    c->times[k] = (c->options.phase + (double)(c->done + k + 1)) * c->options.period;
  c->sampler.count = count;
  c->sampler.next = 0;
  RIC_TRY(run_to(c, c->times[count - 1], run, error));
  ric_sampler_finish(&c->sampler, c->trajectory);
  c->found = c->sampler.next;
  for (size_t k = 0; k < c->found; k++)
    put_state(c, k, c->sampler.q + k * c->n, c->sampler.u + k * c->m);
  c->done += count;
  return RIC_OK;
}

/* Runs that end without the last of the impacts go on as long as each of them has seen one. */
static ric_status next_impacts(crossings *c, size_t count, ric_run *run, ric_error *error) {
  c->found = 0;
  c->wanted = count;
  do {
    double end = c->last + c->options.wait;
    RIC_TRY(run_to(c, end, run, error));
    take_pending(c);
    if (run->outcome == RIC_RUN_COMPLETED && !(c->last + c->options.wait > end))
      return snprintf(run->reason, sizeof run->reason, "no impact for %g", c->options.wait), RIC_OK;
  } while (run->outcome == RIC_RUN_COMPLETED);
  if (run->outcome == RIC_RUN_ENDED)
    run->outcome = RIC_RUN_COMPLETED;
  return RIC_OK;
}

/* Whether the clock may go back; not where nobody knows what the forces do. */
static bool clock_turns(const crossings *c) {
  const system_model *model = c->system->model;
  if (c->options.period > 0)
    return model->repeats && model->repeats(c->system, c->options.period);
  return model->forced && !model->forced(c->system);
}

static ric_status turn_clock(crossings *c, ric_error *error) {
  double period = c->options.period, t = ric_trajectory_time(c->trajectory), early = 0;
  if (!clock_turns(c))
    return RIC_OK;
  if (!at_impacts(c))
    early = c->options.phase * period;
  else if (period > 0)
    early = remainder_of(t, period);
  c->done = 0;
  c->last += early - t;
  return trajectory_set_clock(c->trajectory, early, error);
}

ric_status crossings_next(crossings *c, size_t count, ric_run *run, ric_error *error) {
  RIC_TRY(at_impacts(c) ? next_impacts(c, count, run, error) : next_strobes(c, count, run, error));
  return c->found == count ? turn_clock(c, error) : RIC_OK;
}
