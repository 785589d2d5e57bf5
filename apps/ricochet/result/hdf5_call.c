#include "hdf5_call.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What HDF5 itself forgets at its next call. */
static struct {
  message reason; /* of the first failure since the last one that was refused; empty: none */
  bool memory;    /* memory has been short since the start */
} failure;

/* Keeps the innermost description. */
static herr_t take_reason(unsigned depth, const H5E_error2_t *error, void *user) {
  message *reason = user;
  (void)depth;
  if (!error->desc || !error->desc[0])
    return 0;
  snprintf(reason->text, sizeof reason->text, "%s", error->desc);
  return 1;
}

/* HDF5 calls it at the end of each of its functions that fails, in place of printing its error stack. Not every record
 * of that says when memory was short; what the C library left does. */
static herr_t note_failure(hid_t stack, void *user) {
  message reason = {""};
  (void)user;
  failure.memory = failure.memory || errno == ENOMEM;
  (void)H5Ewalk2(stack, H5E_WALK_UPWARD, take_reason, &reason);
  if (!failure.reason.text[0])
    failure.reason = reason;
  return 0;
}

/* HDF5 does not survive that it gets no memory while it starts. */
static bool has_room(void) {
  enum { ROOM = 4 << 20 };
  void *room = malloc(ROOM);
  free(room);
  return room != NULL;
}

int hdf5_start(const file_place *at) {
  (void)H5dont_atexit(); /* at exit HDF5 would flush handles whose close failed, and crash; all others are closed */
  failure.reason.text[0] = '\0';
  failure.memory = false;
  errno = 0;
  const bool started = has_room() && H5Eset_auto2(H5E_DEFAULT, note_failure, NULL) >= 0;
  if (!started || errno == ENOMEM) /* HDF5 overlooks that a file driver could not be registered */
    return refuse(at->why, EXIT_RUN, "%s: HDF5 cannot start: out of memory", at->path);
  return 0;
}

void hdf5_out_of_memory(void) {
  failure.memory = true;
}

/* From 1.14 on HDF5 keeps nothing of what its filters say. In results they are checksums. */
static void name_the_filter(message *reason) {
  if (strcmp(reason->text, "filter returned failure during read") == 0)
    snprintf(reason->text, sizeof reason->text, "data error detected by a filter, the Fletcher32 checksum");
}

/* HDF5's own file drivers wrap the system's words: "..., errno = 28, error message = 'No space left on device', ...".
 */
static void keep_system_words(message *reason) {
  static const char lead[] = "error message = '";
  char *words = strstr(reason->text, lead);
  if (!words)
    return;
  words += sizeof lead - 1;
  size_t length = strcspn(words, "'");
  memmove(reason->text, words, length);
  reason->text[length] = '\0';
}

int hdf5_refuse(const file_place *at, const char *what, ...) {
  message task, reason = failure.reason;
  failure.memory = failure.memory || errno == ENOMEM; /* the tools above HDF5's functions fail without a word */
  failure.reason.text[0] = '\0';
  if (failure.memory || !reason.text[0])
    snprintf(reason.text, sizeof reason.text, "%s", failure.memory ? "out of memory" : "unknown reason");
  name_the_filter(&reason);
  keep_system_words(&reason);
  va_list arguments;
  va_start(arguments, what);
  vsnprintf(task.text, sizeof task.text, what, arguments);
  va_end(arguments);
  return refuse(at->why, failure.memory ? EXIT_RUN : EXIT_FILES, "%s: cannot %s: %s", at->path, task.text, reason.text);
}

static herr_t close_by_type(hid_t handle) {
  switch (H5Iget_type(handle)) {
  case H5I_FILE:
    return H5Fclose(handle);
  case H5I_GROUP:
    return H5Gclose(handle);
  case H5I_DATASET:
    return H5Dclose(handle);
  case H5I_DATATYPE:
    return H5Tclose(handle);
  case H5I_DATASPACE:
    return H5Sclose(handle);
  case H5I_ATTR:
    return H5Aclose(handle);
  case H5I_GENPROP_LST:
    return H5Pclose(handle);
  default:
    return H5Idec_ref(handle);
  }
}

int hdf5_close(const file_place *at, hid_t handle, int code) {
  if (handle >= 0 && close_by_type(handle) < 0 && !code)
    code = hdf5_refuse(at, "close it");
  if (failure.memory && (!code || code == EXIT_FILES))
    code = refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  return code;
}
