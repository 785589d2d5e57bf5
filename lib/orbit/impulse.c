#include "impulse.h"

#include <stdlib.h>
#include <string.h>

#include "model/image_ring.h"

void impulse_clear(impulse *w) {
  response_clear(&w->response);
  contact_system_clear(&w->contacts);
  free(w->p);
  *w = (impulse){0};
}

static ric_status prepare(impulse *w, const unit_cell *cell, ric_error *error) {
  RIC_TRY(response_prepare(&w->response, &cell->chain, error));
  if (cell->impacts <= w->capacity)
    return RIC_OK;
  double *more = realloc(w->p, cell->impacts * sizeof *more);
  if (!more)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu impulses", cell->impacts);
  w->p = more;
  w->capacity = cell->impacts;
  return RIC_OK;
}

static int has_both_roles(const unit_cell *cell) {
  for (size_t k = 1; k < cell->impacts; k++)
    if (cell->contacts[k].role != cell->contacts[0].role)
      return 1;
  return 0;
}

/* Modal coefficients of the impulses of one role, in place. */
static void excite(const impulse *w, const unit_cell *cell, ric_role role, double *modal) {
  int any = 0;
  memset(modal, 0, cell->chain.particles * sizeof *modal);
  for (size_t k = 0; k < cell->impacts; k++)
    if (cell->contacts[k].role == role) {
      modal[cell->contacts[k].site] = w->p[k];
      any = 1;
    }
  if (any)
    lattice_transform_forward(w->response.transform, modal);
}

/* Impulses -> positions at t = 0 and T/2 in modal coefficients. */
static void respond(const impulse *w, const unit_cell *cell) {
  const response *r = &w->response;
  double sites = (double)image_ring_sites(&cell->chain);
  for (size_t s = 0; s < cell->chain.particles; s++) {
    size_t j = lattice_transform_wave(&cell->chain, s);
    double at_start = r->modal_start[s], at_half = r->modal_half[s];
    r->modal_start[s] = (r->start[j] * at_start + r->half[j] * at_half) / sites;
    r->modal_half[s] = (r->half[j] * at_start + r->start[j] * at_half) / sites;
  }
  for (size_t i = 0; i < w->contacts.border_count; i++) {
    const border_mode *b = &w->contacts.border[i];
    double a = w->contacts.amplitude[i] * lattice_transform_unit(&cell->chain, b->mode) / sites;
    r->modal_start[b->mode] += a;
    r->modal_half[b->mode] += b->harmonic % 2 == 1 ? -a : a;
  }
}

static void write_state(const impulse *w, const unit_cell *cell, const boundary_state *state) {
  size_t bytes = cell->chain.particles * sizeof *state->q;
  memcpy(state->q, w->response.modal_start, bytes);
  memcpy(state->q_half, w->response.modal_half, bytes);
  memset(state->v, 0, bytes);
  memset(state->v_half, 0, bytes);
  for (size_t k = 0; k < cell->impacts; k++) /* half of the jump, after the impact at 0 and before that at T/2 */
    if (cell->contacts[k].role == RIC_ROLE_START)
      state->v[cell->contacts[k].site] = w->p[k] / 2;
    else
      state->v_half[cell->contacts[k].site] = -w->p[k] / 2;
}

ric_status impulse_solve(impulse *w, const unit_cell *cell, double period, const ric_orbit_options *options,
                         const boundary_state *state, linear_outcome *solution, ric_error *error) {
  RIC_TRY(prepare(w, cell, error));
  response *r = &w->response;
  response_compute(r, &cell->chain, period, 1);
  response_kernels(r, has_both_roles(cell));
  RIC_TRY(contact_solve(&w->contacts, cell, r, options, w->p, error));
  *solution = w->contacts.outcome;
  if (solution->singular && !solution->solvable)
    return RIC_OK;
  excite(w, cell, RIC_ROLE_START, r->modal_start);
  excite(w, cell, RIC_ROLE_HALF, r->modal_half);
  respond(w, cell);
  lattice_transform_inverse(r->transform, r->modal_start);
  lattice_transform_inverse(r->transform, r->modal_half);
  write_state(w, cell, state);
  return RIC_OK;
}

ric_status impulse_eigenvalues(impulse *w, const unit_cell *cell, double period, double *eigenvalues,
                               ric_error *error) {
  RIC_TRY(prepare(w, cell, error));
  response_compute(&w->response, &cell->chain, period, 0);
  response_kernels(&w->response, has_both_roles(cell));
  return contact_eigenvalues(&w->contacts, cell, &w->response, eigenvalues, error);
}
