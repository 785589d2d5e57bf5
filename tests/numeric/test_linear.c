/* Factorisations that can be stopped are those of GSL to the bit. */
#include "numeric/linear.h"
#include "scenario/random_source.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sort_vector.h>

enum { MOST = 130 };

/* Random numbers, in some matrices with rows that repeat. */
static void fill(random_source *source, double *matrix, size_t size, bool dependent) {
  for (size_t i = 0; i < size * size; i++)
    matrix[i] = random_uniform(source, -1, 1);
  if (dependent && size > 2)
    memcpy(matrix + (size - 1) * size, matrix, size * sizeof *matrix);
}

/* The solution by GSL alone. @param a  overwritten */
static void solve_by_gsl(double *a, size_t size, double *b, double *x) {
  gsl_matrix_view matrix = gsl_matrix_view_array(a, size, size);
  gsl_vector_view rhs = gsl_vector_view_array(b, size), solution = gsl_vector_view_array(x, size);
  gsl_vector *tau = gsl_vector_alloc(size), *norm = gsl_vector_alloc(size);
  gsl_permutation *p = gsl_permutation_alloc(size);
  int sign;
  assert_int_equal(gsl_linalg_QRPT_decomp(&matrix.matrix, tau, p, &sign, norm), 0);
  if (gsl_matrix_get(&matrix.matrix, size - 1, size - 1) != 0)
    assert_int_equal(gsl_linalg_QRPT_solve(&matrix.matrix, tau, p, &rhs.vector, &solution.vector), 0);
  gsl_vector_free(tau);
  gsl_vector_free(norm);
  gsl_permutation_free(p);
}

static void a_solution_is_that_of_gsl(void **state) {
  (void)state;
  random_source source = {1};
  double *a = calloc(2 * MOST * MOST, sizeof *a), *theirs = a + MOST * MOST;
  double b[MOST], c[MOST], x[MOST], y[MOST], tau[MOST], norm[MOST], work[3 * MOST];
  size_t order[MOST];
  const linear_work w = {.tau = tau, .norm = norm, .work = work, .permutation = order};
  for (int run = 0; run < 60; run++) {
    const size_t size = run < 50 ? 1 + random_below(&source, 40) : MOST - 10 + (size_t)run - 50;
    linear_factor factor;
    fill(&source, a, size, run % 3 == 0);
    memcpy(theirs, a, size * size * sizeof *a);
    for (size_t i = 0; i < size; i++)
      b[i] = c[i] = random_uniform(&source, -1, 1);
    memset(x, 0, sizeof x);
    memset(y, 0, sizeof y);
    assert_int_equal(linear_solve(a, size, b, x, &w, &factor, NULL), RIC_OK);
    solve_by_gsl(theirs, size, c, y);
    assert_memory_equal(a, theirs, size * size * sizeof *a);
    assert_memory_equal(x, y, size * sizeof *x);
  }
  free(a);
}

static void eigenvalues_are_those_of_gsl(void **state) {
  (void)state;
  random_source source = {2};
  double *a = calloc(2 * MOST * MOST, sizeof *a), *theirs = a + MOST * MOST, e[MOST], f[MOST];
  for (int run = 0; run < 60; run++) {
    const size_t size = run < 50 ? 1 + random_below(&source, 40) : MOST - 10 + (size_t)run - 50;
    fill(&source, a, size, run % 3 == 0);
    memcpy(theirs, a, size * size * sizeof *a);
    gsl_matrix_view matrix = gsl_matrix_view_array(theirs, size, size);
    gsl_vector_view values = gsl_vector_view_array(f, size);
    gsl_eigen_symm_workspace *w = gsl_eigen_symm_alloc(size);
    assert_int_equal(gsl_eigen_symm(&matrix.matrix, &values.vector, w), 0);
    gsl_eigen_symm_free(w);
    gsl_sort_vector(&values.vector);
    assert_int_equal(linear_eigenvalues(a, size, e, (ric_poll){0}, NULL), RIC_OK);
    assert_memory_equal(e, f, size * sizeof *e);
  }
  free(a);
}

static int stop_at_tenth(void *user) {
  return ++*(int *)user >= 10;
}

static void large_ones_can_be_stopped(void **state) {
  (void)state;
  random_source source = {3};
  double *a = calloc(MOST * MOST, sizeof *a), b[MOST] = {1}, x[MOST], tau[MOST], norm[MOST], work[3 * MOST];
  size_t order[MOST];
  int asked = 0;
  const ric_poll poll = {.call = stop_at_tenth, .user = &asked};
  const linear_work w = {.tau = tau, .norm = norm, .work = work, .permutation = order, .poll = poll};
  linear_factor factor;
  fill(&source, a, MOST, false);
  assert_int_equal(linear_solve(a, MOST, b, x, &w, &factor, NULL), RIC_ESTOPPED);
  assert_int_equal(asked, 10);
  asked = 0;
  assert_int_equal(linear_eigenvalues(a, MOST, x, poll, NULL), RIC_ESTOPPED);
  assert_int_equal(asked, 10);
  free(a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_solution_is_that_of_gsl),
      cmocka_unit_test(eigenvalues_are_those_of_gsl),
      cmocka_unit_test(large_ones_can_be_stopped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
