/* Lists that grow by doubling: internal to the library. */
#ifndef RICOCHET_LIST_H
#define RICOCHET_LIST_H

#include <stddef.h>
#include <stdlib.h>

/** Makes room for one more item after `count`. @returns the items, which may have moved; NULL without memory: they are
 *  unchanged. */
static inline void *list_room(void *items, size_t count, size_t *capacity, size_t item_bytes) {
  if (count < *capacity)
    return items;
  size_t more = *capacity ? 2 * *capacity : 16;
  void *moved = realloc(items, more * item_bytes);
  if (moved)
    *capacity = more;
  return moved;
}

#endif
