#include "user_callback.h"

#include <math.h>

const char *callback_check(int code, const double *x, size_t count, const char *failed, const char *not_finite) {
  if (code != 0)
    return failed;
  return all_finite(x, count) ? NULL : not_finite;
}

bool all_finite(const double *x, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(x[i]))
      return false;
  return true;
}
