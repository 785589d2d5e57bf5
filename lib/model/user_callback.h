/* Callbacks of user systems: what their answers are checked for. */
#ifndef RICOCHET_USER_CALLBACK_H
#define RICOCHET_USER_CALLBACK_H

#include <stdbool.h>
#include <stddef.h>

/** Returns what went wrong (a static text) to the caller. */
#define TRY_TEXT(call)                                                                                                 \
  do {                                                                                                                 \
    const char *try_text = (call);                                                                                     \
    if (try_text)                                                                                                      \
      return try_text;                                                                                                 \
  } while (0)

/** The texts of a callback that returned non-zero, and of one whose values are not finite. */
#define CALLBACK_TEXTS(name) "the " name " callback failed", "the " name " callback gave a value that is not finite"

/** NULL, or the text that applies to a callback that returned `code` and filled x [count]. */
const char *callback_check(int code, const double *x, size_t count, const char *failed, const char *not_finite);

bool all_finite(const double *x, size_t count);

#endif
