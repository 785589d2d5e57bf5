#include "message.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
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
  const int code = errno == ENOMEM ? EXIT_RUN : EXIT_FILES;
  return refuse(why, code, "%s: cannot %s: %s", path, what, strerror(errno));
}

void escape_text(const char *from, char *to, size_t size) {
  size_t used = 0;
  for (const unsigned char *at = (const unsigned char *)from; *at; at++) {
    const bool second = *at == 0xc2 && at[1] >= 0x80 && at[1] < 0xa0; /* C1 in UTF-8: two bytes */
    const bool control = *at < 0x20 || *at == 0x7f || second;
    if (used + (control ? 4 : 1) >= size)
      break;
    at += second;
    if (control)
      used += (size_t)snprintf(to + used, size - used, "\\x%02x", *at);
    else
      to[used++] = (char)*at;
  }
  if (size > 0)
    to[used] = '\0';
}

int flush_output(int code, message *why) {
  errno = 0;
  if ((fflush(stdout) == 0 && !ferror(stdout)) || code)
    return code;
  return refuse(why, EXIT_FILES, "ricochet: cannot write to standard output: %s",
                errno ? strerror(errno) : "an earlier failure");
}
