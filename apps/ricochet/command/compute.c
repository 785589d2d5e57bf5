#include "run.h"

#include <stdlib.h>

#include "../run/ranks.h"
#include "../run/scheduler.h"

enum { MOST_BYTES = 16 << 20 /* of rows, and of ragged tables, that a rank holds, unless one task has more */ };

/* The state of one rank. */
typedef struct rank {
  const char *name; /* of the study */
  const kind_plan *plan;
  const kind *kind;
  worker *worker;
  checkpoint *checkpoint;
  scheduler *scheduler;
  unsigned char *rows;            /* [capacity] of the current run of tasks */
  uint64_t *counts;               /* [capacity][tails] */
  records tails[KIND_MOST_TAILS]; /* of the tasks not yet appended */
  uint64_t capacity, done;
  uint64_t batch, unit; /* most tasks evaluated at once; chunks are multiples of `unit`, one task or a batch */
  progress *progress;
  double sync_interval, synced;
} rank;

/* The library's poll: signals and time limits, messages of other ranks, progress. */
static int poll_all(void *user) {
  rank *r = user;
  if (stop_asked() != STOP_NONE)
    return 1;
  progress_show(r->progress, r->progress->resumed + scheduler_taken(r->scheduler) * r->unit);
  return scheduler_poll(r->scheduler);
}

static int grow(rank *r, uint64_t tasks, message *why) {
  if (tasks <= r->capacity)
    return 0;
  unsigned char *more = realloc(r->rows, tasks * r->plan->rows.row_bytes);
  if (more)
    r->rows = more;
  uint64_t *counts = realloc(r->counts, (tasks * r->plan->tail_count + 1) * sizeof *counts);
  if (counts)
    r->counts = counts;
  if (!more || !counts)
    return refuse(why, EXIT_RUN, "no memory for a chunk of %llu tasks", (unsigned long long)tasks);
  r->capacity = tasks;
  return 0;
}

/* A row must not depend on the memory of the moment. */
static int refuse_memory(const rank *r, task_range tasks, message *why) {
  return refuse(why, EXIT_RUN, "%s: no memory for task %llu; finished tasks are kept, --resume goes on", r->name,
                (unsigned long long)tasks.first);
}

/* Evaluates tasks into the rows from the `at`-th on. @param stopped  set if the run was stopped */
static int evaluate_batch(rank *r, task_range tasks, uint64_t at, int *stopped, message *why) {
  uint64_t before[KIND_MOST_TAILS], *counts = r->counts + at * r->plan->tail_count;
  const unsigned long refusals = ric_memory_refusals();
  for (size_t k = 0; k < r->plan->tail_count; k++)
    before[k] = r->tails[k].count;
  *stopped = poll_all(r) ||
             r->kind->evaluate(r->worker, r->plan, tasks, r->rows + at * r->plan->rows.row_bytes, r->tails) != 0;
  const int code = ric_memory_refusals() != refusals ? refuse_memory(r, tasks, why) : 0;
  for (size_t k = 0; k < r->plan->tail_count; k++) { /* of the one task */
    if (*stopped || code)
      records_cut(&r->tails[k], before[k]);
    counts[k] = r->tails[k].count - before[k];
  }
  return code;
}

static double tail_bytes(const rank *r) {
  double bytes = 0;
  for (size_t k = 0; k < r->plan->tail_count; k++)
    bytes += (double)r->tails[k].count * (double)r->tails[k].record_bytes;
  return bytes;
}

static int append(rank *r, uint64_t first, uint64_t count, message *why) {
  checkpoint_tails tails = {.counts = r->counts};
  for (size_t k = 0; k < r->plan->tail_count; k++)
    tails.entries[k] = r->tails[k].bytes;
  int code = checkpoint_append(r->checkpoint, first, count, r->rows, r->plan->tail_count ? &tails : NULL, why);
  for (size_t k = 0; k < r->plan->tail_count; k++)
    records_cut(&r->tails[k], 0);
  return code;
}

/* Evaluates consecutive tasks, whole units of them, and appends them as one record: as several if their ragged tables
 * are large, and fewer tasks if the run is stopped in between. */
static int evaluate_run(rank *r, uint64_t first, uint64_t count, int *stopped, message *why) {
  int code = grow(r, count, why);
  uint64_t finished = 0;
  for (uint64_t i = 0; !code && !*stopped && i < count;) {
    const uint64_t batch = count - i < r->batch ? count - i : r->batch;
    code = evaluate_batch(r, (task_range){first + finished, batch}, finished, stopped, why);
    if (!code && !*stopped)
      finished += batch;
    i += batch;
    if (code || finished == 0 || tail_bytes(r) < MOST_BYTES)
      continue;
    code = append(r, first, finished, why);
    r->done += finished;
    first += finished;
    finished = 0;
  }
  message later;
  const int kept = finished > 0 ? append(r, first, finished, code ? &later : why) : 0;
  r->done += finished;
  return code ? code : kept;
}

/* A chunk of missing tasks: one or more runs of consecutive ones. */
static int evaluate_chunk(rank *r, uint64_t first, uint64_t count, int *stopped, message *why) {
  for (uint64_t n = 0; n < count && !*stopped;) {
    uint64_t task, run = checkpoint_missing(r->checkpoint, first + n, &task);
    run = run < count - n ? run : count - n;
    int code = evaluate_run(r, task, run, stopped, why);
    if (code)
      return code;
    n += run;
  }
  if (clock_seconds() - r->synced < r->sync_interval)
    return 0;
  r->synced = clock_seconds();
  return checkpoint_sync(r->checkpoint, why);
}

/* Largest chunk whose rows stay below the limit, in units. */
static uint64_t largest_chunk(const rank *r) {
  uint64_t most = MOST_BYTES / r->plan->rows.row_bytes / r->unit;
  return most > 0 ? most : 1;
}

static int take_chunks(rank *r, message *why) {
  uint64_t first, size = 0, most = largest_chunk(r);
  double seconds = 0;
  int code = 0, stopped = 0;
  while (!code && !stopped) {
    uint64_t want = scheduler_next_size(r->scheduler, size, seconds);
    size = scheduler_take(r->scheduler, want < most ? want : most, &first);
    if (size == 0)
      break;
    double began = clock_seconds();
    code = evaluate_chunk(r, first * r->unit, size * r->unit, &stopped, why);
    seconds = clock_seconds() - began;
  }
  if (code || stopped)
    scheduler_stop(r->scheduler); /* the others finish their chunk */
  if (!code)
    code = scheduler_failure(r->scheduler, why);
  return code;
}

/* A signal that ends the process waits until the tasks that are finished have been appended. */
static int work(rank *r, message *why) {
  stop_hold_signals();
  const int code = take_chunks(r, why);
  stop_release_signals();
  return code;
}

static int start(rank *r, const study *s, message *why) {
  uint64_t missing = study_tasks(s) - checkpoint_done(r->checkpoint);
  int code = r->kind->open(s, (ric_poll){.call = poll_all, .user = r}, &r->worker, why);
  if (!code)
    code = checkpoint_begin(r->checkpoint, ranks_rank(), why);
  code = ranks_agree(code, why);
  if (!code)
    code = ranks_agree(scheduler_create(missing / r->unit, &r->scheduler, why), why);
  return code;
}

int compute(const study *s, const kind *k, const kind_plan *plan, checkpoint *c, const run_options *o,
            compute_result *result, message *why) {
  progress p;
  rank r = {.name = study_name(s),
            .plan = plan,
            .kind = k,
            .checkpoint = c,
            .progress = &p,
            .sync_interval = o->checkpoint_seconds};
  *result = (compute_result){0};
  r.batch = plan->batch > 0 ? plan->batch : 1;
  r.unit = plan->whole ? r.batch : 1;
  for (size_t i = 0; i < plan->tail_count; i++)
    r.tails[i].record_bytes = plan->tails[i].records.row_bytes;
  progress_begin(&p, ranks_rank() == 0 ? o->progress : PROGRESS_NEVER, study_tasks(s), checkpoint_done(c));
  int code = start(&r, s, why);
  if (!code) {
    ranks_barrier();
    double began = r.synced = clock_seconds();
    code = work(&r, why);
    double ended = clock_seconds();
    if (!code)
      code = checkpoint_sync(c, why);
    result->seconds = ranks_max(ended - began);
    result->computed = r.done;
    ranks_sum(&result->computed, 1);
    code = ranks_agree(code, why);
    progress_end(&p, p.resumed + result->computed);
  }
  scheduler_destroy(&r.scheduler);
  k->close(&r.worker);
  free(r.rows);
  free(r.counts);
  for (size_t i = 0; i < KIND_MOST_TAILS; i++)
    records_clear(&r.tails[i]);
  return code;
}
