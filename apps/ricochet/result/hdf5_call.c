#include "hdf5_call.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void hdf5_quiet(void) {
  (void)H5dont_atexit(); /* at exit HDF5 would flush handles whose close failed, and crash; all others are closed */
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* fails only on a bad stack, and prints nothing then either */
}

/* Copies the innermost non-empty description and ends the iteration. */
static herr_t take_reason(unsigned depth, const H5E_error2_t *error, void *user) {
  message *reason = user;
  (void)depth;
  if (!error->desc || !error->desc[0])
    return 0;
  snprintf(reason->text, sizeof reason->text, "%s", error->desc);
  return 1;
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
  message reason = {"unknown reason"}, task;
  (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_reason, &reason);
  name_the_filter(&reason);
  keep_system_words(&reason);
  va_list arguments;
  va_start(arguments, what);
  vsnprintf(task.text, sizeof task.text, what, arguments);
  va_end(arguments);
  return refuse(at->why, EXIT_FILES, "%s: cannot %s: %s", at->path, task.text, reason.text);
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
  if (handle < 0 || close_by_type(handle) >= 0 || code)
    return code;
  return hdf5_refuse(at, "close it");
}
