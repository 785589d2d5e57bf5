#include "file_kind.h"

#include <sys/stat.h>

file_kind file_kind_of(const char *path) {
  struct stat there;
  if (lstat(path, &there) != 0)
    return FILE_ABSENT; /* or out of reach, which the call that uses the name reports */
  if (S_ISREG(there.st_mode))
    return FILE_REGULAR;
  if (S_ISDIR(there.st_mode))
    return FILE_FOLDER;
  return S_ISLNK(there.st_mode) ? FILE_LINK : FILE_OTHER;
}

int file_kind_expect(const char *path, file_kind wanted, message *why) {
  static const char *const words[] = {[FILE_REGULAR] = "a file",
                                      [FILE_FOLDER] = "a folder",
                                      [FILE_LINK] = "a symbolic link",
                                      [FILE_OTHER] = "neither a file nor a folder"};
  const file_kind found = file_kind_of(path);
  if (found == FILE_ABSENT || found == wanted)
    return 0;
  return refuse(why, EXIT_USAGE, "%s: is %s, expected the name of %s, or one that is free", path, words[found],
                words[wanted]);
}
