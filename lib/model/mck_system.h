/* What a system of an M-C-K model holds: internal, for its Taylor flow. */
#ifndef RICOCHET_MCK_SYSTEM_H
#define RICOCHET_MCK_SYSTEM_H

#include "mck_rows.h"
#include "system_model.h"

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

#endif
