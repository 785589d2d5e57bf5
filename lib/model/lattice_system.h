/* A lattice as a system: internal to the library. */
#ifndef RICOCHET_LATTICE_SYSTEM_H
#define RICOCHET_LATTICE_SYSTEM_H

#include "system_model.h"

/** The lattice of a system whose `taylor` is SYSTEM_LATTICE; its arrays belong to the system. */
const ric_lattice *lattice_system_lattice(const ric_system *system);

#endif
