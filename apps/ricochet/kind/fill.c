#include "fill.h"

#include <math.h>
#include <string.h>

enum { STEP_BYTES = 16 << 20 /* between two polls */ };

static size_t least(size_t a, size_t b) {
  return a < b ? a : b;
}

bool fill_zero(void *bytes, size_t size, ric_poll stop) {
  for (size_t done = 0; done < size; done += STEP_BYTES) {
    if (ric_poll_stops(stop))
      return false;
    memset((unsigned char *)bytes + done, 0, least(size - done, STEP_BYTES));
  }
  return true;
}

bool fill_nan(double *numbers, size_t count, ric_poll stop) {
  enum { STEP = STEP_BYTES / sizeof *numbers };
  for (size_t done = 0; numbers && done < count; done += STEP) {
    if (ric_poll_stops(stop))
      return false;
    for (size_t i = done; i < done + least(count - done, STEP); i++)
      numbers[i] = NAN;
  }
  return true;
}
