/* The commands of the program. Each parses its own arguments (argv[0] is the command's name), prints its message and
 * returns the exit code. */
#ifndef RICOCHET_APP_COMMAND_H
#define RICOCHET_APP_COMMAND_H

#include "../base/message.h"

int command_run(int argc, char **argv);
int command_check(int argc, char **argv);
int command_show(int argc, char **argv);
int command_examples(int argc, char **argv);

/** The option that getopt_long has just refused, as the user wrote it. @param text  [3] for a short one */
const char *refused_option(char **argv, char text[3]);

/** Prints "ricochet: MESSAGE" on standard error, or MESSAGE alone if it begins with a place; returns code. */
int complain(int code, const message *why);

/** Flushes standard output; a failed write is EXIT_FILES. */
int finish_output(int code);

/** The build of the program, for --version and the result's attributes. */
const char *build_version(void);
const char *build_git_sha(void);
const char *build_compiler(void);
const char *build_libraries(void);

#endif
