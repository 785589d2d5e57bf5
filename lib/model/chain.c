/* The chain: its numbers, forces and energy, and the system that is made of one. */
#include <math.h>
#include <stdlib.h>

#include "image_ring.h"
#include "numeric/constants.h"
#include "numeric/required.h"
#include "ricochet/chain.h"
#include "ricochet/system.h"

ric_chain ric_chain_default(size_t particles, double gamma) {
  return (ric_chain){.particles = particles, .ends = RIC_ENDS_PERIODIC, .gamma = gamma, .floor = -1};
}

static ric_status check_floors(const ric_chain *chain, ric_error *error) {
  for (size_t i = 0; i < (chain->floors ? chain->particles : 1); i++) {
    double b = ric_chain_floor(chain, i);
    if (!(b < INFINITY))
      return ric_fail(error, RIC_EINVAL, "floor of particle %zu = %g, expected a finite number or -infinity", i, b);
  }
  return RIC_OK;
}

ric_status ric_chain_check(const ric_chain *chain, ric_error *error) {
  REQUIRE(error, {"chain", chain});
  if (chain->particles < 1)
    return ric_fail(error, RIC_EINVAL, "particles = 0, expected at least 1");
  if (chain->ends != RIC_ENDS_PERIODIC && chain->ends != RIC_ENDS_FIXED && chain->ends != RIC_ENDS_FREE)
    return ric_fail(error, RIC_EINVAL, "ends = %d, expected periodic, fixed or free", (int)chain->ends);
  if (!(chain->gamma >= 0 && chain->gamma < INFINITY))
    return ric_fail(error, RIC_EINVAL, "gamma = %g, expected 0 <= gamma < infinity", chain->gamma);
  return check_floors(chain, error);
}

void ric_chain_acceleration(const ric_chain *chain, const double *q, double *acceleration) {
  ptrdiff_t n = (ptrdiff_t)chain->particles;
  double gamma = image_ring_gamma(chain);
  for (ptrdiff_t i = 0; i < n; i++) {
    double left = i > 0 ? q[i - 1] : image_ring_value(chain, q, -1);
    double right = i < n - 1 ? q[i + 1] : image_ring_value(chain, q, n);
    acceleration[i] = -q[i] + gamma * (left - 2 * q[i] + right); /* [JAP] (1) */
  }
}

double ric_chain_energy(const ric_chain *chain, const double *q, const double *v) {
  size_t last = chain->particles - 1;
  double twice = 0, stretched = 0;
  for (size_t i = 0; i <= last; i++)
    twice += v[i] * v[i] + q[i] * q[i];
  for (size_t i = 0; i < last; i++)
    stretched += (q[i + 1] - q[i]) * (q[i + 1] - q[i]);
  if (chain->ends == RIC_ENDS_PERIODIC && last >= 2)
    stretched += (q[0] - q[last]) * (q[0] - q[last]);
  if (chain->ends == RIC_ENDS_FIXED)
    stretched += q[0] * q[0] + q[last] * q[last];
  return (twice + chain->gamma * stretched) / 2;
}

ric_status ric_system_create_chain(const ric_chain *chain, ric_system **system, ric_error *error) {
  REQUIRE(error, {"chain", chain}, {"system", system});
  *system = NULL;
  RIC_TRY(ric_chain_check(chain, error));
  ric_lattice lattice = ric_lattice_of_chain(chain);
  ric_obstacle *floors = malloc(chain->particles * sizeof *floors);
  size_t count = 0;
  if (!floors)
    return ric_fail(error, RIC_ENOMEM, "no memory for the floors of %zu particles", chain->particles);
  for (size_t i = 0; i < chain->particles; i++)
    if (ric_chain_floor(chain, i) > -INFINITY)
      floors[count++] = ric_obstacle_floor(i, ric_chain_floor(chain, i));
  ric_status status = ric_system_create_lattice(&lattice, floors, count, system, error);
  free(floors);
  return status;
}
