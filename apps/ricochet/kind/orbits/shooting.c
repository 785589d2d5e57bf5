/* kind: orbits, by shooting: the motion with the given impacts at every grid point, also of nonlinear models, and its
 * approximation by Ritz's method. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kind/kind.h"
#include "kind/machine.h"
#include "model/lattice_model.h"
#include "orbits.h"
#include "stability.h"
#include "kind/trajectory/trajectory.h"

/* Ritz's approximation in the current task. */
typedef struct ritz_found {
  size_t functions; /* 0: none */
  double frequency, error, error_v, defect;
  char reason[RIC_REASON_BYTES];
} ritz_found;

struct worker {
  study_values *values;
  ric_poll poll;
  lattice_model model;
  size_t *hits; /* [impacts] obstacles of orbit.at_start, then those of at_half */
  size_t starts, halves;
  ric_guess guess;
  ric_system *system; /* of the current task, as the members below */
  ric_shooting *shooting;
  double *z; /* [particles] its unknowns */
  ric_orbit orbit;
  ric_verification verification;
  stability stability;
  ritz_found ritz;
};

static bool is_ritz(const study_values *v) {
  return strcmp(value_word(v, KEY_ORBIT_METHOD), "ritz") == 0;
}

/* --- before the tasks --- */

static int refuse_impacts(const study *s, const study_values *v, message *why) {
  char place[256];
  if (!is_ritz(v) || (value_count(v, KEY_ORBIT_AT_START) == 1 && value_count(v, KEY_ORBIT_AT_HALF) == 0))
    return 0;
  study_place(s, KEY_ORBIT_METHOD, place, sizeof place);
  return refuse(why, EXIT_USAGE,
                "%s = ritz is for one impact per period, expected one particle in orbit.at_start and "
                "none in orbit.at_half",
                place);
}

static int refuse_special(const study *s, const study_values *v, message *why) {
  char place[256];
  if (!value_flag(v, KEY_ORBIT_SPECIAL_POINTS))
    return 0;
  study_place(s, KEY_ORBIT_SPECIAL_POINTS, place, sizeof place);
  return refuse(why, EXIT_USAGE,
                "%s = true with orbit.method = %s, expected method: impulse or dense (or kind: branch)", place,
                value_word(v, KEY_ORBIT_METHOD));
}

static double bytes(const study_values *v) {
  const double n = value_number(v, KEY_MODEL_PARTICLES, 0), all = n * value_number(v, KEY_ORBIT_FUNCTIONS, 0);
  return 8 * (16 * n * n + (is_ritz(v) ? 3 * all * all : 0)) + TRAJECTORY_PARTICLE_BYTES * n;
}

static int shooting_plan(const study *s, kind_plan *plan, message *why) {
  study_values *v = study_values_create(s);
  if (!v)
    return refuse(why, EXIT_RUN, "%s: no memory for the values of a task", study_name(s));
  *plan = (kind_plan){.memory = bytes(v)};
  orbits_lay_out(v, &plan->rows);
  int code = refuse_impacts(s, v, why);
  if (!code)
    code = refuse_special(s, v, why);
  if (!code)
    code = stability_check(s, v, why);
  if (!code)
    code = machine_refuse_size(s, "an orbit", plan->memory, why);
  study_values_destroy(&v);
  return code;
}

static void close_motion(worker *w) {
  ric_shooting_destroy(&w->shooting);
  ric_system_destroy(&w->system);
}

static void shooting_close(worker **out) {
  worker *w = *out;
  if (!w)
    return;
  close_motion(w);
  ric_guess_clear(&w->guess);
  stability_clear(&w->stability);
  ric_orbit_clear(&w->orbit);
  lattice_model_clear(&w->model);
  study_values_destroy(&w->values);
  free(w->hits);
  free(w->z);
  free(w);
  *out = NULL;
}

static int shooting_open(const study *s, ric_poll poll, worker **out, message *why) {
  ric_error error = {0};
  worker *w = *out = calloc(1, sizeof *w);
  if (!w || !(w->values = study_values_create(s)) || lattice_model_init(&w->model, w->values) != 0) {
    shooting_close(out);
    return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
  }
  const size_t n = w->model.lattice.particles;
  w->poll = poll;
  w->starts = value_count(w->values, KEY_ORBIT_AT_START);
  w->halves = value_count(w->values, KEY_ORBIT_AT_HALF);
  w->hits = calloc(w->starts + w->halves + 1, sizeof *w->hits);
  w->z = calloc(n, sizeof *w->z);
  ric_status status = w->hits && w->z ? ric_guess_init(&w->guess, n, &error)
                                      : ric_fail(&error, RIC_ENOMEM, "no memory for %zu particles", n);
  if (status == RIC_OK)
    status = ric_orbit_init(&w->orbit, n, w->starts + w->halves, &error);
  if (status == RIC_OK)
    status = stability_init(&w->stability, w->values, poll, &error);
  if (status == RIC_OK)
    return 0;
  shooting_close(out);
  return refuse(why, EXIT_RUN, "%s: %s", study_name(s), error.message);
}

/* --- the motion --- */

static ric_status solve(worker *w, double period, ric_error *error) {
  lattice_model_read(&w->model, w->values);
  RIC_TRY(lattice_model_hits(&w->model, w->values, KEY_ORBIT_AT_START, w->hits, error));
  RIC_TRY(lattice_model_hits(&w->model, w->values, KEY_ORBIT_AT_HALF, w->hits + w->starts, error));
  const ric_shooting_problem motion = {.kind = RIC_MOTION_EVEN,
                                       .at_start = w->hits,
                                       .start_count = w->starts,
                                       .at_half = w->hits + w->starts,
                                       .half_count = w->halves,
                                       .flow = ric_flow_options_default(),
                                       .poll = w->poll};
  const ric_guess_problem problem = {&w->model.lattice, w->model.obstacles, w->model.obstacle_count, &motion};
  RIC_TRY(ric_guess_even(&problem, period, &w->guess, error));
  RIC_TRY(ric_system_create_lattice(problem.lattice, problem.obstacles, problem.obstacle_count, &w->system, error));
  RIC_TRY(ric_shooting_create(w->system, &motion, &w->shooting, error));
  RIC_TRY(ric_shooting_guess(w->shooting, w->guess.q, w->guess.v, NULL, period, w->z, error));
  return ric_shooting_orbit(w->shooting, w->z, period, &w->orbit, error);
}

/* --- verification and approximation --- */

/* @returns RIC_OK or RIC_ESTOPPED */
static ric_status verify(worker *w) {
  ric_error error = {0};
  ric_verify_options options = ric_verify_options_default();
  options.motion.poll = w->poll;
  w->verification = (ric_verification){.result = RIC_NOT_RUN, .closure_error = NAN};
  if (!value_flag(w->values, KEY_ORBIT_VERIFY) || !w->shooting)
    return RIC_OK;
  const ric_status status =
      ric_shooting_verify(w->shooting, w->z, w->orbit.period, &w->orbit, &options, &w->verification, &error);
  return orbits_verified(status, &error, &w->verification);
}

/* The orbit's state and energy become those of the approximation. */
static ric_status take_ritz(worker *w, ric_ritz *ritz, double *c, ric_error *error) {
  const double period = w->orbit.period, tolerance = value_number(w->values, KEY_ORBIT_TOLERANCE, 0);
  ric_shooting *shooting = w->shooting;
  const ric_status status =
      ric_ritz_refine(ritz, shooting, w->z, period, tolerance > 0 ? tolerance : 0, c, &w->ritz.error, error);
  if (status != RIC_OK && !(status == RIC_ENUMERIC && w->ritz.error < INFINITY))
    return status;
  RIC_TRY(ric_ritz_error(ritz, c, period, shooting, w->z, NULL, &w->ritz.error_v, error));
  w->ritz.functions = ric_ritz_functions(ritz);
  w->ritz.frequency = c[ric_ritz_unknowns(ritz) - 1];
  w->ritz.defect = ric_ritz_defect(ritz, c, period);
  ric_ritz_state(ritz, c, period, 0, w->orbit.q, w->orbit.v);
  w->orbit.energy = ric_system_energy(w->system, 0, w->orbit.q, w->orbit.v);
  return status;
}

/* @returns RIC_OK or RIC_ESTOPPED */
static ric_status approximate(worker *w) {
  ric_error error = {0};
  ric_ritz *ritz = NULL;
  double *c = NULL;
  ric_ritz_options options = ric_ritz_options_default();
  w->ritz = (ritz_found){.frequency = NAN, .error = NAN, .error_v = NAN, .defect = NAN};
  if (!is_ritz(w->values) || !isfinite(w->orbit.energy))
    return RIC_OK;
  options.functions = (size_t)value_number(w->values, KEY_ORBIT_FUNCTIONS, 0);
  options.constants = value_flag(w->values, KEY_ORBIT_CONSTANTS);
  ric_status status = ric_ritz_create(w->system, w->hits[0], &options, &ritz, &error);
  if (status == RIC_OK && !(c = calloc(ric_ritz_unknowns(ritz), sizeof *c)))
    status = ric_fail(&error, RIC_ENOMEM, "no memory for the coefficients");
  if (status == RIC_OK)
    status = take_ritz(w, ritz, c, &error);
  free(c);
  ric_ritz_destroy(&ritz);
  if (status != RIC_OK)
    snprintf(w->ritz.reason, sizeof w->ritz.reason, "%.*s", RIC_REASON_BYTES - 1, error.message);
  return status == RIC_ESTOPPED ? status : RIC_OK;
}

/* --- a task --- */

/* The reason: of the orbit, else of the verifier, else of Ritz's method. */
static const char *reason_of(const worker *w) {
  if (w->orbit.reason[0])
    return w->orbit.reason;
  return w->verification.reason[0] ? w->verification.reason : w->ritz.reason;
}

static void fill_row(worker *w, const table *t, unsigned char *row) {
  orbits_row found = {.orbit = &w->orbit, .reason = reason_of(w), .verification = &w->verification};
  stability_put(&w->stability, &found);
  found.ritz_functions = (long long)w->ritz.functions;
  found.ritz_frequency = w->ritz.frequency;
  found.ritz_error = w->ritz.error;
  found.ritz_error_v = w->ritz.error_v;
  found.ritz_defect = w->ritz.defect;
  row_fill(t, row, &found);
}

static int shooting_evaluate(worker *w, const kind_plan *plan, task_range tasks, unsigned char *row, records *tails) {
  ric_error error = {0};
  (void)tails;
  study_values_at(w->values, tasks.first);
  ric_status status = solve(w, value_number(w->values, KEY_ORBIT_PERIOD, 0), &error);
  if (status != RIC_OK && status != RIC_ESTOPPED)
    ric_orbit_fail(&w->orbit, error.message);
  if (status != RIC_ESTOPPED)
    status = verify(w);
  if (status != RIC_ESTOPPED)
    status = stability_find_motion(&w->stability, w->shooting, w->z, &w->orbit);
  if (status != RIC_ESTOPPED)
    status = approximate(w);
  close_motion(w);
  if (status == RIC_ESTOPPED)
    return -1;
  fill_row(w, &plan->rows, row);
  return 0;
}

const kind kind_orbits_shooting = {.plan = shooting_plan,
                                   .open = shooting_open,
                                   .evaluate = shooting_evaluate,
                                   .close = shooting_close,
                                   .extra = kind_no_extra};
