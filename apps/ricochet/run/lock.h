/* One lock per output: who holds it may resume, compute and commit.
 *
 * Open-file-description locks on `FILE.h5.ckpt/lock`, one byte per rank, so that the lock lives as long as any process
 * of the run does: ranks outlive a killed mpirun by about a second, and the next run waits for them. */
#ifndef RICOCHET_APP_LOCK_H
#define RICOCHET_APP_LOCK_H

#include "../study/message.h"

typedef struct lock lock;

/** Takes the whole lock, for rank 0: creates the folder and the file, waits up to `wait_seconds` for a holder to leave,
 *  then writes this process as the holder (host, process, time) and keeps the byte of rank 0 locked.
 *  A file that was removed or replaced while waiting is opened anew.
 *  @returns 0 or EXIT_FILES, naming the holder. */
int lock_take(const char *folder, double wait_seconds, lock **out, message *why);

/** Locks the byte of another rank of the same run, after rank 0 took the lock. */
int lock_join(const char *folder, int rank, lock **out, message *why);

/** Whether the path still leads to the file that is locked: nobody commits after losing the lock. */
int lock_check(const lock *l, message *why);

/** Releases; rank 0 passes `remove` to delete the lock file too. */
void lock_release(lock **l, int remove);

#endif
