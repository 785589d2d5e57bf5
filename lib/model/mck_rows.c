/* Matrices of M-C-K systems, and their division by the mass matrix. */
#include "mck_rows.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "mck_system.h"

static size_t panels(size_t n) {
  return (n + MCK_PANEL - 1) / MCK_PANEL;
}

int mck_square_fits(size_t n) {
  return n <= (SIZE_MAX / sizeof(double)) / (n + MCK_PANEL);
}

/* Place of the entry (i, 0); entry (i, j) lies j * MCK_PANEL further. */
static size_t dense_row(const mck_rows *rows, size_t i) {
  return i / MCK_PANEL * rows->n * MCK_PANEL + i % MCK_PANEL;
}

static ric_status copy_dense(mck_rows *rows, const double *values, const double *scale, ric_error *error) {
  size_t n = rows->n;
  rows->values = mck_square_fits(n) ? calloc(panels(n) * n, MCK_PANEL * sizeof *rows->values) : NULL;
  if (!rows->values)
    return ric_fail(error, RIC_ENOMEM, "no memory for a matrix of %zu rows", n);
  for (size_t i = 0; i < n; i++) {
    double *row = rows->values + dense_row(rows, i), own = scale ? scale[i] : 1;
    for (size_t j = 0; j < n; j++)
      row[j * MCK_PANEL] = own * values[i * n + j];
  }
  return RIC_OK;
}

static ric_status copy_sparse(mck_rows *rows, const ric_matrix *matrix, const double *scale, ric_error *error) {
  size_t n = rows->n, first = matrix->row_start[0], count = matrix->row_start[n] - first;
  rows->row_start = malloc((n + 1) * sizeof *rows->row_start);
  rows->column = malloc((count ? count : 1) * sizeof *rows->column);
  rows->values = malloc((count ? count : 1) * sizeof *rows->values);
  if (!rows->row_start || !rows->column || !rows->values)
    return ric_fail(error, RIC_ENOMEM, "no memory for a sparse matrix of %zu entries", count);
  for (size_t i = 0; i < n; i++)
    for (size_t k = matrix->row_start[i]; k < matrix->row_start[i + 1]; k++)
      rows->values[k - first] = scale ? scale[i] * matrix->values[k] : matrix->values[k];
  for (size_t i = 0; i <= n; i++)
    rows->row_start[i] = matrix->row_start[i] - first;
  if (count)
    memcpy(rows->column, matrix->column + first, count * sizeof *rows->column);
  return RIC_OK;
}

ric_status mck_rows_copy(mck_rows *rows, const ric_matrix *matrix, size_t n, const double *scale, ric_error *error) {
  *rows = (mck_rows){.n = n};
  if (!matrix->values)
    return RIC_OK;
  return matrix->row_start ? copy_sparse(rows, matrix, scale, error) : copy_dense(rows, matrix->values, scale, error);
}

void mck_rows_clear(mck_rows *rows) {
  free(rows->values);
  free(rows->row_start);
  free(rows->column);
  *rows = (mck_rows){0};
}

static void apply_panel(const double *restrict panel, size_t n, double factor, const double *restrict x,
                        double *restrict sum) {
  double s[MCK_PANEL] = {0};
  for (size_t j = 0; j < n; j++)
    for (size_t r = 0; r < MCK_PANEL; r++)
      s[r] += panel[j * MCK_PANEL + r] * x[j];
  for (size_t r = 0; r < MCK_PANEL; r++)
    sum[r] = factor * s[r];
}

static void apply_dense(const mck_rows *rows, double factor, const double *x, double *y) {
  for (size_t first = 0; first < rows->n; first += MCK_PANEL) {
    double sum[MCK_PANEL];
    size_t count = rows->n - first < MCK_PANEL ? rows->n - first : MCK_PANEL;
    apply_panel(rows->values + first * rows->n, rows->n, factor, x, sum);
    for (size_t r = 0; r < count; r++)
      y[first + r] += sum[r];
  }
}

double mck_rows_dot(const mck_rows *rows, size_t i, const double *x) {
  double sum = 0;
  if (rows->row_start) {
    for (size_t k = rows->row_start[i]; k < rows->row_start[i + 1]; k++)
      sum += rows->values[k] * x[rows->column[k]];
  } else if (rows->values) {
    const double *row = rows->values + dense_row(rows, i);
    for (size_t j = 0; j < rows->n; j++)
      sum += row[j * MCK_PANEL] * x[j];
  }
  return sum;
}

void mck_rows_apply(const mck_rows *rows, double factor, const double *x, double *y) {
  if (!rows->values)
    return;
  if (!rows->row_start) {
    apply_dense(rows, factor, x, y);
    return;
  }
  for (size_t i = 0; i < rows->n; i++)
    y[i] += factor * mck_rows_dot(rows, i, x);
}

static double row_norm(const mck_rows *rows, size_t i) {
  double sum = 0;
  if (rows->row_start) {
    for (size_t k = rows->row_start[i]; k < rows->row_start[i + 1]; k++)
      sum += fabs(rows->values[k]);
  } else {
    const double *row = rows->values + dense_row(rows, i);
    for (size_t j = 0; j < rows->n; j++)
      sum += fabs(row[j * MCK_PANEL]);
  }
  return sum;
}

double mck_rows_norm(const mck_rows *rows) {
  double largest = 0;
  for (size_t i = 0; rows->values && i < rows->n; i++)
    largest = fmax(largest, row_norm(rows, i));
  return largest;
}

static int is_diagonal(const ric_matrix *m, size_t n) {
  if (m->row_start)
    return 1;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      if (i != j && m->values[i * n + j] != 0)
        return 0;
  return 1;
}

static double diagonal_entry(const ric_matrix *m, size_t n, size_t i) {
  if (!m->row_start)
    return m->values[i * n + i];
  double sum = 0;
  for (size_t k = m->row_start[i]; k < m->row_start[i + 1]; k++)
    sum += m->values[k];
  return sum;
}

static ric_status scaled_force(double **to, const double *force, const double *scale, size_t n, ric_error *error) {
  if (!force)
    return RIC_OK;
  *to = malloc(n * sizeof **to);
  if (!*to)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu forces", n);
  for (size_t i = 0; i < n; i++)
    (*to)[i] = scale ? scale[i] * force[i] : force[i];
  return RIC_OK;
}

static ric_status divide_by_diagonal(mck_system *s, const ric_mck *mck, ric_error *error) {
  size_t n = mck->coordinates;
  s->mass = malloc(n * sizeof *s->mass);
  s->inverse = malloc(n * sizeof *s->inverse);
  if (!s->mass || !s->inverse)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu masses", n);
  for (size_t i = 0; i < n; i++) {
    s->mass[i] = diagonal_entry(&mck->mass, n, i);
    if (!(s->mass[i] > 0))
      return ric_fail(error, RIC_EINVAL, "mass is not positive definite: mass[%zu][%zu] = %g", i, i, s->mass[i]);
    s->inverse[i] = 1 / s->mass[i];
  }
  RIC_TRY(mck_rows_copy(&s->damping, &mck->damping, n, s->inverse, error));
  RIC_TRY(mck_rows_copy(&s->stiffness, &mck->stiffness, n, s->inverse, error));
  RIC_TRY(scaled_force(&s->force_cos, mck->force_cos, s->inverse, n, error));
  return scaled_force(&s->force_sin, mck->force_sin, s->inverse, n, error);
}

/* M = P^T L D L^T P. Pivoted, because GSL's plain Cholesky calls its error handler where a matrix is not positive
 * definite. */
typedef struct mass_factor {
  size_t n;
  double *ldl, *column, *square; /* [n][n], [n], [n][n] for a matrix to be divided */
  size_t *order;
} mass_factor;

static void factor_clear(mass_factor *f) {
  free(f->ldl);
  free(f->column);
  free(f->square);
  free(f->order);
}

/* A pivot that is rounding relative to its diagonal entry does not prove positive definiteness. */
static ric_status check_pivots(const mass_factor *f, const double *mass, ric_error *error) {
  for (size_t k = 0; k < f->n; k++) {
    size_t i = f->order[k];
    double pivot = f->ldl[k * f->n + k], entry = mass[i * f->n + i];
    if (!(pivot > 4 * DBL_EPSILON * (double)f->n * entry && pivot < INFINITY))
      return ric_fail(error, RIC_EINVAL, "mass is not positive definite: pivot %g in row %zu, where the entry is %g",
                      pivot, i, entry);
  }
  return RIC_OK;
}

static ric_status factorise(mass_factor *f, const double *mass, size_t n, ric_error *error) {
  *f = (mass_factor){.n = n};
  f->ldl = malloc(n * n * sizeof *f->ldl);
  f->square = malloc(n * n * sizeof *f->square);
  f->column = malloc(n * sizeof *f->column);
  f->order = malloc(n * sizeof *f->order);
  if (!f->ldl || !f->square || !f->column || !f->order)
    return ric_fail(error, RIC_ENOMEM, "no memory for a mass matrix of %zu rows", n);
  memcpy(f->ldl, mass, n * n * sizeof *mass);
  gsl_matrix_view a = gsl_matrix_view_array(f->ldl, n, n);
  gsl_permutation p = {.size = n, .data = f->order};
  gsl_linalg_pcholesky_decomp(&a.matrix, &p);
  return check_pivots(f, mass, error);
}

static void solve_mass(const mass_factor *f, double *x) {
  gsl_matrix_const_view a = gsl_matrix_const_view_array(f->ldl, f->n, f->n);
  gsl_vector_view v = gsl_vector_view_array(x, f->n);
  gsl_permutation p = {.size = f->n, .data = f->order};
  gsl_linalg_pcholesky_svx(&a.matrix, &p, &v.vector);
}

static void expand(const ric_matrix *m, size_t n, double *square) {
  if (!m->row_start) {
    memcpy(square, m->values, n * n * sizeof *square);
    return;
  }
  memset(square, 0, n * n * sizeof *square);
  for (size_t i = 0; i < n; i++)
    for (size_t k = m->row_start[i]; k < m->row_start[i + 1]; k++)
      square[i * n + m->column[k]] += m->values[k];
}

static ric_status divide_matrix(mck_rows *rows, const mass_factor *f, const ric_matrix *m, ric_error *error) {
  size_t n = f->n;
  if (!m->values)
    return mck_rows_copy(rows, m, n, NULL, error);
  expand(m, n, f->square);
  for (size_t j = 0; j < n; j++) {
    for (size_t i = 0; i < n; i++)
      f->column[i] = f->square[i * n + j];
    solve_mass(f, f->column);
    for (size_t i = 0; i < n; i++)
      f->square[i * n + j] = f->column[i];
  }
  return mck_rows_copy(rows, &(ric_matrix){.values = f->square}, n, NULL, error);
}

/* Symmetric to the last bit, so that the mutual actions of impulses are equal. */
static void invert(const mass_factor *f, double *inverse) {
  size_t n = f->n;
  memset(inverse, 0, n * n * sizeof *inverse);
  for (size_t i = 0; i < n; i++) {
    inverse[i * n + i] = 1;
    solve_mass(f, inverse + i * n);
  }
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++)
      inverse[i * n + j] = inverse[j * n + i] = (inverse[i * n + j] + inverse[j * n + i]) / 2;
}

static ric_status divide_all(mck_system *s, const ric_mck *mck, const mass_factor *f, ric_error *error) {
  invert(f, s->inverse);
  RIC_TRY(divide_matrix(&s->damping, f, &mck->damping, error));
  RIC_TRY(divide_matrix(&s->stiffness, f, &mck->stiffness, error));
  RIC_TRY(scaled_force(&s->force_cos, mck->force_cos, NULL, f->n, error));
  RIC_TRY(scaled_force(&s->force_sin, mck->force_sin, NULL, f->n, error));
  if (s->force_cos)
    solve_mass(f, s->force_cos);
  if (s->force_sin)
    solve_mass(f, s->force_sin);
  return RIC_OK;
}

static ric_status divide_by_dense(mck_system *s, const ric_mck *mck, ric_error *error) {
  size_t n = mck->coordinates;
  const double *m = mck->mass.values;
  s->mass = malloc(n * n * sizeof *s->mass); /* no overflow: the caller has such a matrix */
  s->inverse = malloc(n * n * sizeof *s->inverse);
  if (!s->mass || !s->inverse)
    return ric_fail(error, RIC_ENOMEM, "no memory for a mass matrix of %zu rows", n);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      s->mass[i * n + j] = m[i * n + j] / 2 + m[j * n + i] / 2;
  mass_factor f;
  ric_status status = factorise(&f, s->mass, n, error);
  if (status == RIC_OK)
    status = divide_all(s, mck, &f, error);
  factor_clear(&f);
  return status;
}

ric_status mck_divide_by_mass(mck_system *s, const ric_mck *mck, ric_error *error) {
  s->base.uncoupled = is_diagonal(&mck->mass, mck->coordinates);
  return s->base.uncoupled ? divide_by_diagonal(s, mck, error) : divide_by_dense(s, mck, error);
}
