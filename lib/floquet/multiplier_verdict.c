#include "multiplier_verdict.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static double modulus(ric_complex z) {
  return hypot(z.re, z.im);
}

static double distance_from_one(ric_complex z) {
  return hypot(z.re - 1, z.im);
}

/* By modulus, largest first, then by argument, positive first. */
static int in_order(const void *a, const void *b) {
  const ric_complex *x = a, *y = b;
  double rx = modulus(*x), ry = modulus(*y), ax = fabs(atan2(x->im, x->re)), ay = fabs(atan2(y->im, y->re));
  if (rx != ry)
    return rx > ry ? -1 : 1;
  if (ax != ay)
    return ax < ay ? -1 : 1;
  return (x->im < y->im) - (x->im > y->im);
}

void multipliers_sort(ric_multipliers *m) {
  qsort(m->mu, m->count, sizeof *m->mu, in_order);
}

/* The nearest to 1 come first; which they are is a matter of distance alone. */
static int by_distance_from_one(const void *a, const void *b) {
  double x = distance_from_one(*(const ric_complex *)a), y = distance_from_one(*(const ric_complex *)b);
  return (x > y) - (x < y);
}

/* What the multipliers that count say. */
typedef struct finding {
  const ric_complex *outermost; /* of largest modulus */
  const ric_complex *unstable;  /* of those outside by more than the band; NULL if none is */
  const ric_complex *at_one;    /* one that lies too close to 1; NULL if none does */
} finding;

/* Real multipliers that coincide, as symmetry makes them, get imaginary parts from rounding. */
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

static finding look_at(ric_multipliers *m, const ric_complex *mu, size_t count, const ric_multiplier_options *o) {
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

static void say_unstable(ric_multipliers *m, const ric_complex *z, bool real) {
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
    say_unstable(m, f->unstable, is_real(f->unstable, o));
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

/* Farther from 1 than rounding splits a double 1, trivial multipliers are none. */
static const double trivial_tol = 1e-3;

static void look_at_trivial(ric_multipliers *m, size_t trivial) {
  const ric_complex *z = trivial > 0 ? &m->mu[trivial - 1] : NULL;
  if (!z || m->stable != RIC_STABLE || distance_from_one(*z) <= trivial_tol)
    return;
  m->stable = RIC_UNDECIDED;
  snprintf(m->reason, sizeof m->reason,
           "multiplier %.9g %+.3gi, taken for one that is 1 for any motion, lies %.3g from 1", z->re, z->im,
           distance_from_one(*z));
}

static double log_determinant(const ric_multipliers *m) {
  double sum = 0;
  for (size_t i = 0; i < m->count; i++)
    sum += log(modulus(m->mu[i]));
  return m->count == m->dimension ? sum : NAN;
}

void multipliers_judge(ric_multipliers *m, size_t trivial, const ric_multiplier_options *options) {
  ric_multiplier_options own = *options, *o = &own;
  if (trivial < 2) /* no second pair can meet the double 1 */
    own.band_at_one = own.band;
  qsort(m->mu, m->count, sizeof *m->mu, by_distance_from_one);
  finding f = look_at(m, m->mu + trivial, m->count - trivial, o);
  decide(m, &f, o);
  look_at_trivial(m, trivial);
  if (!f.outermost)
    m->margin = 0; /* nothing besides those at 1 */
  multipliers_sort(m);
  m->largest = modulus(m->mu[0]);
  m->log_determinant = log_determinant(m);
}

void multipliers_judge_outside(ric_multipliers *m, size_t untold, size_t near_one, const ric_multiplier_options *o) {
  multipliers_sort(m);
  finding f = look_at(m, m->mu, m->count, o);
  decide(m, &f, o);
  m->largest = m->count > 0 ? modulus(m->mu[0]) : 1;
  if (m->count == 0 && untold == 0)
    m->margin = 0;
  if (m->stable != RIC_STABLE)
    return;
  if (near_one > 0) {
    m->stable = RIC_UNDECIDED;
    snprintf(m->reason, sizeof m->reason, "%zu multipliers besides the trivial ones lie less than %.3g from 1",
             near_one, o->band_at_one);
  } else if (untold > 0) {
    m->stable = RIC_UNDECIDED;
    snprintf(m->reason, sizeof m->reason, "%zu multipliers are not told from the unit circle, within %.3g of it",
             untold, o->band);
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
