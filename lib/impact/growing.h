/* Lists that grow by doubling: internal to the impact room. */
#ifndef RICOCHET_GROWING_H
#define RICOCHET_GROWING_H

#include <stddef.h>

/** Room for one more item after `count`. @returns the items, which may have moved; NULL without memory: they are as
 *  before. */
void *growing_room(void *items, size_t count, size_t *capacity, size_t item_bytes);

#endif
