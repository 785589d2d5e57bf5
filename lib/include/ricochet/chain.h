/* The chain of impact oscillators [JAP]
 *
 *   q''_i + q_i - gamma (q_{i+1} - 2 q_i + q_{i-1}) = lambda_i,   0 <= lambda_i  _|_  q_i - b_i >= 0      (1)-(3)
 *
 * n particles, each on a spring of unit stiffness. Springs of stiffness gamma join neighbours. Below each particle is a
 * floor b_i (-1 in the source) or none. Dimensionless. At an impact q'_i changes sign (restitution 1).
 *
 * Three kinds of ends: `periodic` (a ring; n = 1 is the single oscillator, n = 2 has one spring between the two),
 * `fixed` (q_{-1} = q_n = 0, springs to both walls) and `free` (no springs beyond the ends). All three are pieces of a
 * larger ring with images: a fixed chain is the odd part of a ring of 2(n + 1), a free chain the even part of one of
 * 2n. Hence one dispersion relation for all,
 *
 *   omega(p)^2 = 1 + 4 gamma sin^2(p / 2),                                                                (12)
 *
 * with wave numbers p_j = 2 pi j / n, pi (j + 1) / (n + 1), pi j / n for the modes j = 0 ... n - 1. On a ring the modes
 * j <= n/2 are cosines, the others are sines of wave number 2 pi (n - j) / n: frequencies come in pairs. */
#ifndef RICOCHET_CHAIN_H
#define RICOCHET_CHAIN_H

#include <stddef.h>

#include "status.h"

RIC_BEGIN_DECLARATIONS

typedef enum ric_ends { RIC_ENDS_PERIODIC, RIC_ENDS_FIXED, RIC_ENDS_FREE } ric_ends;

/** A chain. Plain data; ric_chain_check validates it. */
typedef struct ric_chain {
  size_t particles; /* n >= 1 */
  ric_ends ends;    /* default periodic */
  double gamma;     /* coupling, >= 0 */
  double floor;     /* obstacle of every particle, any finite number, or -INFINITY for none; default -1 */
  const double
      *floors; /* [n] obstacle of each particle, -INFINITY for none; replaces `floor` when not NULL. Borrowed */
} ric_chain;

/** A ring of n particles with the given coupling and the floor of the source. */
RIC_API ric_chain ric_chain_default(size_t particles, double gamma);

/** @returns RIC_EINVAL naming the first field that is out of range. */
RIC_API ric_status ric_chain_check(const ric_chain *chain, ric_error *error);

/** Obstacle b_i of a particle; -INFINITY when it has none. */
static inline double ric_chain_floor(const ric_chain *chain, size_t particle) {
  return chain->floors ? chain->floors[particle] : chain->floor;
}

/** Wave number p_j of a mode, 0 <= j < n, in [0, pi]. */
RIC_API double ric_chain_wave_number(const ric_chain *chain, size_t mode);

/** Frequency omega_j of a mode, (12). */
RIC_API double ric_chain_frequency(const ric_chain *chain, size_t mode);

/** Largest frequency of the chain. */
RIC_API double ric_chain_frequency_max(const ric_chain *chain);

/** Displacement of a particle in a mode of unit Euclidean length. */
RIC_API double ric_chain_mode_shape(const ric_chain *chain, size_t mode, size_t particle);

/** Accelerations [n] of the free motion at positions q [n]: minus the stiffness matrix times q, (1) with lambda = 0. */
RIC_API void ric_chain_acceleration(const ric_chain *chain, const double *q, double *acceleration);

/** Total energy of positions q [n] and velocities v [n]: kinetic, on-site springs, coupling springs. */
RIC_API double ric_chain_energy(const ric_chain *chain, const double *q, const double *v);

/** Frequency of wave number p at coupling gamma, dispersion relation (12). */
RIC_API double ric_dispersion(double gamma, double wave_number);

/** Coupling at which the out-of-phase mode p = pi has the period T, (13): ((2 pi / T)^2 - 1) / 4. The first resonance
 *  of even rings; other ends and odd rings resonate slightly later. Negative for T > 2 pi. */
RIC_API double ric_gamma_c(double period);

RIC_END_DECLARATIONS

#endif
