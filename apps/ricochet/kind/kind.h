/* A kind of study: how its results are laid out, and how one task is evaluated.
 *
 * The evaluation of a task is a function of the study's values alone: it knows no rank, no file and no order, so a
 * sweep gives the same bits however it is spread. Tasks that fail are rows with their outcome and reason. */
#ifndef RICOCHET_APP_KIND_H
#define RICOCHET_APP_KIND_H

#include <ricochet/ricochet.h>
#include <stdbool.h>
#include <stdint.h>

#include "keys.h"
#include "base/table.h"
#include "result/result.h"

enum { KIND_MOST_TAILS = 6, KIND_MOST_EXTRAS = 2, KIND_MOST_LISTS = 2 };

/** A table of records, of which each task has as many as it has: task i owns the records offset[i] to offset[i + 1]. */
typedef struct tail {
  table records;                /* its row_axis is the scale of all records: "impact_row" */
  const char *offset, *meaning; /* the data set of the offsets, "impact_offset", and what it says */
} tail;

/** The layout of a study's results, and what their computation needs. */
typedef struct kind_plan {
  table rows; /* a row per task; its column `outcome`, of words, is counted at the end */
  tail tails[KIND_MOST_TAILS];
  size_t tail_count;
  uint64_t batch; /* most tasks that are evaluated at once; 0: one */
  bool whole;     /* exactly so many always: tasks of a batch follow from one another. They have no tails then */
  double memory;  /* bytes that one rank computes with */
} kind_plan;

/** Evaluates tasks; one per rank. */
typedef struct worker worker;

/** Tasks that follow one another. */
typedef struct task_range {
  uint64_t first, count;
} task_range;

/** Reads the rows of finished tasks, [count][row_bytes]. @returns 0 or EXIT_FILES */
typedef struct row_source {
  int (*read)(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why);
  void *user;
} row_source;

/** Rows of a table that belongs to the study as a whole: few of them, or read where they are written. */
typedef struct extra_rows {
  table layout;
  uint64_t count;
  unsigned char *rows; /* [count][layout.row_bytes], freed by the caller; NULL: `read` makes them */
  result_rows read;
  void *from;
  void (*close)(void **from); /* frees it */
} extra_rows;

typedef struct kind kind;

struct kind {
  schema_choice choice; /* its first member, so that a choice of the schema is a kind */
  /** The lists of columns that its tables are laid out from, in up to KIND_MOST_LISTS arrays that each end with an
   * empty list. */
  const column_list *lists[KIND_MOST_LISTS];
  /** The kind that evaluates this study, where that depends on its keys; NULL: this one. */
  const kind *(*variant)(const study *s);
  /** Lays out the results; refuses a study that cannot be computed, or needs more memory than there is (0 or
   *  EXIT_USAGE). */
  int (*plan)(const study *s, kind_plan *plan, message *why);
  /** @param poll  handed to the library; non-zero stops a task */
  int (*open)(const study *s, ric_poll poll, worker **out, message *why);
  /** Fills the rows of a batch of tasks, of one unless the plan says more, and adds its records. What a row holds does
   *  not depend on the batch that its task is in.
   *  @param rows  [tasks.count][plan->rows.row_bytes], at a multiple of 8 bytes, of any content
   *  @param tails  [plan->tail_count], behind the records of earlier tasks; plans with tails have batches of one
   *  @returns 0, or -1 when the poll stopped it; its rows and records are then discarded */
  int (*evaluate)(worker *w, const kind_plan *plan, task_range tasks, unsigned char *rows, records *tails);
  void (*close)(worker **w);
  /** The study's extra tables, made after all tasks, on every rank alike.
   *  @param done  rows of all tasks, borrowed until the extra tables are freed
   *  @param extra  [KIND_MOST_EXTRAS] empty; tables without columns are none
   *  @returns 0, EXIT_RUN, EXIT_FILES; EXIT_STOPPED when the poll stopped it */
  int (*extra)(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
               message *why);
  /** What `show` says of a result in sentences; NULL: nothing. */
  result_card *show;
  /** Replaces a study that refers to an earlier result by the complete one; NULL: none does.
   *  @param from  that the study was read from */
  int (*resolve)(study **s, const study_source *from, message *why);
};

/** The schema of studies: every kind, every type of model, and their keys. */
extern const schema studies;

/** Reads a study file, and what it refers to.
 *  @param stop  asked while a pipe has nothing to read
 *  @returns as study_read_file, study_parse and `resolve` */
int kind_read_study(const char *path, const char *const *sets, size_t set_count, ric_poll stop, study **out,
                    message *why);

/** What the kind of this name says of its results; NULL for nothing, and for no kind. */
result_card *kind_card(const char *name);

/** What evaluates a study. */
const kind *kind_of(const study *s);

/** Lays out a tail from a list, as table_add. */
void kind_lay_out_tail(tail *to, const column_list *list, const table_axis *axes, size_t axis_count);

/** Prints the schema page of results in Markdown: the tables of every kind. */
void kind_results_reference(FILE *out);

/** An `extra` for kinds without such a table. */
int kind_no_extra(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                  message *why);

#endif
