#include "mck_rows.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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
