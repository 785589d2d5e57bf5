/* What the files of the room share: the coefficients of grazing at a state, and Poincare sections through a grazing
 * motion. Internal to the room. */
#ifndef RICOCHET_INTERNAL_GRAZING_H
#define RICOCHET_INTERNAL_GRAZING_H

#include "family/family.h"
#include "model/system_model.h"
#include "ricochet/bypass.h"
#include "ricochet/grazing.h"
#include <stdbool.h>

/* --- local.c --- */

/** @returns RIC_EINVAL for an unknown or compliant obstacle. */
ric_status grazing_check_obstacle(const ric_system *system, size_t obstacle, ric_error *error);

/** @returns RIC_ECALLBACK with the failure in the message. */
ric_status grazing_callback_error(double t, size_t obstacle, const char *trouble, ric_error *error);

/** Gap rate and its rate of change along the free motion. @param rates  [n + m] work, set to those of the state */
ric_status grazing_rates(const ric_system *system, size_t obstacle, double t, const double *x, double *rates,
                         double *rate, double *acceleration, ric_error *error);

/** @returns RIC_EINVAL if the numbers of a grazing point do not belong to this system, or A_g is not positive. */
ric_status grazing_check_local(const ric_grazing_local *local, const ric_system *system, ric_error *error);

/* --- section.c --- */

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
