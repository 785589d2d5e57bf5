#include "message.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int refuse(message *why, int code, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(why->text, sizeof why->text, format, arguments);
  va_end(arguments);
  return code;
}

int refuse_errno(const char *path, const char *what, message *why) {
  return refuse(why, EXIT_FILES, "%s: cannot %s: %s", path, what, strerror(errno));
}

int flush_output(int code, message *why) {
  errno = 0;
  if ((fflush(stdout) == 0 && !ferror(stdout)) || code)
    return code;
  return refuse(why, EXIT_FILES, "ricochet: cannot write to standard output: %s",
                errno ? strerror(errno) : "an earlier failure");
}
