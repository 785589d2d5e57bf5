/* Test functions of a family, and what their zeros are. */
#include <complex.h>
#include <math.h>
#include <string.h>

#include "family.h"

/* Imaginary parts below it, relative to 1 + the modulus, are rounding: of eigenvalues that symmetry makes coincide. */
static const double rounding = 1e-6;
/* Two alpha of the n x n block this near, relative to 1 + the modulus, coincide by a symmetry; those of pairs that meet
 * are rarely nearer than the root of rounding. */
static const double coincidence = 1e-11;

/* --- the motion --------------------------------------------------------------------------------------------------- */

static void mark_seen(ric_family *f, const double *z) {
  memcpy(f->seen_z, z, f->unknowns * sizeof *z);
  f->seen_at[0] = f->at[0];
  f->seen_at[1] = f->at[1];
}

ric_status family_evaluate(ric_family *f, const double *z, double *F, double *J, double *F_given, ric_error *error) {
  const int what = EXAMINE_ORBIT | (f->options.multipliers ? EXAMINE_SPECTRUM : 0);
  f->seen_at[0] = NAN;
  f->judged = false;
  RIC_TRY(shooting_examine(f->shooting, z, f->given, what, F, J, F_given, &f->orbit, error));
  mark_seen(f, z);
  return RIC_OK;
}

/* Whether the last run was along this motion, or, with a tolerance, along one that was corrected to it by no more, in
 * the measure of the curve: what it has seen is as exact as points are. */
static bool was_seen(const ric_family *f, const double *z, double tolerance) {
  double change = f->at[0] - f->seen_at[0], moved = 0, size = 0, n = (double)f->unknowns;
  if (f->at[1] != f->seen_at[1])
    return false;
  for (size_t i = 0; i < f->unknowns; i++) {
    moved += (z[i] - f->seen_z[i]) * (z[i] - f->seen_z[i]);
    size += z[i] * z[i];
  }
  return sqrt(moved / n + change * change) <= tolerance * (1 + sqrt(size / n + f->at[0] * f->at[0]));
}

ric_status family_judge(ric_family *f, const double *z, ric_error *error) {
  if (f->judged && was_seen(f, z, 0))
    return RIC_OK;
  if (f->judged || !was_seen(f, z, f->options.curve.newton_tol))
    RIC_TRY(family_evaluate(f, z, NULL, NULL, NULL, error));
  RIC_TRY(shooting_judge(f->shooting, z, f->given, &f->orbit, error));
  if (f->options.multipliers)
    RIC_TRY(shooting_multipliers(f->shooting, &f->options.judge, &f->multipliers, error));
  mark_seen(f, z);
  f->judged = true;
  return RIC_OK;
}

static bool has_pairs(const ric_family *f) {
  return f->problem.motion.kind == RIC_MOTION_EVEN || f->problem.motion.kind == RIC_MOTION_CONSERVATIVE;
}

static bool knows_multipliers(const ric_family *f) {
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

/* Of multipliers mu and 1/mu one stands for both. */
static bool stands_for_pair(const ric_family *f, size_t k) {
  if (f->problem.motion.kind == RIC_MOTION_EVEN)
    return true;
  ric_complex mu = f->multipliers.mu[k];
  double outside = hypot(mu.re, mu.im) - 1;
  return outside > rounding || (outside > -rounding && mu.im > 0);
}

/* Two pairs. */
typedef struct meeting {
  double apart; /* distance of their alpha */
  double place; /* real part */
} meeting;

/* How near two alpha may be that are one. */
static double same(const ric_family *f, double complex a) {
  return coincidence * (1 + cabs(a) + f->multipliers.largest / 1000);
}

/* The two that are nearest to each other, but for those that coincide. @param coincide  set to how many do
 * @param common  set to where some of those are */
static meeting nearest_different(const ric_family *f, size_t *coincide, double *common) {
  meeting m = {INFINITY, NAN};
  *coincide = 0;
  for (size_t i = 0; i < alpha_count(f); i++)
    for (size_t j = 0; j < i && stands_for_pair(f, i); j++) {
      double complex a = alpha_of(f, i);
      double apart = cabs(a - alpha_of(f, j));
      if (!stands_for_pair(f, j))
        continue;
      if (apart <= same(f, a)) {
        ++*coincide;
        *common = creal(a);
      } else if (apart < m.apart) {
        m = (meeting){apart, creal(a)};
      }
    }
  return m;
}

/* The two that are nearest to each other. Those that a symmetry makes coincide do so all along the family: more than
 * that are meeting. */
static meeting nearest_two(ric_family *f) {
  size_t coincide;
  double common = NAN;
  meeting m = nearest_different(f, &coincide, &common);
  f->coincide = coincide < f->coincide ? coincide : f->coincide;
  return coincide > f->coincide ? (meeting){0, common} : m;
}

/* Largest imaginary part. */
static double across(const ric_family *f) {
  double largest = 0;
  for (size_t i = 0; i < alpha_count(f); i++) {
    double complex a = alpha_of(f, i);
    if (stands_for_pair(f, i) && fabs(cimag(a)) > same(f, a))
      largest = fmax(largest, fabs(cimag(a)));
  }
  return largest;
}

/* Smallest distance of two different ones, squared, or minus the largest imaginary part, squared: the discriminant of
 * the two that meet, linear where they do. */
static double collision(ric_family *f) {
  double largest = across(f);
  meeting m = nearest_two(f);
  return largest > 0 ? -largest * largest : isfinite(m.apart) ? m.apart * m.apart : NAN;
}

/* Of the two that meet, whether they leave the circle. */
static bool meets_on_circle(ric_family *f) {
  return fabs(nearest_two(f).place) < 1;
}

/* Largest modulus of complex multipliers, minus 1. */
static double torus(const ric_family *f) {
  double largest = NAN;
  for (size_t i = 0; i < f->multipliers.count; i++) {
    ric_complex mu = f->multipliers.mu[i];
    double modulus = hypot(mu.re, mu.im);
    if (fabs(mu.im) > rounding * (1 + modulus) && !(modulus - 1 <= largest))
      largest = modulus - 1;
  }
  return largest;
}

/* Product of alpha - c, each over its size. */
static double passage(const ric_family *f, double c) {
  double complex product = 1;
  for (size_t i = 0; i < alpha_count(f); i++) {
    double complex a = alpha_of(f, i);
    product *= (a - c) / (1 + cabs(a));
  }
  return creal(product);
}

static void tests_of_multipliers(ric_family *f, double *values) {
  for (int k = TEST_MINUS_ONE; k <= TEST_FOURTH; k++)
    values[k] = NAN;
  if (!knows_multipliers(f))
    return;
  spectrum_tests t = shooting_spectrum_tests(f->shooting);
  values[TEST_MINUS_ONE] = t.minus_one[0];
  values[TEST_MINUS_ONE_TOO] = t.minus_one[1];
  values[TEST_BREAKING] = t.breaking;
  values[TEST_ENERGY] = t.energy;
  values[TEST_TORUS] = has_pairs(f) ? collision(f) : torus(f);
  if (f->problem.motion.kind != RIC_MOTION_EVEN)
    return;
  values[TEST_THIRD] = passage(f, -0.5);
  values[TEST_FOURTH] = passage(f, 0);
}

static double or_none(double value) {
  return isfinite(value) ? value : NAN;
}

/* How long an arc lasts. */
static double duration(const ric_family *f, const double *z, size_t arc) {
  const arc_plan *plan = &f->shooting->arcs;
  const arc_piece *p = &plan->pieces[arc * (plan->count / plan->arc_count)];
  double period = arcs_period(plan, z, f->given);
  return arcs_time(p->end, z, period) - arcs_time(p->begin, z, period);
}

void family_tests(ric_family *f, const double *z, double *values) {
  tests_of_multipliers(f, values);
  values[TEST_FREE_GAP] = or_none(f->shooting->gaps.watch.free.value);
  values[TEST_OWN_GAP] = or_none(f->shooting->gaps.watch.own.value);
  for (size_t k = 0; k < f->impacts; k++)
    values[TEST_IMPACTS + k] = f->orbit.gap_rate[k];
  size_t first = TEST_IMPACTS + f->impacts;
  for (size_t k = first; k < f->tests; k++)
    values[k] = duration(f, z, k - first);
}

/* --- what zeros are ----------------------------------------------------------------------------------------------- */

/* The piece that begins with an impact of the sequence. */
static const arc_piece *piece_after(const arc_plan *plan, size_t index) {
  size_t cuts = plan->count / plan->arc_count;
  size_t arc = plan->kind == RIC_MOTION_EVEN ? index + 1 : index;
  return &plan->pieces[arc * cuts];
}

/* Impacts of a sequence are recorded at the ends of the arcs: of motions that are not even, the second one first. */
static size_t sequence_index(const arc_plan *plan, size_t which) {
  size_t k = which - plan->start_count - plan->half_count;
  return plan->kind == RIC_MOTION_EVEN ? k : (k + 1) % plan->sequence_count;
}

const double *family_state_after(const ric_family *f, const double *z, size_t which) {
  const arc_plan *plan = &f->shooting->arcs;
  const ric_shooting_problem *m = &f->problem.motion;
  if (which < m->start_count)
    return f->orbit.q; /* q and v follow each other */
  if (which < m->start_count + m->count && plan->kind == RIC_MOTION_EVEN)
    return z + piece_after(plan, which - m->start_count)->state;
  if (plan->kind == RIC_MOTION_EVEN)
    return f->orbit.q_half;
  return z + piece_after(plan, sequence_index(plan, which))->state;
}

/* At a gap rate of zero: whether the gap has its minimum there. */
static bool is_touch(const ric_family *f, const double *z, size_t which) {
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

/* Beyond the loss of an impact the gap has a minimum beside it that comes out of zero: that is not another contact. */
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

static void name_touch(const ric_family *f, const gap_found *gap, ric_family_point *point) {
  if (is_impact_lost(f, gap->obstacle))
    return;
  point->kind = RIC_FAMILY_GRAZING;
  point->obstacle = gap->obstacle;
  point->time = folded(gap->time, f->orbit.period);
}

static void name_impact(const ric_family *f, const double *z, size_t which, ric_family_point *point) {
  point->kind = is_touch(f, z, which) ? RIC_FAMILY_IMPACT_LOST : RIC_FAMILY_IMPULSE_SIGN;
  point->obstacle = f->orbit.impact_obstacle[which];
  point->time = f->orbit.impact_time[which];
}

static double slope_of(event_time e, const ric_family_point *point) {
  return e.index == NO_UNKNOWN ? 0 : point->tangent[e.index];
}

/* Impacts that have one time all along the family, by a symmetry, come to none. */
static void name_order(const ric_family *f, const double *z, size_t arc, ric_family_point *point) {
  const arc_plan *plan = &f->shooting->arcs;
  const arc_piece *p = &plan->pieces[arc * (plan->count / plan->arc_count)];
  size_t next = plan->kind == RIC_MOTION_EVEN ? arc : (arc + 1) % plan->sequence_count;

  if (p->end.of_period == 0 && fabs(slope_of(p->end, point) - slope_of(p->begin, point)) < rounding)
    return;
  point->kind = RIC_FAMILY_ORDER;
  point->time = folded(arcs_time(p->begin, z, f->orbit.period), f->orbit.period);
  point->obstacle = plan->sequence[next < plan->sequence_count ? next : plan->sequence_count - 1];
}

void family_name_zero(ric_family *f, const double *z, size_t test, ric_family_point *point) {
  if (test >= TEST_IMPACTS + f->impacts) {
    name_order(f, z, test - TEST_IMPACTS - f->impacts, point);
    return;
  }
  if (test >= TEST_IMPACTS) {
    name_impact(f, z, test - TEST_IMPACTS, point);
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
    point->kind = !has_pairs(f) || meets_on_circle(f) ? RIC_FAMILY_TORUS : RIC_FAMILY_REGULAR;
    return;
  case TEST_THIRD:
  case TEST_FOURTH:
    point->kind = RIC_FAMILY_RESONANCE;
    point->order = test == TEST_THIRD ? 3 : 4;
    return;
  case TEST_FREE_GAP:
    name_touch(f, &f->shooting->gaps.watch.free, point);
    return;
  case TEST_OWN_GAP:
    name_touch(f, &f->shooting->gaps.watch.own, point);
    return;
  case TEST_IMPACTS:
    break;
  }
}
