/* Filling rows of gigabytes, whose memory is touched here first: a stop is heard meanwhile. */
#ifndef RICOCHET_APP_FILL_H
#define RICOCHET_APP_FILL_H

#include <stdbool.h>
#include <stddef.h>

#include <ricochet/status.h>

/** Sets bytes to zero. @returns false if stopped */
bool fill_zero(void *bytes, size_t size, ric_poll stop);

/** Sets numbers to NaN; NULL is none. @returns false if stopped */
bool fill_nan(double *numbers, size_t count, ric_poll stop);

#endif
