/* Multipliers of a matrix, by GSL, and of an even motion, by its block; the verdict. */
#include "multipliers.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>

#include "ricochet/multipliers.h"
#include "numeric/gsl_quiet.h"
#include "numeric/complex_number.h"
#include "numeric/required.h"

/* A pair (mu, 1/mu) of multipliers and its representative alpha = (mu + 1/mu) / 2. */

static ric_complex plain(double complex z) {
  return (ric_complex){creal(z), cimag(z)};
}

/* alpha^2 - 1 as a product, without cancellation near 1. */
static void real_pair(double alpha, ric_complex pair[2]) {
  double square = (alpha - 1) * (alpha + 1), root = sqrt(fabs(square));
  if (square <= 0) {
    pair[0] = (ric_complex){alpha, root};
    pair[1] = (ric_complex){alpha, -root};
    return;
  }
  double large = alpha > 0 ? alpha + root : alpha - root;
  pair[0] = (ric_complex){large, 0};
  pair[1] = (ric_complex){1 / large, 0};
}

/** The pair of alpha: pair[0] has the larger modulus, or the positive imaginary part on the circle. Real alpha in
 *  [-1, 1] give a pair on the circle; conjugate alpha give conjugate pairs, to the last bit. */
static void multiplier_pair(ric_complex alpha, ric_complex pair[2]) {
  if (alpha.im == 0) {
    real_pair(alpha.re, pair);
    return;
  }
  double complex a = CMPLX(alpha.re, fabs(alpha.im)), root = complex_sqrt(a - 1) * complex_sqrt(a + 1);
  double complex large = creal(conj(a) * root) >= 0 ? a + root : a - root, small = 1 / large;
  pair[0] = plain(alpha.im > 0 ? large : conj(large));
  pair[1] = plain(alpha.im > 0 ? small : conj(small));
}

static double modulus(ric_complex z) {
  return ric_hypot(z.re, z.im);
}

static double distance_from_one(ric_complex z) {
  return ric_hypot(z.re - 1, z.im);
}

/* By modulus, largest first, then by the size of the argument, positive first. */
static int in_order(const void *a, const void *b) {
  const ric_complex *x = a, *y = b;
  double rx = modulus(*x), ry = modulus(*y);
  if (rx != ry)
    return rx > ry ? -1 : 1;
  if (x->re != y->re)
    return x->re > y->re ? -1 : 1;
  return (x->im < y->im) - (x->im > y->im);
}

void multipliers_sort(ric_multipliers *m) {
  qsort(m->mu, m->count, sizeof *m->mu, in_order);
}

/* The nearest to 1 come first, ordered by distance only. */
static int by_distance_from_one(const void *a, const void *b) {
  double x = distance_from_one(*(const ric_complex *)a), y = distance_from_one(*(const ric_complex *)b);
  return (x > y) - (x < y);
}

/* Result of the non-trivial multipliers. */
typedef struct finding {
  const ric_complex *outermost; /* of largest modulus */
  const ric_complex *unstable;  /* of those outside by more than the band; NULL if none is */
  const ric_complex *at_one;    /* one that lies too close to 1; NULL if none does */
} finding;

/* Rounding gives real multipliers that coincide by symmetry imaginary parts. */
static bool is_real(const ric_complex *z, const ric_multiplier_options *o) {
  return fabs(z->im) <= o->multiplier_tol * fabs(z->re);
}

static void count_outside(ric_multipliers *m, const ric_complex *z, const ric_multiplier_options *o) {
  m->outside++;
  if (!is_real(z, o))
    m->complex_outside++;
  else if (z->re > 0)
    m->real_above++;
  else
    m->real_below++;
}

static finding evaluate_multiplier(ric_multipliers *m, const ric_complex *mu, size_t count,
                                   const ric_multiplier_options *o) {
  finding f = {0};
  m->outside = m->real_above = m->real_below = m->complex_outside = 0;
  for (size_t i = 0; i < count; i++) {
    if (!f.outermost || modulus(mu[i]) > modulus(*f.outermost))
      f.outermost = &mu[i];
    if (distance_from_one(mu[i]) < o->band_at_one) {
      f.at_one = &mu[i];
    } else if (modulus(mu[i]) > 1 + o->band) {
      count_outside(m, &mu[i], o);
      if (!f.unstable || modulus(mu[i]) > modulus(*f.unstable))
        f.unstable = &mu[i];
    }
  }
  m->margin = f.outermost ? modulus(*f.outermost) - 1 : NAN;
  return f;
}

static void report_unstable(ric_multipliers *m, const ric_complex *z, bool real) {
  m->stable = RIC_UNSTABLE;
  if (real)
    snprintf(m->reason, sizeof m->reason, "multiplier %.9g lies %.3g outside the unit circle, %zu in all outside",
             z->re, modulus(*z) - 1, m->outside);
  else
    snprintf(m->reason, sizeof m->reason,
             "multiplier %.9g %+.9gi of modulus %.9g lies %.3g outside the unit circle, %zu in all outside", z->re,
             z->im, modulus(*z), modulus(*z) - 1, m->outside);
}

static void decide(ric_multipliers *m, const finding *f, const ric_multiplier_options *o) {
  m->reason[0] = '\0';
  m->stable = RIC_STABLE;
  if (f->unstable) {
    report_unstable(m, f->unstable, is_real(f->unstable, o));
    return;
  }
  if (f->at_one) {
    m->stable = RIC_UNDECIDED;
    snprintf(m->reason, sizeof m->reason, "multiplier %.9g %+.3gi lies %.3g from 1, within %.3g", f->at_one->re,
             f->at_one->im, distance_from_one(*f->at_one), o->band_at_one);
  } else if (f->outermost && !(modulus(*f->outermost) <= 1 + o->multiplier_tol)) {
    m->stable = RIC_UNDECIDED;
    snprintf(m->reason, sizeof m->reason, "multiplier %.9g %+.9gi lies %.3g outside the unit circle, within %.3g",
             f->outermost->re, f->outermost->im, modulus(*f->outermost) - 1, o->band);
  }
}

/* A multiplier farther from 1, more than rounding splits a double 1, is not trivial. */
static const double trivial_tol = 1e-3;

static void evaluate_trivial(ric_multipliers *m, size_t trivial) {
  const ric_complex *z = trivial > 0 ? &m->mu[trivial - 1] : NULL;
  if (!z || m->stable != RIC_STABLE || distance_from_one(*z) <= trivial_tol)
    return;
  m->stable = RIC_UNDECIDED;
  snprintf(m->reason, sizeof m->reason,
           "multiplier %.9g %+.3gi, expected to be a trivial multiplier 1, lies %.3g from 1", z->re, z->im,
           distance_from_one(*z));
}

static double log_determinant(const ric_multipliers *m) {
  double sum = 0;
  for (size_t i = 0; i < m->count; i++)
    sum += ric_log(modulus(m->mu[i]));
  return m->count == m->dimension ? sum : NAN;
}

void multipliers_judge(ric_multipliers *m, size_t trivial, const ric_multiplier_options *options) {
  ric_multiplier_options own = *options, *o = &own;
  if (trivial < 2) /* no second pair can collide with the double 1 */
    own.band_at_one = own.band;
  qsort(m->mu, m->count, sizeof *m->mu, by_distance_from_one);
  finding f = evaluate_multiplier(m, m->mu + trivial, m->count - trivial, o);
  decide(m, &f, o);
  evaluate_trivial(m, trivial);
  if (!f.outermost)
    m->margin = 0; /* none besides those at 1 */
  multipliers_sort(m);
  m->largest = modulus(m->mu[0]);
  m->log_determinant = log_determinant(m);
}

void multipliers_judge_outside(ric_multipliers *m, size_t unlocated, size_t near_one, const ric_multiplier_options *o) {
  multipliers_sort(m);
  finding f = evaluate_multiplier(m, m->mu, m->count, o);
  decide(m, &f, o);
  m->largest = m->count > 0 ? modulus(m->mu[0]) : 1;
  if (m->count == 0 && unlocated == 0)
    m->margin = 0;
  if (m->stable != RIC_STABLE)
    return;
  if (near_one > 0) {
    m->stable = RIC_UNDECIDED;
    snprintf(m->reason, sizeof m->reason, "%zu multipliers besides the trivial ones lie less than %.3g from 1",
             near_one, o->band_at_one);
  } else if (unlocated > 0) {
    m->stable = RIC_UNDECIDED;
    snprintf(m->reason, sizeof m->reason, "%zu multipliers within %.3g of the unit circle cannot be separated from it",
             unlocated, o->band);
  }
}

ric_status multiplier_options_check(const ric_multiplier_options *o, ric_error *error) {
  if (!(o->multiplier_tol >= 0 && o->multiplier_tol <= o->band && o->band < 1))
    return ric_fail(error, RIC_EINVAL, "multiplier_tol = %g, band = %g, expected 0 <= multiplier_tol <= band < 1",
                    o->multiplier_tol, o->band);
  if (!(o->band_at_one >= 0 && o->band_at_one < 1))
    return ric_fail(error, RIC_EINVAL, "band_at_one = %g, expected 0 <= band_at_one < 1", o->band_at_one);
  return RIC_OK;
}

void multiplier_work_clear(multiplier_work *w) {
  if (w->copy)
    gsl_matrix_free(w->copy);
  if (w->values)
    gsl_vector_complex_free(w->values);
  gsl_eigen_nonsymm_free(w->eigen);
  *w = (multiplier_work){0};
}

ric_status multiplier_work_init(multiplier_work *w, size_t n, ric_error *error) {
  *w = (multiplier_work){
      .copy = gsl_matrix_alloc(n, n), .values = gsl_vector_complex_alloc(n), .eigen = gsl_eigen_nonsymm_alloc(n)};
  if (!w->copy || !w->values || !w->eigen) {
    multiplier_work_clear(w);
    return ric_fail(error, RIC_ENOMEM, "no memory for eigenvalues of a matrix of size %zu", n);
  }
  gsl_eigen_nonsymm_params(0, 1, w->eigen); /* balanced: displacements and speeds have different units */
  return RIC_OK;
}

/** @returns RIC_EINVAL as ric_multipliers_of_matrix. */
static ric_status multiplier_matrix_check(const double *M, size_t dimension, size_t trivial, const ric_multipliers *m,
                                          ric_error *error) {
  if (trivial > 2 || trivial > dimension)
    return ric_fail(error, RIC_EINVAL, "trivial = %zu, expected 0, 1 or 2, and at most the dimension %zu", trivial,
                    dimension);
  if (m->dimension != dimension)
    return ric_fail(error, RIC_EINVAL, "room for %zu multipliers, expected %zu", m->dimension, dimension);
  for (size_t i = 0; i < dimension * dimension; i++)
    if (!isfinite(M[i]))
      return ric_fail(error, RIC_EINVAL, "entry [%zu][%zu] = %g, expected a finite number", i / dimension,
                      i % dimension, M[i]);
  return RIC_OK;
}

/* Eigenvalues of M + shift I, minus the shift. */
static int eigenvalues_of_shifted(multiplier_work *w, const double *M, double shift) {
  size_t n = w->copy->size1;
  memcpy(w->copy->data, M, n * n * sizeof *M);
  for (size_t i = 0; i < n; i++)
    w->copy->data[i * (n + 1)] += shift;
  int failed = gsl_eigen_nonsymm(w->copy, w->values, w->eigen);
  for (size_t i = 0; i < n && !failed; i++)
    w->values->data[2 * i] -= shift;
  return failed;
}

/* The largest sum of a row's moduli. */
static double size_of(const double *M, size_t n) {
  double largest = 0;
  for (size_t i = 0; i < n; i++) {
    double sum = 0;
    for (size_t j = 0; j < n; j++)
      sum += fabs(M[i * n + j]);
    largest = fmax(largest, sum);
  }
  return largest;
}

void ric_multipliers_fail(ric_multipliers *m, const char *reason) {
  m->stable = RIC_STABILITY_UNKNOWN;
  snprintf(m->reason, sizeof m->reason, "%s", reason);
  m->count = m->outside = m->real_above = m->real_below = m->complex_outside = 0;
  m->largest = m->margin = m->log_determinant = NAN;
}

ric_status multiplier_work_find(multiplier_work *w, const double *M, size_t trivial, const ric_multiplier_options *o,
                                ric_multipliers *m, ric_error *error) {
  size_t n = w->copy->size1;
  RIC_TRY(multiplier_matrix_check(M, n, trivial, m, error));
  ric_multipliers_fail(m, "not computed");
  /* GSL compares neglected entries with the neighbouring diagonal: if that is zero it may not converge. */
  if (eigenvalues_of_shifted(w, M, 0) != GSL_SUCCESS && eigenvalues_of_shifted(w, M, size_of(M, n)) != GSL_SUCCESS)
    return ric_fail(error, RIC_ENUMERIC, "eigenvalues of a matrix of size %zu: they do not converge", n);
  for (size_t i = 0; i < n; i++)
    m->mu[i] = (ric_complex){w->values->data[2 * i], w->values->data[2 * i + 1]};
  m->count = n;
  multipliers_judge(m, trivial, o);
  return RIC_OK;
}

const char *ric_stability_name(ric_stability stability) {
  switch (stability) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_STABILITY_LIST(X)
#undef X
  case RIC_STABILITIES:
    break;
  }
  return "unknown stability";
}

ric_status ric_multipliers_init(ric_multipliers *m, size_t dimension, ric_error *error) {
  REQUIRE(error, {"multipliers", m});
  *m = (ric_multipliers){.dimension = dimension};
  if (dimension < 1)
    return ric_fail(error, RIC_EINVAL, "multipliers of dimension 0, expected at least 1");
  m->mu = dimension < SIZE_MAX / 32 ? calloc(dimension, sizeof *m->mu) : NULL;
  if (!m->mu)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu multipliers", dimension);
  ric_multipliers_fail(m, "not computed");
  return RIC_OK;
}

void ric_multipliers_clear(ric_multipliers *m) {
  if (!m)
    return;
  free(m->mu);
  *m = (ric_multipliers){0};
}

ric_multiplier_options ric_multiplier_options_default(void) {
  return (ric_multiplier_options){.multiplier_tol = 1e-9, .band = 1e-6, .band_at_one = 1e-4};
}

ric_status ric_multipliers_of_matrix(const double *M, size_t dimension, size_t trivial,
                                     const ric_multiplier_options *options, ric_multipliers *m, ric_error *error) {
  REQUIRE(error, {"M", M}, {"multipliers", m});
  multiplier_work work = {0};
  ric_multiplier_options o = options ? *options : ric_multiplier_options_default();
  RIC_TRY(multiplier_options_check(&o, error));
  RIC_TRY(multiplier_matrix_check(M, dimension, trivial, m, error));
  keep_gsl_quiet();
  ric_status status = multiplier_work_init(&work, dimension, error);
  if (status == RIC_OK)
    status = multiplier_work_find(&work, M, trivial, &o, m, error);
  multiplier_work_clear(&work);
  return status;
}

/* Entries of l W - l above it (relative to the largest entry of W) are not rounding. */
static const double defect_tol = 1e-6;

void even_spectrum_clear(even_spectrum *e) {
  if (e->block)
    gsl_matrix_free(e->block);
  if (e->left)
    gsl_vector_free(e->left);
  if (e->values)
    gsl_vector_complex_free(e->values);
  gsl_eigen_nonsymm_free(e->work[0]);
  gsl_eigen_nonsymm_free(e->work[1]);
  free(e->alpha);
  *e = (even_spectrum){0};
}

ric_status even_spectrum_reserve(even_spectrum *e, size_t n, ric_error *error) {
  if (e->size == n)
    return RIC_OK;
  even_spectrum_clear(e);
  e->block = gsl_matrix_alloc(n, n);
  e->left = gsl_vector_alloc(n);
  e->values = gsl_vector_complex_alloc(n);
  e->work[0] = gsl_eigen_nonsymm_alloc(n);
  e->work[1] = gsl_eigen_nonsymm_alloc(n > 1 ? n - 1 : 1);
  e->alpha = malloc(n * sizeof *e->alpha);
  if (e->block && e->left && e->values && e->work[0] && e->work[1] && e->alpha) {
    e->size = n;
    gsl_eigen_nonsymm_params(0, 1, e->work[0]); /* balanced: displacements and speeds have different units */
    gsl_eigen_nonsymm_params(0, 1, e->work[1]);
    return RIC_OK;
  }
  even_spectrum_clear(e);
  return ric_fail(error, RIC_ENOMEM, "no memory for the reduced matrix of %zu particles", n);
}

/* H W H with the reflection H that maps l to the first coordinate: its first row is (1, 0, ..., 0) up to rounding. */
static void deflate(even_spectrum *e) {
  double tau = gsl_linalg_householder_transform(e->left);
  gsl_linalg_householder_hm(tau, e->left, e->block);
  gsl_linalg_householder_mh(tau, e->left, e->block);
  e->defect = 0;
  for (size_t j = 0; j < e->size; j++)
    e->defect = fmax(e->defect, fabs(gsl_matrix_get(e->block, 0, j) - (j == 0 ? 1 : 0)) / fmax(e->largest, 1));
}

static ric_status find_alpha(even_spectrum *e, size_t first, ric_error *error) {
  e->count = e->size - first;
  if (e->count == 0)
    return RIC_OK;
  gsl_matrix_view rest = gsl_matrix_submatrix(e->block, first, first, e->count, e->count);
  gsl_vector_complex_view values = gsl_vector_complex_subvector(e->values, 0, e->count);
  int code = gsl_eigen_nonsymm(&rest.matrix, &values.vector, e->work[first]);
  if (code != GSL_SUCCESS)
    return ric_fail(error, gsl_status(code), "eigenvalues of the reduced matrix: %s", gsl_text(code));
  for (size_t i = 0; i < e->count; i++) {
    gsl_complex value = gsl_vector_complex_get(&values.vector, i);
    e->alpha[i] = (ric_complex){GSL_REAL(value), GSL_IMAG(value)};
  }
  return RIC_OK;
}

ric_status even_spectrum_find(even_spectrum *e, bool conservative, ric_error *error) {
  e->largest = fmax(fabs(gsl_matrix_max(e->block)), fabs(gsl_matrix_min(e->block)));
  e->defect = 0;
  if (conservative)
    deflate(e);
  return find_alpha(e, conservative ? 1 : 0, error);
}

void even_spectrum_multipliers(const even_spectrum *e, const ric_multiplier_options *options, ric_multipliers *m) {
  if (!(e->defect <= defect_tol)) {
    ric_multipliers_fail(m, "no multiplier at 1: the state does not belong to an orbit of this chain");
    return;
  }
  for (size_t i = 0; i < e->count; i++)
    multiplier_pair(e->alpha[i], m->mu + 2 * i);
  if (e->count < e->size)
    m->mu[m->dimension - 2] = m->mu[m->dimension - 1] = (ric_complex){1, 0};
  m->count = m->dimension;
  multipliers_judge(m, 2 * (e->size - e->count), options);
}
