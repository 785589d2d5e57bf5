/* Writes the made-up tables: result_ranks FILE [GAMMAS FLOORS PARTICLES IMPACTS SPECIAL STUDY_BYTES]. */
#include <stdio.h>
#include <stdlib.h>

#include <mpi.h>

#include "synthetic.h"

static int write_and_time(const char *path, const synthetic_size *size) {
  synthetic s;
  message why = {""};
  int rank, ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (synthetic_init(&s, size, ranks) != 0)
    return EXIT_RUN;
  double start = MPI_Wtime();
  int code = result_write(path, &s.header, s.tables, SYNTHETIC_TABLES, NULL, &why);
  if (rank == 0) {
    printf("%s: %.3f s%s%s\n", path, MPI_Wtime() - start, code ? ": " : "", why.text);
    fflush(stdout); /* before another rank leaves with its code: mpirun then ends this one at once */
  }
  synthetic_clear(&s);
  return code;
}

int main(int argc, char **argv) {
  synthetic_size size = {5, 4, 6, 0, 50, 300, 3};
  size_t *const fields[] = {&size.gammas,  &size.floors,  &size.particles,
                            &size.impacts, &size.special, &size.text_bytes};
  if (argc < 2 || argc > 8)
    return EXIT_USAGE;
  for (int i = 2; i < argc; i++)
    *fields[i - 2] = strtoull(argv[i], NULL, 10);
  if (MPI_Init(&argc, &argv) != MPI_SUCCESS)
    return EXIT_RUN;
  int code = write_and_time(argv[1], &size);
  MPI_Finalize();
  return code;
}
