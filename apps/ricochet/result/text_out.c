#include "text_out.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

int text_out_finish(int code, message *why) {
  errno = 0;
  if ((fflush(stdout) == 0 && !ferror(stdout)) || code)
    return code;
  return refuse(why, EXIT_FILES, "ricochet: cannot write to standard output: %s",
                errno ? strerror(errno) : "an earlier failure");
}
