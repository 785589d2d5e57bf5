/* Studies that start at a point of an earlier result: what they take from there. */
#ifndef RICOCHET_APP_RESTART_H
#define RICOCHET_APP_RESTART_H

#include <stddef.h>

#include "../study/study.h"

/** Reads a study from its file, once. One that restarts is replaced by one that says itself where it starts, its
 * `--set` values included, so that its result can be run again without the earlier one.
 *  @param path  of the study, also for messages
 *  @param out  NULL after a refusal
 *  @returns 0 or the exit code of a study, or of a result, that is refused */
int restart_read_study(const char *path, const char *const *sets, size_t set_count, study **out, message *why);

#endif
