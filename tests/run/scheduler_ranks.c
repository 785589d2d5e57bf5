/* The scheduler on any number of ranks: hands out each item once, sizes chunks, stops everywhere. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "run/ranks.h"
#include "run/scheduler.h"
#include "rank_checks.h"

static int rank, ranks;
static int fetches; /* of the counter, by this rank */

/* MPI's profiling interface: this stands before the function of the same name. */
int MPI_Fetch_and_op(const void *origin, void *result, MPI_Datatype type, int target, MPI_Aint place, MPI_Op op,
                     MPI_Win window) {
  fetches++;
  return PMPI_Fetch_and_op(origin, result, type, target, place, op, window);
}

static scheduler *create(uint64_t items) {
  scheduler *s;
  message why = {""};
  check(scheduler_create(items, &s, &why) == 0);
  if (!s) {
    fprintf(stderr, "%s\n", why.text);
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  return s;
}

static void every_item_is_handed_out_once(uint64_t items, uint64_t largest_chunk) {
  scheduler *s = create(items);
  int *here = calloc(items + 1, sizeof *here), *everywhere = calloc(items + 1, sizeof *everywhere);
  check(here && everywhere);
  uint64_t first = 0, count, want = (uint64_t)rank;
  while ((count = scheduler_take(s, want % (largest_chunk + 1), &first))) {
    check(count <= largest_chunk && first + count <= items);
    for (uint64_t i = first; i < first + count; i++)
      here[i]++;
    want++;
    scheduler_poll(s);
  }
  check(scheduler_taken(s) == items);
  check(scheduler_take(s, 1, &first) == 0);
  check(!scheduler_stopped(s));
  MPI_Allreduce(here, everywhere, (int)items, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  for (uint64_t i = 0; i < items; i++)
    check(everywhere[i] == 1);
  free(here);
  free(everywhere);
  message why;
  check(scheduler_failure(s, &why) == 0);
  scheduler_destroy(&s);
  check(!s);
  scheduler_destroy(&s);
}

static void chunks_aim_at_20_ms(void) {
  scheduler *s = create(1000000);
  check(scheduler_next_size(s, 0, 0) == 1);
  check(scheduler_next_size(s, 1, NAN) == 1);
  check(scheduler_next_size(s, 1, INFINITY) == 1);
  check(scheduler_next_size(s, 1, 0) == 4); /* too short to be measured: grows by four */
  check(scheduler_next_size(s, 10, 1e-6) == 40);
  check(scheduler_next_size(s, 1024, 0.02) == 1024);
  check(scheduler_next_size(s, 1024, 0.64) == 32); /* shrinks at once, as a chunk that lasts holds everybody up */
  check(scheduler_next_size(s, 1, 5) == 1);
  scheduler_destroy(&s);
}

static void chunks_shrink_towards_the_end_but_not_below_10_ms(void) {
  scheduler *s = create(1000);
  const double each = 0.125e-3; /* 160 items in 20 ms, 80 in 10 ms */
  uint64_t first, size = 160, left = 1000;
  while (rank == 0 && scheduler_take(s, size, &first)) {
    left -= size;
    size = scheduler_next_size(s, size, (double)size * each);
    check(size <= (left ? left : 1));
    check(size >= (left < 80 ? left : 80));
    check((double)size <= fmax(80, ceil((double)left / (2 * ranks))));
  }
  scheduler_destroy(&s);
}

static void stop_reaches_every_rank(bool all_of_them_stop) {
  scheduler *s = create(1000000);
  uint64_t first;
  check(scheduler_take(s, 10, &first) == 10);
  MPI_Barrier(MPI_COMM_WORLD);
  check(!scheduler_stopped(s));
  MPI_Barrier(MPI_COMM_WORLD);
  if (all_of_them_stop || rank == ranks - 1)
    for (int i = 0; i < 5; i++)
      scheduler_stop(s);
  MPI_Barrier(MPI_COMM_WORLD);
  fetches = 0;
  while (!scheduler_poll(s))
    ;
  check(fetches <= 1); /* the first look at the counter after the stop finds it */
  check(scheduler_take(s, 10, &first) == 0);
  MPI_Barrier(MPI_COMM_WORLD);
  check(scheduler_stopped(s));
  check(scheduler_taken(s) == (uint64_t)(10 * ranks));
  scheduler_destroy(&s);
}

static void taking_after_a_stop_elsewhere_gives_nothing(void) {
  scheduler *s = create(1000);
  uint64_t first;
  if (rank == 0)
    scheduler_stop(s);
  MPI_Barrier(MPI_COMM_WORLD);
  check(scheduler_take(s, 10, &first) == 0); /* without a poll in between */
  check(scheduler_poll(s));
  scheduler_destroy(&s);
}

static void more_items_than_the_counter_can_hold_are_refused(void) {
  scheduler *s;
  message why;
  check(scheduler_create(UINT64_MAX, &s, &why) == EXIT_RUN && !s);
  s = create(UINT64_C(1000000000000));
  scheduler_destroy(&s);
}

int main(int argc, char **argv) {
  ranks_start(&argc, &argv);
  rank = ranks_rank();
  ranks = ranks_count();
  every_item_is_handed_out_once(0, 1);
  every_item_is_handed_out_once(1, 1);
  every_item_is_handed_out_once(3, 100); /* fewer than ranks, and less than is wanted */
  every_item_is_handed_out_once(2000, 1);
  every_item_is_handed_out_once(10000, 17);
  chunks_aim_at_20_ms();
  chunks_shrink_towards_the_end_but_not_below_10_ms();
  stop_reaches_every_rank(false);
  stop_reaches_every_rank(true);
  taking_after_a_stop_elsewhere_gives_nothing();
  more_items_than_the_counter_can_hold_are_refused();
  return finish_checks();
}
