#include "ricochet/orbit.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

const char *ric_outcome_name(ric_outcome outcome) {
  switch (outcome) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_OUTCOME_LIST(X)
#undef X
  case RIC_OUTCOME_COUNT:
    break;
  }
  return "unknown outcome";
}

ric_orbit_options ric_orbit_options_default(void) {
  return (ric_orbit_options){.method = RIC_METHOD_IMPULSE,
                             .clearance_tol = 1e-12,
                             .grazing_tol = 1e-10,
                             .residual_tol = 1e-9,
                             .resonance_tol = 1e-10,
                             .singular_condition = 1e9};
}

ric_status ric_orbit_init(ric_orbit *orbit, size_t particles, size_t impacts, ric_error *error) {
  *orbit = (ric_orbit){.particles = particles, .impacts = impacts};
  if (particles < 1 || impacts < 1 || impacts > particles)
    return ric_fail(error, RIC_EINVAL, "orbit of %zu particles and %zu impacts, expected 1 <= impacts <= particles",
                    particles, impacts);
  double *store = particles < SIZE_MAX / 64 ? calloc(4 * particles + impacts, sizeof *store) : NULL;
  if (!store)
    return ric_fail(error, RIC_ENOMEM, "no memory for an orbit of %zu particles", particles);
  orbit->q = store;
  orbit->v = store + particles;
  orbit->q_half = store + 2 * particles;
  orbit->v_half = store + 3 * particles;
  orbit->impulse = store + 4 * particles;
  return RIC_OK;
}

void ric_orbit_clear(ric_orbit *orbit) {
  free(orbit->q); /* the one block behind all arrays */
  *orbit = (ric_orbit){0};
}
