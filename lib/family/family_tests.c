/* Test functions of a family, and the special points at their zeros. */
#include <math.h>
#include <string.h>

#include "family.h"
#include "numeric/complex_number.h"

/* Imaginary parts of eigenvalues that coincide by a symmetry: below it, relative to 1 + the modulus, they are
 * rounding. */
static const double rounding = 1e-6;
/* Two alpha of the n x n block nearer than this, relative to 1 + the modulus, coincide by a symmetry. Pairs that
 * collide are rarely nearer than the square root of rounding. */
static const double coincidence = 1e-11;

/* --- the motion --------------------------------------------------------------------------------------------------- */

static void record_evaluated(ric_family *f, const double *z) {
  memcpy(f->evaluated_z, z, f->unknowns * sizeof *z);
  f->evaluated_at[0] = f->at[0];
  f->evaluated_at[1] = f->at[1];
}

ric_status family_evaluate(ric_family *f, const double *z, double *F, double *J, double *F_given, ric_error *error) {
  const int what = EXAMINE_ORBIT | (f->options.multipliers ? EXAMINE_SPECTRUM : 0);
  f->evaluated_at[0] = NAN;
  f->complete = false;
  RIC_TRY(shooting_examine(f->shooting, z, f->given, what, F, J, F_given, &f->orbit, error));
  record_evaluated(f, z);
  return RIC_OK;
}

/* Whether the last run was along this motion. With a tolerance: or along one that the last correction of Newton's
 * method changed by no more, in the norm of the curve; its orbit is then as exact as points are. */
static bool is_evaluated(const ric_family *f, const double *z, double tolerance) {
  double change = f->at[0] - f->evaluated_at[0], moved = 0, size = 0, n = (double)f->unknowns;
  if (f->at[1] != f->evaluated_at[1])
    return false;
  for (size_t i = 0; i < f->unknowns; i++) {
    moved += (z[i] - f->evaluated_z[i]) * (z[i] - f->evaluated_z[i]);
    size += z[i] * z[i];
  }
  return sqrt(moved / n + change * change) <= tolerance * (1 + sqrt(size / n + f->at[0] * f->at[0]));
}

ric_status family_complete(ric_family *f, const double *z, ric_error *error) {
  if (f->complete && is_evaluated(f, z, 0))
    return RIC_OK;
  if (f->complete || !is_evaluated(f, z, f->options.curve.newton_tol))
    RIC_TRY(family_evaluate(f, z, NULL, NULL, NULL, error));
  RIC_TRY(shooting_verdict(f->shooting, z, f->given, &f->orbit, error));
  if (f->options.multipliers)
    RIC_TRY(shooting_multipliers(f->shooting, &f->options.judge, &f->multipliers, error));
  record_evaluated(f, z);
  f->complete = true;
  return RIC_OK;
}

static bool has_pairs(const ric_family *f) {
  return f->problem.motion.kind == RIC_MOTION_EVEN || f->problem.motion.kind == RIC_MOTION_CONSERVATIVE;
}

static bool has_multipliers(const ric_family *f) {
  return f->options.multipliers && f->multipliers.stable != RIC_STABILITY_UNKNOWN;
}

/* alpha = (mu + 1/mu) / 2 of a pair. */
static double complex alpha_of(const ric_family *f, size_t k) {
  if (f->problem.motion.kind == RIC_MOTION_EVEN) {
    ric_complex a = f->shooting->spectrum->even.alpha[k];
    return CMPLX(a.re, a.im);
  }
  double complex mu = CMPLX(f->multipliers.mu[k].re, f->multipliers.mu[k].im);
  return (mu + 1 / mu) / 2;
}

static size_t alpha_count(const ric_family *f) {
  return f->problem.motion.kind == RIC_MOTION_EVEN ? f->shooting->spectrum->even.count : f->multipliers.count;
}

/* Whether a multiplier represents its pair mu and 1/mu. */
static bool stands_for_pair(const ric_family *f, size_t k) {
  if (f->problem.motion.kind == RIC_MOTION_EVEN)
    return true;
  ric_complex mu = f->multipliers.mu[k];
  double outside = ric_hypot(mu.re, mu.im) - 1;
  return outside > rounding || (outside > -rounding && mu.im > 0);
}

/* The two pairs that are nearest to each other. */
typedef struct nearest_pairs {
  double apart; /* distance of their alpha */
  double place; /* real part */
} nearest_pairs;

/* Distance below which two alpha count as equal. */
static double coincidence_distance(const ric_family *f, double complex a) {
  return coincidence * (1 + complex_modulus(a) + f->multipliers.largest / 1000);
}

/* The nearest two that do not coincide. @param coincide  set to the number that coincide
 * @param common  set to the value of some that do */
static nearest_pairs nearest_different(const ric_family *f, size_t *coincide, double *common) {
  nearest_pairs m = {INFINITY, NAN};
  *coincide = 0;
  for (size_t i = 0; i < alpha_count(f); i++)
    for (size_t j = 0; j < i && stands_for_pair(f, i); j++) {
      double complex a = alpha_of(f, i);
      double apart = complex_modulus(a - alpha_of(f, j));
      if (!stands_for_pair(f, j))
        continue;
      if (apart <= coincidence_distance(f, a)) {
        ++*coincide;
        *common = creal(a);
      } else if (apart < m.apart) {
        m = (nearest_pairs){apart, creal(a)};
      }
    }
  return m;
}

/* The nearest two. Pairs that a symmetry makes equal coincide all along the family: if more than those coincide, two
 * pairs collide. */
static nearest_pairs nearest_two(ric_family *f) {
  size_t coincide;
  double common = NAN;
  nearest_pairs m = nearest_different(f, &coincide, &common);
  f->coincide = coincide < f->coincide ? coincide : f->coincide;
  return coincide > f->coincide ? (nearest_pairs){0, common} : m;
}

/* Largest imaginary part of an alpha. */
static double largest_imaginary_part(const ric_family *f) {
  double largest = 0;
  for (size_t i = 0; i < alpha_count(f); i++) {
    double complex a = alpha_of(f, i);
    if (stands_for_pair(f, i) && fabs(cimag(a)) > coincidence_distance(f, a))
      largest = fmax(largest, fabs(cimag(a)));
  }
  return largest;
}

/* The smallest distance of two different alpha, squared, or minus the largest imaginary part, squared: the
 * discriminant of two pairs that collide, linear in the parameter there. */
static double discriminant(ric_family *f) {
  double largest = largest_imaginary_part(f);
  nearest_pairs m = nearest_two(f);
  return largest > 0 ? -largest * largest : isfinite(m.apart) ? m.apart * m.apart : NAN;
}

/* Whether the two pairs collide on the unit circle, and leave it. */
static bool collides_on_circle(ric_family *f) {
  return fabs(nearest_two(f).place) < 1;
}

/* Largest modulus of complex multipliers, minus 1. */
static double largest_complex_modulus(const ric_family *f) {
  double largest = NAN;
  for (size_t i = 0; i < f->multipliers.count; i++) {
    ric_complex mu = f->multipliers.mu[i];
    double modulus = ric_hypot(mu.re, mu.im);
    if (fabs(mu.im) > rounding * (1 + modulus) && !(modulus - 1 <= largest))
      largest = modulus - 1;
  }
  return largest;
}

/* Product over all alpha of alpha - c, each factor over its size. */
static double product_of_distances(const ric_family *f, double c) {
  double complex product = 1;
  for (size_t i = 0; i < alpha_count(f); i++) {
    double complex a = alpha_of(f, i);
    product *= (a - c) / (1 + complex_modulus(a));
  }
  return creal(product);
}

static void tests_of_multipliers(ric_family *f, double *values) {
  for (int k = TEST_MINUS_ONE; k <= TEST_FOURTH; k++)
    values[k] = NAN;
  if (!has_multipliers(f))
    return;
  spectrum_tests t = shooting_spectrum_tests(f->shooting);
  values[TEST_MINUS_ONE] = t.minus_one[0];
  values[TEST_MINUS_ONE_TOO] = t.minus_one[1];
  values[TEST_BREAKING] = t.breaking;
  values[TEST_ENERGY] = t.energy;
  values[TEST_TORUS] = has_pairs(f) ? discriminant(f) : largest_complex_modulus(f);
  if (f->problem.motion.kind != RIC_MOTION_EVEN)
    return;
  values[TEST_THIRD] = product_of_distances(f, -0.5);
  values[TEST_FOURTH] = product_of_distances(f, 0);
}

static double finite_or_nan(double value) {
  return isfinite(value) ? value : NAN;
}

/* Duration of an arc. */
static double duration(const ric_family *f, const double *z, size_t arc) {
  const arc_plan *plan = &f->shooting->arcs;
  const arc_piece *p = &plan->pieces[arc * (plan->count / plan->arc_count)];
  double period = arcs_period(plan, z, f->given);
  return arcs_time(p->end, z, period) - arcs_time(p->begin, z, period);
}

void family_tests(ric_family *f, const double *z, double *values) {
  tests_of_multipliers(f, values);
  values[TEST_FREE_GAP] = finite_or_nan(f->shooting->gaps.watch.free.value);
  values[TEST_OWN_GAP] = finite_or_nan(f->shooting->gaps.watch.own.value);
  for (size_t k = 0; k < f->impacts; k++)
    values[TEST_IMPACTS + k] = f->orbit.gap_rate[k];
  size_t first = TEST_IMPACTS + f->impacts;
  for (size_t k = first; k < f->tests; k++)
    values[k] = duration(f, z, k - first);
}

/* --- special points at the zeros ---------------------------------------------------------------------------------- */

/* The piece that begins with an impact of the sequence. */
static const arc_piece *piece_after(const arc_plan *plan, size_t index) {
  size_t cuts = plan->count / plan->arc_count;
  size_t arc = plan->kind == RIC_MOTION_EVEN ? index + 1 : index;
  return &plan->pieces[arc * cuts];
}

/* Impacts of a sequence are recorded at the ends of the arcs: the second one first, unless the motion is even. */
static size_t sequence_index(const arc_plan *plan, size_t which) {
  size_t k = which - plan->start_count - plan->half_count;
  return plan->kind == RIC_MOTION_EVEN ? k : (k + 1) % plan->sequence_count;
}

/* State [n + m] after impact `which` of the motion evaluated last. */
static const double *family_state_after(const ric_family *f, const double *z, size_t which) {
  const arc_plan *plan = &f->shooting->arcs;
  const ric_shooting_problem *m = &f->problem.motion;
  if (which < m->start_count)
    return f->orbit.q; /* q and v are contiguous */
  if (which < m->start_count + m->count && plan->kind == RIC_MOTION_EVEN)
    return z + piece_after(plan, which - m->start_count)->state;
  if (plan->kind == RIC_MOTION_EVEN)
    return f->orbit.q_half;
  return z + piece_after(plan, sequence_index(plan, which))->state;
}

/* At a gap rate of zero: whether the gap has its minimum there, as it has at a grazing point. */
static bool has_minimum(const ric_family *f, const double *z, size_t which) {
  const ric_system *s = f->problem.system;
  const double *x = family_state_after(f, z, which), t = f->orbit.impact_time[which];
  double *rates = f->shooting->rates, acceleration;
  size_t n = s->coordinates, obstacle = f->orbit.impact_obstacle[which];
  if (ric_system_rate(s, t, x, x + n, rates, rates + n, NULL) != RIC_OK)
    return true;
  if (s->model->gap_acceleration(s, obstacle, t, x, x + n, rates, rates + n, &acceleration))
    return true;
  return acceleration >= 0;
}

/* Beyond the loss of an impact the gap has a minimum next to that impact, which begins at zero: it is not another
 * grazing point. */
static bool is_impact_lost(const ric_family *f, size_t obstacle) {
  for (size_t k = 0; k < f->orbit.impacts; k++)
    if (f->orbit.impact_obstacle[k] == obstacle && fabs(f->orbit.gap_rate[k]) < rounding)
      return true;
  return false;
}

static double folded(double time, double period) {
  double t = fmod(time, period);
  return t < 0 ? t + period : t;
}

static void classify_grazing(const ric_family *f, const gap_found *gap, ric_family_point *point) {
  if (is_impact_lost(f, gap->obstacle))
    return;
  point->kind = RIC_FAMILY_GRAZING;
  point->obstacle = gap->obstacle;
  point->time = folded(gap->time, f->orbit.period);
}

static void classify_impact(const ric_family *f, const double *z, size_t which, ric_family_point *point) {
  point->kind = has_minimum(f, z, which) ? RIC_FAMILY_IMPACT_LOST : RIC_FAMILY_IMPULSE_SIGN;
  point->obstacle = f->orbit.impact_obstacle[which];
  point->time = f->orbit.impact_time[which];
}

static double slope_of(event_time e, const ric_family_point *point) {
  return e.index == NO_UNKNOWN ? 0 : point->tangent[e.index];
}

/* Two impacts that are simultaneous all along the family, by a symmetry, do not change their order. */
static void classify_order(const ric_family *f, const double *z, size_t arc, ric_family_point *point) {
  const arc_plan *plan = &f->shooting->arcs;
  const arc_piece *p = &plan->pieces[arc * (plan->count / plan->arc_count)];
  size_t next = plan->kind == RIC_MOTION_EVEN ? arc : (arc + 1) % plan->sequence_count;

  if (p->end.of_period == 0 && fabs(slope_of(p->end, point) - slope_of(p->begin, point)) < rounding)
    return;
  point->kind = RIC_FAMILY_ORDER;
  point->time = folded(arcs_time(p->begin, z, f->orbit.period), f->orbit.period);
  point->obstacle = plan->sequence[next < plan->sequence_count ? next : plan->sequence_count - 1];
}

void family_classify_zero(ric_family *f, const double *z, size_t test, ric_family_point *point) {
  if (test >= TEST_IMPACTS + f->impacts) {
    classify_order(f, z, test - TEST_IMPACTS - f->impacts, point);
    return;
  }
  if (test >= TEST_IMPACTS) {
    classify_impact(f, z, test - TEST_IMPACTS, point);
    return;
  }
  switch ((family_test)test) {
  case TEST_MINUS_ONE:
  case TEST_MINUS_ONE_TOO:
    point->kind = RIC_FAMILY_PERIOD_DOUBLING;
    return;
  case TEST_BREAKING:
    point->kind = RIC_FAMILY_SYMMETRY_BREAKING;
    return;
  case TEST_ENERGY:
    point->kind = RIC_FAMILY_ENERGY_EXTREME;
    return;
  case TEST_TORUS:
    point->kind = !has_pairs(f) || collides_on_circle(f) ? RIC_FAMILY_TORUS : RIC_FAMILY_REGULAR;
    return;
  case TEST_THIRD:
  case TEST_FOURTH:
    point->kind = RIC_FAMILY_RESONANCE;
    point->order = test == TEST_THIRD ? 3 : 4;
    return;
  case TEST_FREE_GAP:
    classify_grazing(f, &f->shooting->gaps.watch.free, point);
    return;
  case TEST_OWN_GAP:
    classify_grazing(f, &f->shooting->gaps.watch.own, point);
    return;
  case TEST_IMPACTS:
    break;
  }
}
