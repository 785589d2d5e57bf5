/* M-C-K systems: validated models, contacts that hold coordinates, derivatives, and the system. Internal to the
 * library. */
#ifndef RICOCHET_MCK_SYSTEM_H
#define RICOCHET_MCK_SYSTEM_H

#include "mck_rows.h"
#include "system_model.h"

/* Data of an M-C-K system: internal, for its Taylor flow. */

typedef struct mck_system {
  ric_system base;
  /* M and M^-1: [n] when base.uncoupled (a diagonal mass), [n][n] row-major otherwise */
  double *mass, *inverse;
  mck_rows damping, stiffness; /* M^-1 C, M^-1 K */
  mck_rows springs;            /* K, for the energy */
  double frequency;
  double *force_cos, *force_sin; /* M^-1 F, M^-1 G [n]; NULL: none */
} mck_system;

static inline const mck_system *mck_of(const ric_system *s) {
  return (const mck_system *)s;
}

/** Entry (i, i) of M^-1. */
double mck_mobility(const mck_system *s, size_t i);

/** acceleration [n] += M^-1 e_i force. */
void mck_push(const mck_system *s, size_t i, double force, double *acceleration);

/* The mass matrix of an M-C-K system, and the matrices divided by it. */

/** Sets base.uncoupled, M and its inverse, M^-1 C, M^-1 K, M^-1 F and M^-1 G of a system, from a model that has been
 *  checked. A diagonal mass keeps sparse matrices sparse, any other makes all of them dense.
 *  @returns RIC_EINVAL when the mass is not positive definite, RIC_ENOMEM; destroy the system in any case. */
ric_status mck_divide_by_mass(mck_system *s, const ric_mck *mck, ric_error *error);

/* Coordinates held by sticking (persistent) contacts: forces along them make their accelerations zero.
 *
 * With G the columns of the held coordinates, u' = M^-1 (f + G mu), (G^T M^-1 G) mu = -G^T M^-1 f. Several contacts
 * that hold the same coordinate share mu equally: the solution of least norm. */

typedef struct mck_hold {
  size_t count;       /* held coordinates */
  size_t *coordinate; /* [count] increasing */
  size_t *sharing;    /* [count] contacts at each */
  double *force;      /* [count] mu */
  double *factor;     /* [count][count] of G^T M^-1 G, NULL for diagonal masses */
  size_t *order;      /* [count] its permutation */
} mck_hold;

/** Makes room for the contacts that are held in given states, or for all rigid obstacles if `contact` is NULL; none is
 *  held yet. @returns 0 without memory; clear `hold` in any case. */
int mck_hold_init(mck_hold *hold, const mck_system *s, const unsigned char *contact);
void mck_hold_clear(mck_hold *hold);

/** Holds the coordinates of the contacts that are CONTACT_HELD. @returns NULL, or what went wrong. */
const char *mck_hold_set(mck_hold *hold, const mck_system *s, const unsigned char *contact);

/** Computes the forces mu for the free accelerations [n] and adds their effect; held entries become exactly zero. */
void mck_hold_project(mck_hold *hold, const mck_system *s, double *acceleration);

/** Position of a coordinate among the held ones; `count` if it is not held. */
size_t mck_hold_find(const mck_hold *hold, size_t coordinate);

#endif
