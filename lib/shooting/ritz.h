/* Ritz-Galerkin equations, for the files that share them: internal to the room.
 *
 * Times are in periods, tau = t / T. Function m of N' has the number i = first + m in the formulas. */
#ifndef RICOCHET_INTERNAL_RITZ_H
#define RICOCHET_INTERNAL_RITZ_H

#include "model/system_model.h"
#include "ricochet/ritz.h"
#include "shooting.h"

struct ric_ritz {
  const ric_system *system;    /* borrowed */
  unsigned long long revision; /* of the system, when its numbers were last checked */
  size_t obstacle, hit;        /* the coordinate that it stops */
  size_t coordinates;          /* n */
  size_t first;                /* 0 with constants, else 1 */
  size_t most, functions;      /* N of the options, and in use */
  size_t stride;               /* N' of the options */
  size_t points;
  double *tau, *weight; /* [points] in (0, 1/2); weights of a mean */
  double *psi;          /* [points][stride] cos(2 pi i tau) */
  double *cosine;       /* [stride] cos(i w (T/2 - t)) at a time, */
  double *sine;         /* [stride] and their sines */
  double *q, *v;        /* [n] */
  double *bend;         /* [n] second derivatives, */
  double *rate;         /* [n] and accelerations by the forces, at a time */
  double *stiffness;    /* [n][n] derivatives of the accelerations */
  double *unit;         /* [n][n] */
  double *nothing;      /* [n][n] zeros */
  double *spare;        /* [unknowns at most] */
  double *block;        /* owns all of them */
};

/** N' */
static inline size_t ritz_width(const ric_ritz *r) {
  return r->functions + 1 - r->first;
}

/** i of function m. */
static inline double ritz_number(const ric_ritz *r, size_t m) {
  return (double)(r->first + m);
}

static inline double ritz_frequency(const ric_ritz *r, const double *c) {
  return c[r->coordinates * ritz_width(r)];
}

/** @returns RIC_EINVAL unless the system's numbers are those of a lattice that the equations allow. */
ric_status ritz_check_system(ric_ritz *r, ric_error *error);

/** @returns RIC_ENUMERIC unless c are numbers and the period is positive. */
ric_status ritz_check_numbers(const ric_ritz *r, const double *c, double period, ric_error *error);

/** cos and sin [N'] of i phase. */
void ritz_functions_at(const ric_ritz *r, double phase, double *cosine, double *sine);

/** Displacements, velocities and second derivatives [n] at a time; any may be NULL. */
void ritz_motion(const ric_ritz *r, const double *c, double period, double tau, double *q, double *v, double *bend);

#endif
