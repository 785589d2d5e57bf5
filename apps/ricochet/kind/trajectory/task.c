/* kind: trajectory. An event-driven simulation from a state, or from a periodic orbit, at every grid point. */
#include <math.h>
#include <ricochet/ricochet.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "trajectory.h"
#include "model/chain.h"
#include "model/lattice_model.h"
#include "kind/fill.h"
#include "kind/machine.h"
#include "kind/pattern.h"
#include "base/table.h"

/* --- Lyapunov exponents and their convergence --- */

/* The convergence records of one task: each at least 5 % later than the one before, and the last. */
typedef struct convergence {
  const table *layout; /* with the columns lyapunov_time and lyapunov_history */
  records *to;
  double kept; /* time of the last one; 0 before the first */
  int no_memory;
} convergence;

/* Tangent vectors of a state of n numbers are n x n doubles: those of the trajectory and of the exponents, each with a
 * copy, and those of the flow. CVODES stores as many as its highest order, 12, needs. Measured up to 600 numbers. */
enum { COPIES = 5, CVODES_COPIES = 28, STATE_BYTES = 4096 /* the series of a step, per number of the state */ };

static const double spacing = 1.05; /* ratio of the times of two records: equal distances on a logarithmic axis */

/* Memory of tangent vectors for all exponents of a state, and of the records of one task. */
static double convergence_bytes(double exponents, bool by_cvodes) {
  const double most_records = ric_log(1e15) / ric_log(spacing); /* durations over intervals */
  return 8 * exponents * exponents * (by_cvodes ? CVODES_COPIES : COPIES) + STATE_BYTES * exponents +
         2 * 8 * (1 + exponents) * most_records; /* twice, as records grow by doubling */
}

static int keep(convergence *c, double time, const double *exponents) {
  unsigned char *record = records_add(c->to);
  if (!record) {
    c->no_memory = 1;
    return 1;
  }
  row_store(c->layout, record, &(lyapunov_record){.time = time, .history = exponents});
  c->kept = time;
  return 0;
}

static int add_history(double time, const double *exponents, size_t count, void *user) {
  convergence *c = user;
  (void)count;
  return time >= spacing * c->kept ? keep(c, time, exponents) : 0;
}

/* Runs a trajectory from its current time to `end` with all its exponents.
 * @param interval  between factorisations  @param exponents  set, NaN where the run gives none
 * @returns as ric_lyapunov_run; if a record cannot be allocated, the run ends with `no_memory` set */
static ric_status convergence_run(convergence *c, ric_trajectory *trajectory, double end, double interval,
                                  const ric_observer *observer, double *exponents, ric_run *did, ric_error *error) {
  ric_lyapunov_options options = ric_lyapunov_options_default();
  ric_lyapunov found;
  options.interval = interval;
  options.history = add_history;
  options.observer = observer;
  options.user = c;
  ric_status status = ric_lyapunov_run(trajectory, end, &options, exponents, &found, error);
  *did = found.run;
  if (status == RIC_OK && found.time > c->kept)
    keep(c, found.time, exponents);
  return status;
}

struct worker {
  study_values *values;
  ric_poll poll;
  lattice_model model;
  double *q, *v; /* [particles] state at t = 0 */
  double *times; /* [samples] */
  size_t samples;
  int from_orbit;
  chain_model chain; /* of the orbit; empty without one */
  ric_orbit_solver *solver;
  ric_orbit orbit;
};

/* What the observer of a run needs. */
typedef struct observation {
  const worker *worker;
  const kind_plan *plan;
  records *tails;
  ric_sampler sampler;
  trajectory_row row; /* its lyapunov is NULL when exponents are not asked for */
  convergence converged;
  int no_memory;
} observation;

/* Outcome of a task. */
typedef struct verdict {
  int outcome; /* ric_run_outcome and beyond */
  char reason[RIC_REASON_BYTES];
} verdict;

/* --- before the tasks --- */

static ric_flow_method flow_of(const study_values *v) {
  const char *word = value_word(v, KEY_TIME_FLOW);
  if (strcmp(word, "taylor") == 0)
    return RIC_FLOW_TAYLOR;
  return strcmp(word, "cvodes") == 0 ? RIC_FLOW_CVODES : RIC_FLOW_AUTO;
}

static int plan_memory(const study *s, const study_values *v, kind_plan *plan, message *why) {
  const trajectory_shape shape = trajectory_shape_of(v);
  const char *what = shape.exponents > 0 ? "a trajectory with its tangent vectors" : "a trajectory";
  plan->memory = 2 * table_row_bytes(&plan->rows) + 8 * shape.samples +
                 shape.particles * (TRAJECTORY_PARTICLE_BYTES + LATTICE_MODEL_BYTES) +
                 convergence_bytes(shape.exponents, flow_of(v) == RIC_FLOW_CVODES);
  int code = machine_refuse_size(s, what, plan->memory, why);
  chain_model chain = {0};
  ric_pattern *pattern = NULL;
  ric_error error = {0};
  if (code || !value_present(v, KEY_ORBIT_PERIOD))
    return code;
  if (chain_model_init(&chain, v) != 0)
    code = refuse(why, EXIT_RUN, "%s: no memory for the floors", study_name(s));
  else if (pattern_read(v, &pattern, &error) == RIC_OK) {
    plan->memory += ric_orbit_bytes(&chain.chain, pattern, RIC_METHOD_IMPULSE);
    code = machine_refuse_size(s, what, plan->memory, why);
  } else if (error.status == RIC_ENOMEM)
    code = refuse(why, EXIT_RUN, "%s: %s", study_name(s), error.message);
  ric_pattern_destroy(&pattern);
  chain_model_clear(&chain);
  return code;
}

static void worker_close(worker **w) {
  if (!w || !*w)
    return;
  ric_orbit_clear(&(*w)->orbit);
  ric_orbit_solver_destroy(&(*w)->solver);
  chain_model_clear(&(*w)->chain);
  lattice_model_clear(&(*w)->model);
  study_values_destroy(&(*w)->values);
  free((*w)->q);
  free((*w)->v);
  free((*w)->times);
  free(*w);
  *w = NULL;
}

/* @returns 0, or -1 when out of memory */
static int allocate(worker *w, const study *s) {
  w->values = study_values_create(s);
  if (!w->values || lattice_model_init(&w->model, w->values) != 0)
    return -1;
  w->samples = (size_t)value_number(w->values, KEY_TIME_SAMPLES, 0);
  w->from_orbit = value_present(w->values, KEY_ORBIT_PERIOD);
  w->q = calloc(w->model.lattice.particles, sizeof *w->q);
  w->v = calloc(w->model.lattice.particles, sizeof *w->v);
  w->times = calloc(w->samples, sizeof *w->times);
  if (!w->q || !w->v || !w->times)
    return -1;
  return w->from_orbit ? chain_model_init(&w->chain, w->values) : 0;
}

static ric_status prepare_orbit(worker *w, ric_error *error) {
  if (!w->from_orbit)
    return RIC_OK;
  const size_t m = value_count(w->values, KEY_ORBIT_AT_START) + value_count(w->values, KEY_ORBIT_AT_HALF);
  ric_orbit_options options = ric_orbit_options_default();
  options.poll = w->poll;
  RIC_TRY(ric_orbit_solver_create(&options, &w->solver, error));
  return ric_orbit_init(&w->orbit, w->chain.chain.particles, m, error);
}

static int trajectory_open(const study *s, ric_poll poll, worker **out, message *why) {
  worker *w = *out = calloc(1, sizeof *w);
  ric_error error = {.message = "no memory for a task"};
  if (w)
    w->poll = poll;
  if (w && allocate(w, s) == 0 && prepare_orbit(w, &error) == RIC_OK)
    return 0;
  worker_close(out);
  return refuse(why, EXIT_RUN, "%s: %s", study_name(s), error.message);
}

/* --- a task --- */

static void note_outcome(verdict *found, int outcome, const char *reason) {
  found->outcome = outcome;
  const size_t length = strnlen(reason, sizeof found->reason - 1);
  memcpy(found->reason, reason, length);
  found->reason[length] = '\0';
}

/* @returns RIC_OK, with a verdict when there is no orbit to start on; RIC_ESTOPPED */
static ric_status start_on_orbit(worker *w, verdict *found) {
  ric_error error = {0};
  ric_pattern *pattern = NULL;
  chain_model_read(&w->chain, w->values);
  ric_status status = pattern_read(w->values, &pattern, &error);
  if (status == RIC_OK)
    status = ric_orbit_solve(w->solver, &w->chain.chain, pattern, value_number(w->values, KEY_ORBIT_PERIOD, 0),
                             &w->orbit, &error);
  ric_pattern_destroy(&pattern);
  if (status == RIC_ESTOPPED)
    return status;
  const size_t n = w->model.lattice.particles;
  if (status != RIC_OK)
    note_outcome(found, TRAJECTORY_NO_ORBIT, error.message);
  else if (!isfinite(w->orbit.q[0]))
    note_outcome(found, TRAJECTORY_NO_ORBIT, w->orbit.reason);
  memcpy(w->q, w->orbit.q, n * sizeof *w->q);
  memcpy(w->v, w->orbit.v, n * sizeof *w->v);
  return RIC_OK;
}

static ric_status read_start(worker *w, verdict *found) {
  lattice_model_read(&w->model, w->values);
  if (w->from_orbit)
    return start_on_orbit(w, found);
  for (size_t i = 0; i < w->model.lattice.particles; i++) {
    w->q[i] = value_of_particle(w->values, KEY_START_Q, i);
    w->v[i] = value_of_particle(w->values, KEY_START_V, i);
  }
  return RIC_OK;
}

static ric_trajectory_options options_of(const worker *w) {
  ric_trajectory_options options = ric_trajectory_options_default();
  const double tolerance = value_number(w->values, KEY_TIME_TOLERANCE, 0);
  options.flow.method = flow_of(w->values);
  options.flow.tolerance = tolerance > 0 ? tolerance : 0; /* null reads as minus infinity */
  options.events_per_time = value_number(w->values, KEY_TIME_EVENTS_PER_TIME, 0);
  options.poll = w->poll;
  return options;
}

static int see_segment(const ric_segment *piece, double end, void *user) {
  observation *seen = user;
  return ric_sampler_segment(piece, end, &seen->sampler);
}

static void add_record(observation *seen, size_t which, const ric_event *event) {
  const event_record found = {.time = event->time,
                              .particle = (long long)event->coordinate,
                              .side = seen->worker->model.obstacles[event->obstacle].side > 0 ? 0 : 1,
                              .kind = (int)event->kind,
                              .gap_rate = event->gap_rate,
                              .impulse = event->impulse,
                              .depth = event->depth,
                              .accumulation = event->accumulation};
  unsigned char *record = records_add(&seen->tails[which]);
  if (record)
    row_store(&seen->plan->tails[which].records, record, &found);
  else
    seen->no_memory = 1;
}

/* A jump is an impact; chatter is also listed with the other events, which give the time of its end. */
static int see_event(const ric_event *event, void *user) {
  observation *seen = user;
  if (ric_event_jumps(event))
    add_record(seen, TAIL_IMPACTS, event);
  if (!ric_event_jumps(event) || event->kind == RIC_EVENT_CHATTER)
    add_record(seen, TAIL_EVENTS, event);
  return seen->no_memory;
}

/* Runs the trajectory, with its exponents if the study asks for them. */
static ric_status follow(worker *w, observation *seen, ric_trajectory *trajectory, ric_run *did, ric_error *error) {
  const ric_observer observer = {.segment = see_segment, .event = see_event, .user = seen};
  const double end = w->times[w->samples - 1];
  if (!seen->row.lyapunov)
    return ric_trajectory_run(trajectory, end, &observer, did, error);
  return convergence_run(&seen->converged, trajectory, end, value_number(w->values, KEY_TIME_LYAPUNOV_INTERVAL, 0),
                         &observer, seen->row.lyapunov, did, error);
}

static ric_status run(worker *w, observation *seen, const ric_system *system, ric_run *did, ric_error *error) {
  const ric_trajectory_options options = options_of(w);
  ric_trajectory *trajectory = NULL;
  ric_status status = ric_trajectory_create(system, &options, &trajectory, error);
  if (status == RIC_OK)
    status = ric_trajectory_start(trajectory, 0, w->q, w->v, error);
  if (status == RIC_OK)
    status = follow(w, seen, trajectory, did, error);
  if (status == RIC_OK)
    ric_sampler_finish(&seen->sampler, trajectory);
  ric_trajectory_destroy(&trajectory);
  return status;
}

/* Runs from the initial state to the end. @returns RIC_OK with a verdict, or RIC_ESTOPPED */
static ric_status move(worker *w, observation *seen, ric_run *did, verdict *found) {
  ric_error error = {0};
  ric_system *system = NULL;
  const lattice_model *m = &w->model;
  ric_status status = ric_system_create_lattice(&m->lattice, m->obstacles, m->obstacle_count, &system, &error);
  if (status == RIC_OK)
    status = run(w, seen, system, did, &error);
  ric_system_destroy(&system);
  if (status == RIC_ESTOPPED)
    return status;
  if (status == RIC_OK && (seen->no_memory || seen->converged.no_memory))
    status = ric_fail(&error, RIC_ENOMEM, "no memory for the events");
  if (status != RIC_OK)
    note_outcome(found, TRAJECTORY_REFUSED, error.message);
  else
    note_outcome(found, (int)did->outcome, did->reason);
  return RIC_OK;
}

/* --- its row --- */

static void fill_times(worker *w) {
  const double duration = value_number(w->values, KEY_TIME_DURATION, 0);
  for (size_t i = 0; i + 1 < w->samples; i++)
    w->times[i] = duration * ((double)i / (double)(w->samples - 1));
  w->times[w->samples - 1] = duration;
}

/* The sampler writes states into the row itself. @returns 0, or -1 if stopped */
static int begin_row(worker *w, const kind_plan *plan, unsigned char *row, records *tails, observation *seen) {
  const size_t n = w->model.lattice.particles;
  trajectory_row found = {0};
  if (!fill_zero(row, plan->rows.row_bytes, w->poll))
    return -1;
  row_load(&plan->rows, row, &found);
  fill_times(w);
  if (!fill_nan(found.q, w->samples * n, w->poll) || !fill_nan(found.v, w->samples * n, w->poll) ||
      !fill_nan(found.lyapunov, 2 * n, w->poll))
    return -1;
  found.t = w->times;
  *seen = (observation){
      .worker = w,
      .plan = plan,
      .tails = tails,
      .row = found,
      .converged = {.layout = &plan->tails[TAIL_LYAPUNOV].records, .to = &tails[TAIL_LYAPUNOV]},
      .sampler = {.times = w->times, .count = w->samples, .coordinates = n, .speeds = n, .q = found.q, .u = found.v}};
  return 0;
}

static void finish_row(observation *seen, const verdict *found, const ric_run *did, unsigned char *row) {
  trajectory_row *r = &seen->row;
  r->outcome = found->outcome;
  r->reason = found->reason;
  r->time = did->time;
  r->energy_start = did->energy_start;
  r->energy_end = did->energy_end;
  r->impact_loss = did->impact_loss;
  r->steps = (long long)did->flow.steps;
  r->force_evaluations = (long long)did->flow.force_evaluations;
  row_store(&seen->plan->rows, row, r);
}

static int trajectory_evaluate(worker *w, const kind_plan *plan, task_range tasks, unsigned char *row, records *tails) {
  verdict found = {.outcome = RIC_RUN_COMPLETED};
  ric_run did = {.energy_start = NAN, .energy_end = NAN, .impact_loss = NAN};
  study_values_at(w->values, tasks.first);
  observation seen;
  if (begin_row(w, plan, row, tails, &seen) != 0 || read_start(w, &found) == RIC_ESTOPPED)
    return -1;
  if (found.outcome != TRAJECTORY_NO_ORBIT && move(w, &seen, &did, &found) == RIC_ESTOPPED)
    return -1;
  finish_row(&seen, &found, &did, row);
  return 0;
}

/* --- the study --- */

/* Refuses a study of one task if the library refuses that task. */
static int check_only_task(const study *s, message *why) {
  worker *w = NULL;
  ric_error error = {0};
  verdict found = {0};
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  if (study_tasks(s) != 1)
    return 0;
  int code = trajectory_open(s, (ric_poll){0}, &w, why);
  if (code || w->from_orbit) {
    worker_close(&w);
    return code;
  }
  const ric_trajectory_options options = options_of(w);
  read_start(w, &found);
  ric_status status =
      ric_system_create_lattice(&w->model.lattice, w->model.obstacles, w->model.obstacle_count, &system, &error);
  if (status == RIC_OK)
    status = ric_trajectory_create(system, &options, &trajectory, &error);
  if (status == RIC_OK)
    status = ric_trajectory_start(trajectory, 0, w->q, w->v, &error);
  if (status == RIC_EINVAL)
    code = refuse(why, EXIT_USAGE, "%s: %s", study_name(s), error.message);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  worker_close(&w);
  return code;
}

static int trajectory_plan(const study *s, kind_plan *plan, message *why) {
  study_values *v = study_values_create(s);
  if (!v)
    return refuse(why, EXIT_RUN, "%s: no memory for the values of a task", study_name(s));
  const trajectory_shape shape = trajectory_shape_of(v);
  *plan = (kind_plan){0};
  trajectory_lay_out(&shape, plan);
  int code = plan_memory(s, v, plan, why);
  study_values_destroy(&v);
  return code ? code : check_only_task(s, why);
}

/* --- its keys --- */

/* The period is required for a start on an orbit only. */
static bool trajectory_wants(const study *s, const document *d, study_key key) {
  return key != KEY_ORBIT_PERIOD || check_node_of_section(s, d, "orbit");
}

static int check_start(const study *s, const document *d, message *why) {
  const int start = check_node_of_section(s, d, "start"), orbit = check_node_of_section(s, d, "orbit");
  if (!start != !orbit)
    return 0;
  if (!start)
    return check_refuse(s, why,
                        "kind: trajectory has neither start nor orbit, expected exactly one of the two sections");
  return document_refuse(d, start, why,
                         "kind: trajectory has both start and orbit, expected exactly one of the two sections");
}

static int trajectory_check(const study *s, const document *d, message *why) {
  const int code = check_start(s, d, why);
  if (code || !check_node_of_section(s, d, "orbit"))
    return code;
  if (!model_has(s, MODEL_CHAIN))
    return document_refuse(d, check_node_of_key(s, KEY_MODEL_TYPE), why,
                           "model.type = %s, but a start on an orbit needs model.type = chain",
                           study_model_choice(s)->name);
  const int refused = pattern_check_model(s, d, true, "a start on an orbit", why);
  return refused ? refused : pattern_check(s, d, false, why);
}

const kind kind_trajectory = {.choice = {.name = "trajectory",
                                         .summary = "the motion from a state, or from an orbit, at every grid point",
                                         .groups = "pattern|start|time",
                                         .features = MODEL_SYSTEM,
                                         .wants = trajectory_wants,
                                         .check = trajectory_check},
                              .lists = {trajectory_lists},
                              .plan = trajectory_plan,
                              .open = trajectory_open,
                              .evaluate = trajectory_evaluate,
                              .close = worker_close,
                              .extra = kind_no_extra};
