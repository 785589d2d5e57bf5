/* model.type: duffing_chain, particles in series: a lattice with fixed ends and without on-site springs, whose last
 * link has no stiffness. */
#include "lattice_model.h"

static void read_springs(lattice_model *m, const study_values *v) {
  (void)v;
  m->lattice.ends = RIC_ENDS_FIXED;
  m->lattice.links = m->springs;
  m->lattice.on_site = m->lattice.link = (ric_spring){0};
}

static const schema_default defaults[] = {{"model.floor", "null"}, {"orbit.method", "shooting"}, {0}};

const model_type model_duffing_chain = {
    .choice = {.name = "duffing_chain",
               .summary = "particles in series, joined by springs, the first one to the ground",
               .groups = "lattice",
               .features = MODEL_SYSTEM,
               .defaults = defaults,
               .last_keys = "model.wall",
               .particles = lattice_particles},
    .lists_springs = true,
    .read_springs = read_springs};
