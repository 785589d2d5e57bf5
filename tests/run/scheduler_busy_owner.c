/* Over TCP the counter moves only while its owner, rank 0, is inside MPI. Rank 0 computes one item that lasts until the
 * others have taken all that is left, and only polls: were they held up by it, this program would never end. To be run
 * on two ranks or more with the transport forced to TCP (`--mca btl tcp,self --mca osc ^sm`). */
#include "run/ranks.h"
#include "run/scheduler.h"
#include "run/stop.h"
#include "rank_checks.h"

enum { ITEMS = 400 };

static int probes, fetches; /* of this rank */

/* MPI's profiling interface: these stand before the functions of the same name. */
int MPI_Iprobe(int source, int tag, MPI_Comm comm, int *flag, MPI_Status *status) {
  probes++;
  return PMPI_Iprobe(source, tag, comm, flag, status);
}

int MPI_Fetch_and_op(const void *origin, void *result, MPI_Datatype type, int target, MPI_Aint place, MPI_Op op,
                     MPI_Win window) {
  fetches++;
  return PMPI_Fetch_and_op(origin, result, type, target, place, op, window);
}

static int take_all(scheduler *s) {
  uint64_t first;
  int done = 0;
  while (scheduler_take(s, 1, &first))
    done++;
  return done;
}

int main(int argc, char **argv) {
  ranks_start(&argc, &argv);
  const int rank = ranks_rank();
  scheduler *s;
  message why;
  check(scheduler_create(ITEMS, &s, &why) == 0);
  if (!s)
    MPI_Abort(MPI_COMM_WORLD, 1);
  uint64_t first;
  int done = rank == 0 ? (int)scheduler_take(s, 1, &first) : 0;
  ranks_barrier();
  if (rank == 0)
    while (scheduler_taken(s) < ITEMS) /* as of the last look, which is part of a poll now and then */
      scheduler_poll(s);
  const int polled = probes;
  fetches = 0;
  const int taken = take_all(s);
  check(fetches <= taken + 1); /* one each, and one that finds nothing left */
  check(rank > 0 || (taken == 0 && polled > 0));
  uint64_t sum = (uint64_t)(done + taken);
  ranks_sum(&sum, 1);
  check(sum == ITEMS);
  if (rank == 0)
    printf("%d items by others while rank 0 polled %d times\n", ITEMS - done, polled);
  scheduler_destroy(&s);
  return finish_checks();
}
