/* Records: the rows of a table of which every task adds as many as it needs, those of one task after another. */
#ifndef RICOCHET_APP_RECORDS_H
#define RICOCHET_APP_RECORDS_H

#include <stddef.h>
#include <stdint.h>

typedef struct records {
  size_t record_bytes;  /* set by the owner before the first is added */
  unsigned char *bytes; /* [count][record_bytes] */
  uint64_t count, room;
} records;

/** Adds a record of zeros. @returns it, valid until the next one is added; NULL when out of memory. */
unsigned char *records_add(records *r);

/** Leaves the first `count`, which is at most their number; keeps the memory. */
void records_cut(records *r, uint64_t count);

void records_clear(records *r);

#endif
