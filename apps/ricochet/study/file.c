#include "study.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
