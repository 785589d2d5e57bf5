#include "source.h"

#include <stdio.h>
#include <string.h>

int source_refuse_list(const source *from, size_t line, message *why, const char *format, va_list arguments) {
  if (from->lines)
    snprintf(why->text, sizeof why->text, "%s:%zu: ", from->name, line);
  else
    snprintf(why->text, sizeof why->text, "%s: ", from->name);
  const size_t used = strlen(why->text);
  vsnprintf(why->text + used, sizeof why->text - used, format, arguments);
  return EXIT_USAGE;
}

int source_refuse(const source *from, size_t line, message *why, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int code = source_refuse_list(from, line, why, format, arguments);
  va_end(arguments);
  return code;
}

void source_quote(const char *text, size_t length, char *quoted, size_t size) {
  const bool cut = length > size - 1;
  size_t kept = cut ? size - 4 : length;
  /* 10xxxxxx continues a UTF-8 character: a cut in front of one would split it. */
  while (cut && kept > 0 && ((unsigned char)text[kept] & 0xC0u) == 0x80u)
    kept--;
  for (size_t i = 0; i < kept; i++)
    quoted[i] = (unsigned char)text[i] < 0x20 || text[i] == 0x7f ? ' ' : text[i];
  memcpy(quoted + kept, cut ? "..." : "", cut ? 4 : 1);
}
