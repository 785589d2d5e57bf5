/* model.type: chain, particles on on-site springs, coupled to their neighbours by springs; and the linear chain without
 * damping, whose orbits have closed forms. */
#include "chain.h"

#include <stdlib.h>
#include <string.h>

#include "lattice_model.h"

int chain_model_init(chain_model *m, const study_values *v) {
  size_t n = (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
  *m = (chain_model){.chain = ric_chain_default(n, 0)};
  if (value_is_list(v, KEY_MODEL_FLOOR)) {
    m->floors = calloc(n, sizeof *m->floors);
    if (!m->floors)
      return -1;
  }
  chain_model_read(m, v);
  return 0;
}

void chain_model_clear(chain_model *m) {
  free(m->floors);
  m->floors = NULL;
}

static ric_ends ends_of(const study_values *v) {
  const char *word = value_word(v, KEY_MODEL_ENDS);
  if (strcmp(word, "fixed") == 0)
    return RIC_ENDS_FIXED;
  return strcmp(word, "free") == 0 ? RIC_ENDS_FREE : RIC_ENDS_PERIODIC;
}

void chain_model_read(chain_model *m, const study_values *v) {
  m->chain.ends = ends_of(v);
  m->chain.gamma = value_number(v, KEY_MODEL_GAMMA, 0);
  m->chain.floors = m->floors;
  if (!m->floors)
    m->chain.floor = value_number(v, KEY_MODEL_FLOOR, 0);
  for (size_t i = 0; m->floors && i < m->chain.particles; i++)
    m->floors[i] = value_number(v, KEY_MODEL_FLOOR, i);
}

/* --- as a lattice --- */

static ric_spring coupling(const study_values *v) {
  return (ric_spring){.linear = value_number(v, KEY_MODEL_GAMMA, 0),
                      .quadratic = value_number(v, KEY_MODEL_LINK_QUADRATIC, 0),
                      .cubic = value_number(v, KEY_MODEL_LINK_CUBIC, 0),
                      .damping = value_number(v, KEY_MODEL_LINK_DAMPING, 0)};
}

static void read_springs(lattice_model *m, const study_values *v) {
  m->lattice.ends = ends_of(v);
  m->lattice.on_sites = m->springs;
  m->lattice.on_site = lattice_model_spring(v, 0);
  m->lattice.link = coupling(v);
}

const model_type model_chain = {.choice = {.name = "chain",
                                           .summary = "particles on springs of their own, coupled to their neighbours",
                                           .groups = "lattice|chain",
                                           .features = MODEL_SYSTEM | MODEL_CHAIN,
                                           .particles = lattice_particles},
                                .read_springs = read_springs};
