/* GSL's error handler, which ends the program when a call of GSL fails. */
#ifndef RICOCHET_GSL_QUIET_H
#define RICOCHET_GSL_QUIET_H

#include "ricochet/status.h"

/** Switches GSL's handler off, once in the life of the process: its calls then return their errors, which the library
 *  turns into statuses. To switch it back would race with other threads. A handler that the caller sets later stays. */
void keep_gsl_quiet(void);

/** RIC_ENOMEM or RIC_ENUMERIC, for a code that is not GSL_SUCCESS. */
ric_status gsl_status(int code);
/** What it means, for messages. */
const char *gsl_text(int code);

#endif
