/* A folder of its own for each test, removed with what is in it afterwards; and whole files in and out of memory. */
#ifndef RICOCHET_TESTS_TEMPORARY_FOLDER_H
#define RICOCHET_TESTS_TEMPORARY_FOLDER_H

#include "support.h"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

static inline void remove_folder(const char *folder) {
  DIR *entries = opendir(folder);
  if (!entries)
    return;
  for (struct dirent *entry; (entry = readdir(entries));) {
    char path[1024];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    if (entry->d_name[0] != '.' && length < (int)sizeof path && unlink(path) != 0)
      remove_folder(path);
  }
  closedir(entries);
  rmdir(folder);
}

/** cmocka set-up: *state becomes the name of an empty folder. */
static inline int make_temporary_folder(void **state) {
  static char name[64];
  strcpy(name, "/tmp/ricochet-test-XXXXXX");
  *state = mkdtemp(name);
  return *state ? 0 : -1;
}

/** cmocka tear-down. */
static inline int remove_temporary_folder(void **state) {
  remove_folder(*state);
  return 0;
}

/** Contents of a file, to be freed. */
static inline unsigned char *read_whole_file(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  struct stat status;
  assert_int_equal(fstat(fileno(file), &status), 0);
  *size = (size_t)status.st_size;
  unsigned char *bytes = malloc(*size + 1);
  assert_non_null(bytes);
  assert_int_equal(fread(bytes, 1, *size, file), *size);
  fclose(file);
  return bytes;
}

static inline void write_whole_file(const char *path, const void *bytes, size_t size) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

#endif
