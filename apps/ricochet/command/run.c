/* ricochet run: a study from its file to its result. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../result/result.h"
#include "../run/launcher.h"
#include "../run/ranks.h"
#include "../run/scheduler.h"
#include "arithmetic.h"
#include "command.h"
#include "run.h"

static const char help[] =
    "usage: ricochet run STUDY.yaml [options]\n"
    "       mpirun -n RANKS ricochet run STUDY.yaml [options]\n"
    "\n"
    "Computes every task of a study and writes one HDF5 file.\n"
    "\n"
    "  -o, --output FILE.h5     result; default: the study's name with .h5 in the current folder\n"
    "  --set KEY=VALUE          replaces a value of the study, for example model.gamma=0.1; may be repeated\n"
    "  --resume                 goes on from the checkpoint of a run that was stopped or killed\n"
    "  --force                  replaces an existing result and drops an existing checkpoint\n"
    "  --checkpoint INTERVAL    how often finished tasks are synced to disk; default 30s\n"
    "  --max-time TIME          stops with a checkpoint after this time, for example 55m; exit code 75\n"
    "  --progress WHEN          auto (default), always or never\n"
    "  --mpi WHEN               auto (default): on if mpirun or srun --mpi=pmix started this; on; off\n"
    "  -h, --help               this text\n"
    "\n"
    "Exit codes: 0 done (the last line counts the outcomes of the tasks), 1 the run cannot go on, 2 bad usage or\n"
    "study, 3 cannot read or write, 75 stopped by SIGUSR1 or --max-time: --resume goes on.\n";

enum { MOST_TABLES = 2 + KIND_MOST_TAILS + KIND_MOST_EXTRAS };

/* The state of a run on one rank. */
typedef struct run {
  run_options options;
  study *study;
  const kind *kind;
  kind_plan plan;
  output output;
  checkpoint *checkpoint;
  compute_result computed;
  scheduler *stops; /* while there is a result to be made: a stop of one rank stops all */
  extra_rows extras[KIND_MOST_EXTRAS];
  table offsets; /* of the ragged tables; no columns without any */
  char *command;
  double began;
  uint64_t resumed;
  bool speaks;           /* whether this process prints */
  bool finished;         /* --resume found the result there */
  uint64_t arithmetic;   /* digest of what processor and libraries compute */
  bool mixed;            /* some rows were computed with another */
  uint64_t outcomes[64]; /* tasks by word of the outcome column */
} run;

/* Rank 0 reads the file and broadcasts the resulting text, which the other ranks parse. */
static int load(run *r, message *why) {
  const run_options *o = &r->options;
  const bool first = ranks_rank() == 0;
  const ric_poll stop = {.call = stop_poll};
  int code = first ? kind_read_study(o->study_path, o->sets, o->set_count, stop, &r->study, why) : 0;
  code = ranks_agree(code, why);
  if (code)
    return code;
  char *text = first ? (char *)(uintptr_t)study_text(r->study) : NULL; /* not written: rank 0 broadcasts it */
  size_t length = first ? strlen(text) : 0;
  code = ranks_share_text(&text, &length, why);
  const study_source shared = {.schema = &studies, .name = o->study_path, .text = text, .length = length};
  if (!code)
    code = ranks_agree(first ? 0 : study_parse(&shared, &r->study, why), why);
  if (!first)
    free(text);
  if (code)
    return code;
  r->kind = kind_of(r->study);
  return ranks_agree(r->kind->plan(r->study, &r->plan, why), why);
}

static int claim(run *r, message *why) {
  int code = output_name(&r->output, &r->options, why);
  if (!code && ranks_rank() == 0)
    code = output_claim(&r->output, &r->options, why);
  code = ranks_agree(code, why);
  return code ? code : output_join(&r->output, why);
}

/* Rank 0 checks an existing result and the free space: the new result holds every row once, the checkpoint grows by the
 * missing rows. */
static int check_before_computing(run *r, message *why) {
  uint64_t tasks = study_tasks(r->study);
  double row = (double)r->plan.rows.row_bytes;
  int code = r->options.resume
                 ? output_check_result(&r->output, study_digest(r->study), tasks, r->resumed, &r->finished, why)
                 : 0;
  if (!code && !r->finished)
    code = output_check_room(&r->output, row * (double)tasks + row * (double)(tasks - r->resumed), why);
  return code;
}

static int open_checkpoint(run *r, message *why) {
  checkpoint_identity identity = {
      .digest = study_digest(r->study), .tasks = study_tasks(r->study), .row_bytes = r->plan.rows.row_bytes};
  for (size_t k = 0; k < r->plan.tail_count; k++)
    identity.entry_bytes[k] = r->plan.tails[k].records.row_bytes;
  identity.arithmetic = r->arithmetic = arithmetic_digest();
  snprintf(identity.version, sizeof identity.version, "%s %s", build_version(), build_git_sha());
  int code = ranks_agree(checkpoint_open(r->output.folder, &identity, &r->checkpoint, why), why);
  if (code)
    return code;
  r->resumed = checkpoint_done(r->checkpoint);
  code = ranks_agree(ranks_rank() == 0 ? check_before_computing(r, why) : 0, why);
  ranks_share(&r->finished, sizeof r->finished);
  return code;
}

/* Says once that rows of different arithmetic stand side by side: rows of a run that is resumed, or of other ranks. */
static void note_mixed(run *r) {
  if (r->mixed || !checkpoint_mixed(r->checkpoint))
    return;
  r->mixed = true;
  if (r->speaks)
    fprintf(stderr,
            "%s: some rows were computed where the processor or the libraries round otherwise; last bits may differ\n",
            r->output.path);
}

/* The poll of what follows the tasks. The ranks work by themselves then: the shared counter of a scheduler without
 * items tells all of them that one was asked to stop. */
static int poll_ranks(void *user) {
  const run *r = user;
  if (stop_asked() != STOP_NONE)
    scheduler_stop(r->stops);
  return scheduler_poll(r->stops);
}

/* Rows from the checkpoint. */
static int read_done(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  run *r = user;
  if (poll_ranks(r))
    return refuse(why, EXIT_STOPPED, "%s: stopped while its tasks were read", r->output.path);
  return checkpoint_read(r->checkpoint, first, count, rows, why);
}

/* The same for the writer; also counts the outcomes. */
static int read_rows(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  run *r = user;
  const column *outcome = table_column(&r->plan.rows, "outcome");
  int code = read_done(r, first, count, rows, why);
  for (uint64_t i = 0; !code && i < count; i++)
    r->outcomes[rows[i * r->plan.rows.row_bytes + outcome->offset] % 64]++;
  return code;
}

/* A ragged table for the writer. */
typedef struct tail_source {
  run *run;
  size_t tail;
} tail_source;

static int read_tail(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  const tail_source *from = user;
  return checkpoint_read_entries(from->run->checkpoint, from->tail, first, count, rows, why);
}

/* Rows of one offset per ragged table. */
static int read_offsets(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  run *r = user;
  const size_t tails = r->plan.tail_count;
  uint64_t *offsets = (uint64_t *)(void *)rows;
  int code = 0;
  for (size_t k = 0; !code && k < tails; k++)
    code = checkpoint_read_offsets(r->checkpoint, k, first, count, offsets + k, tails, why);
  return code;
}

static void lay_out_offsets(run *r) {
  table *t = &r->offsets;
  *t = (table){.group = r->plan.rows.group, .row_axis = "task_edge"};
  for (size_t k = 0; k < r->plan.tail_count; k++)
    t->columns[t->column_count++] = (column){.name = r->plan.tails[k].offset,
                                             .type = COLUMN_I64,
                                             .units = "1",
                                             .long_name = r->plan.tails[k].meaning,
                                             .source = "counts of all tasks before"};
  table_lay_out(t);
}

static int read_extra(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  const extra_rows *extra = user;
  if (extra->read)
    return extra->read(extra->from, first, count, rows, why);
  memcpy(rows, extra->rows + first * extra->layout.row_bytes, count * extra->layout.row_bytes);
  return 0;
}

static int check_lock(void *user, message *why) {
  const run *r = user;
  return lock_check(r->output.lock, why);
}

/* @param tails  [KIND_MOST_TAILS] that the tables refer to. @returns number of tables */
static size_t list_tables(run *r, result_table *tables, tail_source *tails) {
  const uint64_t tasks = study_tasks(r->study);
  size_t count = 0;
  tables[count++] = (result_table){.layout = &r->plan.rows, .rows = tasks, .read = read_done, .user = r};
  if (r->plan.tail_count > 0) {
    lay_out_offsets(r);
    tables[count++] = (result_table){.layout = &r->offsets, .rows = tasks + 1, .read = read_offsets, .user = r};
  }
  for (size_t k = 0; k < r->plan.tail_count; k++) {
    tails[k] = (tail_source){.run = r, .tail = k};
    tables[count++] = (result_table){.layout = &r->plan.tails[k].records,
                                     .rows = checkpoint_entries(r->checkpoint, k),
                                     .read = read_tail,
                                     .user = &tails[k]};
  }
  for (size_t k = 0; k < KIND_MOST_EXTRAS; k++)
    if (r->extras[k].layout.column_count > 0)
      tables[count++] = (result_table){
          .layout = &r->extras[k].layout, .rows = r->extras[k].count, .read = read_extra, .user = &r->extras[k]};
  return count;
}

static int write_result(run *r, message *why) {
  char libraries[256];
  snprintf(libraries, sizeof libraries, "%s, %s", ric_libraries(), build_libraries());
  result_header header = {.study = r->study,
                          .command = r->command,
                          .git_sha = build_git_sha(),
                          .libraries = libraries,
                          .compiler = build_compiler(),
                          .version = build_version(),
                          .compute_seconds = r->computed.seconds,
                          .total_seconds = ranks_max(clock_seconds() - r->began),
                          .ranks = ranks_count(),
                          .arithmetic = r->arithmetic,
                          .mixed = r->mixed,
                          .tasks_computed = r->computed.computed,
                          .tasks_resumed = r->resumed};
  const result_hooks hooks = {.stop = {.call = poll_ranks, .user = r}, .commit = check_lock, .user = r};
  result_table tables[MOST_TABLES];
  tail_source tails[KIND_MOST_TAILS];
  size_t count = list_tables(r, tables, tails);
  table *stored = calloc(count, sizeof *stored);
  int code = ranks_agree(stored ? 0 : refuse(why, EXIT_RUN, "%s: no memory for its tables", r->output.path), why);
  if (!code)
    code = fit_texts(tables, count, stored, why);
  tables[0].read = read_rows;
  if (!code)
    code = result_write(r->output.path, &header, tables, count, &hooks, why);
  free(stored);
  return code;
}

/* Every rank has counted the entries; the file is laid out for the numbers of rank 0. */
static int agree_on_entries(run *r, message *why) {
  uint64_t first[KIND_MOST_TAILS] = {0};
  int code = 0;
  for (size_t k = 0; k < r->plan.tail_count; k++)
    first[k] = checkpoint_entries(r->checkpoint, k);
  ranks_share(first, sizeof first);
  for (size_t k = 0; !code && k < r->plan.tail_count; k++)
    if (first[k] != checkpoint_entries(r->checkpoint, k))
      code = refuse(why, EXIT_FILES,
                    "%s: rank %d found %llu records of %s, rank 0 %llu: is the folder shared by all nodes?",
                    r->output.folder, ranks_rank(), (unsigned long long)checkpoint_entries(r->checkpoint, k),
                    r->plan.tails[k].records.row_axis, (unsigned long long)first[k]);
  return ranks_agree(code, why);
}

/* What tables there are besides those of the tasks, all of it or none. */
static int find_extras(run *r, const row_source *done, message *why) {
  const unsigned long refusals = ric_memory_refusals();
  const int code = r->kind->extra(r->study, &r->plan, done, (ric_poll){.call = poll_ranks, .user = r}, r->extras, why);
  if (code || ric_memory_refusals() == refusals)
    return code;
  return refuse(why, EXIT_RUN, "%s: no memory for what follows the tasks; all of them are kept, --resume goes on",
                r->output.path);
}

/* Everything after the tasks: their rows into the result. */
static int assemble(run *r, message *why) {
  ranks_barrier();
  int code = ranks_agree(checkpoint_rescan(r->checkpoint, why), why);
  if (code)
    return code;
  note_mixed(r);
  if (checkpoint_done(r->checkpoint) < study_tasks(r->study))
    return EXIT_STOPPED;
  code = ranks_agree(checkpoint_count_entries(r->checkpoint, why), why);
  if (!code)
    code = agree_on_entries(r, why);
  const row_source done = {.read = read_done, .user = r};
  if (!code)
    code = ranks_agree(scheduler_create(0, &r->stops, why), why);
  if (!code)
    code = ranks_agree(find_extras(r, &done, why), why);
  if (!code)
    code = write_result(r, why);
  scheduler_destroy(&r->stops);
  ranks_sum(r->outcomes, 64);
  return code;
}

/* The last line: "15 tasks: 14 admissible, 1 grazing -> example.h5 (0.02 s computing, 0.5 s in all)". */
static void print_summary(const run *r) {
  const column *outcome = table_column(&r->plan.rows, "outcome");
  const char *separator = ":";
  printf("%llu task%s", (unsigned long long)study_tasks(r->study), study_tasks(r->study) == 1 ? "" : "s");
  for (size_t i = 0; i < outcome->name_count; i++)
    if (r->outcomes[i] > 0) {
      printf("%s %llu %s", separator, (unsigned long long)r->outcomes[i], outcome->names[i]);
      separator = ",";
    }
  printf(" -> %s (%.3g s computing, %.3g s in all)\n", r->output.path, r->computed.seconds, clock_seconds() - r->began);
}

/* Counts what is finished: whether the checkpoint has no such tasks; false if that cannot be determined. */
static bool is_useless(run *r) {
  message ignored;
  bool useless =
      r->checkpoint && checkpoint_rescan(r->checkpoint, &ignored) == 0 && checkpoint_done(r->checkpoint) == 0;
  ranks_share(&useless, sizeof useless);
  return useless;
}

static int compute_and_write(run *r, message *why) {
  note_mixed(r);
  int code = compute(r->study, r->kind, &r->plan, r->checkpoint, &r->options, &r->computed, why);
  return code ? code : assemble(r, why);
}

static void print_end(const run *r) {
  if (ranks_rank() != 0)
    return;
  if (r->finished)
    printf("%s: finished and verified, nothing to do\n", r->output.path);
  else
    print_summary(r);
}

/* What is to be said of a stop, wherever it happened. Collective. */
static int explain_stop(const run *r, message *why) {
  static const char *const reasons[] = {"by another rank", "by SIGUSR1", "by --max-time", "by a signal"};
  const char *by = reasons[(int)ranks_max((double)stop_asked())];
  if (!r->checkpoint)
    return refuse(why, EXIT_STOPPED, "%s: stopped %s before its first task; --resume goes on",
                  r->output.path[0] ? r->output.path : r->options.study_path, by);
  const uint64_t done = checkpoint_done(r->checkpoint), tasks = study_tasks(r->study);
  if (done == tasks)
    return refuse(why, EXIT_STOPPED, "%s: stopped %s before it was written, with all tasks done; --resume writes it",
                  r->output.path, by);
  return refuse(why, EXIT_STOPPED, "%s: stopped %s with %llu of %llu tasks done; --resume goes on", r->output.path, by,
                (unsigned long long)done, (unsigned long long)tasks);
}

static int run_study(run *r, message *why) {
  int code = load(r, why);
  if (!code)
    code = claim(r, why);
  if (code)
    return code == EXIT_STOPPED ? explain_stop(r, why) : code;
  code = open_checkpoint(r, why);
  if (!code && !r->finished)
    code = compute_and_write(r, why);
  ranks_barrier(); /* no rank appends any more */
  bool useless = is_useless(r);
  if (code == EXIT_STOPPED)
    explain_stop(r, why);
  checkpoint_close(&r->checkpoint);
  output_release(&r->output, code == 0 || useless);
  if (!code)
    print_end(r);
  return code;
}

/* The command line, words joined by spaces. */
static char *join_words(int argc, char **argv) {
  size_t size = sizeof "ricochet";
  for (int i = 0; i < argc; i++)
    size += strlen(argv[i]) + 1;
  char *line = malloc(size);
  if (!line)
    return NULL;
  strcpy(line, "ricochet");
  for (int i = 0; i < argc; i++)
    strcat(strcat(line, " "), argv[i]);
  return line;
}

/* Starts MPI if the launcher or --mpi asks for it, also if the options were refused with `code`: then one rank prints
 * the message. */
static int start(run *r, int *argc, char ***argv, int code, message *why) {
  launcher_decision launched;
  message refused;
  r->began = clock_seconds();
  stop_watch(r->options.max_seconds); /* before MPI starts, so that no signal is lost */
  int not_launched = launcher_decide(r->options.mpi, &launched, &refused);
  if (launched.parallel) {
    stop_hold_signals(); /* mpirun can hang where ranks die while MPI starts or ends */
    ranks_start(argc, argv);
    stop_release_signals();
    not_launched = launcher_check(ranks_count(), &refused);
  }
  r->speaks = ranks_rank() == 0 && !launched.silent;
  if (!code && not_launched)
    *why = refused;
  return code ? code : not_launched;
}

static void clear_extras(run *r) {
  for (size_t k = 0; k < KIND_MOST_EXTRAS; k++) {
    free(r->extras[k].rows);
    if (r->extras[k].close)
      r->extras[k].close(&r->extras[k].from);
  }
}

int command_run(int argc, char **argv) {
  run r = {0};
  message why;
  r.command = join_words(argc, argv); /* before getopt reorders the words */
  int code = r.command ? run_options_parse(argc, argv, &r.options, &why)
                       : refuse(&why, EXIT_RUN, "no memory for the command line");
  if (!code && r.options.help) {
    free(r.command);
    fputs(help, stdout);
    run_options_clear(&r.options);
    return finish_output(0);
  }
  code = start(&r, &argc, &argv, code, &why);
  if (!code)
    code = run_study(&r, &why);
  if (code && r.speaks)
    complain(code, &why); /* before a rank exits with its code: mpirun then ends the others at once */
  stop_hold_signals();
  ranks_finish();
  study_destroy(&r.study);
  clear_extras(&r);
  free(r.command);
  run_options_clear(&r.options);
  return code || !r.speaks ? code : finish_output(0);
}
