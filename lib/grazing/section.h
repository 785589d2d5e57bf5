/* A Poincare section through a grazing motion: internal to the room. */
#ifndef RICOCHET_SECTION_H
#define RICOCHET_SECTION_H

#include "family/family.h"
#include "ricochet/grazing.h"

typedef struct section {
  const ric_grazing *g;
  const ric_family *f;
  bool forced;
  size_t numbers, state, size; /* n + m; with time; of the coordinates */
  double time, grazing_time;   /* at which the motion is on it; of the grazing point after that */
  double *normal;              /* [state] of length 1 */
  double *rates;               /* [state] F there, and 1 */
  double *basis;               /* [size][state] */
  double *matrix;              /* [numbers][numbers] derivative of the state */
  double *x, *from, *goes;     /* [numbers], [state], [state] */
  double *block;
} section;

/** Makes the section, and L, eta, xi and the stretch of the map on it.
 *  @returns as ric_grazing_section; close it in any case */
ric_status section_open(section *section, ric_family *family, const ric_grazing *grazing,
                        const ric_grazing_plane *plane, ric_grazing_map *map, ric_error *error);
void section_close(section *section);

#endif
