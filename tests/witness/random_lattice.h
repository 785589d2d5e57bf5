/* Lattices with everything that a lattice can have, each constant of each particle its own. */
#ifndef RICOCHET_TESTS_RANDOM_LATTICE_H
#define RICOCHET_TESTS_RANDOM_LATTICE_H

#include <ricochet/ricochet.h>

#include "scenario/random_source.h"

enum { RANDOM_LATTICE_MOST = 1024 };

/** What a random lattice has beyond masses and linear springs. */
enum { WITH_SITES = 1, WITH_LINKS = 2, WITH_SITE_DAMPING = 4, WITH_LINK_DAMPING = 8, WITH_FORCING = 16, WITH_ALL = 31 };

typedef struct random_lattice {
  ric_lattice lattice; /* its arrays are those below */
  double masses[RANDOM_LATTICE_MOST], force_cos[RANDOM_LATTICE_MOST], force_sin[RANDOM_LATTICE_MOST];
  ric_spring on_sites[RANDOM_LATTICE_MOST], links[RANDOM_LATTICE_MOST + 1];
} random_lattice;

void random_lattice_set(random_lattice *r, random_source *source, size_t n, ric_ends ends, unsigned with);

void random_lattice_state(random_source *source, size_t n, double *q, double *v);

#endif
