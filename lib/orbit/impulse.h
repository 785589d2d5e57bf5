/* The impulse method: modal responses of the unit cell, the contact equations, and the state that follows. Internal to
 * the library. */
#ifndef RICOCHET_IMPULSE_H
#define RICOCHET_IMPULSE_H

#include <stddef.h>

#include "model/image_ring.h"
#include "motion.h"
#include "numeric/linear.h"
#include "ricochet/chain.h"
#include "ricochet/orbit.h"
#include "unit_cell.h"

/* Responses of the modes of a chain to unit impulses that repeat with the period T.
 *
 * For wave number j with x = omega_j T / 2 the response at the time of the impulse is cos x / (2 omega sin x), half
 * a period later it is 1 / (2 omega sin x). Close to a resonance, x = pi l + d with small d, both grow in proportion
 * to one amplitude a (with the factor (-1)^l at the start): that amplitude becomes an unknown of the contact
 * equations, with 2 omega sin(d) a = (impulses that excite the mode), and only the bounded remainder -tan(d/2) / (2
 * omega) stays in the response. So the solution is computed stably up to and at the resonance, where its limit is
 * finite. */

enum { RESPONSE_NEAR = 32 /* wave numbers that are separated from the response: those closest to resonance */ };

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
  size_t near_count, near_dropped; /* dropped: close to resonance, too, but the list is full */
  double scale; /* mean over the modes of the largest response 1 / (2 omega |sin x|); 1 / (2 omega) for the near ones */
} response;

/** Modes of the chain with a wave number: one, or the two of a ring. Returns their number. */
size_t response_modes(const ric_chain *chain, size_t wave, size_t modes[2]);

/* The contact equations of a pattern on its cell.
 *
 * Unknowns are the impulses p_k > 0 and the amplitudes a_s of the modes near resonance:
 *
 *   sum_l G_kl(t_k - t_l) p_l + sum_s u_ks a_s = b_k,     sum_k u_ks p_k - d_s a_s = 0,
 *
 * with u_ks = phi_s(k), times (-1)^l for impacts at T/2, and d_s = 2 omega sin(distance), which is 0 at resonance.
 * The matrix is symmetric. A combination of modes of equal d that vanishes at every contact is not excited, and at
 * resonance its amplitude is free: the equations omit it (0). So the unknowns are the observable combinations, those
 * that do not vanish at all contacts, scaled to the size of the other entries. */

/** A mode that is close to resonance or at it. */
typedef struct border_mode {
  size_t mode;
  unsigned harmonic;
  double stiffness; /* d_s */
  size_t group; /* modes of equal stiffness, numbered from 0: all that are at resonance, or a wave number of its own */
} border_mode;

enum { BORDER_MODES = 2 * RESPONSE_NEAR };

typedef struct contact_system {
  size_t capacity; /* largest m + BORDER_MODES so far */
  double *store;   /* owns every array below */
  double *matrix;  /* [size][size], row-major */
  double *rhs, *solution, *tau, *norm, *work;
  size_t *permutation;
  border_mode border[BORDER_MODES];
  size_t border_count;
  size_t column_count;                        /* observable combinations of border modes */
  double weights[BORDER_MODES][BORDER_MODES]; /* [mode][column] */
  double amplitude[BORDER_MODES];             /* a_s of the solution */
  linear_outcome outcome;
} contact_system;

/** Displacement u_ks of a mode at a contact, with the sign of its half period. */
double contact_shape(const unit_cell *cell, const border_mode *b, const contact *k);

/** Combinations of modes that do not vanish at all contacts: the rank of [contacts][modes], from its Gram matrix.
 *  @param rotation  [count][count], columns are orthonormal combinations, observable ones first; may be NULL
 *  @param observable  set to the rank */
ric_status contact_observable(const unit_cell *cell, const border_mode *modes, size_t count, double *rotation,
                              size_t *observable, ric_error *error);

/* The impulse-response form of the boundary-value problem (orbit.h), on the unit cell. */

/** Workspace. */
typedef struct impulse {
  response response;
  contact_system contacts;
  double *p; /* [capacity] impulses of the cell's contacts */
  size_t capacity;
} impulse;

void impulse_clear(impulse *w);

/** State of the orbit of a cell; O(n log n + m^3).
 *  @param solution  set; when it is singular and not solvable the state is not written */
ric_status impulse_solve(impulse *w, const unit_cell *cell, double period, const ric_orbit_options *options,
                         const boundary_state *state, linear_outcome *solution, ric_error *error);

/** Smallest-to-largest eigenvalues of the cell's contact matrix, [impacts]. */
ric_status impulse_eigenvalues(impulse *w, const unit_cell *cell, double period, double *eigenvalues, ric_poll poll,
                               ric_error *error);

#endif
