/* The derivative of a motion over its period and between two of its times; its multipliers. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "floquet/multipliers.h"
#include "ricochet/elementary.h"
#include "shooting.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* Derivatives of the state of a motion between two of its times. */

/* Ends of pieces nearer than this to one of the times, over the period, are at it; the piece ends before it. */
static const double end_tol = 1e-12;

typedef struct transfer {
  ric_shooting *s;
  const double *z;
  double period, origin; /* time of the first state */
  double from, to;       /* since then */
  double *x;             /* state at `from` */
  double *matrix;        /* NULL: only the state is computed */
  bool begun;
} transfer;

static ric_status move(const transfer *k, double from, double to, bool carry, ric_error *error) {
  ric_shooting *s = k->s;
  return arc_runner_move(&s->runner, k->origin + from, k->origin + to, s->x, carry ? s->arcs.size : 0,
                         carry ? s->spectrum->matrix : NULL, NULL, error);
}

/* Applies the saltation matrix of the impact at the end of a piece, with s->x before it, to s->spectrum->matrix; or
 * sets `grazing`. */
static ric_status shooting_spectrum_jump(ric_shooting *s, const piece_run *run, ric_error *error) {
  shooting_spectrum *k = s->spectrum;
  size_t n = s->arcs.coordinates, obstacle = run->piece->obstacle;
  double e = s->system->model->restitution(s->system, obstacle);
  double rate = ric_system_gap_rate(s->system, obstacle, run->end, s->x, s->x + n), *x = k->after;
  jump_group group = {&obstacle, &e, 1, false};
  tangents d = {.columns = k->size, .q = k->matrix, .u = k->matrix + n * k->size};
  ric_saltation_kind kind = RIC_SALTATION_GRAZING;
  memcpy(x, s->x, k->size * sizeof *x);
  if (rate < 0) {
    for (size_t j = 0; j < s->system->obstacle_count; j++) {
      k->contact[j] = system_complies(s->system, j) && ric_system_gap(s->system, j, run->end, s->x) < 0
                          ? CONTACT_PRESSED
                          : CONTACT_OPEN;
    }
    RIC_TRY(tangent_jump_apply(&k->jump, run->end, &group, s->grazing_tol, k->contact, k->contact, x, x + n, &d, &kind,
                               error));
  }
  k->grazing = kind != RIC_SALTATION_DIFFERENTIABLE;
  k->obstacle = obstacle;
  return RIC_OK;
}

/* Integrates the part of a piece between the times. @param shift  added to the times of the piece */
static ric_status pass_piece(transfer *k, size_t index, double shift, ric_error *error) {
  ric_shooting *s = k->s;
  const double slack = end_tol * k->period;
  const piece_run run = shooting_begin(s, index, k->z, k->period, OUTPUT_STATE);
  double begin = run.begin - k->origin, end = run.end - k->origin, from = k->from - shift, to = k->to - shift;
  if (end <= from + slack || begin > to + slack)
    return RIC_OK;
  if (!k->begun) {
    RIC_TRY(move(k, begin, fmax(begin, from), false, error));
    memcpy(k->x, s->x, s->arcs.size * sizeof *s->x);
    begin = fmax(begin, from);
    k->begun = true;
  }
  if (!k->matrix)
    return RIC_OK;
  RIC_TRY(move(k, begin, fmax(begin, fmin(end, to)), true, error));
  if (run.piece->how != PIECE_IMPACT || end > to + slack)
    return RIC_OK;
  RIC_TRY(shooting_spectrum_jump(s, &run, error));
  if (s->spectrum->grazing)
    return ric_fail(error, RIC_ENUMERIC, "the impact on obstacle %zu at t = %g is too slow for a derivative",
                    run.piece->obstacle, run.end);
  return RIC_OK;
}

static ric_status check_times(const ric_shooting *s, double from, double to, double period, ric_error *error) {
  if (s->arcs.kind == RIC_MOTION_EVEN)
    return ric_fail(error, RIC_EINVAL, "derivatives between times of an even motion, expected another kind");
  if (fabs(from) < INFINITY && to >= from && to <= from + period * (1 + end_tol))
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "from = %.9g, to = %.9g, expected from <= to <= from + %.9g, the period", from, to,
                  period);
}

void shooting_spectrum_destroy(shooting_spectrum **spectrum) {
  shooting_spectrum *k = *spectrum;
  if (!k)
    return;
  tangent_jump_clear(&k->jump);
  even_spectrum_clear(&k->even);
  multiplier_work_clear(&k->work);
  if (k->bordered)
    gsl_matrix_free(k->bordered);
  gsl_permutation_free(k->order);
  free(k->matrix);
  free(k->tau);
  free(k->contact);
  free(k);
  *spectrum = NULL;
}

static ric_status create(ric_shooting *s, shooting_spectrum **spectrum, ric_error *error) {
  size_t size = s->arcs.size, n = s->arcs.coordinates, bordered = shooting_is_even(s) ? n + 1 : size;
  shooting_spectrum *k = *spectrum = calloc(1, sizeof *k);
  if (k) {
    k->size = size;
    k->matrix = size < SIZE_MAX / 64 / size ? malloc((3 * size * size + 4 * size) * sizeof *k->matrix) : NULL;
    k->contact = calloc(s->system->obstacle_count + 1, 1);
    k->bordered = gsl_matrix_alloc(bordered, bordered);
    k->order = gsl_permutation_alloc(bordered);
    k->tau = malloc(2 * bordered * sizeof *k->tau);
  }
  if (!k || !k->matrix || !k->contact || !k->bordered || !k->order || !k->tau) {
    shooting_spectrum_destroy(spectrum);
    return ric_fail(error, RIC_ENOMEM, "no memory for a matrix of size %zu", size);
  }
  k->product = k->matrix + size * size;
  k->vectors = k->product + size * size;
  k->start = k->vectors + size * (size + 1);
  k->half = k->start + size;
  k->after = k->half + size;
  ric_status status = tangent_jump_init(&k->jump, s->system, &s->law, size, error);
  if (status == RIC_OK && shooting_is_even(s))
    status = even_spectrum_reserve(&k->even, n, error);
  else if (status == RIC_OK)
    status = multiplier_work_init(&k->work, size, error);
  if (status != RIC_OK)
    shooting_spectrum_destroy(spectrum);
  return status;
}

/* --- results ------------------------------------------------------------------------------------------------------ */

ric_status shooting_spectrum_reserve(ric_shooting *s, ric_error *error) {
  if (s->spectrum)
    return RIC_OK;
  keep_gsl_quiet();
  ric_status status = create(s, &s->spectrum, error);
  return status;
}

/* --- along the motion --------------------------------------------------------------------------------------------- */

static double *entry(const shooting_spectrum *k, size_t row, size_t column) {
  return &k->matrix[row * k->size + column];
}

/* --- the matrix --------------------------------------------------------------------------------------------------- */

/* Sets s->spectrum->matrix to the identity. */
static void shooting_spectrum_identity(shooting_spectrum *k) {
  memset(k->matrix, 0, k->size * k->size * sizeof *k->matrix);
  for (size_t i = 0; i < k->size; i++)
    *entry(k, i, i) = 1;
}

ric_status ric_shooting_transfer(ric_shooting *s, const double *z, double given, double from, double to, double *x,
                                 double *matrix, ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"z", z}, {"x", x});
  const size_t size = s->arcs.size;
  transfer k = {.s = s, .z = z, .x = x, .matrix = matrix};
  RIC_TRY(shooting_period(s, z, given, &k.period, error));
  RIC_TRY(check_times(s, from, to, k.period, error));
  RIC_TRY(shooting_spectrum_reserve(s, error));
  k.origin = piece_begin(&s->arcs.pieces[0], z, k.period);
  k.from = fmod(from - k.origin, k.period);
  k.from += k.from < 0 ? k.period : 0;
  k.to = k.from + (to - from);
  s->spectrum->grazing = false;
  shooting_spectrum_identity(s->spectrum);
  for (int round = 0; round < 2; round++)
    for (size_t p = 0; p < s->arcs.count; p++)
      RIC_TRY(pass_piece(&k, p, round * k.period, error));
  if (!k.begun)
    return ric_fail(error, RIC_ENUMERIC, "no arc of the motion is at t = %g", from);
  if (matrix)
    memcpy(matrix, s->spectrum->matrix, size * size * sizeof *matrix);
  return RIC_OK;
}

/* Whether the forces of an even motion do not depend on time. */
static bool is_unforced(const ric_shooting *s) {
  return !s->system->model->forced(s->system);
}

/* Multiplies the matrix up to the beginning of a piece by the tangent vectors along the piece. */
static void multiply_by_tangents(const ric_shooting *s, const piece_run *run) {
  shooting_spectrum *k = s->spectrum;
  memset(k->product, 0, k->size * k->size * sizeof *k->product);
  for (size_t l = 0; l < k->size; l++) {
    const double *before = entry(k, l, 0), *vectors = run->vectors + shooting_column(s, run, l);
    for (size_t i = 0; i < k->size; i++) {
      double x = vectors[i * run->columns], *row = k->product + i * k->size;
      for (size_t j = 0; x != 0 && j < k->size; j++)
        row[j] += x * before[j];
    }
  }
  memcpy(k->matrix, k->product, k->size * k->size * sizeof *k->matrix);
}

/* --- even motions ------------------------------------------------------------------------------------------------- */

/* Half of the saltation of an impact at a turning point: the change of the speed of its coordinate per displacement.
 * In the saltation matrix of an elastic impact the entry is 2 a / v-, a the acceleration and v- the speed before. */
static double half_saltation(double acceleration, double speed_before) {
  return -acceleration / speed_before;
}

/* Sets the rates at a turning point, and `grazing` if an impact there is too slow. The speeds of inadmissible
 * motions may have the other sign. */
static ric_status set_turning_rates(ric_shooting *s, const size_t *hit, double t, ric_error *error) {
  size_t n = s->arcs.coordinates;
  RIC_TRY(ric_system_rate(s->system, t, s->x, s->x + n, s->rates, s->rates + n, error));
  for (size_t i = 0; i < n; i++) {
    if (hit[i] == NO_UNKNOWN || fabs(s->x[n + i]) > s->grazing_tol)
      continue;
    s->spectrum->grazing = true;
    s->spectrum->obstacle = hit[i];
  }
  return RIC_OK;
}

/* The columns (s, a) of the start, as tangent vectors just after the impacts. */
static void set_start(ric_shooting *s) {
  shooting_spectrum *k = s->spectrum;
  size_t n = s->arcs.coordinates;
  memset(k->matrix, 0, k->size * k->size * sizeof *k->matrix);
  for (size_t i = 0; i < n; i++) {
    double mass = s->system->model->mass(s->system, i);
    bool hit = s->arcs.at_start[i] != NO_UNKNOWN;
    *entry(k, hit ? n + i : i, i) = hit ? 1 / mass : 1;
    *entry(k, hit ? i : n + i, n + i) = hit ? -1 : 1 / mass;
    if (hit)
      *entry(k, n + i, n + i) = -half_saltation(s->rates[n + i], -s->x[n + i]);
    k->start[n + i] = hit ? -s->x[n + i] : mass * s->rates[n + i];
  }
}

/* Converts rows just before the impacts at T/2 to (s, a) in the middle of the impacts. */
static void set_half(ric_shooting *s) {
  shooting_spectrum *k = s->spectrum;
  size_t n = s->arcs.coordinates;
  for (size_t i = 0; i < n; i++) {
    double mass = s->system->model->mass(s->system, i), *q = entry(k, i, 0), *v = entry(k, n + i, 0);
    bool hit = s->arcs.at_half[i] != NO_UNKNOWN;
    double saltation = hit ? half_saltation(s->rates[n + i], s->x[n + i]) : 0;
    for (size_t j = 0; j < k->size; j++) {
      double place = q[j], momentum = mass * (v[j] + saltation * place);
      q[j] = hit ? momentum : place;
      v[j] = hit ? -place : momentum;
    }
    k->half[n + i] = hit ? -s->x[n + i] : mass * s->rates[n + i];
  }
}

ric_status shooting_spectrum_begin(ric_shooting *s, ric_error *error) {
  s->spectrum->grazing = false;
  if (shooting_is_even(s))
    RIC_TRY(set_turning_rates(s, s->arcs.at_start, 0, error));
  if (shooting_is_even(s))
    set_start(s);
  else
    shooting_spectrum_identity(s->spectrum);
  return RIC_OK;
}

ric_status shooting_spectrum_pass(ric_shooting *s, const piece_run *run, ric_error *error) {
  if (s->spectrum->grazing)
    return RIC_OK;
  multiply_by_tangents(s, run);
  if (run->piece->how == PIECE_IMPACT)
    return shooting_spectrum_jump(s, run, error);
  if (run->piece->how != PIECE_HALF)
    return RIC_OK;
  RIC_TRY(set_turning_rates(s, s->arcs.at_half, run->end, error));
  if (!s->spectrum->grazing)
    set_half(s);
  return RIC_OK;
}

/* W = 1 + 2 B^T C, and the gradient of the energy in (s, a): that is, the a-part of the rates. */
static void set_block(ric_shooting *s) {
  const shooting_spectrum *k = s->spectrum;
  size_t n = s->arcs.coordinates;
  const even_spectrum *e = &k->even;
  for (size_t i = 0; i < n; i++) {
    double *row = gsl_matrix_ptr(e->block, i, 0);
    for (size_t j = 0; j < n; j++)
      row[j] = i == j ? 1 : 0;
    for (size_t l = 0; l < n; l++) {
      double b = 2 * *entry(k, l, n + i);
      const double *c = entry(k, n + l, 0);
      for (size_t j = 0; j < n; j++)
        row[j] += b * c[j];
    }
    gsl_vector_set(e->left, i, k->start[n + i]);
  }
}

/* By QR with column pivoting, since GSL's LU allocates memory: each reflection of Q has the determinant -1, one with
 * tau = 0 is the identity. */
static double determinant(const shooting_spectrum *k, size_t size) {
  int sign;
  double log_size = 0;
  gsl_matrix_view a = gsl_matrix_submatrix(k->bordered, 0, 0, size, size);
  gsl_permutation order = {.size = size, .data = k->order->data};
  gsl_vector_view tau = gsl_vector_view_array(k->tau, size), scratch = gsl_vector_view_array(k->tau + size, size);
  gsl_linalg_QRPT_decomp(&a.matrix, &tau.vector, &order, &sign, &scratch.vector);
  for (size_t i = 0; i < size; i++) {
    double r = gsl_matrix_get(&a.matrix, i, i);
    if (r == 0)
      return 0;
    sign *= (r > 0 ? 1 : -1) * (k->tau[i] != 0 ? -1 : 1);
    log_size += ric_log(fabs(r));
  }
  return sign * ric_exp(fmax(-600, fmin(log_size, 600)));
}

static double determinant_of_block(const ric_shooting *s, size_t row, size_t column) {
  const shooting_spectrum *k = s->spectrum;
  size_t n = s->arcs.coordinates;
  for (size_t i = 0; i < n; i++)
    memcpy(gsl_matrix_ptr(k->bordered, i, 0), entry(k, row + i, column), n * sizeof(double));
  return determinant(k, n);
}

/* Determinant of an n x n block bordered by the a-parts of the motion's rates, at T/2 on the right and at the start
 * below. B maps the latter to zero and its transpose the former; C maps s to -f_half dT/2 for a neighbouring motion
 * of the period T + dT. */
static double determinant_of_bordered(const ric_shooting *s, size_t row, size_t column) {
  const shooting_spectrum *k = s->spectrum;
  size_t n = s->arcs.coordinates;
  for (size_t i = 0; i < n; i++) {
    memcpy(gsl_matrix_ptr(k->bordered, i, 0), entry(k, row + i, column), n * sizeof(double));
    gsl_matrix_set(k->bordered, i, n, k->half[n + i]);
    gsl_matrix_set(k->bordered, n, i, k->start[n + i]);
  }
  gsl_matrix_set(k->bordered, n, n, 0);
  return determinant(k, n + 1);
}

static void even_tests(ric_shooting *s, spectrum_tests *t) {
  size_t n = s->arcs.coordinates;
  t->minus_one[0] = determinant_of_block(s, 0, 0);
  t->minus_one[1] = determinant_of_block(s, n, n);
  t->breaking = is_unforced(s) ? determinant_of_bordered(s, 0, n) : determinant_of_block(s, 0, n);
  if (is_unforced(s))
    t->energy = determinant_of_bordered(s, n, 0);
}

spectrum_tests shooting_spectrum_tests(ric_shooting *s) {
  const shooting_spectrum *k = s->spectrum;
  spectrum_tests t = {{NAN, NAN}, NAN, NAN};
  if (k->grazing)
    return t;
  keep_gsl_quiet();
  if (shooting_is_even(s)) {
    even_tests(s, &t);
  } else {
    memcpy(k->bordered->data, k->matrix, k->size * k->size * sizeof *k->matrix);
    for (size_t i = 0; i < k->size; i++)
      *gsl_matrix_ptr(k->bordered, i, i) += 1;
    t.minus_one[0] = determinant(k, k->size);
  }
  return t;
}

static size_t trivial_of(const ric_shooting *s) {
  return s->arcs.kind == RIC_MOTION_AUTONOMOUS ? 1 : s->arcs.kind == RIC_MOTION_CONSERVATIVE ? 2 : 0;
}

static void fail_grazing(const shooting_spectrum *k, ric_multipliers *m) {
  char reason[sizeof m->reason];
  snprintf(reason, sizeof reason, "grazing: obstacle %zu is not hit with a gap rate below zero", k->obstacle);
  ric_multipliers_fail(m, reason);
}

static ric_status even_multipliers(ric_shooting *s, const ric_multiplier_options *o, ric_multipliers *m,
                                   ric_error *error) {
  set_block(s);
  RIC_TRY(even_spectrum_find(&s->spectrum->even, is_unforced(s), error));
  even_spectrum_multipliers(&s->spectrum->even, o, m);
  return RIC_OK;
}

ric_status shooting_multipliers(ric_shooting *s, const ric_multiplier_options *options, ric_multipliers *m,
                                ric_error *error) {
  ric_multiplier_options o = options ? *options : ric_multiplier_options_default();
  RIC_TRY(multiplier_options_check(&o, error));
  if (m->dimension != s->arcs.size)
    return ric_fail(error, RIC_EINVAL, "room for %zu multipliers, expected %zu", m->dimension, s->arcs.size);
  ric_multipliers_fail(m, "not computed");
  if (s->spectrum->grazing) {
    fail_grazing(s->spectrum, m);
    return RIC_OK;
  }
  keep_gsl_quiet();
  ric_status status = shooting_is_even(s)
                          ? even_multipliers(s, &o, m, error)
                          : multiplier_work_find(&s->spectrum->work, s->spectrum->matrix, trivial_of(s), &o, m, error);
  return status;
}

ric_status ric_shooting_multipliers(ric_shooting *s, const double *z, double given,
                                    const ric_multiplier_options *options, ric_multipliers *m, ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"z", z}, {"multipliers", m});
  RIC_TRY(shooting_examine(s, z, given, EXAMINE_SPECTRUM, NULL, NULL, NULL, NULL, error));
  return shooting_multipliers(s, options, m, error);
}
