#include "ranks.h"

#include <limits.h>
#include <mpi.h>
#include <stdlib.h>

void ranks_start(int *argc, char ***argv) {
  MPI_Init(argc, argv);
}

void ranks_finish(void) {
  if (ranks_parallel())
    MPI_Finalize();
}

bool ranks_parallel(void) {
  int started; /* one of the few questions that MPI answers at any time */
  MPI_Initialized(&started);
  return started;
}

int ranks_rank(void) {
  int rank = 0;
  if (ranks_parallel())
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int ranks_count(void) {
  int count = 1;
  if (ranks_parallel())
    MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}

void ranks_barrier(void) {
  if (ranks_parallel())
    MPI_Barrier(MPI_COMM_WORLD);
}

int ranks_agree(int code, message *why) {
  if (!ranks_parallel())
    return code;
  int mine = code ? ranks_rank() : INT_MAX, first;
  MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == INT_MAX)
    return 0;
  MPI_Bcast(&code, 1, MPI_INT, first, MPI_COMM_WORLD);
  MPI_Bcast(why->text, (int)sizeof why->text, MPI_CHAR, first, MPI_COMM_WORLD);
  return code;
}

void ranks_share(void *bytes, size_t size) {
  if (ranks_parallel())
    MPI_Bcast(bytes, (int)size, MPI_BYTE, 0, MPI_COMM_WORLD);
}

int ranks_share_text(char **text, size_t *length, message *why) {
  ranks_share(length, sizeof *length);
  int code = 0;
  if (ranks_rank() != 0 && !(*text = malloc(*length + 1)))
    code = refuse(why, EXIT_RUN, "no memory for the study (%zu bytes)", *length);
  code = ranks_agree(code, why);
  if (!code)
    ranks_share(*text, *length + 1);
  return code;
}

double ranks_max(double value) {
  double largest = value;
  if (ranks_parallel())
    MPI_Allreduce(&value, &largest, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return largest;
}

void ranks_sum(uint64_t *values, size_t count) {
  if (ranks_parallel())
    MPI_Allreduce(MPI_IN_PLACE, values, (int)count, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
}
