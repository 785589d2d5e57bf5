/* The attractor of a motion on a section: its crossings, in blocks, and the run over them. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attractor.h"
#include "cycle_growth.h"
#include "floquet/lyapunov.h"
#include "impact/trajectory.h"
#include "numeric/constants.h"
#include "numeric/required.h"
#include "ricochet/elementary.h"
#include "ricochet/motion_section.h"

/* Crossings of a motion with a section, in blocks.
 *
 * Stroboscopic states are evaluated on the segments of the motion, so that steps continue across them; impacts are
 * events. Every CROSSINGS_MOST crossings, or where a caller asks for fewer, the run ends. There the clock is set
 * back by whole periods if the forces of the system repeat after one: the phase of the forcing has the digits of a
 * time below CROSSINGS_MOST periods, however long the motion is. Results depend on the start, the options and the
 * numbers asked for only. */

typedef struct crossings {
  ric_motion_section_options options;
  const ric_system *system;
  ric_trajectory *trajectory;
  lyapunov_course *course; /* NULL: no tangent vectors. Set to NULL where they are not defined any more */
  size_t n, m, size;       /* of a state on the section */
  double *store;           /* owns all arrays */
  double *states;          /* [found][size] those of the last call, CROSSINGS_MOST at most */
  size_t found;
  unsigned long long impacts; /* of all obstacles, since the caller set it */

  ric_sampler sampler;
  double *times; /* [CROSSINGS_MOST] of stroboscopic crossings */
  size_t wanted; /* impacts */
  size_t done;   /* periods of the clock at the start of a call */
  bool pending;  /* an impact whose state has not been recorded yet */
  double last;   /* time of the last impact, or of the start */
} crossings;

enum { CROSSINGS_MOST = 64 };

static bool at_impacts(const crossings *c) {
  return c->options.kind == RIC_SECTION_IMPACT;
}

/** @param options  in range */
static ric_status crossings_init(crossings *c, const ric_system *system, const ric_motion_section_options *options,
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

static void crossings_clear(crossings *c) {
  ric_trajectory_destroy(&c->trajectory);
  free(c->store);
  *c = (crossings){0};
}

/* The phase of the forcing, as a time in [0, T). */
static double remainder_of(double t, double period) {
  double left = fmod(t, period);
  return left < 0 ? left + period : left;
}

/** Starts a motion at a state of the section's form. @returns as ric_trajectory_start */
static ric_status crossings_start(crossings *c, const double *z, ric_error *error) {
  double t = c->size > c->n + c->m ? z[c->n + c->m] : at_impacts(c) ? 0 : c->options.phase * c->options.period;
  RIC_TRY(ric_trajectory_start(c->trajectory, t, z, c->m ? z + c->n : NULL, error));
  c->last = t;
  c->done = 0;
  c->pending = false;
  return RIC_OK;
}

/* --- observers ---------------------------------------------------------------------------------------------------- */

static void record_crossing(crossings *c, size_t k, const double *q, const double *u) {
  double *z = c->states + k * c->size;
  memcpy(z, q, c->n * sizeof *z);
  if (c->m)
    memcpy(z + c->n, u, c->m * sizeof *z);
}

/* Records the state after an impact, at the start of the next step: then all events of its time are over. */
static void record_pending(crossings *c) {
  if (!c->pending)
    return;
  c->pending = false;
  record_crossing(c, c->found, ric_trajectory_q(c->trajectory), ric_trajectory_u(c->trajectory));
  if (c->size > c->n + c->m)
    c->states[c->found * c->size + c->n + c->m] = remainder_of(c->last, c->options.period);
  c->found++;
}

static int on_segment(const ric_segment *piece, double end, void *user) {
  crossings *c = user;
  if (!at_impacts(c))
    return ric_sampler_segment(piece, end, &c->sampler);
  record_pending(c);
  return 0;
}

static int on_event(const ric_event *event, void *user) {
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

static bool is_not_differentiable(const ric_run *run) {
  return run->outcome == RIC_RUN_GRAZING || run->outcome == RIC_RUN_NOT_DIFFERENTIABLE;
}

/* Continues the run; without tangent vectors after an impact that has no derivative. */
static ric_status run_to(crossings *c, double end, ric_run *run, ric_error *error) {
  const ric_observer observer = {.segment = on_segment, .event = on_event, .user = c};
  if (c->course) {
    c->course->options.observer = &observer;
    ric_status status = lyapunov_course_run(c->course, end, run, error);
    c->course->options.observer = NULL;
    if (status != RIC_OK || !is_not_differentiable(run))
      return status;
    c->course = NULL;
    if (c->pending && c->found + 1 >= c->wanted) { /* the same event ended the run */
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
    record_crossing(c, k, c->sampler.q + k * c->n, c->sampler.u + k * c->m);
  c->done += count;
  return RIC_OK;
}

/* A run ends `wait` after the last impact; it continues while each of these runs has found another impact. */
static ric_status next_impacts(crossings *c, size_t count, ric_run *run, ric_error *error) {
  c->found = 0;
  c->wanted = count;
  do {
    double end = c->last + c->options.wait;
    RIC_TRY(run_to(c, end, run, error));
    record_pending(c);
    if (run->outcome == RIC_RUN_COMPLETED && !(c->last + c->options.wait > end))
      return snprintf(run->reason, sizeof run->reason, "no impact for %g", c->options.wait), RIC_OK;
  } while (run->outcome == RIC_RUN_COMPLETED);
  if (run->outcome == RIC_RUN_ENDED)
    run->outcome = RIC_RUN_COMPLETED;
  return RIC_OK;
}

/* Whether the clock may be set back: not where the period of the forces is unknown. */
static bool clock_is_periodic(const crossings *c) {
  const system_model *model = c->system->model;
  if (c->options.period > 0)
    return model->repeats && model->repeats(c->system, c->options.period);
  return model->forced && !model->forced(c->system);
}

static ric_status set_clock_back(crossings *c, ric_error *error) {
  double period = c->options.period, t = ric_trajectory_time(c->trajectory), early = 0;
  if (!clock_is_periodic(c))
    return RIC_OK;
  if (!at_impacts(c))
    early = c->options.phase * period;
  else if (period > 0)
    early = remainder_of(t, period);
  c->done = 0;
  c->last += early - t;
  return trajectory_set_clock(c->trajectory, early, error);
}

/** The next crossings.
 *  @param count  1 to CROSSINGS_MOST
 *  @param run  outcome and reason; `completed` when all were found
 *  @returns as ric_trajectory_run */
static ric_status crossings_next(crossings *c, size_t count, ric_run *run, ric_error *error) {
  RIC_TRY(at_impacts(c) ? next_impacts(c, count, run, error) : next_strobes(c, count, run, error));
  return c->found == count ? set_clock_back(c, error) : RIC_OK;
}

/* Iterates before the measured ones in which tangent vectors align. */
enum { ALIGNING = 64 };

/* Growth of the rounding of a state by slow impacts, relative to the state: up to 3e-11 at speeds of 0.02. */
static const double NOISE = 1e-9;

struct ric_motion_section {
  crossings crossings;
  lyapunov_course course;
  cycle_growth growth; /* of the size of the system's states */
  double *window;      /* the states of which the period is determined */
  size_t window_room;
};

ric_motion_section_options ric_motion_section_options_default(double period) {
  return (ric_motion_section_options){
      .period = period, .obstacle = SIZE_MAX, .wait = 1000, .trajectory = ric_trajectory_options_default()};
}

static ric_status check_period(const ric_motion_section_options *o, ric_error *error) {
  bool none = o->kind == RIC_SECTION_IMPACT;
  if ((o->period > 0 || (none && o->period == 0)) && o->period < INFINITY)
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "period = %g, expected a finite number > 0%s", o->period,
                  none ? " (or 0: none)" : "");
}

static ric_status check_obstacle(const ric_system *system, const ric_motion_section_options *o, ric_error *error) {
  if (system->obstacle_count == 0)
    return ric_fail(error, RIC_EINVAL, "section = impact, expected a system with obstacles");
  if (o->obstacle != SIZE_MAX && o->obstacle >= system->obstacle_count)
    return ric_fail(error, RIC_EINVAL, "obstacle = %zu, expected at most %zu", o->obstacle, system->obstacle_count - 1);
  if (!(o->wait > 0 && o->wait < INFINITY))
    return ric_fail(error, RIC_EINVAL, "wait = %g, expected a finite number > 0", o->wait);
  return RIC_OK;
}

static ric_status check_section(const ric_system *system, const ric_motion_section_options *o, ric_error *error) {
  if (o->kind != RIC_SECTION_STROBE && o->kind != RIC_SECTION_IMPACT)
    return ric_fail(error, RIC_EINVAL, "section = %d, expected strobe or impact", (int)o->kind);
  RIC_TRY(check_period(o, error));
  if (o->kind == RIC_SECTION_IMPACT)
    return check_obstacle(system, o, error);
  if (!(o->phase >= 0 && o->phase < 1))
    return ric_fail(error, RIC_EINVAL, "phase = %g, expected 0 <= phase < 1", o->phase);
  return RIC_OK;
}

void ric_motion_section_destroy(ric_motion_section **section) {
  if (!section || !*section)
    return;
  crossings_clear(&(*section)->crossings);
  lyapunov_course_clear(&(*section)->course);
  cycle_growth_clear(&(*section)->growth);
  free((*section)->window);
  free(*section);
  *section = NULL;
}

ric_status ric_motion_section_create(const ric_system *system, const ric_motion_section_options *options,
                                     ric_motion_section **section, ric_error *error) {
  REQUIRE(error, {"system", system}, {"options", options}, {"section", section});
  *section = NULL;
  RIC_TRY(check_section(system, options, error));
  ric_motion_section *s = calloc(1, sizeof *s);
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a section of motions");
  ric_status status = crossings_init(&s->crossings, system, options, error);
  if (status != RIC_OK)
    ric_motion_section_destroy(&s);
  *section = s;
  return status;
}

size_t ric_motion_section_size(const ric_motion_section *section) {
  return section->crossings.size;
}

ric_status ric_motion_section_set_period(ric_motion_section *section, double period, ric_error *error) {
  REQUIRE(error, {"section", section});
  crossings *c = &section->crossings;
  ric_motion_section_options o = c->options;
  o.period = period;
  RIC_TRY(check_period(&o, error));
  if (o.kind == RIC_SECTION_IMPACT && (period > 0) != (c->options.period > 0))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected %s: states on the section would be of another size",
                    period, period > 0 ? "0, as before" : "> 0, as before");
  c->options.period = period;
  return RIC_OK;
}

/* --- one attractor ------------------------------------------------------------------------------------------------ */

/* A run in progress. */
typedef struct section_run {
  ric_motion_section *section;
  const ric_attractor_options *options;
  ric_attractor *attractor;
  size_t width; /* numbers of a state in the window */
  size_t done;  /* iterates */
  bool over;    /* diverged or failed */
} section_run;

/* Adds a state to the window: the phase of the forcing as a point on a circle, so that both ends of a period are
 * near. */
static void add_to_window(const section_run *j, const double *z, size_t k) {
  const crossings *c = &j->section->crossings;
  double *row = j->section->window + k * j->width;
  size_t numbers = c->n + c->m;
  memcpy(row, z, numbers * sizeof *row);
  if (c->size > numbers) {
    double radius = c->options.period / two_pi;
    ric_sincos(z[numbers] / radius, &row[numbers + 1], &row[numbers]);
    row[numbers] *= radius;
    row[numbers + 1] *= radius;
  }
}

/* The last state, in its original form, stored after the window. */
static double *last_of(const section_run *j) {
  return j->section->window + (2 * j->options->period_limit + 1) * j->width;
}

static void record_state(section_run *j, const double *z) {
  const ric_attractor_options *o = j->options;
  ric_attractor *a = j->attractor;
  size_t size = j->section->crossings.size, measured = o->transient + o->measure;
  j->done++;
  if (j->done <= measured)
    memcpy(a->z, z, size * sizeof *z);
  else
    memcpy(last_of(j), z, size * sizeof *z);
  if (j->done >= measured)
    add_to_window(j, z, j->done - measured);
  if (j->done <= o->transient || j->done > o->transient + o->keep)
    return;
  size_t kept = j->done - o->transient - 1;
  if (a->values)
    a->values[kept] = z[o->observe];
  if (a->states)
    memcpy(a->states + kept * size, z, size * sizeof *z);
}

static void end_run(section_run *j, ric_attractor_kind kind, const char *reason) {
  ric_attractor *a = j->attractor;
  size_t transient = j->options->transient, measured = transient + j->options->measure;
  j->over = true;
  a->kind = kind;
  a->iterates = j->done;
  snprintf(a->reason, sizeof a->reason, "%.*s", (int)sizeof a->reason - 1, reason);
  if (j->done > transient && j->done < measured)
    a->impacts = (double)j->section->crossings.impacts / (double)(j->done - transient);
  if (j->done > measured)
    memcpy(a->z, last_of(j), j->section->crossings.size * sizeof *a->z);
}

/* Records the crossings found, up to one that is out of bounds. */
static void record_crossings(section_run *j) {
  const crossings *c = &j->section->crossings;
  char reason[128];
  for (size_t k = 0; k < c->found; k++) {
    const double *z = c->states + k * c->size;
    for (size_t i = 0; i < c->n + c->m; i++)
      if (!(fabs(z[i]) <= j->options->bound)) {
        snprintf(reason, sizeof reason, "number %zu of the state is %g", i, z[i]);
        end_run(j, RIC_ATTRACTOR_DIVERGED, reason);
        return;
      }
    record_state(j, z);
  }
}

static void end_with_reason(section_run *j, const ric_run *run) {
  char reason[320];
  if (run->outcome == RIC_RUN_COMPLETED)
    snprintf(reason, sizeof reason, "%s", run->reason);
  else
    snprintf(reason, sizeof reason, "%s: %s", ric_run_outcome_name(run->outcome), run->reason);
  end_run(j, run->outcome == RIC_RUN_BLOW_UP ? RIC_ATTRACTOR_DIVERGED : RIC_ATTRACTOR_FAILED, reason);
}

/* Runs over a number of iterates. */
static ric_status run_iterates(section_run *j, size_t count, ric_error *error) {
  crossings *c = &j->section->crossings;
  for (size_t left = count, asked; left > 0 && !j->over; left -= asked) {
    ric_run run;
    asked = left < CROSSINGS_MOST ? left : CROSSINGS_MOST;
    RIC_TRY(crossings_next(c, asked, &run, error));
    record_crossings(j);
    if (!j->over && c->found < asked)
      end_with_reason(j, &run);
  }
  return RIC_OK;
}

/* --- exponents ---------------------------------------------------------------------------------------------------- */

static ric_status prepare_course(ric_motion_section *s, size_t count, ric_error *error) {
  ric_lyapunov_options o = ric_lyapunov_options_default();
  o.count = count;
  o.interval = s->crossings.options.period > 0 ? s->crossings.options.period : 1; /* problems are dimensionless */
  if (s->course.count != count) {
    lyapunov_course_clear(&s->course);
    RIC_TRY(lyapunov_course_init(&s->course, s->crossings.trajectory, &o, error));
  }
  s->course.options = o;
  lyapunov_course_restart(&s->course);
  return RIC_OK;
}

/* The iterates before the measured ones, the last of them with tangent vectors. */
static ric_status run_transient(section_run *j, ric_error *error) {
  const ric_attractor_options *o = j->options;
  size_t aligning = o->exponents == 0 ? 0 : o->transient < ALIGNING ? o->transient : ALIGNING;
  RIC_TRY(run_iterates(j, o->transient - aligning, error));
  if (o->exponents == 0 || j->over)
    return RIC_OK;
  RIC_TRY(prepare_course(j->section, o->exponents, error));
  j->section->crossings.course = &j->section->course;
  return run_iterates(j, aligning, error);
}

static ric_status measure(section_run *j, ric_error *error) {
  const ric_attractor_options *o = j->options;
  crossings *c = &j->section->crossings;
  c->impacts = 0;
  if (c->course)
    lyapunov_course_forget(c->course);
  RIC_TRY(run_iterates(j, o->measure, error));
  if (j->over)
    return RIC_OK;
  j->attractor->impacts = (double)c->impacts / (double)o->measure;
  for (size_t k = 0; c->course && k < o->exponents; k++)
    j->attractor->exponents[k] = c->course->sum[k] / (double)o->measure;
  return RIC_OK;
}

/* One period more, of a cycle. @param complete  whether the motion went on, with its tangent vectors if it has any */
static ric_status run_period(section_run *j, bool *complete, ric_error *error) {
  crossings *c = &j->section->crossings;
  const size_t columns = ric_trajectory_columns(c->trajectory);
  const bool course = c->course != NULL;
  *complete = true;
  c->impacts = 0;
  for (size_t left = j->attractor->period, asked; left > 0 && *complete; left -= asked) {
    ric_run run;
    asked = left < CROSSINGS_MOST ? left : CROSSINGS_MOST;
    RIC_TRY(crossings_next(c, asked, &run, error));
    *complete = c->found == asked && (course ? c->course != NULL : ric_trajectory_columns(c->trajectory) == columns);
  }
  return RIC_OK;
}

/* Tangent vectors along all axes, for the derivative of a period. */
static ric_status carry_all(section_run *j, ric_error *error) {
  crossings *c = &j->section->crossings;
  cycle_growth *g = &j->section->growth;
  const size_t size = c->n + c->m;
  if (g->size == 0)
    RIC_TRY(cycle_growth_init(g, size, error));
  memset(g->product, 0, size * size * sizeof *g->product);
  for (size_t i = 0; i < size; i++)
    g->product[i * size + i] = 1;
  return ric_trajectory_carry(c->trajectory, size, g->product, c->m ? g->product + c->n * size : NULL, error);
}

/* Exponents from the given one on, which vanish in the rounding of the derivative, by the growth of orthogonal tangent
 * vectors: in the first period they turn. */
static ric_status measure_contracting(section_run *j, size_t from, ric_error *error) {
  crossings *c = &j->section->crossings;
  bool complete;
  RIC_TRY(prepare_course(j->section, j->options->exponents, error));
  c->course = &j->section->course;
  RIC_TRY(run_period(j, &complete, error));
  lyapunov_course_forget(&j->section->course);
  if (complete)
    RIC_TRY(run_period(j, &complete, error));
  for (size_t k = from; complete && k < j->options->exponents; k++)
    j->attractor->exponents[k] = j->section->course.sum[k] / (double)j->attractor->period;
  return RIC_OK;
}

/* Of a cycle the numbers of one period. */
static ric_status measure_cycle(section_run *j, bool exponents, ric_error *error) {
  crossings *c = &j->section->crossings;
  cycle_growth *g = &j->section->growth;
  ric_attractor *a = j->attractor;
  bool complete;
  if (exponents)
    RIC_TRY(carry_all(j, error));
  RIC_TRY(run_period(j, &complete, error));
  if (complete)
    a->impacts = (double)c->impacts / (double)a->period;
  if (!complete || !exponents)
    return RIC_OK;
  memcpy(g->product, ric_trajectory_dq(c->trajectory), c->n * g->size * sizeof *g->product);
  if (c->m)
    memcpy(g->product + c->n * g->size, ric_trajectory_du(c->trajectory), c->m * g->size * sizeof *g->product);
  const size_t known = cycle_growth_resolve(g, a->period, a->exponents, j->options->exponents);
  RIC_TRY(ric_trajectory_carry(c->trajectory, 0, NULL, NULL, error));
  return known > 0 && known < j->options->exponents ? measure_contracting(j, known, error) : RIC_OK;
}

static ric_status find_period(section_run *j, ric_error *error) {
  size_t limit = j->options->period_limit;
  ric_attractor *a = j->attractor;
  const bool exponents = j->section->crossings.course != NULL;
  j->section->crossings.course = NULL;
  RIC_TRY(ric_trajectory_carry(j->section->crossings.trajectory, 0, NULL, NULL, error));
  RIC_TRY(run_iterates(j, 2 * limit, error));
  if (j->over)
    return RIC_OK;
  a->iterates = j->options->transient + j->options->measure;
  a->period = period_find(j->section->window, j->width, j->width, limit, j->options->period_tol, NOISE);
  a->kind = a->period ? RIC_ATTRACTOR_PERIODIC : RIC_ATTRACTOR_APERIODIC;
  if (a->lowest) {
    size_t lowest = period_lowest(j->section->window, j->width, 2 * limit + 1, j->options->observe);
    memcpy(a->lowest, j->section->window + lowest * j->width, j->section->crossings.size * sizeof *a->lowest);
  }
  return a->period ? measure_cycle(j, exponents, error) : RIC_OK;
}

static ric_status run_all(section_run *j, ric_error *error) {
  RIC_TRY(run_transient(j, error));
  if (!j->over)
    RIC_TRY(measure(j, error));
  return j->over ? RIC_OK : find_period(j, error);
}

static ric_status reserve_states(ric_motion_section *s, size_t width, size_t limit, ric_error *error) {
  size_t room = (2 * limit + 2) * width; /* with the last state as it is */
  if (room <= s->window_room)
    return RIC_OK;
  free(s->window);
  s->window_room = 0;
  s->window = malloc(room * sizeof *s->window);
  if (!s->window)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu states of %zu numbers", 2 * limit + 1, width);
  s->window_room = room;
  return RIC_OK;
}

static ric_status clear_results(const ric_attractor_options *o, size_t size, ric_poll poll, ric_attractor *a,
                                ric_error *error) {
  a->period = a->iterates = 0;
  a->impacts = NAN;
  a->reason[0] = '\0';
  for (size_t k = 0; k < o->exponents; k++)
    a->exponents[k] = NAN;
  for (size_t i = 0; a->lowest && i < size; i++)
    a->lowest[i] = NAN;
  RIC_TRY(fill_unknown(a->values, o->keep, poll, error));
  return fill_unknown(a->states, o->keep * size, poll, error);
}

ric_status ric_motion_section_run(ric_motion_section *section, const ric_attractor_options *options,
                                  ric_attractor *attractor, ric_error *error) {
  REQUIRE(error, {"section", section}, {"attractor", attractor});
  crossings *c = &section->crossings;
  ric_attractor_options o = options ? *options : ric_attractor_options_default();
  size_t numbers = c->n + c->m;
  section_run j = {.section = section, .options = &o, .attractor = attractor};
  RIC_TRY(ric_attractor_options_check(&o, c->size, error));
  if (o.exponents > numbers)
    return ric_fail(error, RIC_EINVAL, "exponents = %zu, expected at most %zu", o.exponents, numbers);
  j.width = c->size > numbers ? c->size + 1 : c->size;
  RIC_TRY(reserve_states(section, j.width, o.period_limit, error));
  c->course = NULL;
  c->trajectory->options.poll = o.poll.call ? o.poll : c->options.trajectory.poll;
  RIC_TRY(crossings_start(c, attractor->z, error));
  RIC_TRY(clear_results(&o, c->size, c->trajectory->options.poll, attractor, error));
  return run_all(&j, error);
}
