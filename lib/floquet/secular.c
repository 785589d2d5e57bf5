/* The determinant for the multipliers of large chains: set-up for an orbit, and evaluation. */
#include "secular.h"

#include <math.h>
#include <stdlib.h>

#include "numeric/constants.h"
#include "ricochet/elementary.h"

/* Set-up of the determinant for an orbit: modes, poles, memory. */

static void free_matrices(secular *s) {
  if (s->symmetric)
    gsl_matrix_free(s->symmetric);
  if (s->eigenvalues)
    gsl_vector_free(s->eigenvalues);
  gsl_eigen_symm_free(s->work);
  free(s->position);
}

void secular_clear(secular *s) {
  free_matrices(s);
  free(s->poles);
  free(s->store);
  *s = (secular){0};
}

enum { MODE_ARRAYS = 13 };

static ric_status place_modes(secular *s, size_t n, size_t m, ric_error *error) {
  size_t need = n * (m + MODE_ARRAYS);
  if (need > s->capacity) {
    free(s->store);
    s->store = malloc(need * sizeof *s->store);
    s->capacity = s->store ? need : 0;
  }
  if (n > s->pole_capacity) {
    free(s->poles);
    s->poles = malloc(n * sizeof *s->poles);
    s->pole_capacity = s->poles ? n : 0;
  }
  if (!s->store || !s->poles)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu modes at %zu impacts", n, m);
  secular_modes *a = &s->modes;
  double **arrays[MODE_ARRAYS] = {&a->below_one,
                                  &a->above_minus_one,
                                  &a->same_position,
                                  &a->same_speed,
                                  &a->other_position,
                                  &a->other_mean,
                                  &a->other_speed,
                                  &a->along_start,
                                  &a->along_half,
                                  &a->along_start_beta,
                                  &a->along_half_beta,
                                  &a->re,
                                  &a->im};
  for (size_t i = 0; i < MODE_ARRAYS; i++)
    *arrays[i] = s->store + i * n;
  a->shape = s->store + MODE_ARRAYS * n;
  return RIC_OK;
}

static ric_status place_matrices(secular *s, size_t m, ric_error *error) {
  if (m == s->impact_capacity)
    return RIC_OK;
  free_matrices(s);
  s->symmetric = gsl_matrix_alloc(2 * m, 2 * m);
  s->eigenvalues = gsl_vector_alloc(2 * m);
  s->work = gsl_eigen_symm_alloc(2 * m);
  s->position = malloc((7 * m * m + m) * sizeof *s->position);
  s->impact_capacity = m;
  if (s->symmetric && s->eigenvalues && s->work && s->position) {
    s->mean = s->position + m * m;
    s->speed = s->mean + m * m;
    s->matrix = s->speed + m * m;
    s->along = s->matrix + 4 * m * m;
    return RIC_OK;
  }
  secular_clear(s);
  return ric_fail(error, RIC_ENOMEM, "no memory for matrices of %zu impacts", m);
}

double secular_bytes(const secular *s) {
  double m = (double)s->impact_capacity;
  double matrices = m * m * (7 * sizeof *s->position + 4 * sizeof(double));
  return (double)(s->capacity * sizeof *s->store + s->pole_capacity * sizeof *s->poles) + matrices;
}

/* Fills row `visible` of the shapes. @returns whether the mode is hidden: its entries are rounding, 1e-16 */
static bool set_shape(secular *s, const ric_chain *chain, size_t mode, size_t visible) {
  double largest = 0, rounding = 1e-12 / sqrt((double)s->particles);
  for (size_t k = 0; k < s->impacts; k++) {
    double shape = ric_chain_mode_shape(chain, mode, s->impact[k].particle);
    s->modes.shape[k * s->particles + visible] = shape;
    largest = fmax(largest, fabs(shape));
  }
  return largest <= rounding;
}

static void set_coefficients(secular *s, size_t j, double omega, double x) {
  secular_modes *a = &s->modes;
  double start = 0, half = 0; /* modal impulses of the orbit */
  for (size_t k = 0; k < s->impacts; k++) {
    double felt = a->shape[k * s->particles + j] * s->impact[k].impulse;
    *(s->impact[k].at_half ? &half : &start) += felt;
  }
  double sine, cosine;
  ric_sincos(x, &sine, &cosine);
  double cot = omega * cosine / (2 * sine), csc = omega / (2 * sine);
  a->below_one[j] = 2 * sine * sine;
  a->above_minus_one[j] = 2 * cosine * cosine;
  a->same_position[j] = sine * cosine / omega;
  a->same_speed[j] = -omega * sine * cosine;
  a->other_position[j] = sine / omega;
  a->other_mean[j] = cosine;
  a->other_speed[j] = -omega * sine;
  a->along_start[j] = cot * start + csc * half;
  a->along_half[j] = cot * half + csc * start;
  a->along_start_beta[j] = -omega * sine / 2 * half;
  a->along_half_beta[j] = -omega * sine / 2 * start;
}

static int by_angle(const void *a, const void *b) {
  const secular_pole *x = a, *y = b;
  return (x->angle > y->angle) - (x->angle < y->angle);
}

static void set_modes(secular *s, const ric_chain *chain, double period) {
  s->modes.visible = 0;
  for (size_t mode = 0; mode < s->particles; mode++) {
    double omega = ric_chain_frequency(chain, mode), x = omega * period / 2;
    double turn = remainder(2 * x, two_pi);
    bool hidden = set_shape(s, chain, mode, s->modes.visible);
    s->poles[mode] = (secular_pole){.angle = fabs(turn), .signature = turn > 0 ? 1 : -1, .hidden = hidden};
    if (!hidden)
      set_coefficients(s, s->modes.visible++, omega, x);
  }
  qsort(s->poles, s->particles, sizeof *s->poles, by_angle);
}

ric_status secular_prepare(secular *s, const ric_chain *chain, const orbit_impacts *impacts, double period,
                           ric_error *error) {
  RIC_TRY(place_modes(s, chain->particles, impacts->count, error));
  RIC_TRY(place_matrices(s, impacts->count, error));
  s->particles = chain->particles;
  s->impacts = impacts->count;
  s->impact = impacts->items;
  s->evaluations = 0;
  s->largest = 0;
  for (size_t k = 1; k < s->impacts; k++)
    if (fabs(s->impact[k].impulse) > fabs(s->impact[s->largest].impulse))
      s->largest = k;
  set_modes(s, chain, period);
  return RIC_OK;
}

/* 1 / (alpha - cos wT), alpha = cosh zeta = beta^2 + kappa^2, with the difference computed from the nearer of 1 and -1,
 * without cancellation; kappa = sinh(zeta / 2), beta = cosh(zeta / 2). */
static void set_resolvent(secular *s, double complex kappa, double complex beta) {
  bool right = creal(beta * beta + kappa * kappa) >= 0;
  double complex from_end = right ? 2 * kappa * kappa : 2 * beta * beta;
  double re = creal(from_end), im = cimag(from_end), sign = right ? 1 : -1;
  const double *pole = right ? s->modes.below_one : s->modes.above_minus_one;
  for (size_t j = 0; j < s->modes.visible; j++) {
    double x = re + sign * pole[j], square = x * x + im * im;
    s->modes.re[j] = x / square;
    s->modes.im[j] = -im / square;
  }
}

/* The three sums of a pair of impacts; with the factor beta required by its parity. */
static void sum_pair(secular *s, size_t k, size_t l, double complex beta) {
  const secular_modes *a = &s->modes;
  const double *first = a->shape + k * s->particles, *second = a->shape + l * s->particles;
  double sum[6] = {0};
  bool same = s->impact[k].at_half == s->impact[l].at_half;
  const double *position = same ? a->same_position : a->other_position, *speed = same ? a->same_speed : a->other_speed;
  for (size_t j = 0; j < a->visible; j++) {
    double both = first[j] * second[j], re = both * a->re[j], im = both * a->im[j];
    double mean = same ? 1 : a->other_mean[j];
    sum[0] += position[j] * re;
    sum[1] += position[j] * im;
    sum[2] += mean * re;
    sum[3] += mean * im;
    sum[4] += speed[j] * re;
    sum[5] += speed[j] * im;
  }
  size_t there = k * s->impacts + l, back = l * s->impacts + k;
  s->position[there] = s->position[back] = CMPLX(sum[0], sum[1]) * (same ? 1 : beta);
  s->mean[there] = s->mean[back] = CMPLX(sum[2], sum[3]) * (same ? beta : 1);
  s->speed[there] = s->speed[back] = CMPLX(sum[4], sum[5]) * (same ? 1 : beta);
}

/* Derivative of the mean velocity of impact k along the orbit, divided difference from alpha = 1. */
static void sum_along(secular *s, size_t k, double complex beta) {
  const secular_modes *a = &s->modes;
  bool half = s->impact[k].at_half;
  const double *shape = a->shape + k * s->particles, *plain = half ? a->along_half : a->along_start;
  const double *with_beta = half ? a->along_half_beta : a->along_start_beta;
  double sum[4] = {0};
  for (size_t j = 0; j < a->visible; j++) {
    double re = shape[j] * a->re[j], im = shape[j] * a->im[j];
    sum[0] += plain[j] * re;
    sum[1] += plain[j] * im;
    sum[2] += with_beta[j] * re;
    sum[3] += with_beta[j] * im;
  }
  s->along[k] = CMPLX(sum[0], sum[1]) + CMPLX(sum[2], sum[3]) / (beta + 1);
}

static void set_sums(secular *s, double complex kappa, double complex beta) {
  s->evaluations++;
  set_resolvent(s, kappa, beta);
  for (size_t k = 0; k < s->impacts; k++) {
    for (size_t l = 0; l <= k; l++)
      sum_pair(s, k, l, beta);
    sum_along(s, k, beta);
  }
}

static void set_entry(secular *s, size_t row, size_t column, double complex z) {
  s->matrix[row * 2 * s->impacts + column] = z;
}

/* N, with the factor (-4)^m in its rows, its speed columns times kappa and its speed rows over it, and
 * the column of the largest impulse replaced by N w / (alpha - 1), w the jumps along the orbit. */
static void set_matrix(secular *s, double complex kappa) {
  size_t m = s->impacts;
  double complex square = kappa * kappa;
  for (size_t k = 0; k < m; k++) {
    double complex along = 0;
    for (size_t l = 0; l < m; l++) {
      size_t i = k * m + l;
      set_entry(s, k, l, 2 * s->position[i]);
      set_entry(s, k, m + l, 2 * square * s->mean[i]);
      set_entry(s, m + k, l, -2 * s->mean[i]);
      set_entry(s, m + k, m + l, -2 * (s->speed[i] + (k == l ? s->impact[k].slope / 4 : 0)));
      along += s->mean[i] * s->impact[l].impulse;
    }
    double impulse = s->impact[s->largest].impulse;
    set_entry(s, k, m + s->largest, along / impulse);
    set_entry(s, m + k, m + s->largest, -2 * s->along[k] / impulse);
  }
}

static double size_of(double complex z) {
  return fabs(creal(z)) + fabs(cimag(z));
}

/* Moves the largest entry of a column to the diagonal. @returns whether rows were exchanged */
static bool pivot(double complex *a, size_t size, size_t column) {
  size_t best = column;
  for (size_t i = column + 1; i < size; i++)
    if (size_of(a[i * size + column]) > size_of(a[best * size + column]))
      best = i;
  for (size_t j = column; j < size && best != column; j++) {
    double complex swap = a[column * size + j];
    a[column * size + j] = a[best * size + j];
    a[best * size + j] = swap;
  }
  return best != column;
}

/* Product without the special cases of infinities required by the C standard. */
static inline double complex times(double complex a, double complex b) {
  return CMPLX(creal(a) * creal(b) - cimag(a) * cimag(b), creal(a) * cimag(b) + cimag(a) * creal(b));
}

static void eliminate(double complex *a, size_t size, size_t c) {
  double complex inverse = 1 / a[c * size + c];
  for (size_t i = c + 1; i < size; i++) {
    double complex factor = times(a[i * size + c], inverse);
    for (size_t j = c + 1; j < size; j++)
      a[i * size + j] -= times(factor, a[c * size + j]);
  }
}

/* Takes a power of two out of a product before it leaves the range of numbers. @returns its exponent */
static int rescale(double complex *product) {
  const double size = size_of(*product);
  int exponent = 0;
  if ((size > 0 && size < 1e-100) || (size > 1e100 && isfinite(size))) {
    frexp(size, &exponent);
    *product = CMPLX(ldexp(creal(*product), -exponent), ldexp(cimag(*product), -exponent));
  }
  return exponent;
}

/* Gaussian elimination; for the small matrices here several times faster than a library call. The imaginary part is in
 * [-pi, pi]. */
static double complex log_determinant(double complex *a, size_t size) {
  double complex product = 1;
  double exponent = 0;
  for (size_t c = 0; c < size; c++) {
    if (pivot(a, size, c))
      product = -product;
    product = times(product, a[c * size + c]);
    exponent += rescale(&product);
    eliminate(a, size, c);
  }
  return CMPLX(ric_log(complex_modulus(product)) + exponent * ln_2, ric_atan2(cimag(product), creal(product)));
}

double complex secular_log(secular *s, double complex zeta) {
  s->stopped = s->stopped || ric_poll_stops(s->poll);
  if (s->stopped)
    return CMPLX(NAN, NAN);
  double complex kappa, beta;
  complex_sinh_cosh(zeta / 2, &kappa, &beta);
  set_sums(s, kappa, beta);
  set_matrix(s, kappa);
  return log_determinant(s->matrix, 2 * s->impacts);
}

/* H = [[A, -B], [-B, -C - s/4]], real on the circle. */
static void set_symmetric(secular *s, double angle) {
  size_t m = s->impacts;
  double mean = -ric_sin(angle / 2);
  for (size_t k = 0; k < m; k++)
    for (size_t l = 0; l < m; l++) {
      size_t i = k * m + l;
      double slope = k == l ? s->impact[k].slope / 4 : 0;
      gsl_matrix_set(s->symmetric, k, l, creal(s->position[i]));
      gsl_matrix_set(s->symmetric, k, m + l, mean * creal(s->mean[i]));
      gsl_matrix_set(s->symmetric, m + k, l, mean * creal(s->mean[i]));
      gsl_matrix_set(s->symmetric, m + k, m + l, -creal(s->speed[i]) - slope);
    }
}

/* The sign of det H is that of f = (alpha - 1) g, which is accurate near 1, too: if the eigenvalues disagree with it,
 * the smallest one is noise. */
size_t secular_negative(secular *s, double angle) {
  double complex value = secular_log(s, CMPLX(0, angle));
  bool odd = ric_cos(cimag(value)) > 0;
  size_t negative = 0, smallest = 0;
  set_symmetric(s, angle);
  gsl_eigen_symm(s->symmetric, s->eigenvalues, s->work);
  for (size_t i = 0; i < 2 * s->impacts; i++) {
    negative += gsl_vector_get(s->eigenvalues, i) < 0;
    if (fabs(gsl_vector_get(s->eigenvalues, i)) < fabs(gsl_vector_get(s->eigenvalues, smallest)))
      smallest = i;
  }
  if ((negative % 2 == 1) == odd)
    return negative;
  return gsl_vector_get(s->eigenvalues, smallest) < 0 ? negative - 1 : negative + 1;
}
