#include "gsl_quiet.h"

#include <threads.h>

#include <gsl/gsl_errno.h>

static void switch_off(void) {
  gsl_set_error_handler_off();
}

void keep_gsl_quiet(void) {
  static once_flag once = ONCE_FLAG_INIT;
  call_once(&once, switch_off);
}

ric_status gsl_status(int code) {
  return code == GSL_ENOMEM ? RIC_ENOMEM : RIC_ENUMERIC;
}

const char *gsl_text(int code) {
  return code == GSL_ENOMEM ? "no memory" : gsl_strerror(code);
}
