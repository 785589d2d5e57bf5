/* Studies that start at a point of an earlier result: what they take from there. */
#ifndef RICOCHET_APP_RESTART_H
#define RICOCHET_APP_RESTART_H

#include <stdbool.h>
#include <stddef.h>

#include "../base/message.h"

/** Replaces the text of a study that restarts by one that says itself where it starts, its `--set` values included, so
 *  that its result can be run again without the earlier one.
 *  @param path  of the study, for messages
 *  @param text  malloc'd, exchanged where the study restarts
 *  @param complete  whether it was: no `--set` values are to be applied any more
 *  @returns 0 or the exit code of a study, or of a result, that is refused */
int restart_resolve(const char *path, char **text, size_t *length, const char *const *sets, size_t set_count,
                    bool *complete, message *why);

#endif
