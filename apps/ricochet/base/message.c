#include "message.h"

#include <stdarg.h>
#include <stdio.h>

int refuse(message *why, int code, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(why->text, sizeof why->text, format, arguments);
  va_end(arguments);
  return code;
}
