/* Which grazing points the theory does not cover: internal to the room. Refusals are RIC_ENUMERIC and name the
 * condition. */
#ifndef RICOCHET_DEGENERATE_H
#define RICOCHET_DEGENERATE_H

#include "ricochet/grazing.h"
#include "touch.h"

/** How much the gap of an obstacle changes along a motion: largest less smallest, of samples. */
ric_status degenerate_size(ric_shooting *shooting, const double *z, double given, size_t obstacle, double *size,
                           ric_error *error);

/** A_g near zero. */
ric_status degenerate_acceleration(const touch *touch, double period, double size, const ric_grazing_options *options,
                                   ric_error *error);

/** Other grazing points, and impacts that are not transversal: by an event-driven run over a period. */
ric_status degenerate_motion(ric_family *family, const double *z, const ric_grazing *grazing, double size,
                             const ric_grazing_options *options, ric_error *error);

#endif
