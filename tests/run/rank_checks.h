/* Checks of a test program that runs on several ranks: failures are printed where they happen and counted over all. */
#ifndef RICOCHET_TESTS_RANK_CHECKS_H
#define RICOCHET_TESTS_RANK_CHECKS_H

#include <mpi.h>
#include <stdio.h>

static int failures_here;

#define check(condition) check_at((condition), #condition, __FILE__, __LINE__)

static inline void check_at(int holds, const char *condition, const char *file, int line) {
  if (holds)
    return;
  failures_here++;
  fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, condition);
}

/** Collective; ends MPI. @returns the exit code of the program, the same on every rank */
static inline int finish_checks(void) {
  int failures = 0;
  MPI_Allreduce(&failures_here, &failures, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  MPI_Finalize();
  return failures ? 1 : 0;
}

#endif
