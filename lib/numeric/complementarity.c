#include "complementarity.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "linear.h"

/* An unknown depends on others if its unit diagonal is reduced below this: contact directions that differ by less than
 * 1e-5 count as equal. */
static const double dependence_tol = 1e-10;

/* A reduced diagonal may be negative by rounding errors divided by the square root of the value above; more is no
 * rounding error. */
static const double indefinite_tol = 1e-8;

/* w counts as zero below this fraction of its terms, which covers the rounding errors of the solution. */
static const double residual_tol = 1e-12;

/* Largest number of exchanges per unknown before rounding errors are assumed to cycle; a few are usual. */
enum { MOST_EXCHANGES = 50 };

static const char no_solution[] = "there is no solution";
static const char not_semidefinite[] = "the matrix is not positive semidefinite, or a value not finite";
static const char rounding_decides[] = "rounding errors decide";

typedef enum unknown_state {
  OUTSIDE, /* of S, zero */
  INSIDE,
  PASSED /* outside; its w is zero up to rounding errors until S changes */
} unknown_state;

/* The problem with rows and columns scaled to a unit diagonal, and the set S of unknowns that may be positive. */
typedef struct problem {
  size_t size, count;   /* count of S */
  double *scale;        /* [size] */
  double *a, *b, *z;    /* [size][size], [size], [size] scaled */
  double *factor;       /* [count][size] rows of Cholesky's L for A_SS */
  double *target;       /* [count + 1] in the order of S: the solution for S, or a direction */
  size_t *set;          /* [count] S */
  unsigned char *state; /* [size] unknown_state */
} problem;

static ric_status reserve(complementarity_work *w, size_t size, ric_error *error) {
  if (size <= w->capacity)
    return RIC_OK;
  complementarity_clear(w);
  bool fits = size < SIZE_MAX / sizeof(double) / 2 / (size + 4);
  w->values = fits ? malloc((2 * size * size + 4 * size + 1) * sizeof *w->values) : NULL;
  w->set = fits ? malloc(size * (sizeof *w->set + 1)) : NULL;
  if (!w->values || !w->set) {
    complementarity_clear(w);
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu contacts that act together", size);
  }
  w->capacity = size;
  return RIC_OK;
}

void complementarity_clear(complementarity_work *work) {
  free(work->values);
  free(work->set);
  *work = (complementarity_work){0};
}

static problem lay_out_work(const complementarity_work *w, size_t size) {
  double *next = w->values;
  problem p = {.size = size, .a = next, .factor = next + size * size};
  next += 2 * size * size;
  p.b = next;
  p.z = next + size;
  p.scale = next + 2 * size;
  p.target = next + 3 * size; /* one longer */
  p.set = w->set;
  p.state = (unsigned char *)(w->set + size);
  return p;
}

/* @returns whether all entries are finite and the diagonal is that of a positive semidefinite matrix. */
static bool scale(problem *p, const double *A, const double *b) {
  size_t n = p->size;
  for (size_t i = 0; i < n; i++) {
    double own = A[i * n + i];
    if (!(own >= 0 && own < INFINITY && isfinite(b[i])))
      return false;
    p->scale[i] = own > 0 ? 1 / sqrt(own) : 1;
    p->b[i] = b[i] * p->scale[i];
    p->z[i] = 0;
    p->state[i] = OUTSIDE;
  }
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      double entry = (A[i * n + j] / 2 + A[j * n + i] / 2) * p->scale[i] * p->scale[j];
      p->a[i * n + j] = entry;
      if (!(fabs(entry) <= 1 + indefinite_tol)) /* Cauchy and Schwarz */
        return false;
    }
  return true;
}

/* --- Cholesky's factor of A_SS --------------------------------------------------------------------------------- */

/* Row of the factor for member `place` of S; the earlier ones exist. @returns the reduced diagonal */
static double factor_row(problem *p, size_t place) {
  double *row = p->factor + place * p->size;
  for (size_t k = 0; k <= place; k++)
    row[k] = p->a[p->set[place] * p->size + p->set[k]];
  double left = cholesky_row(p->factor, p->size, place);
  row[place] = left > 0 ? sqrt(left) : 0;
  return left;
}

static void remove_member(problem *p, size_t place) {
  p->state[p->set[place]] = OUTSIDE;
  p->z[p->set[place]] = 0;
  p->count--;
  for (size_t k = place; k < p->count; k++) {
    p->set[k] = p->set[k + 1];
    factor_row(p, k);
  }
}

/* --- exchanges ------------------------------------------------------------------------------------------------- */

/* w_i, and the sum of the absolute values of its terms. */
static double residual_at(const problem *p, size_t i, double *terms) {
  double w = p->b[i];
  *terms = fabs(w);
  for (size_t k = 0; k < p->count; k++) {
    double term = p->a[i * p->size + p->set[k]] * p->z[p->set[k]];
    w += term;
    *terms += fabs(term);
  }
  return w;
}

/* The unknown outside S with the most negative w; `size` if none is negative. */
static size_t find_entering(const problem *p) {
  size_t found = p->size;
  double least = 0;
  for (size_t i = 0; i < p->size; i++) {
    double terms = 0, w = p->state[i] == OUTSIDE ? residual_at(p, i, &terms) : 0;
    if (w < least && w < -residual_tol * terms) {
      least = w;
      found = i;
    }
  }
  return found;
}

/* Adds share * step [count] to z_S. */
static void move(problem *p, const double *step, double share) {
  for (size_t k = 0; k < p->count; k++)
    p->z[p->set[k]] += share * step[k];
}

/* The member of S that reaches zero first along z_S + share step, share <= `most`; `count` if none does. */
static size_t find_blocking(const problem *p, const double *step, double most, double *share) {
  size_t found = p->count;
  *share = most;
  for (size_t k = 0; k < p->count; k++)
    if (step[k] < 0 && p->z[p->set[k]] < -step[k] * *share) {
      *share = p->z[p->set[k]] / -step[k];
      found = k;
    }
  return found;
}

/* Moves z_S to the solution for S; members that reach zero leave S. */
static void solve_set(problem *p) {
  while (p->count > 0) {
    double share;
    for (size_t k = 0; k < p->count; k++)
      p->target[k] = -p->b[p->set[k]];
    cholesky_solve_lower(p->factor, p->size, p->count, p->target);
    cholesky_solve_upper(p->factor, p->size, p->count, p->target);
    for (size_t k = 0; k < p->count; k++)
      p->target[k] -= p->z[p->set[k]];
    size_t blocking = find_blocking(p, p->target, 1, &share);
    move(p, p->target, share);
    if (blocking == p->count)
      return;
    remove_member(p, blocking);
  }
}

/* Adds `enter` to S; its row of the factor exists or will be computed by the caller. */
static void include(problem *p, size_t enter) {
  for (size_t i = 0; i < p->size; i++)
    p->state[i] = p->state[i] == PASSED ? OUTSIDE : p->state[i];
  p->set[p->count++] = enter;
  p->state[enter] = INSIDE;
}

/* Since `enter` depends on S, its w is the same combination of those of S: zero up to their rounding errors. */
static bool is_rounding(const problem *p, size_t enter, const double *direction) {
  double terms, sum = 1, w = residual_at(p, enter, &terms);
  for (size_t k = 0; k < p->count; k++)
    sum += fabs(direction[k]);
  return fabs(w) <= residual_tol * terms * sum;
}

/* Unknown `enter` depends on S, so there is a direction that leaves w_S unchanged and decreases the objective. Follows
 * it until a member of S reaches zero, which `enter` replaces. @returns NULL, or why there is no solution */
static const char *exchange(problem *p, size_t enter) {
  double share, *direction = p->target;
  memcpy(direction, p->factor + p->count * p->size, p->count * sizeof *direction);
  cholesky_solve_upper(p->factor, p->size, p->count, direction);
  for (size_t k = 0; k < p->count; k++)
    direction[k] = -direction[k];
  if (is_rounding(p, enter, direction)) {
    p->state[enter] = PASSED;
    return NULL;
  }
  size_t blocking = find_blocking(p, direction, INFINITY, &share);
  if (blocking == p->count)
    return no_solution;
  move(p, direction, share);
  p->z[enter] = share;
  remove_member(p, blocking);
  include(p, enter);
  if (factor_row(p, p->count - 1) <= dependence_tol) /* on the remaining S as well: tested again */
    remove_member(p, p->count - 1);
  return NULL;
}

/* @returns NULL, or why there is no solution */
static const char *enter_set(problem *p, size_t enter) {
  p->set[p->count] = enter;
  double left = factor_row(p, p->count);
  if (left < -indefinite_tol)
    return not_semidefinite;
  if (left <= dependence_tol)
    return exchange(p, enter);
  include(p, enter);
  return NULL;
}

static const char *solve_problem(problem *p) {
  for (size_t round = 0; round < MOST_EXCHANGES * p->size; round++) {
    size_t enter = find_entering(p);
    if (enter == p->size)
      return NULL;
    const char *trouble = enter_set(p, enter);
    if (trouble)
      return trouble;
    solve_set(p);
  }
  return rounding_decides;
}

ric_status complementarity_solve(complementarity_work *work, size_t size, const double *A, const double *b, double *z,
                                 ric_error *error) {
  if (size == 0)
    return RIC_OK;
  RIC_TRY(reserve(work, size, error));
  problem p = lay_out_work(work, size);
  const char *trouble = scale(&p, A, b) ? solve_problem(&p) : not_semidefinite;
  if (trouble)
    return ric_fail(error, RIC_ENUMERIC, "%zu contacts that act together: %s", size, trouble);
  for (size_t i = 0; i < size; i++)
    z[i] = p.z[i] > 0 ? p.z[i] * p.scale[i] : 0;
  return RIC_OK;
}
