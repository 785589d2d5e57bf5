#include "scheduler.h"

#include <math.h>
#include <mpi.h>
#include <stdlib.h>

#include "ranks.h"
#include "stop.h"

/* Half the interval at which callers poll (scheduler.h); an MPI_Iprobe costs about a microsecond. */
static const double progress_interval = 0.5e-3;
/* A read of the counter costs 4 to 14 microseconds on one node, a millisecond between nodes. */
static const double read_interval = 0.1;
/* Long against a fetch (a millisecond when oversubscribed), short against the wait for the last rank of a run. */
static const double chunk_seconds = 20e-3;
static const double shortest_chunk_seconds = 10e-3;

struct scheduler {
  bool shared; /* between ranks of MPI; otherwise the counter is `own`, and the three below are unused */
  MPI_Comm comm;
  MPI_Win window;
  int64_t *counter; /* the window's memory: one number on rank 0, nothing elsewhere */
  int64_t own;
  int rank, ranks;
  int64_t items;
  int64_t mark;  /* what a stop adds; larger than the sum of all requests */
  int64_t taken; /* at the last read, at most `items` */
  bool stopped, stop_sent;
  double progressed, counter_read; /* clock_seconds */
  message failure;                 /* empty when there was none */
};

static int refuse_mpi(message *why, int status, const char *what) {
  char text[MPI_MAX_ERROR_STRING] = "unknown error";
  int length = 0;
  MPI_Error_string(status, text, &length);
  return refuse(why, EXIT_RUN, "MPI: %s: %s", what, text);
}

/* The counter stays below 2^63: each rank adds at most one chunk after the last item is gone and at most one mark. */
static int set_limits(scheduler *s, uint64_t items, message *why) {
  s->mark = INT64_MAX / (s->ranks + 1);
  const uint64_t most = (uint64_t)s->mark / ((uint64_t)s->ranks + 2);
  if (items > most)
    return refuse(why, EXIT_RUN, "%llu tasks for %d ranks, expected at most %llu", (unsigned long long)items, s->ranks,
                  (unsigned long long)most);
  s->items = (int64_t)items;
  return 0;
}

static int open_window(scheduler *s, message *why) {
  const MPI_Aint size = s->rank == 0 ? (MPI_Aint)sizeof *s->counter : 0;
  int status = MPI_Win_allocate(size, (int)sizeof *s->counter, MPI_INFO_NULL, s->comm, (void *)&s->counter, &s->window);
  if (status != MPI_SUCCESS)
    return refuse_mpi(why, status, "cannot allocate the shared counter");
  status = MPI_Win_set_errhandler(s->window, MPI_ERRORS_RETURN);
  if (status == MPI_SUCCESS && s->rank == 0) {
    status = MPI_Win_lock(MPI_LOCK_EXCLUSIVE, 0, 0, s->window);
    *s->counter = 0;
    if (status == MPI_SUCCESS)
      status = MPI_Win_unlock(0, s->window);
  }
  if (status == MPI_SUCCESS)
    status = MPI_Barrier(s->comm); /* no rank adds before the counter is zero */
  if (status == MPI_SUCCESS)
    status = MPI_Win_lock_all(0, s->window);
  return status == MPI_SUCCESS ? 0 : refuse_mpi(why, status, "cannot open the shared counter");
}

static int open_communicator(scheduler *s, message *why) {
  int status = MPI_Comm_dup(MPI_COMM_WORLD, &s->comm);
  if (status == MPI_SUCCESS)
    status = MPI_Comm_set_errhandler(s->comm, MPI_ERRORS_RETURN);
  return status == MPI_SUCCESS ? 0 : refuse_mpi(why, status, "cannot duplicate the communicator");
}

int scheduler_create(uint64_t items, scheduler **out, message *why) {
  *out = NULL;
  scheduler *s = calloc(1, sizeof *s);
  if (!s)
    return refuse(why, EXIT_RUN, "out of memory for the scheduler");
  s->shared = ranks_parallel();
  s->rank = ranks_rank();
  s->ranks = ranks_count();
  int code = set_limits(s, items, why);
  if (!code && s->shared)
    code = open_communicator(s, why);
  if (!code && s->shared)
    code = open_window(s, why);
  if (code) {
    /* After a failure of MPI its objects are not freed: that is collective and might wait forever. */
    free(s);
    return code;
  }
  *out = s;
  return 0;
}

void scheduler_destroy(scheduler **s) {
  if (!*s)
    return;
  if ((*s)->shared) {
    MPI_Win_unlock_all((*s)->window);
    MPI_Win_free(&(*s)->window);
    MPI_Comm_free(&(*s)->comm);
  }
  free(*s);
  *s = NULL;
}

static void fail(scheduler *s, int status, const char *what) {
  if (!s->failure.text[0])
    refuse_mpi(&s->failure, status, what);
  s->stopped = true;
}

/* @param before  the counter before `amount` was added to it. @returns a status of MPI */
static int reach_counter(scheduler *s, int64_t amount, int64_t *before) {
  if (!s->shared) {
    *before = s->own;
    s->own += amount;
    return MPI_SUCCESS;
  }
  const int status = MPI_Fetch_and_op(&amount, before, MPI_INT64_T, 0, 0, amount ? MPI_SUM : MPI_NO_OP, s->window);
  return status == MPI_SUCCESS ? MPI_Win_flush(0, s->window) : status;
}

/* Adds to the counter, or only reads it if `amount` is 0, and updates `taken` and `stopped`.
 * @returns the counter before, or the mark when MPI failed (which reads as "stopped"). */
static int64_t fetch_and_add(scheduler *s, int64_t amount) {
  int64_t before = s->mark;
  const int status = reach_counter(s, amount, &before);
  if (status != MPI_SUCCESS) {
    fail(s, status, "cannot reach the shared counter");
    return s->mark;
  }
  const int64_t asked_for = before % s->mark;
  s->taken = asked_for < s->items ? asked_for : s->items;
  s->stopped = s->stopped || before >= s->mark;
  s->counter_read = clock_seconds();
  return before;
}

uint64_t scheduler_take(scheduler *s, uint64_t want, uint64_t *first) {
  if (s->stopped || s->taken >= s->items)
    return 0;
  const int64_t amount = want < 1 ? 1 : want > (uint64_t)s->items ? s->items : (int64_t)want;
  const int64_t before = fetch_and_add(s, amount);
  if (s->stopped || before >= s->items)
    return 0;
  const int64_t left = s->items - before, count = amount < left ? amount : left;
  s->taken = before + count;
  *first = (uint64_t)before;
  return (uint64_t)count;
}

uint64_t scheduler_next_size(const scheduler *s, uint64_t last_size, double last_seconds) {
  if (last_size < 1 || !(last_seconds >= 0))
    return 1;
  const double each = last_seconds / (double)last_size, left = (double)(s->items - s->taken);
  double size = fmin(chunk_seconds / each, 4 * (double)last_size);
  const double fair_share = ceil(left / (2.0 * s->ranks));
  size = fmin(size, fmax(fair_share, shortest_chunk_seconds / each));
  size = fmin(size, left);
  return size >= 1 ? (uint64_t)size : 1;
}

bool scheduler_poll(scheduler *s) {
  if (!s->shared)
    return s->stopped;
  const double now = clock_seconds();
  if (now - s->progressed < progress_interval)
    return s->stopped;
  int waiting;
  const int status = MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, s->comm, &waiting, MPI_STATUS_IGNORE);
  if (status != MPI_SUCCESS)
    fail(s, status, "cannot make progress");
  s->progressed = now;
  if (!s->stopped && !(now - s->counter_read < read_interval))
    fetch_and_add(s, 0);
  return s->stopped;
}

void scheduler_stop(scheduler *s) {
  if (s->stop_sent)
    return;
  s->stop_sent = true;
  s->stopped = true;
  fetch_and_add(s, s->mark);
}

bool scheduler_stopped(scheduler *s) {
  if (!s->stopped)
    fetch_and_add(s, 0);
  return s->stopped;
}

uint64_t scheduler_taken(const scheduler *s) {
  return (uint64_t)s->taken;
}

int scheduler_failure(const scheduler *s, message *why) {
  return s->failure.text[0] ? refuse(why, EXIT_RUN, "%s", s->failure.text) : 0;
}
