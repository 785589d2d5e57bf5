/* _SC_PHYS_PAGES is not in POSIX. */
#define _DEFAULT_SOURCE
#include "machine.h"
#include "keys.h"

#include <libgen.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

/* Bytes of physical memory; INFINITY if unknown. */
static double machine_memory(void) {
  long pages = sysconf(_SC_PHYS_PAGES), bytes = sysconf(_SC_PAGESIZE);
  return pages > 0 && bytes > 0 ? (double)pages * (double)bytes : INFINITY;
}

double machine_disk(const char *path) {
  struct statvfs disk;
  char *copy = strdup(path);
  double bytes = INFINITY;
  if (copy && statvfs(dirname(copy), &disk) == 0)
    bytes = (double)disk.f_bavail * (double)disk.f_frsize;
  free(copy);
  return bytes;
}

const char *machine_size(double bytes, char *text, size_t size) {
  static const char *const units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  size_t u = 0;
  while (bytes >= 999.5 && u + 1 < sizeof units / sizeof *units) {
    bytes /= 1000;
    u++;
  }
  snprintf(text, size, "%.3g %s", bytes, units[u]);
  return text;
}

int machine_refuse_size(const study *s, const char *what, double bytes, message *why) {
  char place[256], needed[32], there[32];
  if (bytes <= machine_memory())
    return 0;
  study_place(s, model_has(s, MODEL_MAP) ? KEY_ITERATE_KEEP : KEY_MODEL_PARTICLES, place, sizeof place);
  return refuse(why, EXIT_USAGE, "%s: %s of this size needs %s of memory, expected at most the %s of this machine",
                place, what, machine_size(bytes, needed, sizeof needed),
                machine_size(machine_memory(), there, sizeof there));
}
