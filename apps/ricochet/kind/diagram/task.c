/* kinds: diagram, basin. The attractor of a map, or of a motion on a section, at every grid point. */
#include "diagram.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kind/fill.h"
#include "kind/machine.h"

struct worker {
  iterated it;
  bool follows;              /* iterate.follow: every task starts at the final state of the one before */
  size_t exponents;          /* numbers of them in a task */
  ric_attractor *attractors; /* [slots] */
  diagram_row *rows;         /* [slots] of them */
  double *starts;            /* [slots][size] */
  double *before;            /* [size] final state of the last task */
  double *found;             /* [slots][exponents] */
};

/* --- before the tasks --------------------------------------------------------------------------------------------- */

enum { BATCH_BYTES = 64 << 20 /* of rows of a batch, unless one row has more */ };

static size_t line_of(const study *s) {
  return study_sweeps(s) > 0 ? study_sweep_at(s, study_sweeps(s) - 1)->points : 1;
}

/* Tasks that run side by side. */
static size_t slots_of(const study *s, double row_bytes) {
  return (size_t)fmax(1, fmin((double)iterated_slots(s), BATCH_BYTES / row_bytes));
}

static int diagram_plan(const study *s, kind_plan *plan, message *why) {
  study_values *v = study_values_create(s);
  if (!v)
    return refuse(why, EXIT_RUN, "%s: no memory for the values of a task", study_name(s));
  *plan = (kind_plan){0};
  plan->whole = value_flag(v, KEY_ITERATE_FOLLOW);
  diagram_lay_out(s, v, &plan->rows);
  const double row_bytes = table_row_bytes(&plan->rows);
  plan->batch = plan->whole ? line_of(s) : slots_of(s, row_bytes);
  plan->memory = iterated_bytes(s, v) + (double)plan->batch * row_bytes;
  const int code = machine_refuse_size(s, "a task", plan->memory, why);
  study_values_destroy(&v);
  return code;
}

static void diagram_close(worker **w) {
  if (!w || !*w)
    return;
  iterated_clear(&(*w)->it);
  free((*w)->attractors);
  free((*w)->rows);
  free((*w)->starts);
  free((*w)->before);
  free((*w)->found);
  free(*w);
  *w = NULL;
}

static int allocate(worker *w, const study *s, message *why) {
  const size_t slots = w->it.slots;
  w->follows = value_flag(w->it.values, KEY_ITERATE_FOLLOW);
  w->exponents = (size_t)value_number(w->it.values, KEY_ITERATE_EXPONENTS, 0);
  w->attractors = calloc(slots, sizeof *w->attractors);
  w->rows = calloc(slots, sizeof *w->rows);
  w->starts = calloc(slots * w->it.size, sizeof *w->starts);
  w->before = calloc(w->it.size, sizeof *w->before);
  w->found = calloc(slots * w->exponents, sizeof *w->found);
  if (w->attractors && w->rows && w->starts && w->before && w->found)
    return 0;
  return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
}

static int diagram_open(const study *s, ric_poll poll, worker **out, message *why) {
  worker *w = *out = calloc(1, sizeof *w);
  if (!w)
    return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
  int code = iterated_init(&w->it, s, poll, why);
  if (!code)
    code = allocate(w, s, why);
  if (code)
    diagram_close(out);
  return code;
}

/* --- a motion beyond grazing compared with the return map -------------------------------------------------------- */

/* No comparison: all its numbers are NaN. @returns RIC_OK or RIC_ESTOPPED */
static ric_status put_nothing(const iterated *it, diagram_row *row) {
  row->parameter = row->d = row->map_impacts = row->map_lyapunov = row->distance = NAN;
  return fill_nan(row->map_values, it->options.keep, it->poll) ? RIC_OK : RIC_ESTOPPED;
}

/* Both sets are copied, because ric_attractor_distance sorts them. */
static ric_status put_distance(diagram_row *row, size_t keep, ric_error *error) {
  double *both = calloc(2 * keep + 1, sizeof *both);
  if (!both)
    return ric_fail(error, RIC_ENOMEM, "no memory for a comparison");
  memcpy(both, row->values, keep * sizeof *both);
  memcpy(both + keep, row->map_values, keep * sizeof *both);
  row->distance = ric_attractor_distance(both, both + keep, keep);
  free(both);
  return RIC_OK;
}

static void put_map(const iterated *it, diagram_row *row, const ric_attractor *a, double origin) {
  row->parameter = beyond_parameter(it->beyond, it->values);
  row->d = beyond_d(it->beyond, it->values);
  row->map_period = (long long)a->period;
  row->map_impacts = a->impacts;
  row->map_lyapunov = a->exponents[0];
  for (size_t i = 0; a->values && i < it->options.keep; i++)
    a->values[i] += origin;
}

static ric_status run_map(iterated *it, diagram_row *row, double *z, double *x, double *exponents, ric_error *error) {
  ric_attractor a = {.z = z, .exponents = exponents, .values = row->map_values};
  RIC_TRY(beyond_find(it->beyond, it->values, error));
  RIC_TRY(beyond_motion(it->beyond, it->values, beyond_parameter(it->beyond, it->values), x, error));
  RIC_TRY(beyond_run(it->beyond, it->values, &it->options, &a, error));
  put_map(it, row, &a, x[it->options.observe]);
  return it->options.keep > 0 ? put_distance(row, it->options.keep, error) : RIC_OK;
}

/* Runs the map for the current task and stores its attractor in the row beside that of the motion.
 * @param error  why there is no map, which the row may borrow as its reason
 * @returns RIC_OK, also where there is no map; RIC_ESTOPPED */
static ric_status put_comparison(iterated *it, diagram_row *row, ric_error *error) {
  double *z = calloc(2 * it->size + it->options.exponents + 1, sizeof *z);
  ric_status status = z ? run_map(it, row, z, z + it->size, z + 2 * it->size, error)
                        : ric_fail(error, RIC_ENOMEM, "no memory for a comparison");
  free(z);
  if (status == RIC_ESTOPPED)
    return status;
  if (status != RIC_OK) {
    RIC_TRY(put_nothing(it, row));
    if (!row->reason[0]) /* a reason of the motion takes precedence */
      row->reason = error->message;
  }
  return RIC_OK;
}

/* --- tasks -------------------------------------------------------------------------------------------------------- */

/* Reads a task into a slot, with its own start. @returns RIC_OK or RIC_ESTOPPED */
static ric_status read_task(worker *w, const table *layout, uint64_t task, size_t slot, unsigned char *row) {
  double *start = w->starts + slot * w->it.size;
  study_values_at(w->it.values, task);
  iterated_take(&w->it, slot, start);
  w->attractors[slot] = (ric_attractor){.z = start, .exponents = w->found + slot * w->exponents};
  return diagram_begin_row(layout, w->it.poll, row, &w->rows[slot], &w->attractors[slot]);
}

/* Stores a finished task in its row. */
static ric_status put(worker *w, const table *rows, size_t slot, unsigned char *row) {
  diagram_row *found = &w->rows[slot];
  diagram_put_row(found, &w->attractors[slot]);
  ric_error error = {0};
  const ric_status status = w->it.beyond ? put_comparison(&w->it, found, &error) : RIC_OK;
  row_store(rows, row, found);
  return status;
}

/* Independent tasks. */
static ric_status run_side_by_side(worker *w, const table *rows, task_range tasks, unsigned char *bytes) {
  for (uint64_t i = 0; i < tasks.count; i++)
    RIC_TRY(read_task(w, rows, tasks.first + i, i, bytes + i * rows->row_bytes));
  RIC_TRY(iterated_run(&w->it, tasks.count, w->attractors));
  for (uint64_t i = 0; i < tasks.count; i++)
    RIC_TRY(put(w, rows, i, bytes + i * rows->row_bytes));
  return RIC_OK;
}

/* A line of tasks, each of which starts at the final state of the one before, unless that one has no attractor. */
static ric_status run_in_turn(worker *w, const table *rows, task_range tasks, unsigned char *bytes) {
  const size_t start_bytes = w->it.size * sizeof *w->starts;
  bool goes_on = false;
  for (uint64_t i = 0; i < tasks.count; i++) {
    unsigned char *row = bytes + i * rows->row_bytes;
    RIC_TRY(read_task(w, rows, tasks.first + i, 0, row));
    if (goes_on)
      memcpy(w->starts, w->before, start_bytes);
    RIC_TRY(iterated_run(&w->it, 1, w->attractors));
    RIC_TRY(put(w, rows, 0, row));
    memcpy(w->before, w->starts, start_bytes);
    goes_on = w->attractors->kind == RIC_ATTRACTOR_PERIODIC || w->attractors->kind == RIC_ATTRACTOR_APERIODIC;
  }
  return RIC_OK;
}

static int diagram_evaluate(worker *w, const kind_plan *plan, task_range tasks, unsigned char *rows, records *tails) {
  (void)tails;
  const ric_status status =
      w->follows ? run_in_turn(w, &plan->rows, tasks, rows) : run_side_by_side(w, &plan->rows, tasks, rows);
  return status == RIC_OK ? 0 : -1;
}

const kind kind_diagram = {
    .choice = {.name = "diagram",
               .summary = "the attractor of a map, or of a motion on a section, at every grid point",
               .groups = "iterate|start|diagram|pattern|family",
               .complete = diagram_complete,
               .wants = diagram_wants,
               .check = diagram_check},
    .lists = {diagram_lists, diagram_window_lists},
    .show = diagram_show,
    .plan = diagram_plan,
    .open = diagram_open,
    .evaluate = diagram_evaluate,
    .close = diagram_close,
    .extra = diagram_windows};

const kind kind_basin = {.choice = {.name = "basin",
                                    .summary = "to which of the attractors every start of a grid comes",
                                    .groups = "iterate|start",
                                    .complete = diagram_complete,
                                    .check = basin_check},
                         .lists = {basin_lists, basin_attractor_lists},
                         .show = basin_show,
                         .plan = diagram_plan,
                         .open = diagram_open,
                         .evaluate = diagram_evaluate,
                         .close = diagram_close,
                         .extra = basin_attractors};
