/* Over TCP the counter moves only while its owner, rank 0, is inside MPI. Rank 0 computes one long item and polls each
 * millisecond; the others take many short ones and must not be kept waiting. To be run on two ranks or more with the
 * transport forced to TCP (`--mca btl tcp,self --mca osc ^sm`). */
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "run/scheduler.h"
#include "run/stop.h"
#include "rank_checks.h"

static const double long_item = 2, short_item = 2e-3, longest_wait_allowed = 0.2;
enum { ITEMS = 400 };

/* Computes and polls as a task does that is called back each millisecond. */
static void compute(scheduler *s, double seconds) {
  const double began = clock_seconds();
  for (double polled = began, now = began; now - began < seconds; now = clock_seconds())
    if (now - polled > 1e-3) {
      scheduler_poll(s);
      polled = now;
    }
}

int main(int argc, char **argv) {
  int rank;
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  scheduler *s;
  message why;
  check(scheduler_create(MPI_COMM_WORLD, ITEMS, &s, &why) == 0);
  if (!s)
    MPI_Abort(MPI_COMM_WORLD, 1);
  uint64_t first;
  int done = 0;
  double longest = 0;
  if (rank == 0)
    done += (int)scheduler_take(s, 1, &first);
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0)
    compute(s, long_item);
  for (;;) {
    const double began = clock_seconds();
    const uint64_t count = scheduler_take(s, 1, &first);
    longest = fmax(longest, clock_seconds() - began);
    if (!count)
      break;
    done++;
    compute(s, short_item);
  }
  double waits[2] = {rank ? longest : 0, 0};
  int counts[2] = {rank ? done : 0, 0};
  MPI_Reduce(&waits[0], &waits[1], 1, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
  MPI_Reduce(&counts[0], &counts[1], 1, MPI_INT, MPI_SUM, 0, MPI_COMM_WORLD);
  if (rank == 0) {
    printf("items by others: %d of %d; longest take: %.2f ms\n", counts[1], ITEMS, 1e3 * waits[1]);
    check(waits[1] < longest_wait_allowed);
    check(counts[1] > ITEMS / 2 && counts[1] + done == ITEMS);
  }
  scheduler_destroy(&s);
  return finish_checks();
}
