/* Refusing NULL: what every public function that can fail does first. Internal to the library.
 *
 *   REQUIRE(error, {"chain", chain}, {"times", unless_empty(count, times)});
 *
 * Names are those of the header. A test calls every function with NULL in the place of each of its pointers. */
#ifndef RICOCHET_REQUIRED_H
#define RICOCHET_REQUIRED_H

#include "ricochet/status.h"

typedef struct required_pointer {
  const char *name;
  const void *value;
} required_pointer;

/** Returns RIC_EINVAL with the name to the caller if a pointer is NULL. */
#define REQUIRE(error, ...)                                                                                            \
  do {                                                                                                                 \
    const required_pointer required[] = {__VA_ARGS__};                                                                 \
    for (size_t required_index = 0; required_index < sizeof required / sizeof *required; required_index++)             \
      if (!required[required_index].value)                                                                             \
        return ric_fail((error), RIC_EINVAL, "%s = NULL, expected a pointer", required[required_index].name);          \
  } while (0)

/** An array of length 0 may be NULL. */
static inline const void *unless_empty(size_t count, const void *array) {
  return count > 0 ? array : "";
}

/** Stands for a callback, whose address is none of an object. */
static inline const void *called(int is_given) {
  return is_given ? "" : NULL;
}

#endif
