#include "source.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study.h"

/* Reads up to one byte more than a study may have, so that what is too large is seen to be. Not by asking for the size
 * first: a study may come through a pipe. */
static int read_stream(const char *path, FILE *file, char **text, size_t *length, message *why) {
  char *bytes = malloc(STUDY_MAX_BYTES + 1);
  if (!bytes)
    return refuse(why, EXIT_RUN, "%s: out of memory", path);
  *length = fread(bytes, 1, STUDY_MAX_BYTES + 1, file);
  int code = 0;
  if (ferror(file))
    code = refuse(why, EXIT_FILES, "%s: cannot be read: %s", path, strerror(errno));
  else if (*length > STUDY_MAX_BYTES)
    code = refuse(why, EXIT_USAGE, "%s: larger than %d MiB, the most a study may have", path, STUDY_MAX_BYTES >> 20);
  if (code) {
    free(bytes);
    return code;
  }
  bytes[*length] = 0;
  char *shrunk = realloc(bytes, *length + 1);
  *text = shrunk ? shrunk : bytes;
  return 0;
}

int study_read_file(const char *path, char **text, size_t *length, message *why) {
  FILE *file = fopen(path, "rb");
  if (!file)
    return refuse(why, EXIT_FILES, "%s: cannot be opened: %s", path, strerror(errno));
  const int code = read_stream(path, file, text, length, why);
  fclose(file);
  return code;
}

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
