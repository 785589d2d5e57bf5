#include "ricochet/attractor.h"

#include <math.h>

ric_attractor_options ric_attractor_options_default(void) {
  return (ric_attractor_options){
      .transient = 9000, .keep = 1000, .measure = 1000, .period_limit = 64, .period_tol = 1e-6, .bound = 1e100};
}

enum { MOST_PERIOD = 100000 };
static const double most_iterates = 0x1p52; /* their sum is then a number of any kind */

ric_status ric_attractor_options_check(const ric_attractor_options *o, size_t size, ric_error *error) {
  if (!((double)o->transient <= most_iterates))
    return ric_fail(error, RIC_EINVAL, "transient = %zu, expected at most %.0f", o->transient, most_iterates);
  if (!(o->measure >= 1 && (double)o->measure <= most_iterates))
    return ric_fail(error, RIC_EINVAL, "measure = %zu, expected 1 to %.0f", o->measure, most_iterates);
  if (o->keep > o->measure)
    return ric_fail(error, RIC_EINVAL, "keep = %zu, expected at most measure = %zu", o->keep, o->measure);
  if (o->observe >= size)
    return ric_fail(error, RIC_EINVAL, "observe = %zu, expected a number of a state of %zu", o->observe, size);
  if (o->exponents > size)
    return ric_fail(error, RIC_EINVAL, "exponents = %zu, expected at most %zu, the size of the state", o->exponents,
                    size);
  if (o->period_limit < 1 || o->period_limit > MOST_PERIOD)
    return ric_fail(error, RIC_EINVAL, "period_limit = %zu, expected 1 to %d", o->period_limit, MOST_PERIOD);
  if (!(o->period_tol > 0 && o->period_tol < 1))
    return ric_fail(error, RIC_EINVAL, "period_tol = %g, expected 0 < period_tol < 1", o->period_tol);
  if (!(o->bound > 0 && isfinite(o->bound)))
    return ric_fail(error, RIC_EINVAL, "bound = %g, expected a finite number > 0", o->bound);
  return RIC_OK;
}

const char *ric_attractor_kind_name(ric_attractor_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_ATTRACTOR_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_ATTRACTOR_KINDS ? names[kind] : "unknown";
}

const char *ric_map_lanes_name(ric_map_lanes lanes) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_MAP_LANES_LIST(X)
#undef X
  };
  return (unsigned)lanes < RIC_MAP_LANES_KINDS ? names[lanes] : "unknown";
}
