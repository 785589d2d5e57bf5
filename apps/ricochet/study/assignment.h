/* `--set path=value`: an edit of the document tree, made before anything is validated, so that it meets the same
 * checks, and the same messages, as a line of the file.
 *
 * The path is names joined by dots, list elements by index: `model.gamma`, `sweep[0].points`. The value is YAML, read
 * through the same guard as a file. Missing keys and sections are created; list elements must exist. */
#ifndef RICOCHET_APP_ASSIGNMENT_H
#define RICOCHET_APP_ASSIGNMENT_H

#include "document.h"

/** @param assignment  "path=value", copied. @returns 0, EXIT_USAGE, or EXIT_RUN when out of memory. */
int document_assign(document *d, const char *assignment, message *why);

#endif
