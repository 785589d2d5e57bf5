/* What the machine has room for. */
#ifndef RICOCHET_APP_MACHINE_H
#define RICOCHET_APP_MACHINE_H

#include <stddef.h>

/** Bytes of physical memory; INFINITY when the system does not tell. */
double machine_memory(void);

/** Bytes free in the folder of a path; INFINITY when the system does not tell. */
double machine_disk(const char *path);

/** "1.5 GB": a size for people. @returns text. */
const char *machine_size(double bytes, char *text, size_t size);

#endif
