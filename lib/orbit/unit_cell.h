/* The unit cell: the shortest repeating piece of a pattern. Internal to the library. */
#ifndef RICOCHET_UNIT_CELL_H
#define RICOCHET_UNIT_CELL_H

#include <stdbool.h>
#include <stddef.h>

#include "ricochet/chain.h"
#include "ricochet/pattern.h"

/* The roles of a pattern as one array. */

/** Roles [particles], values of ric_role. */
const unsigned char *pattern_roles(const ric_pattern *pattern);

/* The smallest chain with the same motion as the whole one.
 *
 * A pattern that repeats every c particles of a ring has an orbit that repeats with it: the orbit of a ring of c. A
 * chain with free ends is half of a ring of 2 n with its mirror image, so it reduces when the mirrored pattern
 * repeats. At gamma = 0 every permutation is a symmetry, and one particle of each role stands for all. */

/** An impact of the cell. */
typedef struct contact {
  size_t site;
  ric_role role;
} contact;

typedef struct unit_cell {
  ric_chain chain;            /* of the cell; floors borrowed from the whole chain */
  const unsigned char *roles; /* of the whole pattern, borrowed */
  bool by_role;               /* gamma = 0: sites are classes of particles with the same role */
  size_t site_of_role[3];
  ric_role role_of_site[3];
  contact *contacts; /* [impacts], ordered by site */
  size_t impacts, capacity;
} unit_cell;

/** Sets the cell of a chain and a pattern; `cell` was zeroed once, and calls reuse its memory. */
ric_status unit_cell_find(unit_cell *cell, const ric_chain *chain, const ric_pattern *pattern, ric_error *error);

/** The same without any reduction: the cell is the chain. */
ric_status unit_cell_whole(unit_cell *cell, const ric_chain *chain, const ric_pattern *pattern, ric_error *error);
void unit_cell_clear(unit_cell *cell);

/** Number of sites of the cell, without setting it up; for estimates of memory. */
size_t unit_cell_sites(const ric_chain *chain, const ric_pattern *pattern);

/** Site of the cell with the motion of a particle. */
static inline size_t unit_cell_site(const unit_cell *cell, size_t particle) {
  return cell->by_role ? cell->site_of_role[cell->roles[particle]] : particle % cell->chain.particles;
}

/** Role of a site. */
ric_role unit_cell_role(const unit_cell *cell, size_t site);

/** First particle with the motion of a site. */
size_t unit_cell_particle(const unit_cell *cell, size_t site);

#endif
