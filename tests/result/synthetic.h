/* Made-up tables with every type of column, of any size: the same bytes on every rank, for every number of ranks. */
#ifndef RICOCHET_TESTS_SYNTHETIC_H
#define RICOCHET_TESTS_SYNTHETIC_H

#include "result/result.h"

typedef struct synthetic_size {
  size_t gammas, floors; /* points of the two sweeps; both 0: no sweep, one task */
  size_t particles, impacts;
  size_t special;    /* rows of the table that has no row per task */
  size_t text_bytes; /* of the study */
  size_t list;       /* numbers of the study's list */
} synthetic_size;

enum { SYNTHETIC_TABLES = 3 };

typedef struct synthetic {
  study *study;
  table layouts[SYNTHETIC_TABLES];
  result_table tables[SYNTHETIC_TABLES]; /* orbits, special, and one without rows */
  result_header header;
} synthetic;

/** What the file for `size` holds. @returns 0, or 1 when out of memory; synthetic_clear frees. */
int synthetic_init(synthetic *s, const synthetic_size *size, int ranks);
void synthetic_clear(synthetic *s);

/** Writes a file of small tables from this process alone, without MPI.
 *  @param list  numbers of the study's list
 *  @returns 0 or an exit code */
int synthetic_write(const char *path, size_t list);

/** Its groups have no cards. */
result_card *synthetic_card(const char *group);

#endif
