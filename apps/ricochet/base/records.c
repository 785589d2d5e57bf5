#include "records.h"

#include <stdlib.h>
#include <string.h>

unsigned char *records_add(records *r) {
  if (r->count == r->room) {
    const uint64_t room = r->room ? 2 * r->room : 64;
    unsigned char *more = room > SIZE_MAX / r->record_bytes ? NULL : realloc(r->bytes, room * r->record_bytes);
    if (!more)
      return NULL;
    r->bytes = more;
    r->room = room;
  }
  unsigned char *added = r->bytes + r->count++ * r->record_bytes;
  memset(added, 0, r->record_bytes);
  return added;
}

void records_cut(records *r, uint64_t count) {
  r->count = count;
}

void records_clear(records *r) {
  free(r->bytes);
  *r = (records){.record_bytes = r->record_bytes};
}
