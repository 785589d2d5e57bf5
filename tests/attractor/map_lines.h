/* Maps along a parameter, and windows of their cycles, for tests. */
#ifndef RICOCHET_TESTS_MAP_LINES_H
#define RICOCHET_TESTS_MAP_LINES_H

#include <ricochet/ricochet.h>

/** Puts the numbers of a map into one of the same size. */
void map_copy(const ric_grazing_map *from, ric_grazing_map *to);

/** One map along d. @param map  borrowed */
ric_map_line map_line_along_d(ric_grazing_map *map);

/** The window of the cycle at p, which is stable and lies inside. Asserts that this works. */
ric_cycle_window cycle_window_of(const ric_map_line *line, double p, size_t period, double low, double high, double *z);

#endif
