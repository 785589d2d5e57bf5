/* Grazing motions, for the files that share them: internal to the room. */
#ifndef RICOCHET_GRAZING_PARTS_H
#define RICOCHET_GRAZING_PARTS_H

#include "family/family_parts.h"
#include "ricochet/grazing.h"
#include "touch.h"

/** Fills all that follows from the touch of a motion whose z, parameters and x, that of the touch, are there. The
 * family has its parameters. @returns as ric_grazing_local_find */
ric_status grazing_keep(const ric_family *family, const touch *touch, double period, ric_grazing *grazing,
                        ric_error *error);

#endif
