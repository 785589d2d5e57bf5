#include "launcher.h"

#include <stdlib.h>

/* Variables that launchers set for their ranks. SLURM_* alone does not show a launcher: every command of a batch script
 * has these variables. */
static const char *const signs[] = {
    "OMPI_COMM_WORLD_SIZE", /* mpirun of Open MPI */
    "PMIX_RANK",            /* PMIx: srun --mpi=pmix, prterun */
    "PMI_RANK",             /* PMI: mpiexec of MPICH, srun --mpi=pmi2 */
    "PMI_FD",               /* the same */
};

static bool is_launched(void) {
  for (size_t i = 0; i < sizeof signs / sizeof *signs; i++)
    if (getenv(signs[i]))
      return true;
  return false;
}

static long number_of(const char *variable, long otherwise) {
  const char *text = getenv(variable);
  return text ? strtol(text, NULL, 10) : otherwise;
}

int launcher_decide(launcher_mode mode, launcher_decision *decision, message *why) {
  *decision = (launcher_decision){.parallel = mode == LAUNCHER_ON || (mode == LAUNCHER_AUTO && is_launched())};
  const long tasks = number_of("SLURM_STEP_NUM_TASKS", 1);
  if (mode != LAUNCHER_AUTO || decision->parallel || tasks <= 1)
    return 0;
  decision->silent = number_of("SLURM_PROCID", 0) != 0;
  return refuse(why, EXIT_USAGE,
                "ricochet run: srun started %ld tasks without MPI, each of which would compute the whole study: use "
                "srun --mpi=pmix "
                "or mpirun; --mpi off lets each compute by itself",
                tasks);
}

int launcher_check(int ranks, message *why) {
  const long started = number_of("PMI_SIZE", 1);
  if (ranks > 1 || started <= 1)
    return 0;
  return refuse(why, EXIT_USAGE,
                "ricochet run: %ld processes were started, but MPI has one rank in each: the launcher is not that of "
                "this program's MPI; use mpirun of Open MPI or srun --mpi=pmix",
                started);
}
