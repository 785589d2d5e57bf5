#include "growing.h"

#include <stdlib.h>

void *growing_room(void *items, size_t count, size_t *capacity, size_t item_bytes) {
  if (count < *capacity)
    return items;
  size_t more = *capacity ? 2 * *capacity : 16;
  void *moved = realloc(items, more * item_bytes);
  if (moved)
    *capacity = more;
  return moved;
}
