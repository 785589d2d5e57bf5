/* The return map that a study's values describe. */
#ifndef RICOCHET_APP_GRAZING_MAP_H
#define RICOCHET_APP_GRAZING_MAP_H

#include <ricochet/ricochet.h>

#include "model.h"

/** Reads the map of the present task.
 *  @param map  empty, or of an earlier task; cleared by the caller, also after a failure
 *  @returns RIC_EINVAL as ric_grazing_map_check; RIC_ENOMEM */
ric_status grazing_map_read(ric_grazing_map *map, const study_values *v, ric_error *error);

/** Numbers of a state of the map. */
size_t grazing_map_size(const study *s);

#endif
