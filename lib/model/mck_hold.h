/* Coordinates that persistent contacts hold: forces along them bring their accelerations to zero. Internal.
 *
 * With G the columns of the held coordinates, u' = M^-1 (f + G mu), (G^T M^-1 G) mu = -G^T M^-1 f. Several contacts
 * that hold the same coordinate share mu equally: the smallest of the forces that do the same. */
#ifndef RICOCHET_MCK_HOLD_H
#define RICOCHET_MCK_HOLD_H

#include "mck_system.h"

typedef struct mck_hold {
  size_t count;       /* held coordinates */
  size_t *coordinate; /* [count] increasing */
  size_t *sharing;    /* [count] contacts at each */
  double *force;      /* [count] mu */
  double *factor;     /* [count][count] of G^T M^-1 G, NULL for diagonal masses */
  size_t *order;      /* [count] its permutation */
} mck_hold;

/** Room for the contacts that are held in given states, or for all rigid obstacles when `contact` is NULL; none is held
 *  yet. @returns 0 without memory; clear `hold` in any case. */
int mck_hold_init(mck_hold *hold, const mck_system *s, const unsigned char *contact);
void mck_hold_clear(mck_hold *hold);

/** Holds the coordinates of the contacts that are CONTACT_HELD. @returns NULL, or what went wrong. */
const char *mck_hold_set(mck_hold *hold, const mck_system *s, const unsigned char *contact);

/** Finds the forces mu for the free accelerations [n] and adds what they do; held entries become exactly zero. */
void mck_hold_project(mck_hold *hold, const mck_system *s, double *acceleration);

/** Position of a coordinate among the held ones; `count` when it is not. */
size_t mck_hold_find(const mck_hold *hold, size_t coordinate);

#endif
