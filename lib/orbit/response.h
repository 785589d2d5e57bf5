/* Responses of the modes of a chain to unit impulses that repeat with the period T: internal to the library.
 *
 * For wave number j with x = omega_j T / 2 the response at the time of the impulse is cos x / (2 omega sin x), half a
 * period away it is 1 / (2 omega sin x). Close to a resonance, x = pi l + d with small d, both grow like the same
 * amplitude a (times (-1)^l at the start): that amplitude becomes an unknown of the contact equations, with
 * 2 omega sin(d) a = (impulses that excite the mode), and only the bounded remainder -tan(d/2) / (2 omega) stays in the
 * response. So the solution is computed stably up to and at the resonance, where its limit is finite. */
#ifndef RICOCHET_RESPONSE_H
#define RICOCHET_RESPONSE_H

#include <stddef.h>

#include "model/lattice_transform.h"
#include "ricochet/chain.h"

enum { RESPONSE_NEAR = 32 /* wave numbers close to resonance that are treated apart, the closest ones */ };

/** A wave number close to resonance. */
typedef struct near_wave {
  size_t wave;       /* j, of the image ring */
  unsigned harmonic; /* l */
  double omega;
  double distance; /* d = omega T / 2 - pi l */
} near_wave;

typedef struct response {
  ric_chain shape; /* particles and ends that the plans and the table below belong to */
  lattice_transform *transform;
  double *sine2;                      /* 4 sin^2(p_j / 2) by wave number */
  double *start;                      /* response at the time of the impulse, by wave number */
  double *half;                       /* response half a period away */
  double *start_kernel, *half_kernel; /* the same between particles, by distance on the image ring */
  double *modal_start, *modal_half;   /* work arrays for modal coefficients */
  near_wave near[RESPONSE_NEAR];
  size_t near_count, near_dropped; /* dropped: close to resonance, too, but beyond the room for them */
  double scale; /* mean over the modes of the largest response 1 / (2 omega |sin x|); 1 / (2 omega) for the near ones */
} response;

/** Plans and tables for chains with these particles and ends; does nothing when they are there already. */
ric_status response_prepare(response *r, const ric_chain *chain, ric_error *error);
void response_clear(response *r);

/** Fills start, half, near and scale. @param apart  0 leaves resonant waves in the response, for counting poles. */
void response_compute(response *r, const ric_chain *chain, double period, int apart);

/** Fills the kernels from the responses; the one for half a period only when asked. */
void response_kernels(response *r, int with_half);

/** Modes of the chain with a wave number: one, or the two of a ring. Returns their number. */
size_t response_modes(const ric_chain *chain, size_t wave, size_t modes[2]);

#endif
