/* One lock per output: its holder alone may resume, compute and commit.
 *
 * Open-file-description locks on `FILE.h5.ckpt/lock`, one byte per rank, so that the lock persists as long as any
 * process of the run: ranks outlive a killed mpirun by about a second, and the next run waits for them. The kernel
 * frees the locks when a process ends, however it ends. The text in the file only names the holder; it locks nothing.
 */
#ifndef RICOCHET_APP_LOCK_H
#define RICOCHET_APP_LOCK_H

#include "../base/message.h"

typedef struct lock lock;

/** Takes the whole lock, for rank 0: creates the folder and the file, waits up to `wait_seconds` for a holder to leave,
 *  then writes this process as the holder (host, process, time) and keeps the byte of rank 0 locked.
 *  A file that was removed or replaced while waiting is opened anew. Faults that waiting cannot remove (a folder that
 *  cannot be written, a file system without locks) are refused at once.
 *  @param wait_seconds  0 for one attempt
 *  @returns 0 or EXIT_FILES, naming the holder; EXIT_RUN out of memory; *out is NULL then. */
int lock_take(const char *folder, double wait_seconds, lock **out, message *why);

/** Locks the byte of another rank (>= 1) of the same run, after lock_take on rank 0; does not wait.
 *  @returns 0, EXIT_FILES, or EXIT_RUN out of memory; *out is NULL then. */
int lock_join(const char *folder, int rank, lock **out, message *why);

/** Whether the path still names the locked file: a run that has lost the lock must not commit.
 *  @returns 0 or EXIT_FILES. */
int lock_check(const lock *l, message *why);

/** Releases; rank 0 passes `remove` to delete the lock file too (if it is still its own) and the folder if that leaves
 * it empty. Takes &l, sets it NULL, accepts NULL. */
void lock_release(lock **l, int remove);

#endif
