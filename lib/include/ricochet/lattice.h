/* Lattices: chains of particles on springs, linear or not.
 *
 *   m_i q''_i = -s_i(q_i, q'_i) - l_i(d_i, d'_i) + l_{i+1}(d_{i+1}, d'_{i+1}) + F_i cos(w t) + G_i sin(w t) + forces of
 * obstacles,     d_i = q_i - q_{i-1},
 *
 * where s_i is the on-site spring of particle i and l_i the link that joins particle i to particle i - 1, each
 *
 *   f(x, x') = linear x + quadratic x^2 + cubic x^3 + damping x',
 *
 * so that potentials have quadratic, cubic and quartic terms. Ends: `periodic` (link 0 joins the last particle and the
 * first; rings of one and two particles are chains with free ends), `fixed` (links 0 and n join the ends to walls at
 * 0), `free` (links 0 and n do not exist). The chain of [JAP] (1) has masses 1, on-site springs 1 and links gamma. */
#ifndef RICOCHET_LATTICE_H
#define RICOCHET_LATTICE_H

#include <stddef.h>

#include "chain.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_spring {
  double linear, quadratic, cubic; /* force at extension x: linear x + quadratic x^2 + cubic x^3 */
  double damping;                  /* force per rate of extension, >= 0 */
} ric_spring;

/** A lattice. Plain data; ric_lattice_check validates it. An array that is not NULL replaces the single value for all
 *  particles; arrays are borrowed. */
typedef struct ric_lattice {
  size_t particles; /* n >= 1 */
  ric_ends ends;
  double mass;                         /* > 0, default 1 */
  const double *masses;                /* [n] */
  ric_spring on_site;                  /* default: linear 1 */
  const ric_spring *on_sites;          /* [n] */
  ric_spring link;                     /* default: none */
  const ric_spring *links;             /* [n + 1], link i joins particles i - 1 and i; see above for links 0 and n */
  double frequency;                    /* w of the forcing */
  const double *force_cos, *force_sin; /* [n] F and G; NULL: none */
} ric_lattice;

/** Uncoupled particles of mass 1 on linear springs of stiffness 1. */
RIC_API ric_lattice ric_lattice_default(size_t particles, ric_ends ends);

/** The lattice of a chain, without its floors: these are obstacles. */
RIC_API ric_lattice ric_lattice_of_chain(const ric_chain *chain);

/** @returns RIC_EINVAL naming the first field that is out of range: masses not positive, values not finite. */
RIC_API ric_status ric_lattice_check(const ric_lattice *lattice, ric_error *error);

static inline double ric_lattice_mass(const ric_lattice *lattice, size_t particle) {
  return lattice->masses ? lattice->masses[particle] : lattice->mass;
}

static inline ric_spring ric_lattice_on_site(const ric_lattice *lattice, size_t particle) {
  return lattice->on_sites ? lattice->on_sites[particle] : lattice->on_site;
}

/** Link i, 0 <= i <= n; zeros where the ends have no link. On a ring links 0 and n are the same. */
RIC_API ric_spring ric_lattice_link(const ric_lattice *lattice, size_t i);

/** Accelerations [n] at time t, positions q [n] and velocities v [n], without obstacles. */
RIC_API void ric_lattice_acceleration(const ric_lattice *lattice, double t, const double *q, const double *v,
                                      double *acceleration);

/** Kinetic and potential energy, without that of the forcing. */
RIC_API double ric_lattice_energy(const ric_lattice *lattice, const double *q, const double *v);

/** An upper bound of the frequencies of the linear part (Gershgorin), > 0 or 0 without springs. */
RIC_API double ric_lattice_frequency_bound(const ric_lattice *lattice);

RIC_END_DECLARATIONS

#endif
