/* Every way in which writing a result can fail, on any number of ranks: all ranks return the same code with the same
 * message, nobody hangs, and no file is left. Run in an empty folder of its own. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <mpi.h>

#include "synthetic.h"

typedef struct scenario scenario;
struct scenario {
  const char *name, *path;
  int code;         /* expected */
  const char *says; /* expected in the message */
  void (*prepare)(synthetic *s);
  int (*commit)(void *user, message *why);
  int (*stop)(void *user);
};

static int rank, ranks;

/* --- troubles --- */

static void limit_file_size(rlim_t bytes) {
  struct rlimit limit;
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = bytes;
  setrlimit(RLIMIT_FSIZE, &limit);
}

static result_rows honest_read;

/* The file can be made, but the last rank cannot write its rows into it: a failure on one rank only, in the middle of
 * a collective call. */
static int read_then_limit(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  if (rank == ranks - 1)
    limit_file_size(1024);
  return honest_read(user, first, count, rows, why);
}

static int read_fails_on_last(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  if (rank == ranks - 1)
    return refuse(why, EXIT_RUN, "rank %d has no row %d", rank, (int)first);
  return honest_read(user, first, count, rows, why);
}

static void small_limit(synthetic *s) {
  (void)s;
  limit_file_size(20000);
}

static void tiny_limit(synthetic *s) {
  (void)s;
  limit_file_size(512);
}

static void limit_later(synthetic *s) {
  s->tables[0].read = read_then_limit;
}

static void read_failure(synthetic *s) {
  s->tables[0].read = read_fails_on_last;
}

static void other_extent(synthetic *s) {
  s->layouts[0].columns[5].extents[0] -= 1;
  table_lay_out(&s->layouts[0]);
}

static void axis_like_group(synthetic *s) {
  s->layouts[1].row_axis = "orbits";
}

static void other_rows(synthetic *s) {
  s->tables[0].rows -= 1;
}

static int lost_lock(void *user, message *why) {
  (void)user;
  return refuse(why, EXIT_FILES, "the lock was lost");
}

static int stop_last(void *user) {
  (void)user;
  return rank == ranks - 1;
}

/* On the last rank, further and further on; every other rank goes on as it would. */
static int stop_later(void *user) {
  static int asked, limit = 2;
  (void)user;
  if (rank != ranks - 1 || ++asked < limit)
    return 0;
  asked = 0;
  limit *= 2;
  return 1;
}

static const scenario scenarios[] = {
    {"limit on the file's size", "a.h5", EXIT_FILES, "a.h5: cannot ", small_limit, NULL, NULL},
    {"no room even for the header", "a.h5", EXIT_FILES, "File too large", tiny_limit, NULL, NULL},
    {"one rank cannot write", "a.h5", EXIT_FILES, "a.h5: cannot write /orbits/outcome", limit_later, NULL, NULL},
    {"one rank cannot read its rows", "a.h5", EXIT_RUN, "has no row", read_failure, NULL, NULL},
    {"commit refuses", "a.h5", EXIT_FILES, "the lock was lost", NULL, lost_lock, NULL},
    {"the last rank is to stop", "a.h5", EXIT_STOPPED, "a.h5: stopped", NULL, NULL, stop_last},
    {"the last rank is to stop at the 2nd call", "a.h5", EXIT_STOPPED, "a.h5: stopped", NULL, NULL, stop_later},
    {"the last rank is to stop at the 4th call", "a.h5", EXIT_STOPPED, "a.h5: stopped", NULL, NULL, stop_later},
    {"no such folder", "none/a.h5", EXIT_FILES, "none/a.h5: cannot create it: No such file or directory", NULL, NULL,
     NULL},
    {"two extents of one axis", "a.h5", EXIT_RUN, "axis particle = ", other_extent, NULL, NULL},
    {"axis with the name of a group", "a.h5", EXIT_RUN, "axis orbits has the name of a group", axis_like_group, NULL,
     NULL},
    {"rows that are not the tasks", "a.h5", EXIT_RUN, "axis task = ", other_rows, NULL, NULL},
};

/* --- checks --- */

static int complain(const scenario *t, const char *what, int code, const char *text) {
  fprintf(stderr, "rank %d of %d: %s: %s: code %d, \"%s\"\n", rank, ranks, t->name, what, code, text);
  return 1;
}

static int file_exists(const char *path, const char *end) {
  struct stat about;
  char name[256];
  snprintf(name, sizeof name, "%s%s", path, end);
  return stat(name, &about) == 0;
}

static int check(const scenario *t, int code, const message *why) {
  message first = *why;
  MPI_Bcast(first.text, (int)sizeof first.text, MPI_CHAR, 0, MPI_COMM_WORLD);
  int bad = 0;
  if (code != t->code)
    bad = complain(t, "another code than expected", code, why->text);
  else if (code && !strstr(why->text, t->says))
    bad = complain(t, t->says, code, why->text);
  else if (code && strcmp(first.text, why->text) != 0)
    bad = complain(t, "rank 0 has another message", code, why->text);
  if (rank == 0 && (file_exists(t->path, "") || file_exists(t->path, ".tmp")))
    bad = complain(t, "a file is left", code, why->text);
  if (rank == 0 && !bad)
    printf("%s: %s\n", t->name, why->text);
  return bad;
}

static int run(const scenario *t) {
  const synthetic_size size = {300, 200, 6, 2, 5, 300, 3};
  synthetic s;
  message why = {""};
  struct rlimit before;
  if (synthetic_init(&s, &size, ranks) != 0)
    return 1;
  getrlimit(RLIMIT_FSIZE, &before);
  honest_read = s.tables[0].read;
  if (t->prepare)
    t->prepare(&s);
  const result_hooks hooks = {.stop = {.call = t->stop}, .commit = t->commit};
  int code = result_write(t->path, &s.header, s.tables, SYNTHETIC_TABLES, &hooks, &why);
  setrlimit(RLIMIT_FSIZE, &before);
  synthetic_clear(&s);
  return check(t, code, &why);
}

/* After all the failures, writing still works. */
static int run_good(void) {
  const synthetic_size size = {3, 2, 6, 2, 5, 300, 3};
  synthetic s;
  message why = {""};
  if (synthetic_init(&s, &size, ranks) != 0)
    return 1;
  int code = result_write("good.h5", &s.header, s.tables, SYNTHETIC_TABLES, NULL, &why);
  if (!code)
    code = result_verify("good.h5", (ric_poll){0}, &why);
  if (code)
    fprintf(stderr, "rank %d: after the failures: %s\n", rank, why.text);
  synthetic_clear(&s);
  return code;
}

int main(int argc, char **argv) {
  int bad = 0;
  signal(SIGXFSZ, SIG_IGN); /* as the program does: the write fails with EFBIG instead of killing it */
  if (MPI_Init(&argc, &argv) != MPI_SUCCESS)
    return 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  for (size_t i = 0; i < sizeof scenarios / sizeof scenarios[0]; i++)
    bad += run(&scenarios[i]);
  bad += run_good();
  MPI_Finalize();
  return bad ? 1 : 0;
}
