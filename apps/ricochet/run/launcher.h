/* Whether a launcher started this process as one rank of several, read off the environment before MPI starts.
 *
 * MPI_Init takes about 0.3 s and opens files and sockets, which a run of one process does not need. A process that no
 * launcher started therefore computes without MPI, with the same bytes of data. The variables that launchers set are
 * listed in launcher.c. */
#ifndef RICOCHET_APP_LAUNCHER_H
#define RICOCHET_APP_LAUNCHER_H

#include <stdbool.h>

#include "../base/message.h"

typedef enum launcher_mode {
  LAUNCHER_AUTO, /* MPI if a launcher started the process */
  LAUNCHER_ON,   /* MPI in any case */
  LAUNCHER_OFF   /* this process alone, whatever started it */
} launcher_mode;

/** How this process starts. */
typedef struct launcher_decision {
  bool parallel; /* start MPI */
  bool silent;   /* leave messages to another process: set for all but the first task of a refused Slurm step */
} launcher_decision;

/** Decides whether MPI is to be started.
 *  @returns 0; EXIT_USAGE when Slurm started several tasks without telling them how to find one another, so that each
 *  would compute the whole study. */
int launcher_decide(launcher_mode mode, launcher_decision *decision, message *why);

/** To be called once MPI has started with so many ranks.
 *  @returns 0; EXIT_USAGE when the launcher of another MPI started several processes that cannot find one another */
int launcher_check(int ranks, message *why);

#endif
