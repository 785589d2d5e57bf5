/* Where families meet: what the ways over to another one share. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "family_parts.h"

/* First step into another family. Multipliers grow without bound towards a touch, and special points crowd there. */
static const double first_step = 1e-3;

/* Singular values below it, over the largest, are zero. */
static const double singular_tol = 1e-7;

void ric_family_junction_clear(ric_family_junction *junction) {
  ric_family_destroy(&junction->family);
  free(junction->z);
  free(junction->tangent);
  *junction = (ric_family_junction){0};
}

void family_show_again(ric_family *f, const ric_family_point *point) {
  family_forget(f);
  if (family_set(f, point->parameter, f->problem.second, NULL) == RIC_OK)
    (void)family_look(f, point->z, NULL);
  family_forget(f);
}

ric_status family_branch(const ric_family_problem *problem, const ric_family *from, const ric_family_point *point,
                         const double *x, const double *times, double period, ric_family_junction *junction,
                         ric_error *error) {
  size_t n = from->shooting->arcs.coordinates;
  ric_family_options options = from->options;
  options.curve.step = fmin(options.curve.step, fmax(first_step, options.curve.step_least));
  RIC_TRY(ric_family_create(problem, &options, &junction->family, error));
  size_t unknowns = junction->family->unknowns;
  junction->z = calloc(unknowns, sizeof *junction->z);
  junction->tangent = calloc(unknowns + 1, sizeof *junction->tangent);
  junction->parameter = point->parameter;
  if (!junction->z || !junction->tangent)
    return ric_fail(error, RIC_ENOMEM, "no memory for a point of %zu unknowns", unknowns);
  RIC_TRY(family_set(junction->family, point->parameter, problem->second, error));
  return ric_shooting_guess(junction->family->shooting, x, x + n, times, period, junction->z, error);
}

/* (J, F_p) in the first rows of a square matrix. */
static ric_status fill(ric_family *f, const double *z, gsl_matrix *A, ric_error *error) {
  size_t n = f->unknowns;
  double *J = malloc((n * n + 2 * n) * sizeof *J);
  if (!J)
    return ric_fail(error, RIC_ENOMEM, "no memory for a matrix of size %zu", n);
  double *F = J + n * n, *F_p = F + n;
  ric_status status = family_residual(f, z, 0, F, J, F_p, error);
  for (size_t i = 0; i < n && status == RIC_OK; i++) {
    memcpy(gsl_matrix_ptr(A, i, 0), J + i * n, n * sizeof *J);
    gsl_matrix_set(A, i, n, F_p[i]);
  }
  free(J);
  return status;
}

static ric_status decompose(gsl_matrix *A, gsl_matrix *V, gsl_vector *S, gsl_vector *work, size_t count,
                            double *vectors, ric_error *error) {
  size_t size = A->size1;
  if (gsl_linalg_SV_decomp(A, V, S, work) != GSL_SUCCESS)
    return ric_fail(error, RIC_ENUMERIC, "no singular values of the equations where two families meet");
  double last = gsl_vector_get(S, size - 1 - count), first = gsl_vector_get(S, 0);
  if (!(last > singular_tol * first))
    return ric_fail(error, RIC_ENUMERIC, "the families that meet are no simple ones: a singular value of %.3g of %.3g",
                    last, first);
  for (size_t k = 0; k < count; k++)
    for (size_t i = 0; i < size; i++)
      vectors[k * size + i] = gsl_matrix_get(V, i, size - 1 - k);
  return RIC_OK;
}

ric_status family_null_vectors(ric_family *f, const double *z, size_t count, double *vectors, ric_error *error) {
  size_t size = f->unknowns + 1;
  gsl_matrix *A = gsl_matrix_calloc(size, size), *V = gsl_matrix_alloc(size, size);
  gsl_vector *S = gsl_vector_alloc(size), *work = gsl_vector_alloc(size);
  ric_status status = A && V && S && work ? fill(f, z, A, error)
                                          : ric_fail(error, RIC_ENOMEM, "no memory for a matrix of size %zu", size);
  if (status == RIC_OK)
    status = decompose(A, V, S, work, count, vectors, error);
  if (A)
    gsl_matrix_free(A);
  if (V)
    gsl_matrix_free(V);
  if (S)
    gsl_vector_free(S);
  if (work)
    gsl_vector_free(work);
  return status;
}
