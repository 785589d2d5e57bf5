/* The contact equations of a pattern on its cell: internal to the library.
 *
 * Unknowns are the impulses p_k > 0 and the amplitudes a_s of the modes near resonance (response.h):
 *
 *   sum_l G_kl(t_k - t_l) p_l + sum_s u_ks a_s = b_k,     sum_k u_ks p_k - d_s a_s = 0,
 *
 * with u_ks = phi_s(k), times (-1)^l for impacts at T/2, and d_s = 2 omega sin(distance), which is 0 at resonance. The
 * matrix is symmetric. A combination of modes of equal d that vanishes at every contact is not excited, and at
 * resonance its amplitude is free: it is left out (0). So the unknowns are the combinations that the contacts see,
 * scaled to the size of the other entries. */
#ifndef RICOCHET_CONTACT_H
#define RICOCHET_CONTACT_H

#include <stddef.h>

#include "numeric/linear_system.h"
#include "response.h"
#include "ricochet/orbit.h"
#include "unit_cell.h"

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
  double *store;   /* every array below */
  double *matrix;  /* [size][size], row-major */
  double *rhs, *solution, *tau, *norm, *work;
  size_t *permutation;
  border_mode border[BORDER_MODES];
  size_t border_count;
  size_t column_count;                        /* combinations of border modes that the contacts see */
  double weights[BORDER_MODES][BORDER_MODES]; /* [mode][column] */
  double amplitude[BORDER_MODES];             /* a_s of the solution */
  linear_outcome outcome;
} contact_system;

void contact_system_clear(contact_system *c);

/** Displacement u_ks of a mode at a contact, with the sign of its half period. */
double contact_shape(const unit_cell *cell, const border_mode *b, const contact *k);

/** Combinations of modes that the contacts see: the rank of [contacts][modes], from its Gram matrix.
 *  @param rotation  [count][count], columns are orthonormal combinations, seen ones first; may be NULL
 *  @param visible  set to the rank */
ric_status contact_visible(const unit_cell *cell, const border_mode *modes, size_t count, double *rotation,
                           size_t *visible, ric_error *error);

/** Assembles and solves for the impulses p [m]. Needs the kernels of the responses.
 *
 *  Beyond options->singular_condition the solution of least norm is taken if it satisfies the equations to
 *  residual_tol; c->outcome says which. */
ric_status contact_solve(contact_system *c, const unit_cell *cell, const response *r, const ric_orbit_options *options,
                         double *p, ric_error *error);

/** Smallest-to-largest eigenvalues [m] of the contact matrix, without any mode set apart. */
ric_status contact_eigenvalues(contact_system *c, const unit_cell *cell, const response *r, double *eigenvalues,
                               ric_error *error);

#endif
