#include "ricochet/status.h"

#include <stdarg.h>
#include <stdio.h>

const char *ric_status_text(ric_status status) {
  switch (status) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_STATUS_LIST(X)
#undef X
  }
  return "unknown status";
}

static _Thread_local unsigned long refusals;

unsigned long ric_memory_refusals(void) {
  return refusals;
}

ric_status ric_fail(ric_error *error, ric_status status, const char *format, ...) {
  refusals += status == RIC_ENOMEM;
  if (error) {
    va_list arguments;
    va_start(arguments, format);
    error->status = status;
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
  }
  return status;
}
