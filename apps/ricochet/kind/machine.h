/* Memory and disk space of the machine. */
#ifndef RICOCHET_APP_MACHINE_H
#define RICOCHET_APP_MACHINE_H

#include "study/study.h"

/** Bytes free in the folder of a path; INFINITY if unknown. */
double machine_disk(const char *path);

/** "1.5 GB": a size for people. @returns text. */
const char *machine_size(double bytes, char *text, size_t size);

/** Refuses a study that needs more than the memory of this machine, at the place of model.particles, or of
 *  iterate.keep for maps.
 *  @param what  "an orbit". @returns 0 or EXIT_USAGE */
int machine_refuse_size(const study *s, const char *what, double bytes, message *why);

#endif
