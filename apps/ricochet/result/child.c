/* MAP_ANONYMOUS is not in POSIX. */
#define _DEFAULT_SOURCE
#include "child.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* What the child leaves behind, in memory of both. */
typedef struct answer {
  bool ended; /* by itself: not by a crash, nor by a call of a library */
  message why;
} answer;

/* A child at work, as its parent has it. */
typedef struct child {
  const char *path;
  const child_task *task;
  answer *answer;
  pid_t parent, id;
  int pipe[2];
  rlim_t memory, seconds;
} child;

/* --- limits --- */

static rlim_t mapped_bytes(void) {
  unsigned long pages = 0;
  FILE *from = fopen("/proc/self/statm", "r");
  const bool known = from && fscanf(from, "%lu", &pages) == 1;
  if (from)
    fclose(from); /* only read */
  return known ? (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) : RLIM_INFINITY;
}

static void set_limits(child *c) {
  struct stat about;
  const rlim_t bytes = stat(c->path, &about) == 0 && about.st_size > 0 ? (rlim_t)about.st_size : 0;
  const rlim_t mapped = mapped_bytes(), most = (rlim_t)1 << 56;
  c->seconds = 60 + (bytes < most ? bytes : most) / 2000;
  c->memory = mapped < most && bytes < most / 16 ? mapped + ((rlim_t)2 << 30) + 16 * bytes : RLIM_INFINITY;
}

/* A limit that is lower already stays; one that cannot be set does not keep the file from being read. */
static void lower(int what, rlim_t value) {
  struct rlimit limit;
  if (getrlimit(what, &limit) != 0 || limit.rlim_cur <= value)
    return;
  limit.rlim_cur = value;
  (void)setrlimit(what, &limit);
}

/* --- the child --- */

static void work(const child *c) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != c->parent) /* it has ended before the line above */
    _exit(EXIT_RUN);
  lower(RLIMIT_AS, c->memory);
  lower(RLIMIT_CPU, c->seconds);
  lower(RLIMIT_CORE, 0);
  close(c->pipe[0]);
  message *why = &c->answer->why;
  FILE *reply = fdopen(c->pipe[1], "w");
  int code =
      reply ? c->task->read(c->task->user, reply, why) : refuse(why, EXIT_RUN, "%s: no memory to read it", c->path);
  if (reply && fclose(reply) != 0 && !code)
    code = refuse_errno(c->path, "hand over what was read", why);
  code = flush_output(code, why);
  c->answer->ended = true;
  _exit(code); /* not exit: buffers and handlers are those of the parent */
}

/* --- the parent --- */

static const int ending[] = {SIGINT, SIGTERM};
enum { ENDING = sizeof ending / sizeof *ending };

/* While the child works these signals end both, whatever handlers there are; those that are ignored stay so. */
static void let_signals_end(struct sigaction old[ENDING]) {
  const struct sigaction plain = {.sa_handler = SIG_DFL};
  for (int i = 0; i < ENDING; i++)
    if (sigaction(ending[i], NULL, &old[i]) == 0 && old[i].sa_handler != SIG_IGN)
      sigaction(ending[i], &plain, NULL);
}

static void restore_signals(const struct sigaction old[ENDING]) {
  for (int i = 0; i < ENDING; i++)
    sigaction(ending[i], &old[i], NULL);
}

static int wait_for(const child *c, int *status, message *why) {
  while (waitpid(c->id, status, 0) < 0)
    if (errno != EINTR)
      return refuse_errno(c->path, "wait for what reads it", why);
  return 0;
}

/* A crash is the fault of the file; SIGKILL comes from a user, or from a system without memory. */
static int refuse_signal(const child *c, int number, message *why) {
  switch (number) {
  case SIGXCPU:
    return refuse(why, EXIT_FILES, "%s: not read within %llu s: the file is damaged, or made to keep its readers busy",
                  c->path, (unsigned long long)c->seconds);
  case SIGSEGV:
  case SIGBUS:
  case SIGFPE:
  case SIGILL:
  case SIGABRT:
    return refuse(
        why, EXIT_FILES,
        "%s: HDF5 crashed while it read it (signal %d): the file is damaged, or made to do that, or memory ran out",
        c->path, number);
  case SIGKILL:
    return refuse(why, EXIT_FILES, "%s: what read it was killed (signal 9), as happens where memory runs out", c->path);
  default: /* a closed pipe, a key of the terminal */
    signal(number, SIG_DFL);
    raise(number);
    return refuse(why, EXIT_FILES, "%s: what read it ended by signal %d", c->path, number);
  }
}

static int outcome(const child *c, int status, message *why) {
  if (WIFSIGNALED(status))
    return refuse_signal(c, WTERMSIG(status), why);
  if (!c->answer->ended)
    return refuse(
        why, EXIT_FILES,
        "%s: HDF5 ended while it read it (code %d): the file is damaged, or made to do that, or memory ran out",
        c->path, WEXITSTATUS(status));
  c->answer->why.text[sizeof c->answer->why.text - 1] = '\0';
  if (WEXITSTATUS(status))
    escape_text(c->answer->why.text, why->text, sizeof why->text); /* it may repeat words of the file */
  return WEXITSTATUS(status);
}

static int take_reply(child *c, message *why) {
  FILE *reply = fdopen(c->pipe[0], "r");
  if (!reply) {
    close(c->pipe[0]);
    return refuse(why, EXIT_RUN, "%s: no memory to read it", c->path);
  }
  const int code = c->task->take ? c->task->take(c->task->user, reply, why) : 0;
  while (getc(reply) != EOF) /* until the child ends: a closed pipe would be an end of another kind */
    continue;
  fclose(reply); /* only read */
  return code;
}

static int start(child *c, message *why) {
  if (pipe(c->pipe) != 0)
    return refuse_errno(c->path, "start what reads it", why);
  fflush(stdout); /* or the child would print it again */
  c->parent = getpid();
  c->id = fork();
  if (c->id == 0)
    work(c);
  if (c->id < 0)
    refuse_errno(c->path, "start what reads it", why);
  close(c->pipe[1]);
  if (c->id > 0)
    return 0;
  close(c->pipe[0]);
  return EXIT_RUN;
}

int child_read(const char *path, const child_task *task, message *why) {
  child c = {.path = path, .task = task};
  struct sigaction old[ENDING];
  message untaken = {""};
  int status;
  c.answer = mmap(NULL, sizeof *c.answer, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (c.answer == MAP_FAILED)
    return refuse(why, EXIT_RUN, "%s: no memory to read it", path);
  set_limits(&c);
  let_signals_end(old);
  int code = start(&c, why);
  if (!code) {
    const int taken = take_reply(&c, &untaken);
    code = wait_for(&c, &status, why);
    if (!code)
      code = outcome(&c, status, why);
    if (!code && taken) {
      code = taken;
      *why = untaken;
    }
  }
  restore_signals(old);
  munmap(c.answer, sizeof *c.answer);
  return code;
}
