/* Systems in all forms that the library has, each with a state at which its motion grazes obstacle 0: for tests. */
#ifndef RICOCHET_TESTS_GRAZING_POINT_H
#define RICOCHET_TESTS_GRAZING_POINT_H

#include <ricochet/ricochet.h>

#include "witness/random_lattice.h"
#include "witness/random_mck.h"

typedef enum grazing_kind {
  GRAZING_ONE_MASS,    /* forced linear oscillator, wall */
  GRAZING_TWO_MASSES,  /* forced lattice with everything nonlinear */
  GRAZING_FIVE_MASSES, /* forced M-C-K system with a full mass matrix */
  GRAZING_VAN_DER_POL, /* self-excited oscillator of a user, wall */
  GRAZING_PENDULUM,    /* driven double pendulum, its lower bob at a wall */
  GRAZING_TABLE,       /* ball over a shaken table */
  GRAZING_SKATE,       /* three coordinates, two speeds: its nose at a wall */
  GRAZING_MAP,         /* the forced linear oscillator in first-order form */
  GRAZING_KINDS
} grazing_kind;

enum { GRAZING_MOST = 10 };

typedef struct grazing_point {
  ric_system *system;
  size_t numbers; /* n + m */
  double t, x[GRAZING_MOST];
  ric_grazing_local local; /* at x */
  double restitution, wall;
  random_lattice lattice; /* what the system's callbacks and models stand on */
  random_mck mck;
} grazing_point;

/** Makes one; `p` must stay where it is. Asserts that this works. @param seed  of random systems and states */
void grazing_point_make(grazing_point *p, grazing_kind kind, double restitution, uint64_t seed);
void grazing_point_clear(grazing_point *p);

/** The state `depth` behind grazing: x - depth eta / |eta|^2. */
void grazing_point_behind(const grazing_point *p, double depth, double *x);

/** Bypass map of obstacle 0. Asserts that this works. */
ric_bypass *bypass_within(ric_system *system, double reach);

/** Largest modulus of a - b. */
double largest_difference(const double *a, const double *b, size_t size);

/** Asserts that a call was refused, with this in its message. */
void assert_refused(ric_status status, ric_status expected, const ric_error *error, const char *text);

#endif
