/* Where a text came from, as messages begin: `FILE:LINE:`, or `--set path=value:`, whose lines are not worth naming. */
#ifndef RICOCHET_APP_SOURCE_H
#define RICOCHET_APP_SOURCE_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include "../base/message.h"

typedef struct source {
  const char *name; /* borrowed */
  bool lines;       /* messages name the line too */
} source;

/** A refusal that begins with the place. @param line  from 1. @returns EXIT_USAGE. */
int source_refuse(const source *from, size_t line, message *why, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int source_refuse_list(const source *from, size_t line, message *why, const char *format, va_list arguments)
    __attribute__((format(printf, 4, 0)));

/** Copies text for use inside a one-line message: control characters become blanks, and what does not fit into `size`
 *  bytes is cut between two characters and replaced by "...". @param size  at least 8. */
void source_quote(const char *text, size_t length, char *quoted, size_t size);

#endif
