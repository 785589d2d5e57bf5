#include "message.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
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

/* Bytes of the character of UTF-8 at this place; 0 if there is none. */
static size_t utf8_bytes(const unsigned char *at) {
  static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000}; /* of so many bytes; lower ones are written in fewer */
  const size_t count = *at < 0x80 ? 1 : *at >= 0xc0 && *at < 0xe0 ? 2 : *at >= 0xe0 && *at < 0xf0 ? 3 : 4;
  if (count == 1)
    return 1;
  if (*at < 0xc0 || *at >= 0xf8)
    return 0;
  uint32_t letter = *at & (0x7fu >> count);
  for (size_t i = 1; i < count; i++) {
    if ((at[i] & 0xc0) != 0x80)
      return 0;
    letter = letter << 6 | (at[i] & 0x3fu);
  }
  const bool surrogate = letter >= 0xd800 && letter < 0xe000;
  return letter >= least[count] && letter <= 0x10ffff && !surrogate ? count : 0;
}

/* Control characters, also the second set, C1, which takes two bytes. */
static bool is_control(const unsigned char *at) {
  return *at < 0x20 || *at == 0x7f || (*at == 0xc2 && at[1] < 0xa0);
}

void escape_text(const char *from, char *to, size_t size) {
  size_t used = 0, count;
  for (const unsigned char *at = (const unsigned char *)from; *at; at += count) {
    const size_t known = utf8_bytes(at);
    const bool escaped = known == 0 || is_control(at);
    count = known ? known : 1;
    if (used + (escaped ? 4 : count) >= size)
      break;
    if (escaped)
      used += (size_t)snprintf(to + used, size - used, "\\x%02x", at[count - 1]);
    else
      memcpy(to + used, at, count);
    used += escaped ? 0 : count;
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
