/* The unit cell: the shortest repeating piece of a pattern. */
#include "unit_cell.h"

#include <stdlib.h>
#include <string.h>

static bool repeats_on_ring(const ric_chain *chain, const unsigned char *roles, size_t c) {
  size_t rest = chain->particles - c;
  if (memcmp(roles, roles + c, rest) != 0)
    return false;
  for (size_t i = 0; chain->floors && i < rest; i++)
    if (chain->floors[i] != chain->floors[i + c])
      return false;
  return true;
}

/* On the ring of 2 n of a free chain and its mirror image. */
static bool repeats_with_mirror(const ric_chain *chain, const unsigned char *roles, size_t c) {
  size_t n = chain->particles;
  for (size_t i = 0; i < 2 * n; i++) {
    size_t next = (i + c) % (2 * n), a = i < n ? i : 2 * n - 1 - i, b = next < n ? next : 2 * n - 1 - next;
    if (roles[a] != roles[b] || ric_chain_floor(chain, a) != ric_chain_floor(chain, b))
      return false;
  }
  return true;
}

static size_t common_divisor(size_t a, size_t b) {
  while (b != 0) {
    size_t rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

/* Smallest c < n after which roles and floors repeat, n if there is none. All cells have the same number of impacts,
 * so the number of cells divides both; few candidates remain. */
static size_t period_of(const ric_chain *chain, const ric_pattern *pattern) {
  const unsigned char *roles = pattern_roles(pattern);
  size_t n = chain->particles, m = ric_pattern_impacts(pattern);
  bool ring = chain->ends == RIC_ENDS_PERIODIC;
  if (chain->ends == RIC_ENDS_FIXED)
    return n;
  size_t sites = ring ? n : 2 * n, most = common_divisor(sites, ring ? m : 2 * m);
  for (size_t cells = most; sites / cells < n; cells--) {
    if (most % cells != 0)
      continue;
    size_t c = sites / cells;
    if (ring ? repeats_on_ring(chain, roles, c) : repeats_with_mirror(chain, roles, c))
      return c;
  }
  return n;
}

/* Numbers the roles that occur; returns how many. */
static size_t classes_of(const ric_chain *chain, const unsigned char *roles, size_t site_of_role[3],
                         ric_role role_of_site[3]) {
  bool occurs[3] = {false, false, false};
  for (size_t i = 0; i < chain->particles; i++)
    occurs[roles[i]] = true;
  size_t sites = 0;
  for (int role = 0; role < 3; role++) {
    site_of_role[role] = sites;
    if (occurs[role])
      role_of_site[sites++] = (ric_role)role;
  }
  return sites;
}

/* Number of classes when the particles are not coupled and a class stands for several of them, else 0. */
static size_t classes_when_decoupled(const ric_chain *chain, const unsigned char *roles, size_t site_of_role[3],
                                     ric_role role_of_site[3]) {
  if (chain->gamma != 0 || chain->floors)
    return 0;
  size_t classes = classes_of(chain, roles, site_of_role, role_of_site);
  return classes < chain->particles ? classes : 0;
}

size_t unit_cell_sites(const ric_chain *chain, const ric_pattern *pattern) {
  size_t site_of_role[3];
  ric_role role_of_site[3];
  size_t classes = classes_when_decoupled(chain, pattern_roles(pattern), site_of_role, role_of_site);
  return classes > 0 ? classes : period_of(chain, pattern);
}

ric_role unit_cell_role(const unit_cell *cell, size_t site) {
  return cell->by_role ? cell->role_of_site[site] : (ric_role)cell->roles[site];
}

size_t unit_cell_particle(const unit_cell *cell, size_t site) {
  size_t particle = cell->by_role ? 0 : site;
  while (cell->by_role && unit_cell_site(cell, particle) != site)
    particle++;
  return particle;
}

static ric_status list_contacts(unit_cell *cell, ric_error *error) {
  size_t sites = cell->chain.particles, count = 0;
  for (size_t s = 0; s < sites; s++)
    count += unit_cell_role(cell, s) != RIC_ROLE_FREE;
  if (count > cell->capacity) {
    contact *more = realloc(cell->contacts, count * sizeof *more);
    if (!more)
      return ric_fail(error, RIC_ENOMEM, "no memory for %zu impacts", count);
    cell->contacts = more;
    cell->capacity = count;
  }
  cell->impacts = 0;
  for (size_t s = 0; s < sites; s++)
    if (unit_cell_role(cell, s) != RIC_ROLE_FREE)
      cell->contacts[cell->impacts++] = (contact){.site = s, .role = unit_cell_role(cell, s)};
  return RIC_OK;
}

ric_status unit_cell_whole(unit_cell *cell, const ric_chain *chain, const ric_pattern *pattern, ric_error *error) {
  cell->chain = *chain;
  cell->roles = pattern_roles(pattern);
  cell->by_role = false;
  return list_contacts(cell, error);
}

ric_status unit_cell_find(unit_cell *cell, const ric_chain *chain, const ric_pattern *pattern, ric_error *error) {
  size_t n = chain->particles;
  cell->chain = *chain;
  cell->roles = pattern_roles(pattern);
  size_t classes = classes_when_decoupled(chain, cell->roles, cell->site_of_role, cell->role_of_site);
  cell->by_role = classes > 0;
  if (cell->by_role) {
    cell->chain.particles = classes;
    cell->chain.ends = RIC_ENDS_FREE;
    return list_contacts(cell, error);
  }
  cell->chain.particles = period_of(chain, pattern);
  if (cell->chain.particles < n) {
    cell->chain.ends = RIC_ENDS_PERIODIC;
    if (cell->chain.particles == 2)
      cell->chain.gamma *= 2; /* neighbours on both sides are the same particle; a ring of two has one spring */
  }
  return list_contacts(cell, error);
}

void unit_cell_clear(unit_cell *cell) {
  free(cell->contacts);
  *cell = (unit_cell){0};
}
