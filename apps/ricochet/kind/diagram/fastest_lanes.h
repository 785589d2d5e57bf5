/* The variant of the map kernel that is fastest on this processor, measured: the widest need not be. */
#ifndef RICOCHET_APP_FASTEST_LANES_H
#define RICOCHET_APP_FASTEST_LANES_H

#include <ricochet/ricochet.h>

/** A few milliseconds of work. @param size  of the maps  @param exponents  that are wanted */
ric_map_lanes fastest_lanes(size_t size, size_t exponents);

#endif
