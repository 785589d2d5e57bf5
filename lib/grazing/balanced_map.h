/* A grazing map in coordinates in which its numbers are of one size: internal to the room.
 *
 * z = D y with a diagonal D of powers of two; then L -> D^-1 L D, eta -> eta D, xi -> D^-1 xi, each divided by a power
 * of two. Nothing is rounded, and the terms eta_k (L^i xi)_k of a coefficient stay what they are. */
#ifndef RICOCHET_BALANCED_MAP_H
#define RICOCHET_BALANCED_MAP_H

#include "ricochet/grazing_map.h"

typedef struct balanced_map {
  size_t n;
  double *L;        /* [n][n]; its largest entry, and those of eta and xi, in [1/2, 1) */
  double *eta, *xi; /* [n] */
  double *scale;    /* [n] D */
  double size;      /* Frobenius norm of L */
  long L_exponent;  /* L of the map is D L D^-1 times 2 to this */
  long c_exponent;  /* c_i of the map is eta L^i xi times 2 to this and to i times L_exponent */
  double *block;
} balanced_map;

/** The map must have been checked. @returns RIC_ENOMEM; RIC_ENUMERIC when D has no room in a number; nothing to clear
 *  then. */
ric_status balanced_map_init(balanced_map *balanced, const ric_grazing_map *map, ric_error *error);
void balanced_map_clear(balanced_map *balanced);

/** Room for arrays of n numbers, and n x n ones before them, set to 0; freed by the caller.
 *  @returns NULL when there is none */
double *balanced_map_room(size_t n, size_t matrices, size_t vectors);

#endif
