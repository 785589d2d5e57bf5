/* kind: orbits. The orbit of a pattern at every grid point. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "model/chain.h"
#include "kind/kind.h"
#include "kind/machine.h"
#include "kind/pattern.h"
#include "orbits.h"
#include "stability.h"
#include "kind/trajectory/trajectory.h"

struct worker {
  study_values *values;
  chain_model model;
  ric_pattern *pattern;
  int pattern_varies; /* an element of at_start or at_half is swept */
  ric_orbit_solver *solver;
  ric_orbit orbit;
  int verifies;
  ric_verify_options verify;
  ric_verification verification; /* of the orbit of the current task */
  stability stability;
};

static ric_orbit_method method_of(const study_values *v) {
  return strcmp(value_word(v, KEY_ORBIT_METHOD), "dense") == 0 ? RIC_METHOD_DENSE : RIC_METHOD_IMPULSE;
}

static int plan_memory(const study *s, const study_values *v, kind_plan *plan, message *why) {
  chain_model model = {0};
  ric_pattern *pattern = NULL;
  ric_error error = {0};
  /* Before anything large is allocated: four state arrays alone are 32 bytes per particle. */
  int code = machine_refuse_size(s, "an orbit",
                                 33 * value_number(v, KEY_MODEL_PARTICLES, 0) + (double)plan->rows.row_bytes, why);
  if (code)
    return code;
  if (chain_model_init(&model, v) != 0)
    code = refuse(why, EXIT_RUN, "%s: no memory for the floors", study_name(s));
  else if (pattern_read(v, &pattern, &error) == RIC_OK) {
    plan->memory = ric_orbit_bytes(&model.chain, pattern, method_of(v)) + 2 * (double)plan->rows.row_bytes;
    if (value_flag(v, KEY_ORBIT_VERIFY))
      plan->memory += TRAJECTORY_PARTICLE_BYTES * value_number(v, KEY_MODEL_PARTICLES, 0);
    plan->memory += stability_bytes(v);
    code = machine_refuse_size(s, "an orbit", plan->memory, why);
  } else if (error.status == RIC_ENOMEM)
    code = refuse(why, EXIT_RUN, "%s: %s", study_name(s), error.message);
  ric_pattern_destroy(&pattern);
  chain_model_clear(&model);
  return code;
}

static int refuse_dense(const study *s, const study_values *v, message *why) {
  char place[256];
  double n = value_number(v, KEY_MODEL_PARTICLES, 0);
  if (method_of(v) != RIC_METHOD_DENSE || n <= RIC_DENSE_PARTICLES)
    return 0;
  study_place(s, KEY_ORBIT_METHOD, place, sizeof place);
  return refuse(why, EXIT_USAGE, "%s = dense with %.0f particles, expected at most %d (or method: impulse)", place, n,
                RIC_DENSE_PARTICLES);
}

static int orbits_plan(const study *s, kind_plan *plan, message *why) {
  study_values *v = study_values_create(s);
  if (!v)
    return refuse(why, EXIT_RUN, "%s: no memory for the values of a task", study_name(s));
  *plan = (kind_plan){0};
  orbits_lay_out(v, &plan->rows);
  int code = refuse_dense(s, v, why);
  if (!code)
    code = stability_check(s, v, why);
  if (!code)
    code = plan_memory(s, v, plan, why);
  if (!code)
    code = orbits_special_plan(s, v, why);
  study_values_destroy(&v);
  return code;
}

static void orbits_close(worker **w) {
  if (!w || !*w)
    return;
  stability_clear(&(*w)->stability);
  ric_orbit_clear(&(*w)->orbit);
  ric_orbit_solver_destroy(&(*w)->solver);
  ric_pattern_destroy(&(*w)->pattern);
  chain_model_clear(&(*w)->model);
  study_values_destroy(&(*w)->values);
  free(*w);
  *w = NULL;
}

static int sweeps_pattern(const study *s) {
  for (size_t i = 0; i < study_sweeps(s); i++) {
    study_key key = study_sweep_at(s, i)->key;
    if (key == KEY_ORBIT_AT_START || key == KEY_ORBIT_AT_HALF)
      return 1;
  }
  return 0;
}

static int orbits_open(const study *s, ric_poll poll, worker **out, message *why) {
  worker *w = calloc(1, sizeof *w);
  ric_error error = {0};
  *out = w;
  if (!w || !(w->values = study_values_create(s)) || chain_model_init(&w->model, w->values) != 0) {
    orbits_close(out);
    return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
  }
  size_t m = value_count(w->values, KEY_ORBIT_AT_START) + value_count(w->values, KEY_ORBIT_AT_HALF);
  ric_orbit_options options = ric_orbit_options_default();
  options.method = method_of(w->values);
  options.poll = poll;
  w->pattern_varies = sweeps_pattern(s);
  w->verifies = value_flag(w->values, KEY_ORBIT_VERIFY);
  w->verify = ric_verify_options_default();
  w->verify.motion.poll = poll;
  ric_status status = ric_orbit_solver_create(&options, &w->solver, &error);
  if (status == RIC_OK)
    status = ric_orbit_init(&w->orbit, w->model.chain.particles, m, &error);
  if (status == RIC_OK)
    status = stability_init(&w->stability, w->values, poll, &error);
  if (status == RIC_OK && !w->pattern_varies)
    status = pattern_read(w->values, &w->pattern, &error);
  if (status == RIC_OK)
    return 0;
  orbits_close(out);
  return refuse(why, EXIT_RUN, "%s: %s", study_name(s), error.message);
}

static ric_status solve(worker *w, ric_error *error) {
  if (w->pattern_varies) {
    ric_pattern_destroy(&w->pattern);
    RIC_TRY(pattern_read(w->values, &w->pattern, error));
  }
  return ric_orbit_solve(w->solver, &w->model.chain, w->pattern, value_number(w->values, KEY_ORBIT_PERIOD, 0),
                         &w->orbit, error);
}

/* Verifies an admissible or grazing orbit by an event-driven run. @returns RIC_OK or RIC_ESTOPPED */
static ric_status verify(worker *w) {
  ric_error error = {0};
  w->verification = (ric_verification){.result = RIC_NOT_RUN, .closure_error = NAN};
  if (!w->verifies)
    return RIC_OK;
  return orbits_verified(ric_orbit_verify(w->solver, &w->model.chain, &w->orbit, &w->verify, &w->verification, &error),
                         &error, &w->verification);
}

/* The reason of the verifier is stored if the orbit itself has none. */
static const char *reason_of(const worker *w) {
  return w->orbit.reason[0] ? w->orbit.reason : w->verification.reason;
}

static int orbits_evaluate(worker *w, const kind_plan *plan, task_range tasks, unsigned char *row, records *tails) {
  ric_error error = {0};
  (void)tails;
  study_values_at(w->values, tasks.first);
  chain_model_read(&w->model, w->values);
  ric_status status = solve(w, &error);
  if (status == RIC_ESTOPPED)
    return -1;
  if (status != RIC_OK)
    ric_orbit_fail(&w->orbit, error.message);
  if (verify(w) == RIC_ESTOPPED ||
      stability_find(&w->stability, w->solver, &w->model.chain, w->pattern, &w->orbit) == RIC_ESTOPPED)
    return -1;
  orbits_row found = {.orbit = &w->orbit, .reason = reason_of(w), .verification = &w->verification};
  stability_put(&w->stability, &found);
  row_fill(&plan->rows, row, &found);
  return 0;
}

/* --- its keys --- */

static bool has_closed_form(const study *s) {
  return schema_word_needs(KEY_ORBIT_METHOD, study_word(s, KEY_ORBIT_METHOD)) != 0;
}

static int check_special_points(const study *s, const document *d, message *why) {
  const typed_value *flag = study_value(s, KEY_ORBIT_SPECIAL_POINTS);
  const study_key over = s->sweep_count == 1 ? s->sweeps[0].view.key : NULL;
  if (flag->numbers[0] == 0 || over == KEY_MODEL_GAMMA || over == KEY_ORBIT_PERIOD)
    return 0;
  return document_refuse(d, flag->node, why,
                         "orbit.special_points = true lists resonances and singular points along the swept parameter: "
                         "it requires exactly one sweep entry, over model.gamma or orbit.period");
}

static int orbits_check(const study *s, const document *d, message *why) {
  int code = pattern_check_model(s, d, has_closed_form(s), "kind: orbits", why);
  if (!code)
    code = pattern_check(s, d, false, why);
  return code ? code : check_special_points(s, d, why);
}

static const kind *by_method(const study *s) {
  return has_closed_form(s) ? &kind_orbits : &kind_orbits_shooting;
}

const kind kind_orbits = {.choice = {.name = "orbits",
                                     .summary = "the periodic orbit of one impact pattern at every grid point",
                                     .groups = "pattern|orbits",
                                     .features = MODEL_SYSTEM,
                                     .check = orbits_check},
                          .lists = {orbits_lists, orbits_special_lists},
                          .variant = by_method,
                          .plan = orbits_plan,
                          .open = orbits_open,
                          .evaluate = orbits_evaluate,
                          .close = orbits_close,
                          .extra = orbits_special};
