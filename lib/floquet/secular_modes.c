/* The set-up of the determinant for an orbit: modes, poles, room. */
#include "secular.h"
#include "numeric/constants.h"

#include <math.h>
#include <stdlib.h>

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

/* Fills row `seen` of the shapes. @returns whether the mode is hidden: rounding leaves 1e-16 of a zero */
static bool set_shape(secular *s, const ric_chain *chain, size_t mode, size_t seen) {
  double largest = 0, rounding = 1e-12 / sqrt((double)s->particles);
  for (size_t k = 0; k < s->impacts; k++) {
    double shape = ric_chain_mode_shape(chain, mode, s->kicks[k].particle);
    s->modes.shape[k * s->particles + seen] = shape;
    largest = fmax(largest, fabs(shape));
  }
  return largest <= rounding;
}

static void set_coefficients(secular *s, size_t j, double omega, double x) {
  secular_modes *a = &s->modes;
  double start = 0, half = 0; /* the orbit's impulses as the mode feels them */
  for (size_t k = 0; k < s->impacts; k++) {
    double felt = a->shape[k * s->particles + j] * s->kicks[k].impulse;
    *(s->kicks[k].at_half ? &half : &start) += felt;
  }
  double cot = omega / (2 * tan(x)), csc = omega / (2 * sin(x));
  a->below_one[j] = 2 * sin(x) * sin(x);
  a->above_minus_one[j] = 2 * cos(x) * cos(x);
  a->same_position[j] = sin(2 * x) / (2 * omega);
  a->same_speed[j] = -omega * sin(2 * x) / 2;
  a->other_position[j] = sin(x) / omega;
  a->other_mean[j] = cos(x);
  a->other_speed[j] = -omega * sin(x);
  a->along_start[j] = cot * start + csc * half;
  a->along_half[j] = cot * half + csc * start;
  a->along_start_beta[j] = -omega * sin(x) / 2 * half;
  a->along_half_beta[j] = -omega * sin(x) / 2 * start;
}

static int by_angle(const void *a, const void *b) {
  const secular_pole *x = a, *y = b;
  return (x->angle > y->angle) - (x->angle < y->angle);
}

static void set_modes(secular *s, const ric_chain *chain, double period) {
  s->modes.seen = 0;
  for (size_t mode = 0; mode < s->particles; mode++) {
    double omega = ric_chain_frequency(chain, mode), x = omega * period / 2;
    double turn = remainder(2 * x, two_pi);
    bool hidden = set_shape(s, chain, mode, s->modes.seen);
    s->poles[mode] = (secular_pole){.angle = fabs(turn), .signature = turn > 0 ? 1 : -1, .hidden = hidden};
    if (!hidden)
      set_coefficients(s, s->modes.seen++, omega, x);
  }
  qsort(s->poles, s->particles, sizeof *s->poles, by_angle);
}

ric_status secular_prepare(secular *s, const ric_chain *chain, const kick_list *kicks, double period,
                           ric_error *error) {
  RIC_TRY(place_modes(s, chain->particles, kicks->count, error));
  RIC_TRY(place_matrices(s, kicks->count, error));
  s->particles = chain->particles;
  s->impacts = kicks->count;
  s->kicks = kicks->kicks;
  s->evaluations = 0;
  s->largest = 0;
  for (size_t k = 1; k < s->impacts; k++)
    if (fabs(s->kicks[k].impulse) > fabs(s->kicks[s->largest].impulse))
      s->largest = k;
  set_modes(s, chain, period);
  return RIC_OK;
}
