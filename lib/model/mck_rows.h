/* Matrices as M-C-K systems keep them: dense in panels of rows, sparse in compressed rows, or zero. Internal.
 *
 * A panel holds PANEL rows column by column, so that the products of its rows run side by side: the compiler vectorises
 * them without changing the order of any sum. */
#ifndef RICOCHET_MCK_ROWS_H
#define RICOCHET_MCK_ROWS_H

#include "ricochet/mck.h"

enum { MCK_PANEL = 8 };

/** All NULL: zero. `row_start` NULL: dense, values [panels][n][MCK_PANEL], the last panel filled up with zeros. */
typedef struct mck_rows {
  size_t n;
  double *values;
  size_t *row_start, *column;
} mck_rows;

/** Whether a square matrix of n rows has a number of entries that memory can address. */
int mck_square_fits(size_t n);

/** diag(scale) A; `scale` [n] may be NULL for ones. Copies. @returns RIC_ENOMEM; clear `rows` whatever the status. */
ric_status mck_rows_copy(mck_rows *rows, const ric_matrix *matrix, size_t n, const double *scale, ric_error *error);

void mck_rows_clear(mck_rows *rows);

/** y += factor A x; x and y are [n] and do not overlap. */
void mck_rows_apply(const mck_rows *rows, double factor, const double *x, double *y);

/** Product of row i with x [n]; the same sum as in mck_rows_apply. */
double mck_rows_dot(const mck_rows *rows, size_t i, const double *x);

/** Largest sum of the absolute values of a row. */
double mck_rows_norm(const mck_rows *rows);

#endif
