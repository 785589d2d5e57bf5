/* The linearised forces of M-C-K systems: internal to the library. */
#ifndef RICOCHET_MCK_TANGENT_H
#define RICOCHET_MCK_TANGENT_H

#include "mck_system.h"

/** The table's `tangent`. */
const char *mck_tangent(const ric_system *s, const unsigned char *contact, double t, const double *q, const double *u,
                        const tangents *d, const tangents *d_rate);

#endif
