/* Reading a file of others in a child process.
 *
 * HDF5 1.10 crashes on some files that were made to make it crash, with right checksums. What reads such a file is a
 * child with limits of memory and time: its crash ends in a sentence, and nothing of the parent is lost. This is no
 * sandbox: whoever makes HDF5 run code of theirs has the rights of the user. */
#ifndef RICOCHET_APP_CHILD_H
#define RICOCHET_APP_CHILD_H

#include <stdio.h>

#include "../base/message.h"

/** What reads the file. Both functions return 0 or an exit code, with its reason in `why`. */
typedef struct child_task {
  /** In the child: reads, prints on standard output, and writes to `reply` what the parent is to have. */
  int (*read)(void *user, FILE *reply, message *why);
  /** In the parent, at the same time: takes the reply; it is not to be believed. NULL: there is none. */
  int (*take)(void *user, FILE *reply, message *why);
  void *user;
} child_task;

/** Does the task, and waits for the child. It may take 2 GB of memory and 16 times the size of the file, and, of its
 * processor, a minute and 500 s for each MB of the file: many times what a sound result takes, also when it was
 * compressed. The child has ended when this returns; it also ends when the parent does. SIGINT and SIGTERM end the
 * parent at once. Under MPI too: the child calls nothing of it.
 *  @param path  of the file, for the limits and the message
 *  @returns what `read` returned, or else what `take` did; EXIT_FILES when the child crashed or reached a limit,
 *  EXIT_RUN when it cannot be started. A signal that ended the child without harm, such as SIGPIPE, ends the caller. */
int child_read(const char *path, const child_task *task, message *why);

#endif
