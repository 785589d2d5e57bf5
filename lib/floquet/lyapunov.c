#include "lyapunov.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "impact/trajectory.h"
#include "model/system_model.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

ric_lyapunov_options ric_lyapunov_options_default(void) {
  return (ric_lyapunov_options){.interval = 1};
}

/* Shorter intervals are lost in the rounding of time. */
static double least_interval(double t) {
  return 1e-12 * (1 + fabs(t));
}

static ric_status check_course(const ric_lyapunov_options *o, size_t size, double end, ric_error *error) {
  if (o->count > size)
    return ric_fail(error, RIC_EINVAL, "count = %zu, expected at most %zu exponents (or 0: all)", o->count, size);
  if (!(o->interval > least_interval(end)))
    return ric_fail(error, RIC_EINVAL, "interval = %g, expected > %g", o->interval, least_interval(end));
  if (!(o->transient >= 0 && o->transient < INFINITY))
    return ric_fail(error, RIC_EINVAL, "transient = %g, expected a finite number >= 0", o->transient);
  return RIC_OK;
}

static ric_status allocate_course(lyapunov_course *c, ric_error *error) {
  c->vectors = calloc(c->size * c->count, sizeof *c->vectors);
  c->growth = calloc(2 * c->count, sizeof *c->growth);
  if (!c->vectors || !c->growth)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors of %zu numbers", c->count, c->size);
  c->sum = c->growth + c->count;
  return orthonormal_init(&c->work, c->size, c->count, error);
}

ric_status lyapunov_course_init(lyapunov_course *c, ric_trajectory *trajectory, const ric_lyapunov_options *options,
                                ric_error *error) {
  const ric_system *system = trajectory->system;
  *c = (lyapunov_course){.trajectory = trajectory, .options = *options, .n = system->coordinates};
  c->size = c->n + system->speeds;
  c->count = options->count ? options->count : c->size;
  RIC_TRY(allocate_course(c, error));
  lyapunov_course_restart(c);
  return RIC_OK;
}

void lyapunov_course_clear(lyapunov_course *c) {
  free(c->vectors);
  free(c->growth);
  orthonormal_clear(&c->work);
  *c = (lyapunov_course){0};
}

void lyapunov_course_restart(lyapunov_course *c) {
  orthonormal_scatter(&c->work, c->vectors, c->growth);
  c->stride = c->options.interval / 64;
  c->begin = -INFINITY;
  lyapunov_course_forget(c);
}

void lyapunov_course_forget(lyapunov_course *c) {
  c->time = 0;
  for (size_t k = 0; k < c->count; k++)
    c->sum[k] = 0;
}

static double time_now(const lyapunov_course *c) {
  return ric_trajectory_time(c->trajectory);
}

/* Adds the counts of a part of the run to those of the whole. */
static void join(ric_run *whole, const ric_run *part) {
  ric_run before = *whole;
  *whole = *part;
  for (int k = 0; k < RIC_EVENT_KINDS; k++)
    whole->events[k] += before.events[k];
  whole->energy_start = before.energy_start;
  whole->impact_loss += before.impact_loss;
  whole->flow.steps += before.flow.steps;
  whole->flow.force_evaluations += before.flow.force_evaluations;
  whole->flow.starts += before.flow.starts;
}

/* At the end of a stride: factorises the tangent vectors and adds their growth, after the transient. */
static void factorise_stride(lyapunov_course *c, double length) {
  size_t n = c->n, count = c->count;
  memcpy(c->vectors, ric_trajectory_dq(c->trajectory), n * count * sizeof *c->vectors);
  if (c->size > n)
    memcpy(c->vectors + n * count, ric_trajectory_du(c->trajectory), (c->size - n) * count * sizeof *c->vectors);
  orthonormal_make(&c->work, c->vectors, c->growth);
  if (time_now(c) <= c->begin)
    return;
  c->time += length;
  for (size_t k = 0; k < count; k++)
    c->sum[k] += c->growth[k];
}

/* Adapts the stride so that growth ratios of vectors stay below e^7: a vector in the span of the previous ones has then
 * lost its direction at a contact, not by rounding. */
static void adapt_stride(lyapunov_course *c) {
  double most = -INFINITY, least = INFINITY;
  for (size_t k = 0; k < c->count; k++)
    if (c->growth[k] > -INFINITY) {
      most = fmax(most, c->growth[k]);
      least = fmin(least, c->growth[k]);
    }
  double spread = most > least ? most - least : 0;
  c->stride = fmin(c->stride * fmin(2, fmax(0.25, 7 / spread)), c->options.interval);
  c->stride = fmax(c->stride, least_interval(time_now(c)));
}

/* The end of the current interval is c->mark; a stride that would leave a very short rest is extended to it. */
static double next_stop(lyapunov_course *c, double end) {
  double t = time_now(c);
  if (!(c->mark > t))
    c->mark = fmin(t + c->options.interval, t < c->begin ? fmin(c->begin, end) : end);
  return t + 1.2 * c->stride < c->mark ? t + c->stride : c->mark;
}

/* Reports the exponents so far. @returns whether the caller stops */
static bool report(lyapunov_course *c, ric_run *whole) {
  const ric_lyapunov_options *o = &c->options;
  if (!(c->time > 0) || !o->history)
    return false;
  for (size_t k = 0; k < c->count; k++)
    c->growth[k] = c->sum[k] / c->time;
  if (o->history(c->time, c->growth, c->count, o->user) == 0)
    return false;
  whole->outcome = RIC_RUN_ENDED;
  snprintf(whole->reason, sizeof whole->reason, "the history asked for the end");
  return true;
}

/* One stride. @param over  whether it was the last */
static ric_status advance_course(lyapunov_course *c, double end, ric_run *whole, bool *over, ric_error *error) {
  double start = time_now(c);
  ric_run part;
  RIC_TRY(ric_trajectory_carry(c->trajectory, c->count, c->vectors, c->vectors + c->n * c->count, error));
  RIC_TRY(ric_trajectory_run(c->trajectory, next_stop(c, end), c->options.observer, &part, error));
  join(whole, &part);
  *over = part.outcome != RIC_RUN_COMPLETED || time_now(c) >= end;
  if (ric_trajectory_columns(c->trajectory) != c->count)
    return RIC_OK;
  /* Also after a stride without progress in time: an observer may have ended it at an impact. */
  factorise_stride(c, time_now(c) - start);
  adapt_stride(c);
  if (time_now(c) >= c->mark || *over)
    *over |= report(c, whole);
  return RIC_OK;
}

ric_status lyapunov_course_run(lyapunov_course *c, double end, ric_run *run, ric_error *error) {
  c->mark = time_now(c);
  /* Contacts that are closed at the start are processed before tangent vectors are set. */
  RIC_TRY(ric_trajectory_run(c->trajectory, time_now(c), c->options.observer, run, error));
  bool over = run->outcome != RIC_RUN_COMPLETED;
  keep_gsl_quiet();
  ric_status status = RIC_OK;
  while (!over && status == RIC_OK)
    status = advance_course(c, end, run, &over, error);
  return status;
}

/* A whole run. */
static ric_status run_course(lyapunov_course *c, double end, double *exponents, ric_lyapunov *lyapunov,
                             ric_error *error) {
  c->begin = time_now(c) + c->options.transient;
  RIC_TRY(lyapunov_course_run(c, end, &lyapunov->run, error));
  lyapunov->time = c->time;
  for (size_t k = 0; k < c->count && c->time > 0; k++)
    exponents[k] = c->sum[k] / c->time;
  return RIC_OK;
}

ric_status ric_lyapunov_run(ric_trajectory *trajectory, double end, const ric_lyapunov_options *options,
                            double *exponents, ric_lyapunov *lyapunov, ric_error *error) {
  REQUIRE(error, {"trajectory", trajectory}, {"exponents", exponents}, {"lyapunov", lyapunov});
  ric_lyapunov_options o = options ? *options : ric_lyapunov_options_default();
  size_t size = trajectory->system->coordinates + trajectory->system->speeds;
  lyapunov_course c = {0};
  *lyapunov = (ric_lyapunov){0};
  RIC_TRY(check_course(&o, size, end, error));
  for (size_t k = 0; k < (o.count ? o.count : size); k++)
    exponents[k] = NAN;
  keep_gsl_quiet();
  ric_status status = lyapunov_course_init(&c, trajectory, &o, error);
  if (status == RIC_OK)
    status = run_course(&c, end, exponents, lyapunov, error);
  lyapunov_course_clear(&c);
  return status;
}
