/* The linear part of a system as matrices, and its normal modes. */
#include "normal_modes.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>

#include "lattice_system.h"
#include "mck_rows.h"
#include "mck_system.h"
#include "numeric/required.h"
#include "numeric/vector.h"
#include "numeric/linear.h"
#include "ricochet/normal_modes.h"
#include "numeric/gsl_quiet.h"

/* Entries of K that differ by less, relative to the largest, differ by rounding. */
static const double symmetry_tol = 1e-12;

static ric_status refuse_user_system(const ric_system *system, ric_error *error) {
  if (system->taylor == SYSTEM_USER)
    return ric_fail(error, RIC_EINVAL, "a user system, expected a lattice or an M-C-K system");
  return RIC_OK;
}

/* A link with one end missing joins the other end to a wall. */
static void add_link(double *K, size_t n, double stiffness, size_t left, size_t right) {
  if (left < n)
    K[left * n + left] += stiffness;
  if (right < n)
    K[right * n + right] += stiffness;
  if (left < n && right < n) {
    K[left * n + right] -= stiffness;
    K[right * n + left] -= stiffness;
  }
}

static void assemble_lattice(const ric_lattice *lattice, double *K) {
  size_t n = lattice->particles;
  bool ring = lattice->ends == RIC_ENDS_PERIODIC && n >= 3;
  for (size_t i = 0; i < n; i++)
    K[i * n + i] += ric_lattice_on_site(lattice, i).linear;
  for (size_t i = 0; i < (ring ? n : n + 1); i++)
    add_link(K, n, ric_lattice_link(lattice, i).linear, i > 0 ? i - 1 : ring ? n - 1 : n, i);
}

/* Dense rows are stored in panels (mck_rows.h); sparse matrices may have repeated entries. */
static void read_mck(const mck_system *s, double *K) {
  size_t n = s->base.coordinates;
  for (size_t i = 0; i < n; i++) {
    const mck_rows *rows = &s->springs;
    if (!rows->values)
      return;
    if (rows->row_start)
      for (size_t k = rows->row_start[i]; k < rows->row_start[i + 1]; k++)
        K[i * n + rows->column[k]] += rows->values[k];
    for (size_t j = 0; !rows->row_start && j < n; j++)
      K[i * n + j] = rows->values[(i / MCK_PANEL * n + j) * MCK_PANEL + i % MCK_PANEL];
  }
}

static ric_status make_symmetric(double *K, size_t n, ric_error *error) {
  double most = 0;
  for (size_t e = 0; e < n * n; e++)
    most = fmax(most, fabs(K[e]));
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) {
      double below = K[i * n + j], above = K[j * n + i];
      if (!(fabs(below - above) <= symmetry_tol * most))
        return ric_fail(error, RIC_EINVAL, "stiffness[%zu][%zu] = %g and stiffness[%zu][%zu] = %g, expected equal ones",
                        i, j, below, j, i, above);
      K[i * n + j] = K[j * n + i] = below / 2 + above / 2;
    }
  return RIC_OK;
}

/** K [n][n] row-major, symmetric to the last bit; nonlinear terms and obstacles are ignored.
 *  @returns RIC_EINVAL for user systems, and for a matrix that is not symmetric beyond rounding. */
static ric_status linear_part_stiffness(const ric_system *system, double *stiffness, ric_error *error) {
  size_t n = system->coordinates;
  RIC_TRY(refuse_user_system(system, error));
  memset(stiffness, 0, n * n * sizeof *stiffness);
  if (system->taylor == SYSTEM_LATTICE)
    assemble_lattice(lattice_system_lattice(system), stiffness);
  else
    read_mck(mck_of(system), stiffness);
  return make_symmetric(stiffness, n, error);
}

/** M: [n] if diagonal (system->uncoupled), [n][n] otherwise. Lattices and M-C-K systems only. */
static void linear_part_mass(const ric_system *system, double *mass) {
  size_t n = system->coordinates;
  if (!system->uncoupled)
    memcpy(mass, mck_of(system)->mass, n * n * sizeof *mass);
  for (size_t i = 0; system->uncoupled && i < n; i++)
    mass[i] = system->model->mass(system, i);
}

/* --- terms beyond the linear part
 * --------------------------------------------------------------------------------------- */

static ric_status refuse_spring(const ric_spring *s, const char *what, size_t i, ric_error *error) {
  const double value[] = {s->quadratic, s->cubic, s->damping};
  static const char *const name[] = {"quadratic", "cubic", "damping"};
  for (size_t k = 0; k < 3; k++)
    if (value[k] != 0)
      return ric_fail(error, RIC_EINVAL, "%s %zu: %s = %g, expected 0: a linear system without damping", what, i,
                      name[k], value[k]);
  return RIC_OK;
}

static ric_status refuse_force(const double *force, size_t n, const char *what, ric_error *error) {
  for (size_t i = 0; force && i < n; i++)
    if (force[i] != 0)
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected 0: a system without forcing", what, i, force[i]);
  return RIC_OK;
}

static ric_status lattice_is_linear(const ric_lattice *lattice, ric_error *error) {
  size_t n = lattice->particles;
  for (size_t i = 0; i < n; i++) {
    ric_spring own = ric_lattice_on_site(lattice, i);
    RIC_TRY(refuse_spring(&own, "on-site spring", i, error));
  }
  for (size_t i = 0; i <= n; i++) {
    ric_spring link = ric_lattice_link(lattice, i);
    RIC_TRY(refuse_spring(&link, "link", i, error));
  }
  RIC_TRY(refuse_force(lattice->force_cos, n, "force_cos", error));
  return refuse_force(lattice->force_sin, n, "force_sin", error);
}

static ric_status mck_is_linear(const mck_system *s, ric_error *error) {
  size_t n = s->base.coordinates;
  double damping = mck_rows_norm(&s->damping);
  if (damping > 0)
    return ric_fail(error, RIC_EINVAL, "damping matrix with a row sum of %g (over the mass), expected none", damping);
  RIC_TRY(refuse_force(s->force_cos, n, "force_cos (over the mass)", error));
  return refuse_force(s->force_sin, n, "force_sin (over the mass)", error);
}

ric_status linear_part_is_all(const ric_system *system, ric_error *error) {
  RIC_TRY(refuse_user_system(system, error));
  return system->taylor == SYSTEM_LATTICE ? lattice_is_linear(lattice_system_lattice(system), error)
                                          : mck_is_linear(mck_of(system), error);
}

/* Components this close to the largest, relatively, count as equal to it, so that rounding does not decide which is the
 * first. */
static const double tie = 1e-6;

/* The eigenvalue problem of A = L^-1 K L^-T. */
typedef struct problem {
  size_t n;
  bool diagonal;  /* the mass */
  double *factor; /* L [n][n], or the roots of the masses [n] */
  double *a, *y;  /* [n][n] A; eigenvectors, one a column */
  int half_power; /* A is over 4^half_power */
  double *values; /* [n] */
  gsl_eigen_symmv_workspace *work;
} problem;

static void problem_clear(problem *p) {
  gsl_eigen_symmv_free(p->work);
  free(p->factor);
  free(p->a);
  free(p->y);
  free(p->values);
}

static ric_status problem_init(problem *p, const ric_system *system, ric_error *error) {
  size_t n = system->coordinates;
  *p = (problem){.n = n, .diagonal = system->uncoupled};
  if (mck_square_fits(n)) {
    p->factor = malloc((p->diagonal ? n : n * n) * sizeof *p->factor);
    p->a = malloc(n * n * sizeof *p->a);
    p->y = malloc(n * n * sizeof *p->y);
    p->values = malloc(n * sizeof *p->values);
    p->work = gsl_eigen_symmv_alloc(n);
  }
  if (p->factor && p->a && p->y && p->values && p->work)
    return RIC_OK;
  return ric_fail(error, RIC_ENOMEM, "no memory for the modes of %zu coordinates", n);
}

/* M = L L^T. */
static ric_status factorise(problem *p, const ric_system *system, ric_error *error) {
  linear_part_mass(system, p->factor);
  for (size_t i = 0; p->diagonal && i < p->n; i++)
    p->factor[i] = sqrt(p->factor[i]);
  if (!p->diagonal && !cholesky_factor(p->factor, p->n))
    return ric_fail(error, RIC_ENUMERIC, "the mass matrix is not positive definite to rounding");
  return RIC_OK;
}

/* x = L^-1 x. */
static void divide(const problem *p, double *x) {
  for (size_t i = 0; p->diagonal && i < p->n; i++)
    x[i] /= p->factor[i];
  if (!p->diagonal)
    cholesky_solve_lower(p->factor, p->n, p->n, x);
}

static void transpose(double *a, size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) {
      double kept = a[i * n + j];
      a[i * n + j] = a[j * n + i];
      a[j * n + i] = kept;
    }
}

/* Rows of K become those of K L^-T, and rows of its transpose those of L^-1 K L^-T. */
static ric_status reduce(problem *p, ric_error *error) {
  for (int side = 0; side < 2; side++) {
    for (size_t i = 0; i < p->n; i++)
      divide(p, p->a + i * p->n);
    transpose(p->a, p->n);
  }
  for (size_t e = 0; e < p->n * p->n; e++)
    if (!isfinite(p->a[e]))
      return ric_fail(error, RIC_ENUMERIC, "the stiffness over the mass overflows");
  return RIC_OK;
}

/* Scales the largest entry to about 1 by an even power of two: the eigenvalue problem squares numbers, and does not
 * converge if they underflow. */
static void scale(problem *p) {
  int power;
  frexp(largest(p->a, p->n * p->n), &power);
  p->half_power = power / 2;
  for (size_t e = 0; e < p->n * p->n; e++)
    p->a[e] = ldexp(p->a[e], -2 * p->half_power);
}

static ric_status decompose(problem *p, ric_error *error) {
  gsl_matrix_view a = gsl_matrix_view_array(p->a, p->n, p->n), y = gsl_matrix_view_array(p->y, p->n, p->n);
  gsl_vector_view values = gsl_vector_view_array(p->values, p->n);
  int code = gsl_eigen_symmv(&a.matrix, &values.vector, &y.matrix, p->work);
  if (!code)
    code = gsl_eigen_symmv_sort(&values.vector, &y.matrix, GSL_EIGEN_SORT_VAL_ASC);
  if (code)
    return ric_fail(error, gsl_status(code), "modes of %zu coordinates: %s", p->n, gsl_text(code));
  double rounding = 8 * DBL_EPSILON * (double)p->n * largest(p->values, p->n);
  if (!(p->values[0] >= -rounding))
    return ric_fail(error, RIC_ENUMERIC, "w^2 = %g of the slowest mode, expected >= 0: the stiffness is not definite",
                    ldexp(p->values[0], 2 * p->half_power));
  for (size_t j = 0; j < p->n && p->values[j] <= rounding; j++)
    p->values[j] = 0;
  return RIC_OK;
}

static ric_status solve_eigenproblem(problem *p, const ric_system *system, ric_error *error) {
  RIC_TRY(factorise(p, system, error));
  RIC_TRY(linear_part_stiffness(system, p->a, error));
  RIC_TRY(reduce(p, error));
  scale(p);
  return decompose(p, error);
}

/* phi = L^-T y. */
static void set_shape(const problem *p, size_t mode, double *phi) {
  size_t n = p->n, first = 0;
  for (size_t i = 0; i < n; i++)
    phi[i] = p->y[i * n + mode] / (p->diagonal ? p->factor[i] : 1);
  if (!p->diagonal)
    cholesky_solve_upper(p->factor, n, n, phi);
  double most = largest(phi, n), sign;
  while (fabs(phi[first]) < (1 - tie) * most)
    first++;
  sign = copysign(1, phi[first]);
  for (size_t i = 0; i < n; i++)
    phi[i] *= sign;
}

ric_status ric_normal_modes(const ric_system *system, double *frequency, double *shape, ric_error *error) {
  REQUIRE(error, {"system", system}, {"frequency", frequency}, {"shape", shape});
  problem p = {0};
  if (system->taylor == SYSTEM_USER)
    return ric_fail(error, RIC_EINVAL, "modes of a user system, expected a lattice or an M-C-K system");
  keep_gsl_quiet();
  ric_status status = problem_init(&p, system, error);
  if (status == RIC_OK)
    status = solve_eigenproblem(&p, system, error);
  for (size_t j = 0; status == RIC_OK && j < p.n; j++) {
    frequency[j] = ldexp(sqrt(p.values[j]), p.half_power);
    set_shape(&p, j, shape + j * p.n);
  }
  problem_clear(&p);
  return status;
}
