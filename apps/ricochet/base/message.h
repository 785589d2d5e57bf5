/* The one-line message of a refusal or failure, and the exit code that goes with it.
 *
 * Every function of the application that can fail takes a `message *` as its last parameter, returns 0 or the exit
 * code of the program, and leaves the sentence that the user reads here. It begins with the place (`FILE:LINE:` where
 * there is one) and gives the value received and what is allowed. */
#ifndef RICOCHET_APP_MESSAGE_H
#define RICOCHET_APP_MESSAGE_H

#include <stddef.h>

/** Exit codes of the program. 0 is success, also when tasks have outcomes such as `failed`. */
enum exit_code {
  EXIT_DONE = 0,
  EXIT_RUN = 1,      /* the run itself cannot go on */
  EXIT_USAGE = 2,    /* bad usage or bad study */
  EXIT_FILES = 3,    /* cannot read or write */
  EXIT_STOPPED = 75, /* stopped by SIGUSR1 or --max-time with a checkpoint: --resume goes on */
};

typedef struct message {
  char text[1024];
} message;

/** The file that messages name, and where they go. */
typedef struct file_place {
  const char *path;
  message *why;
} file_place;

/** Formats the sentence and returns `code`, so that a refusal is one statement: `return refuse(why, EXIT_USAGE, ...)`.
 */
int refuse(message *why, int code, const char *format, ...) __attribute__((format(printf, 3, 4)));

/** EXIT_FILES with "PATH: cannot WHAT: REASON", the reason being that of errno; EXIT_RUN if it is memory. */
int refuse_errno(const char *path, const char *what, message *why);

/** Copies text that somebody else wrote so that a terminal shows it and does not obey it: control characters, also
 * those of UTF-8 (C1), and bytes that are no UTF-8 as \x1b. @param to  [size], cut to fit, between characters */
void escape_text(const char *from, char *to, size_t size);

/** Flushes standard output. @returns `code`, or EXIT_FILES when that is 0 and something could not be printed */
int flush_output(int code, message *why);

#endif
