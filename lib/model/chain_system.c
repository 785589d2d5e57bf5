/* The system of a chain: its lattice, and its floors as obstacles. */
#include <math.h>
#include <stdlib.h>

#include "ricochet/system.h"

ric_status ric_system_create_chain(const ric_chain *chain, ric_system **system, ric_error *error) {
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
