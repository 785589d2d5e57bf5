/* The document tree written out as YAML again: what a study with `--set` assignments really ran. */
#ifndef RICOCHET_APP_EMIT_H
#define RICOCHET_APP_EMIT_H

#include "document.h"

/** Writes the tree as YAML text that reads back as the same values. Comments are gone, the layout is libyaml's.
 *  @param text  set to malloc'd text with a terminating 0; the caller frees
 *  @returns 0, or EXIT_RUN when out of memory. */
int document_emit(const document *d, char **text, message *why);

#endif
