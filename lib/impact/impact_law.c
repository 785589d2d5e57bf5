#include "impact_law.h"

#include <stdlib.h>
#include <string.h>

#include "numeric/linear.h"

static const double coupling_tol = 1e-13; /* of g_i^T M^-1 g_j against the diagonal: below it, rounding */

/* Accelerations below this fraction of their terms count as zero: those of user gaps are differences. */
static const double acceleration_tol = 1e-7;

ric_status impact_solver_init(impact_solver *solver, const ric_system *system, ric_error *error) {
  *solver = (impact_solver){.system = system};
  if (system->model->direction)
    return RIC_OK;
  solver->before = malloc(system->coordinates * sizeof *solver->before);
  solver->after = malloc(system->coordinates * sizeof *solver->after);
  if (solver->before && solver->after)
    return RIC_OK;
  impact_solver_clear(solver);
  return ric_fail(error, RIC_ENOMEM, "no memory for impacts of %zu states", system->coordinates);
}

void impact_solver_clear(impact_solver *solver) {
  complementarity_clear(&solver->lcp);
  free(solver->g);
  free(solver->w);
  free(solver->directions);
  free(solver->matrix);
  free(solver->rhs);
  free(solver->solution);
  free(solver->before);
  free(solver->after);
  *solver = (impact_solver){0};
}

/* Makes room for directions, and for their complementarity problem. */
ric_status impact_solver_reserve(impact_solver *s, size_t count, ric_error *error) {
  size_t m = s->system->speeds;
  if (count <= s->capacity || !s->system->model->direction)
    return RIC_OK;
  impact_solver kept = {.system = s->system, .lcp = s->lcp, .before = s->before, .after = s->after};
  s->lcp = (complementarity_work){0};
  s->before = s->after = NULL;
  impact_solver_clear(s);
  *s = kept;
  s->g = malloc(count * m * sizeof *s->g);
  s->w = malloc(count * m * sizeof *s->w);
  s->directions = malloc(count * sizeof *s->directions);
  s->matrix = malloc(count * count * sizeof *s->matrix);
  s->rhs = malloc(count * sizeof *s->rhs);
  s->solution = malloc(count * sizeof *s->solution);
  if (!s->g || !s->w || !s->directions || !s->matrix || !s->rhs || !s->solution)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu contacts at one time", count);
  s->capacity = count;
  return RIC_OK;
}

static ric_status callback_error(ric_error *error, double t, size_t obstacle, const char *trouble) {
  return ric_fail(error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", t, obstacle, trouble);
}

static ric_status find_direction(impact_solver *s, size_t slot, size_t obstacle, double t, const double *q,
                                 ric_error *error) {
  size_t m = s->system->speeds;
  contact_direction *d = &s->directions[slot];
  *d = (contact_direction){.g = s->g + slot * m, .w = s->w + slot * m};
  const char *trouble = s->system->model->direction(s->system, obstacle, t, q, d);
  return trouble ? callback_error(error, t, obstacle, trouble) : RIC_OK;
}

/* g_a . w_b over the common speeds. */
static double product(const contact_direction *a, const contact_direction *b) {
  size_t from = a->first > b->first ? a->first : b->first;
  size_t a_end = a->first + a->count, b_end = b->first + b->count, to = a_end < b_end ? a_end : b_end;
  double sum = 0;
  for (size_t i = from; i < to; i++)
    sum += a->g[i - a->first] * b->w[i - b->first];
  return sum;
}

static void push(const contact_direction *d, double impulse, double *u) {
  for (size_t i = 0; i < d->count; i++)
    u[d->first + i] += impulse * d->w[i];
}

static ric_status read_rate(const impact_solver *s, double t, const double *q, const double *u, size_t obstacle,
                            double *rate, ric_error *error) {
  const char *trouble = s->system->model->gap_rate(s->system, obstacle, t, q, u, rate);
  return trouble ? callback_error(error, t, obstacle, trouble) : RIC_OK;
}

/* Minus the work of an impulse on the speeds before and after, on their mean. The motion of the obstacle, `offset`, is
 * excluded. */
static double work_lost(const impact *c, double offset) {
  return c->impulse * (offset - (c->rate + c->rate_end) / 2);
}

/* [FN97] (2.9) for a single contact. */
static ric_status apply_alone(impact_solver *s, double t, const double *q, double *u, impact *c, ric_error *error) {
  double e = c->restitution;
  RIC_TRY(find_direction(s, 0, c->obstacle, t, q, error));
  RIC_TRY(read_rate(s, t, q, u, c->obstacle, &c->rate, error));
  double inverse_mass = product(&s->directions[0], &s->directions[0]);
  c->impulse = c->rate < 0 ? -(1 + e) * c->rate / inverse_mass : 0;
  c->rate_end = c->rate < 0 ? -e * c->rate : c->rate;
  c->loss = work_lost(c, s->directions[0].offset);
  c->coupled = false;
  push(&s->directions[0], c->impulse, u);
  return RIC_OK;
}

static void fill_matrix(impact_solver *s, size_t count) {
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++)
      s->matrix[i * count + j] = product(&s->directions[i], &s->directions[j]);
}

static ric_status set_up(impact_solver *s, double t, const double *q, const double *u, impact *contacts, size_t count,
                         ric_error *error) {
  for (size_t i = 0; i < count; i++) {
    RIC_TRY(find_direction(s, i, contacts[i].obstacle, t, q, error));
    RIC_TRY(read_rate(s, t, q, u, contacts[i].obstacle, &contacts[i].rate, error));
    s->rhs[i] = (1 + contacts[i].restitution) * contacts[i].rate;
  }
  fill_matrix(s, count);
  return RIC_OK;
}

static bool couples(const double *matrix, size_t count, size_t i) {
  for (size_t j = 0; j < count; j++) {
    double scale = sqrt(matrix[i * count + i] * matrix[j * count + j]);
    if (j != i && fabs(matrix[i * count + j]) > coupling_tol * scale)
      return true;
  }
  return false;
}

/* Moreau's form for all of them together. */
static ric_status apply_together(impact_solver *s, double t, const double *q, double *u, impact *contacts, size_t count,
                                 ric_error *error) {
  RIC_TRY(set_up(s, t, q, u, contacts, count, error));
  RIC_TRY(complementarity_solve(&s->lcp, count, s->matrix, s->rhs, s->solution, error));
  for (size_t i = 0; i < count; i++) {
    impact *c = &contacts[i];
    c->impulse = s->solution[i];
    c->rate_end = c->rate;
    for (size_t j = 0; j < count; j++)
      c->rate_end += s->matrix[i * count + j] * s->solution[j];
    c->loss = work_lost(c, s->directions[i].offset);
    c->coupled = couples(s->matrix, count, i);
    push(&s->directions[i], c->impulse, u);
  }
  return RIC_OK;
}

/* One impact map; s->before keeps the state before it. */
static ric_status apply_map(impact_solver *s, double t, double *x, impact *c, ric_error *error) {
  const ric_system *system = s->system;
  size_t bytes = system->coordinates * sizeof *x;
  double energy_before = ric_system_energy(system, t, x, NULL);
  RIC_TRY(read_rate(s, t, x, NULL, c->obstacle, &c->rate, error));
  c->rate_end = c->rate;
  c->impulse = c->rate < 0 ? NAN : 0;
  c->loss = 0;
  c->coupled = false;
  if (!(c->rate < 0)) /* a previous impact has reversed this gap rate */
    return RIC_OK;
  const char *trouble = system->model->impact(system, c->obstacle, t, x, s->after);
  if (trouble)
    return callback_error(error, t, c->obstacle, trouble);
  memcpy(s->before, x, bytes);
  memcpy(x, s->after, bytes);
  c->loss = energy_before - ric_system_energy(system, t, x, NULL);
  return read_rate(s, t, x, NULL, c->obstacle, &c->rate_end, error);
}

/* Maps in order of the obstacles; coupled if one changes the initial rate of another. */
static ric_status apply_maps(impact_solver *s, double t, double *x, impact *contacts, size_t count, ric_error *error) {
  for (size_t i = 0; i < count; i++)
    RIC_TRY(read_rate(s, t, x, NULL, contacts[i].obstacle, &contacts[i].rate_end, error));
  for (size_t i = 0; i < count; i++) {
    double alone = contacts[i].rate_end;
    RIC_TRY(apply_map(s, t, x, &contacts[i], error));
    contacts[i].coupled = fabs(contacts[i].rate - alone) > coupling_tol * (1 + fabs(alone));
  }
  return RIC_OK;
}

ric_status impact_apply(impact_solver *solver, double t, double *q, double *u, impact *contacts, size_t count,
                        ric_error *error) {
  if (!solver->system->model->direction)
    return apply_maps(solver, t, q, contacts, count, error);
  if (!solver->system->uncoupled && count > 1) {
    RIC_TRY(impact_solver_reserve(solver, count, error));
    return apply_together(solver, t, q, u, contacts, count, error);
  }
  RIC_TRY(impact_solver_reserve(solver, 1, error));
  for (size_t i = 0; i < count; i++)
    RIC_TRY(apply_alone(solver, t, q, u, &contacts[i], error));
  return RIC_OK;
}

ric_status impact_stick(impact_solver *solver, double t, double *q, double *u, impact *contact, double restitution,
                        ric_error *error) {
  double left = contact->rate_end, part = restitution / (1 + restitution);
  if (solver->system->model->direction) {
    RIC_TRY(find_direction(solver, 0, contact->obstacle, t, q, error));
    push(&solver->directions[0], -part * contact->impulse, u);
    contact->impulse -= part * contact->impulse;
    contact->rate_end -= part * (contact->rate_end - contact->rate);
    if (contact->rate < 0)
      contact->rate_end = 0; /* the impact, to rounding */
    contact->loss = work_lost(contact, solver->directions[0].offset);
  } else { /* the gap rate is zero between the states before and after */
    double back = left / (left - contact->rate), energy = ric_system_energy(solver->system, t, q, NULL);
    for (size_t i = 0; i < solver->system->coordinates; i++)
      q[i] -= back * (q[i] - solver->before[i]);
    contact->loss += energy - ric_system_energy(solver->system, t, q, NULL);
    contact->rate_end = 0;
  }
  return RIC_OK;
}

/* The equations A p = -(1 + e) h' of contacts [count] with consecutive directions in the solver. */
static ric_status reflect_together(impact_solver *s, double t, const double *q, double *u, const size_t *obstacles,
                                   const double *restitution, size_t count, double *loss, ric_error *error) {
  for (size_t i = 0; i < count; i++) {
    RIC_TRY(find_direction(s, i, obstacles[i], t, q, error));
    RIC_TRY(read_rate(s, t, q, u, obstacles[i], &s->rhs[i], error));
    s->solution[i] = -(restitution ? 1 + restitution[i] : 1) * s->rhs[i];
  }
  fill_matrix(s, count);
  cholesky_factor_semidefinite(s->matrix, count);
  cholesky_solve(s->matrix, count, s->solution);
  for (size_t i = 0; i < count; i++) {
    impact c = {
        .rate = s->rhs[i], .rate_end = restitution ? -restitution[i] * s->rhs[i] : 0, .impulse = s->solution[i]};
    *loss += work_lost(&c, s->directions[i].offset);
    push(&s->directions[i], c.impulse, u);
  }
  return RIC_OK;
}

ric_status impact_reflect(impact_solver *solver, double t, const double *q, double *u, const size_t *obstacles,
                          const double *restitution, size_t count, double *loss, ric_error *error) {
  size_t together = solver->system->uncoupled ? 1 : count;
  double sum = 0;
  RIC_TRY(impact_solver_reserve(solver, together, error));
  for (size_t i = 0; i < count; i += together)
    RIC_TRY(
        reflect_together(solver, t, q, u, obstacles + i, restitution ? restitution + i : NULL, together, &sum, error));
  if (loss)
    *loss = sum;
  return RIC_OK;
}

ric_status impact_close_in(impact_solver *solver, double t, const double *q, double *u, const size_t *obstacles,
                           size_t count, ric_error *error) {
  RIC_TRY(impact_solver_reserve(solver, count, error));
  for (size_t i = 0; i < count; i++) {
    RIC_TRY(find_direction(solver, i, obstacles[i], t, q, error));
    solver->solution[i] = -ric_system_gap(solver->system, obstacles[i], t, q);
  }
  fill_matrix(solver, count);
  cholesky_factor_semidefinite(solver->matrix, count);
  cholesky_solve(solver->matrix, count, solver->solution);
  for (size_t i = 0; i < count; i++)
    push(&solver->directions[i], solver->solution[i], u);
  return RIC_OK;
}

static ric_status force_alone(impact_solver *s, double t, const double *q, size_t obstacle, double *b, double *lambda,
                              ric_error *error) {
  double inverse_mass = 1; /* of impact maps: only the sign counts */
  if (s->system->model->direction) {
    RIC_TRY(find_direction(s, 0, obstacle, t, q, error));
    inverse_mass = product(&s->directions[0], &s->directions[0]);
  }
  *lambda = fmax(-*b / inverse_mass, 0);
  *b = fmax(*b, 0);
  return RIC_OK;
}

/* A lambda + b in the place of b. */
static void add_forces(const impact_solver *s, double *b, const double *lambda, size_t count) {
  for (size_t i = 0; i < count; i++) {
    double terms = fabs(b[i]);
    for (size_t j = 0; j < count; j++) {
      double term = s->matrix[i * count + j] * lambda[j];
      b[i] += term;
      terms += fabs(term);
    }
    b[i] = b[i] > acceleration_tol * terms ? b[i] : 0;
  }
}

ric_status contact_forces(impact_solver *solver, double t, const double *q, const size_t *obstacles, double *b,
                          size_t count, double *lambda, ric_error *error) {
  bool maps = !solver->system->model->direction, alone = maps || solver->system->uncoupled || count == 1;
  if (!maps)
    RIC_TRY(impact_solver_reserve(solver, alone ? 1 : count, error));
  for (size_t i = 0; alone && i < count; i++)
    RIC_TRY(force_alone(solver, t, q, obstacles[i], &b[i], &lambda[i], error));
  if (alone)
    return RIC_OK;
  for (size_t i = 0; i < count; i++)
    RIC_TRY(find_direction(solver, i, obstacles[i], t, q, error));
  fill_matrix(solver, count);
  RIC_TRY(complementarity_solve(&solver->lcp, count, solver->matrix, b, lambda, error));
  add_forces(solver, b, lambda, count);
  return RIC_OK;
}
