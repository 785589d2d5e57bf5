/* The impulse method: modal responses of the unit cell, the contact equations, and the state that follows. */
#include "impulse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_eigen.h>

#include "model/image_ring.h"
#include "numeric/constants.h"
#include "ricochet/elementary.h"
#include "numeric/gsl_quiet.h"

/* Waves with n |sin d| below it are separated from the response. Their remainder in the contact matrix, 2 / n times
 * 1 / (2 omega |sin d|), is then of order one, so that no digits cancel there unless the matrix is singular. */
static const double closeness = 0.5;

/* Wave numbers [first, last] that belong to modes: the odd part of the image ring has no constant and no alternating
 * mode, the even part no alternating one. */
static size_t first_wave(const ric_chain *chain) {
  return chain->ends == RIC_ENDS_FIXED ? 1 : 0;
}

static size_t last_wave(const ric_chain *chain) {
  return chain->ends == RIC_ENDS_PERIODIC ? chain->particles / 2
                                          : chain->particles - (chain->ends == RIC_ENDS_FREE ? 1 : 0);
}

static void tabulate(response *r, const ric_chain *chain) {
  size_t sites = image_ring_sites(chain);
  for (size_t j = 0; j <= sites / 2; j++) {
    double s = ric_sin(pi * (double)j / (double)sites);
    r->sine2[j] = 4 * s * s;
  }
}

static void response_clear(response *r) {
  lattice_transform_free(r->sine2);
  lattice_transform_free(r->start);
  lattice_transform_free(r->half);
  lattice_transform_free(r->start_kernel);
  lattice_transform_free(r->half_kernel);
  lattice_transform_free(r->modal_start);
  lattice_transform_free(r->modal_half);
  lattice_transform_destroy(&r->transform);
  *r = (response){0};
}

/** Makes plans and tables for chains with these particles and ends, unless they exist already. */
static ric_status response_prepare(response *r, const ric_chain *chain, ric_error *error) {
  if (r->transform && r->shape.particles == chain->particles && r->shape.ends == chain->ends)
    return RIC_OK;
  response_clear(r);
  double **arrays[] = {&r->sine2,       &r->start,       &r->half,      &r->start_kernel,
                       &r->half_kernel, &r->modal_start, &r->modal_half};
  RIC_TRY(lattice_transform_create(chain, &r->transform, error));
  r->shape = *chain;
  int complete = 1;
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
    complete = complete && (*arrays[i] = lattice_transform_alloc(r->transform));
  if (!complete) {
    response_clear(r);
    return ric_fail(error, RIC_ENOMEM, "no memory for the modes of %zu particles", chain->particles);
  }
  tabulate(r, chain);
  return RIC_OK;
}

size_t response_modes(const ric_chain *chain, size_t wave, size_t modes[2]) {
  modes[0] = chain->ends == RIC_ENDS_FIXED ? wave - 1 : wave;
  modes[1] = chain->particles - wave;
  return chain->ends == RIC_ENDS_PERIODIC && wave > 0 && 2 * wave < chain->particles ? 2 : 1;
}

/* Keeps the waves closest to resonance, in a list of limited length. */
static void insert_near_wave(response *r, near_wave wave) {
  if (r->near_count < RESPONSE_NEAR) {
    r->near[r->near_count++] = wave;
    return;
  }
  size_t farthest = 0;
  r->near_dropped++;
  for (size_t i = 1; i < RESPONSE_NEAR; i++)
    if (fabs(r->near[i].distance) > fabs(r->near[farthest].distance))
      farthest = i;
  if (fabs(wave.distance) < fabs(r->near[farthest].distance))
    r->near[farthest] = wave;
}

/* Subtracts the near waves from the response; the remainder is bounded. */
static void subtract_near_waves(response *r) {
  for (size_t i = 0; i < r->near_count; i++) {
    const near_wave *w = &r->near[i];
    r->start[w->wave] = -ric_tan(w->distance / 2) / (2 * w->omega);
    r->half[w->wave] = 0;
  }
}

/** Fills start, half, near and scale. @param apart  0: resonant waves stay in the response, for counting poles. */
static void response_compute(response *r, const ric_chain *chain, double period, int apart) {
  double gamma = image_ring_gamma(chain), n = (double)chain->particles, near = apart ? closeness / n : 0;
  size_t pair[2];
  r->near_count = r->near_dropped = 0;
  r->scale = 0;
  for (size_t j = 0; j <= image_ring_sites(chain) / 2; j++)
    r->start[j] = r->half[j] = 0;
  for (size_t j = first_wave(chain); j <= last_wave(chain); j++) {
    double omega = sqrt(1 + gamma * r->sine2[j]); /* (12) */
    double x = omega * period / 2, l = nearbyint(x / pi), d = x - pi * l;
    double s, c, sign = fmod(l, 2) == 0 ? 1 : -1;
    ric_sincos(d, &s, &c);
    r->half[j] = sign / (2 * omega * s);
    r->start[j] = c / (2 * omega * s);
    int close = l >= 1 && fabs(s) < near;
    if (close)
      insert_near_wave(r, (near_wave){.wave = j, .harmonic = (unsigned)l, .omega = omega, .distance = d});
    double largest = close ? 1 / (2 * omega) : fabs(r->half[j]);
    r->scale += largest * (double)response_modes(chain, j, pair) / n;
  }
  subtract_near_waves(r);
}

/** Fills the kernels from the responses; that for half a period only on request. */
static void response_kernels(response *r, int with_half) {
  size_t bytes = lattice_transform_length(r->transform) * sizeof *r->start;
  memcpy(r->start_kernel, r->start, bytes);
  lattice_transform_kernel(r->transform, r->start_kernel);
  if (!with_half)
    return;
  memcpy(r->half_kernel, r->half, bytes);
  lattice_transform_kernel(r->transform, r->half_kernel);
}

static void contact_system_clear(contact_system *c) {
  free(c->store);
  free(c->permutation);
  *c = (contact_system){0};
}

/* Room for m impacts and all border modes. */
static ric_status reserve(contact_system *c, size_t m, ric_error *error) {
  size_t size = m + BORDER_MODES;
  if (size <= c->capacity)
    return RIC_OK;
  contact_system_clear(c);
  c->store = malloc((size * size + 7 * size) * sizeof *c->store);
  c->permutation = malloc(size * sizeof *c->permutation);
  if (!c->store || !c->permutation) {
    contact_system_clear(c);
    return ric_fail(error, RIC_ENOMEM, "no memory for the contact matrix of %zu impacts", m);
  }
  c->capacity = size;
  c->matrix = c->store;
  c->rhs = c->store + size * size;
  c->solution = c->rhs + size;
  c->tau = c->solution + size;
  c->norm = c->tau + size;
  c->work = c->norm + size; /* [3 size] */
  return RIC_OK;
}

double contact_shape(const unit_cell *cell, const border_mode *b, const contact *k) {
  double shape = ric_chain_mode_shape(&cell->chain, b->mode, k->site);
  return k->role == RIC_ROLE_HALF && b->harmonic % 2 == 1 ? -shape : shape;
}

/* The near waves as modes: group 0 holds those at resonance, every other wave is a group of its own. */
static void list_border(contact_system *c, const unit_cell *cell, const response *r, double resonance_tol) {
  size_t group = 0;
  c->border_count = 0;
  for (int exact = 1; exact >= 0; exact--)
    for (size_t i = 0; i < r->near_count; i++) {
      const near_wave *w = &r->near[i];
      if ((fabs(w->distance) <= pi * resonance_tol) != exact)
        continue;
      size_t modes[2], count = response_modes(&cell->chain, w->wave, modes);
      group += !exact;
      for (size_t k = 0; k < count; k++)
        c->border[c->border_count++] = (border_mode){.mode = modes[k],
                                                     .harmonic = w->harmonic,
                                                     .stiffness = 2 * w->omega * ric_sin(w->distance),
                                                     .group = group};
    }
}

/* Eigenvalues, largest first, and eigenvectors of a symmetric matrix. One and two modes, the usual case, are a
 * rotation in closed form: GSL's workspace would be allocated in a hot loop. */
static int diagonalise(double *gram, size_t count, double *values, double *vectors) {
  if (count <= 2) {
    double s, c;
    ric_sincos(count == 2 ? ric_atan2(2 * gram[1], gram[0] - gram[3]) / 2 : 0, &s, &c);
    double turn[4] = {c, -s, s, c};
    for (size_t i = 0; i < count * count; i++)
      vectors[i] = turn[i];
    values[0] = count == 2 ? c * c * gram[0] + 2 * c * s * gram[1] + s * s * gram[3] : gram[0];
    if (count == 2)
      values[1] = s * s * gram[0] - 2 * c * s * gram[1] + c * c * gram[3];
    return 0;
  }
  gsl_eigen_symmv_workspace *w = gsl_eigen_symmv_alloc(count);
  if (!w)
    return GSL_ENOMEM;
  gsl_matrix_view g = gsl_matrix_view_array(gram, count, count), v = gsl_matrix_view_array(vectors, count, count);
  gsl_vector_view e = gsl_vector_view_array(values, count);
  int code = gsl_eigen_symmv(&g.matrix, &e.vector, &v.matrix, w);
  gsl_eigen_symmv_free(w);
  return code ? code : gsl_eigen_symmv_sort(&e.vector, &v.matrix, GSL_EIGEN_SORT_VAL_DESC);
}

ric_status contact_observable(const unit_cell *cell, const border_mode *modes, size_t count, double *rotation,
                              size_t *observable, ric_error *error) {
  double gram[BORDER_MODES * BORDER_MODES], vectors[BORDER_MODES * BORDER_MODES], values[BORDER_MODES];
  *observable = 0;
  if (count == 0)
    return RIC_OK;
  for (size_t i = 0; i < count * count; i++)
    gram[i] = 0;
  for (size_t k = 0; k < cell->impacts; k++) {
    double u[BORDER_MODES];
    for (size_t a = 0; a < count; a++)
      u[a] = contact_shape(cell, &modes[a], &cell->contacts[k]);
    for (size_t i = 0; i < count * count; i++)
      gram[i] += u[i / count] * u[i % count];
  }
  int code = diagonalise(gram, count, values, vectors);
  if (code)
    return ric_fail(error, gsl_status(code), "eigenvalues of a %zu x %zu Gram matrix: %s", count, count,
                    gsl_text(code));
  /* A mode of unit length has squares of order 1/n at the contacts; rounding leaves 1e-16 of that. */
  double least = 1e-13 / (double)cell->chain.particles;
  while (*observable < count && values[*observable] > least)
    (*observable)++;
  for (size_t i = 0; rotation && i < count * count; i++)
    rotation[i] = vectors[i];
  return RIC_OK;
}

/* Columns of the combinations that do not vanish at all contacts, group by group. */
static ric_status combine_modes(contact_system *c, const unit_cell *cell, ric_error *error) {
  double rotation[BORDER_MODES * BORDER_MODES];
  c->column_count = 0;
  for (size_t first = 0, count; first < c->border_count; first += count) {
    size_t observable;
    for (count = 1; first + count < c->border_count && c->border[first + count].group == c->border[first].group;)
      count++;
    RIC_TRY(contact_observable(cell, &c->border[first], count, rotation, &observable, error));
    for (size_t v = 0; v < observable; v++, c->column_count++)
      for (size_t a = 0; a < c->border_count; a++)
        c->weights[a][c->column_count] = a >= first && a < first + count ? rotation[(a - first) * count + v] : 0;
  }
  return RIC_OK;
}

static double entry(const unit_cell *cell, const response *r, const contact *k, const contact *l) {
  return image_ring_entry(&cell->chain, k->role == l->role ? r->start_kernel : r->half_kernel, k->site, l->site);
}

/* One border column and row: a combination at the contacts, scaled to the size of the responses. Its weights get the
 * same scale, so that the solution is in units of the modes. Where the modes of a group differ in stiffness,
 * within the tolerance of a resonance, its combinations are coupled. */
static void fill_border(contact_system *c, const unit_cell *cell, size_t column, size_t size, double scale) {
  size_t m = cell->impacts, at = m + column;
  double largest = 0;
  for (size_t k = 0; k < m; k++) {
    double u = 0;
    for (size_t a = 0; a < c->border_count; a++)
      if (c->weights[a][column] != 0)
        u += c->weights[a][column] * contact_shape(cell, &c->border[a], &cell->contacts[k]);
    c->matrix[k * size + at] = u;
    largest = fmax(largest, fabs(u));
  }
  double unit = scale / largest;
  for (size_t k = 0; k < m; k++)
    c->matrix[at * size + k] = c->matrix[k * size + at] *= unit;
  for (size_t a = 0; a < c->border_count; a++)
    c->weights[a][column] *= unit;
  for (size_t other = 0; other <= column; other++) {
    double stiffness = 0;
    for (size_t a = 0; a < c->border_count; a++)
      stiffness += c->weights[a][other] * c->border[a].stiffness * c->weights[a][column];
    c->matrix[at * size + m + other] = c->matrix[(m + other) * size + at] = -stiffness;
  }
}

/* The symmetric matrix [size][size] and the right-hand side. */
static void assemble(contact_system *c, const unit_cell *cell, const response *r) {
  size_t m = cell->impacts, size = m + c->column_count;
  for (size_t i = 0; i < size * size; i++)
    c->matrix[i] = 0;
  for (size_t i = 0; i < size; i++)
    c->rhs[i] = i < m ? ric_chain_floor(&cell->chain, cell->contacts[i].site) : 0;
  for (size_t k = 0; k < m; k++)
    for (size_t l = 0; l <= k; l++) {
      double g = entry(cell, r, &cell->contacts[k], &cell->contacts[l]);
      c->matrix[k * size + l] = c->matrix[l * size + k] = g;
    }
  for (size_t column = 0; column < c->column_count; column++)
    fill_border(c, cell, column, size, r->scale);
}

/* The smallest of the solutions of a singular system, if it has any. */
static ric_status solve_singular(contact_system *c, const unit_cell *cell, const response *r,
                                 const ric_orbit_options *options, double last, ric_error *error) {
  double residual;
  assemble(c, cell, r); /* the factorisation has overwritten it */
  RIC_TRY(linear_least_norm(c->matrix, cell->impacts + c->column_count, c->rhs, c->solution,
                            r->scale / options->singular_condition, last, &residual, error));
  c->outcome.solvable = residual <= options->residual_tol;
  return RIC_OK;
}

/** Assembles and solves for the impulses p [m]. Needs the kernels of the responses.
 *
 *  Beyond options->singular_condition it returns the solution of least norm if that satisfies the equations to
 *  residual_tol; c->outcome says which. */
static ric_status contact_solve(contact_system *c, const unit_cell *cell, const response *r,
                                const ric_orbit_options *options, double *p, ric_error *error) {
  size_t m = cell->impacts;
  linear_factor factor;
  RIC_TRY(reserve(c, m, error));
  list_border(c, cell, r, options->resonance_tol);
  RIC_TRY(combine_modes(c, cell, error));
  assemble(c, cell, r);
  linear_work work = {
      .tau = c->tau, .norm = c->norm, .work = c->work, .permutation = c->permutation, .poll = options->poll};
  RIC_TRY(linear_solve(c->matrix, m + c->column_count, c->rhs, c->solution, &work, &factor, error));
  c->outcome = (linear_outcome){.condition = r->scale * factor.inverse_norm};
  c->outcome.singular = !(c->outcome.condition < options->singular_condition);
  if (c->outcome.singular)
    RIC_TRY(solve_singular(c, cell, r, options, factor.last, error));
  for (size_t a = 0; a < c->border_count; a++) {
    c->amplitude[a] = 0;
    for (size_t column = 0; column < c->column_count; column++)
      c->amplitude[a] += c->weights[a][column] * c->solution[m + column];
  }
  for (size_t k = 0; k < m; k++)
    p[k] = c->solution[k];
  return RIC_OK;
}

/** Smallest-to-largest eigenvalues [m] of the contact matrix, with all modes in the response. */
static ric_status contact_eigenvalues(contact_system *c, const unit_cell *cell, const response *r, double *eigenvalues,
                                      ric_poll poll, ric_error *error) {
  size_t m = cell->impacts;
  RIC_TRY(reserve(c, m, error));
  c->border_count = c->column_count = 0;
  assemble(c, cell, r);
  return linear_eigenvalues(c->matrix, m, eigenvalues, poll, error);
}

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
static void transform_impulses(const impulse *w, const unit_cell *cell, ric_role role, double *modal) {
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
static void compute_positions(const impulse *w, const unit_cell *cell) {
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

/* Asked between the transforms of the whole cell. */
static ric_status ask(const ric_orbit_options *options, ric_error *error) {
  return ric_poll_stops(options->poll) ? ric_fail(error, RIC_ESTOPPED, "stopped in the contact equations") : RIC_OK;
}

/* From the impulses to the state. */
static ric_status find_state(const impulse *w, const unit_cell *cell, const ric_orbit_options *options,
                             const boundary_state *state, ric_error *error) {
  const response *r = &w->response;
  transform_impulses(w, cell, RIC_ROLE_START, r->modal_start);
  RIC_TRY(ask(options, error));
  transform_impulses(w, cell, RIC_ROLE_HALF, r->modal_half);
  RIC_TRY(ask(options, error));
  compute_positions(w, cell);
  lattice_transform_inverse(r->transform, r->modal_start);
  RIC_TRY(ask(options, error));
  lattice_transform_inverse(r->transform, r->modal_half);
  write_state(w, cell, state);
  return ask(options, error);
}

ric_status impulse_solve(impulse *w, const unit_cell *cell, double period, const ric_orbit_options *options,
                         const boundary_state *state, linear_outcome *solution, ric_error *error) {
  RIC_TRY(prepare(w, cell, error));
  response *r = &w->response;
  RIC_TRY(ask(options, error));
  response_compute(r, &cell->chain, period, 1);
  RIC_TRY(ask(options, error));
  response_kernels(r, has_both_roles(cell));
  RIC_TRY(ask(options, error));
  RIC_TRY(contact_solve(&w->contacts, cell, r, options, w->p, error));
  *solution = w->contacts.outcome;
  if (solution->singular && !solution->solvable)
    return RIC_OK;
  return find_state(w, cell, options, state, error);
}

ric_status impulse_eigenvalues(impulse *w, const unit_cell *cell, double period, double *eigenvalues, ric_poll poll,
                               ric_error *error) {
  RIC_TRY(prepare(w, cell, error));
  response_compute(&w->response, &cell->chain, period, 0);
  response_kernels(&w->response, has_both_roles(cell));
  return contact_eigenvalues(&w->contacts, cell, &w->response, eigenvalues, poll, error);
}
