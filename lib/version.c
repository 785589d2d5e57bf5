#include "ricochet/version.h"

#include <fftw3.h>
#include <gsl/gsl_version.h>
#include <sundials/sundials_config.h>

const char *ric_version(void) {
  return RIC_VERSION;
}

const char *ric_libraries(void) {
  return "GSL " GSL_VERSION ", FFTW " RIC_FFTW_VERSION ", SLEEF " RIC_SLEEF_VERSION ", SUNDIALS " SUNDIALS_VERSION;
}
