/* The lattice, its obstacles and the state at t = 0 that a study's values describe. */
#ifndef RICOCHET_APP_LATTICE_MODEL_H
#define RICOCHET_APP_LATTICE_MODEL_H

#include <stdbool.h>

#include <ricochet/ricochet.h>

#include "model.h"

/** A lattice with the storage of its lists. */
typedef struct lattice_model {
  ric_lattice lattice;
  double *masses;      /* [particles] when the study lists them, else NULL */
  ric_spring *springs; /* [particles + 1] those of a Duffing chain, or of a chain that lists them; else NULL */
  double *force_cos, *force_sin; /* [particles] */
  ric_obstacle *obstacles;       /* [obstacle_count] floors by particle, then walls by particle; room for both of all */
  size_t obstacle_count;
} lattice_model;

/** Bytes of a lattice with its lists, per particle. */
enum { LATTICE_MODEL_BYTES = 3 * sizeof(double) + sizeof(ric_spring) + 2 * sizeof(ric_obstacle) };

/** Allocates for the number of particles of the values. @returns 0, or -1 when out of memory. */
int lattice_model_init(lattice_model *m, const study_values *v);
void lattice_model_clear(lattice_model *m);

/** Reads the lattice of the present task. */
void lattice_model_read(lattice_model *m, const study_values *v);

/** Index of the obstacle of a particle, side +1 floor, -1 wall; SIZE_MAX when it has none. */
size_t lattice_model_obstacle(const lattice_model *m, size_t particle, int side);
/** Index of the obstacle that a particle hits: its floor, or its wall if it has no floor; SIZE_MAX without either. */
size_t lattice_model_hit(const lattice_model *m, size_t particle);

/** Obstacles of the particles that a key lists: their floors, or their walls where they have no floor.
 *  @param hits  set, one for each. @returns RIC_EINVAL for a particle without an obstacle */
ric_status lattice_model_hits(const lattice_model *m, const study_values *v, study_key key, size_t *hits,
                              ric_error *error);

/** The spring of a particle: of a chain its own, of a Duffing chain the one before it. */
ric_spring lattice_model_spring(const study_values *v, size_t particle);

/* What checks of a study ask of its lattice. */

size_t lattice_particles(const study *s);
/** Whether a particle has a floor or a wall, at some point of a sweep at least. */
bool lattice_has_obstacle(const study *s, size_t particle);
/** Refuses element `i` of a list that is no particle of the lattice, as "orbit.at_start[2]"; swept values that are
 *  none. */
int lattice_check_particle(const study *s, const document *d, study_key key, size_t i, message *why);
int lattice_check_swept_particles(const study *s, const document *d, study_key key, message *why);

#endif
