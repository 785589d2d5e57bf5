/* Common checks and gap rates of an obstacle for the functions of grazing: internal to the room. */
#ifndef RICOCHET_LOCAL_H
#define RICOCHET_LOCAL_H

#include <stdbool.h>

#include "model/system_model.h"
#include "ricochet/bypass.h"

/** @returns RIC_EINVAL for an unknown or compliant obstacle. */
ric_status grazing_check_obstacle(const ric_system *system, size_t obstacle, ric_error *error);

/** @returns RIC_ECALLBACK with the failure in the message. */
ric_status grazing_callback_error(double t, size_t obstacle, const char *trouble, ric_error *error);

/** Gap rate and its rate of change along the free motion. @param rates  [n + m] work, set to those of the state */
ric_status grazing_rates(const ric_system *system, size_t obstacle, double t, const double *x, double *rates,
                         double *rate, double *acceleration, ric_error *error);

/** @returns RIC_EINVAL if the numbers of a grazing point do not belong to this system, or A_g is not positive. */
ric_status grazing_check_local(const ric_grazing_local *local, const ric_system *system, ric_error *error);

#endif
