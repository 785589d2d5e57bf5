/* The block of an even orbit of a chain: slopes of its saltation matrices, kernels of the free flow, the matrix.
 * Internal to the library. */
#ifndef RICOCHET_REDUCED_H
#define RICOCHET_REDUCED_H

#include <stdbool.h>

#include "model/image_ring.h"
#include "multipliers.h"
#include "ricochet/orbit.h"

/* Saltation at the impacts of an orbit.
 *
 * The saltation matrix of an impact of particle k with restitution 1 acts on (q_k, v_k) alone (the chain has no
 * damping), as [[-1, 0], [s, -1]] with s = 2 a_k / v_k-, a_k the acceleration at the impact. With the velocity jump
 * p_k = -2 v_k- this is s = -4 a_k / p_k. */

/** One impact. */
typedef struct orbit_impact {
  size_t particle;
  bool at_half;
  double impulse; /* p */
  double slope;   /* s */
} orbit_impact;

/** In the order of the pattern: those at t = 0 first. Zeroed once, keeps its memory. */
typedef struct orbit_impacts {
  orbit_impact *items;
  size_t count, capacity;
} orbit_impacts;

void orbit_impacts_clear(orbit_impacts *list);

/** Reads the impacts of an orbit with a state.
 *  @param grazing_tol  relative to the largest displacement: smaller impulses have no saltation matrix
 *  @param grazing  set to the first impact with such an impulse, or to the number of impacts */
ric_status orbit_impacts_find(orbit_impacts *list, const ric_chain *chain, const ric_pattern *pattern,
                              const ric_orbit *orbit, double grazing_tol, size_t *grazing, ric_error *error);

/* Entries of the free flow of a chain over T and T/2, from kernels on its image ring.
 *
 * The flow over t is [[cos(W t), sin(W t) / W], [-W sin(W t), cos(W t)]] on (q, v), W^2 the stiffness matrix. Its
 * blocks are functions of the stiffness matrix, each given by n / 2 + 1 numbers. */

/** Kernels of one time. */
typedef struct flow_kernel {
  double *cosine, *sine, *fall; /* cos, sin / W, -W sin */
} flow_kernel;

typedef struct flow_kernels {
  ric_chain shape; /* particles and ends that the plans belong to */
  lattice_transform *transform;
  flow_kernel full, half;
} flow_kernels;

/* Multipliers of an even orbit from one n x n block.
 *
 * The saltation matrix of an impact is S = K P K with P = -1 on (q_k, v_k) and two half jumps K = [[1, 0], [-s/2, 1]].
 * With the free flow F over T/2, based in the middle of the impacts at t = 0, the monodromy matrix is
 *
 *   M = P2 K2 F (K1 P1 K1) F K2.
 *
 * Conjugation with the time reversal R = diag(1, -1) inverts F and K, so R' = P2 R inverts M, and (M + M^-1) / 2 maps
 * the states with R' x = x to themselves: displacements of the particles that do not hit at t = 0, speeds of those that
 * do. There it is the block W of M, with the eigenvalues alpha = (mu + 1/mu) / 2.
 *
 * Its eigenvalues and the verdict: multipliers.h. */

typedef struct reduced {
  size_t particles;
  flow_kernels kernels;
  double *rows;                   /* [2][n] */
  const orbit_impact **impact_of; /* [n] the impact of a particle at t = 0, NULL if it has none */
  even_spectrum spectrum;
} reduced;

void reduced_clear(reduced *r);

/** Finds the spectrum; O(n^3).
 *  @returns RIC_ENOMEM, RIC_ENUMERIC if the eigenvalues do not converge */
ric_status reduced_compute(reduced *r, const ric_chain *chain, const orbit_impacts *impacts, const ric_orbit *orbit,
                           ric_error *error);

#endif
