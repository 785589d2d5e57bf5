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

static ric_status allocate(ric_orbit *orbit, size_t coordinates, size_t speeds, size_t impacts, ric_error *error) {
  size_t numbers = 2 * (coordinates + speeds) + 3 * impacts;
  *orbit = (ric_orbit){.particles = coordinates, .speeds = speeds, .impacts = impacts};
  bool fits = coordinates < SIZE_MAX / 128 && speeds < SIZE_MAX / 128 && impacts < SIZE_MAX / 128;
  double *store = fits ? calloc(numbers, sizeof *store) : NULL;
  orbit->impact_obstacle = store ? calloc(impacts + 1, sizeof *orbit->impact_obstacle) : NULL;
  if (!orbit->impact_obstacle) {
    free(store);
    return ric_fail(error, RIC_ENOMEM, "no memory for an orbit of %zu particles", coordinates);
  }
  orbit->q = store;
  orbit->v = orbit->q + coordinates;
  orbit->q_half = orbit->v + speeds;
  orbit->v_half = orbit->q_half + coordinates;
  orbit->impulse = orbit->v_half + speeds;
  orbit->impact_time = orbit->impulse + impacts;
  orbit->gap_rate = orbit->impact_time + impacts;
  return RIC_OK;
}

ric_status ric_orbit_init(ric_orbit *orbit, size_t particles, size_t impacts, ric_error *error) {
  *orbit = (ric_orbit){.particles = particles, .impacts = impacts};
  if (particles < 1 || impacts < 1 || impacts > particles)
    return ric_fail(error, RIC_EINVAL, "orbit of %zu particles and %zu impacts, expected 1 <= impacts <= particles",
                    particles, impacts);
  return allocate(orbit, particles, particles, impacts, error);
}

ric_status ric_orbit_init_for(ric_orbit *orbit, const ric_system *system, size_t impacts, ric_error *error) {
  return allocate(orbit, ric_system_coordinates(system), ric_system_speeds(system), impacts, error);
}

void ric_orbit_clear(ric_orbit *orbit) {
  free(orbit->q); /* the one block behind all arrays of numbers */
  free(orbit->impact_obstacle);
  *orbit = (ric_orbit){0};
}
