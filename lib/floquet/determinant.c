/* Multipliers by the determinant: those on the unit circle are counted and located by signature; the verdict. */
#include "determinant.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "multipliers.h"
#include "numeric/constants.h"
#include "ricochet/elementary.h"

/* Arcs of this length count as points. With a pole on or next to an arc, rounding is 1e-16 over the distance of alpha,
 * and the second value is the shortest distance. */
static const double shortest = 4e-16, shortest_at_pole = 1e-11;

/* Arcs shorter than this may end within the rounding of a zero: an increase of the sum of bounds there is noise. */
static const double noisy = 1e-9;

/* Where an arc is divided: not in the middle, where symmetric systems have poles. */
static const double division = 0.4871;

typedef struct arc {
  double low, high;
  size_t negative_low, negative_high; /* negative eigenvalues of H at the ends */
  size_t first, last;                 /* poles [first, last) lie on it */
} arc;

/* Length below which an arc with a pole is not divided: alpha = cos(angle). */
static double undivided(const arc *a) {
  return shortest_at_pole / fmax(fmax(ric_sin(a->low), ric_sin(a->high)), 1e-8);
}

/* Poles of f on it, and the sum of their signs. */
static size_t poles_on(const secular *s, const arc *a, long *signs) {
  size_t seen = 0;
  *signs = 0;
  for (size_t j = a->first; j < a->last; j++)
    if (!s->poles[j].hidden) {
      seen++;
      *signs += s->poles[j].signature;
    }
  return seen;
}

static size_t bound_on(const arc *a, long signs) {
  return (size_t)labs((long)a->negative_low - (long)a->negative_high + signs);
}

static size_t bound_of(const secular *s, const arc *a) {
  long signs;
  poles_on(s, a, &signs);
  return bound_on(a, signs);
}

static size_t hidden_below(const secular *s, double angle) {
  size_t hidden = 0;
  for (size_t j = 0; j < s->particles && s->poles[j].angle < angle; j++)
    hidden += s->poles[j].hidden;
  return hidden;
}

static size_t first_above(const secular *s, size_t first, size_t last, double angle) {
  while (first < last) {
    size_t middle = (first + last) / 2;
    if (s->poles[middle].angle > angle)
      last = middle;
    else
      first = middle + 1;
  }
  return first;
}

static arc whole_circle(secular *s, double from) {
  return (arc){.low = from,
               .high = pi,
               .negative_low = secular_negative(s, from),
               .negative_high = secular_negative(s, pi),
               .first = first_above(s, 0, s->particles, from),
               .last = s->particles};
}

static void divide(secular *s, const arc *a, double at, arc *left, arc *right) {
  *left = *right = *a;
  left->high = right->low = at;
  left->negative_high = right->negative_low = secular_negative(s, at);
  left->last = right->first = first_above(s, a->first, a->last, at);
}

/* A point between the poles in the middle of the arc; its low end if they coincide. */
static double between_poles(const secular *s, const arc *a) {
  size_t middle = (a->first + a->last) / 2;
  double left = s->poles[middle - 1].angle, right = s->poles[middle].angle;
  return right - left > 1e-13 ? left + division * (right - left) : a->low;
}

/* A point for dividing an arc away from the poles on it. */
static double place(const secular *s, const arc *a) {
  double length = a->high - a->low, at = a->low + division * length;
  for (int i = 1; i <= 4; i++) {
    size_t next = first_above(s, a->first, a->last, at);
    double after = next < a->last ? s->poles[next].angle - at : length;
    double before = next > a->first ? at - s->poles[next - 1].angle : length;
    if (fmin(after, before) > 0.05 * length)
      break;
    at = a->low + (division - 0.113 * i * (i % 2 ? 1 : -1)) * length;
  }
  return at;
}

static size_t count_on(secular *s, const arc *a, int depth) {
  long signs;
  size_t seen = poles_on(s, a, &signs), bound = bound_on(a, signs);
  if (s->stopped || depth == 0 || seen == 0 || bound == seen || a->high - a->low < undivided(a))
    return bound;
  arc left, right;
  double at = a->last - a->first > 1 ? between_poles(s, a) : a->low;
  divide(s, a, at > a->low ? at : place(s, a), &left, &right);
  return count_on(s, &left, depth - 1) + count_on(s, &right, depth - 1);
}

size_t unit_circle_count(secular *s, double from, int depth) {
  arc whole = whole_circle(s, from);
  return hidden_below(s, INFINITY) - hidden_below(s, from) + count_on(s, &whole, depth);
}

/** The same for the angles 0 < t < band. */
static size_t unit_circle_near_one(secular *s, double band) {
  long signs;
  arc near = {.high = band,
              .negative_low = secular_negative(s, 0),
              .negative_high = secular_negative(s, band),
              .last = first_above(s, 0, s->particles, band)};
  poles_on(s, &near, &signs);
  return hidden_below(s, band) + bound_on(&near, signs);
}

/* The search: arcs of count 0 with one pole are divided a few more times, in case they contain two multipliers of
 * opposite sign. */
typedef struct search {
  secular *s;
  double *angles;
  size_t count, room;
  int spare;
} search;

/* The sign of det H and its logarithm, that of its modulus, up to a smooth factor. */
static int sign_at(secular *s, double angle, double *modulus) {
  double complex value = secular_log(s, CMPLX(0, angle));
  *modulus = creal(value);
  return ric_cos(cimag(value)) < 0 ? 1 : -1;
}

/* Two multipliers of opposite sign on an arc without poles change the sign of det H between them: searches such a place
 * by golden section. */
static bool dips(secular *s, const arc *a, double *where) {
  const double golden = 0.3819660112501051;
  double low = a->low, high = a->high, x = low + golden * (high - low), at_x, at_y;
  int sign = a->negative_low % 2 == 0 ? 1 : -1;
  if (sign_at(s, x, &at_x) != sign) {
    *where = x;
    return true;
  }
  for (int i = 0; i < 30; i++) { /* x divides [low, high] in the golden ratio, on alternate sides */
    double y = low + high - x;
    bool changes = sign_at(s, y, &at_y) != sign, left = y < x;
    if (changes) {
      *where = y;
      return true;
    }
    if (at_y < at_x) {
      *(left ? &high : &low) = x;
      x = y;
      at_x = at_y;
    } else {
      *(left ? &low : &high) = y;
    }
  }
  return false;
}

static void put(search *x, double angle, size_t times) {
  for (; times > 0; times--, x->count++)
    if (x->count < x->room)
      x->angles[x->count] = angle;
}

static void find_on(search *x, const arc *a, int spare) {
  long signs;
  size_t seen = poles_on(x->s, a, &signs), bound = bound_on(a, signs);
  double length = a->high - a->low;
  bool barren = bound == 0 && seen <= 1;
  if (x->s->stopped || (barren && seen == 1 && spare == 0))
    return;
  if (length <= (seen > 0 ? undivided(a) : shortest * fmax(1, a->high))) {
    put(x, (a->low + a->high) / 2, bound);
    return;
  }
  arc left, right;
  double where = 0;
  if (barren && seen == 0 && !dips(x->s, a, &where))
    return;
  divide(x->s, a, where > 0 ? where : place(x->s, a), &left, &right);
  if (where > 0 && bound_of(x->s, &left) == 0 && bound_of(x->s, &right) == 0)
    return; /* the eigenvalues of H change no sign there: that of det H is rounding */
  if (length < noisy && bound_of(x->s, &left) + bound_of(x->s, &right) > bound) {
    put(x, (a->low + a->high) / 2, bound);
    return;
  }
  find_on(x, &left, barren ? spare - 1 : x->spare);
  find_on(x, &right, barren ? spare - 1 : x->spare);
}

/** The angles of the pairs on the circle above `from`, to rounding, without the one at 1.
 *  @param angles  [n], or NULL to count; @param count  set to their number
 *  @param wanted  upper limit: stop when found
 *  @returns RIC_ESTOPPED */
static ric_status unit_circle_find(secular *s, double from, size_t wanted, double *angles, size_t *count,
                                   ric_error *error) {
  arc whole = whole_circle(s, from);
  search x = {.s = s, .angles = angles, .room = angles ? s->particles : 0};
  for (x.spare = 2; x.spare <= 8; x.spare += 3) {
    x.count = 0;
    for (size_t j = 0; j < s->particles; j++)
      if (s->poles[j].hidden && s->poles[j].angle >= from)
        put(&x, s->poles[j].angle, 1);
    find_on(&x, &whole, x.spare);
    *count = x.count;
    if (s->stopped)
      return ric_fail(error, RIC_ESTOPPED, "stopped on the unit circle");
    if (x.count >= wanted)
      break;
  }
  return RIC_OK;
}

/* Results of the counts. */
typedef struct multiplier_counts {
  size_t on_circle; /* pairs, at least */
  size_t outside;   /* beyond the last contour */
  double contour;   /* log of its radius */
  size_t farther;   /* beyond the contour before it */
  double far;       /* log of its radius */
  size_t near_one;  /* multipliers too close to 1, besides the trivial ones */
  double from;      /* angle from which the unit circle is examined */
} multiplier_counts;

/* If there are more multipliers than this between the last two contours, they are counted but not located: in a large
 * ring hundreds leave the unit circle by 1e-6 where modes of both signs overlap. */
enum { MOST_BETWEEN = 64 };

/* A contour through a multiplier is shifted slightly. */
static bool count_outside(secular *s, double distance, multiplier_counts *t) {
  t->farther = t->outside;
  t->far = t->contour > 0 ? t->contour : INFINITY;
  for (int i = 0; i < 4; i++) {
    t->contour = ric_log(1 + distance * (1 + 0.1371 * i));
    if (winding_outside(s, t->contour, &t->outside))
      return true;
  }
  return false;
}

static bool all_counted(const secular *s, const multiplier_counts *t) {
  return t->on_circle + t->outside >= s->particles;
}

/* Counts multipliers within `band` of 1 besides the trivial ones, on the unit circle or off it, by the winding number
 * around 1. There rounding decides signs, so the unit circle is examined beyond it. If a pole is as close, only those
 * on the circle are counted. */
static void count_near_one(secular *s, double band, multiplier_counts *t) {
  if (winding_box(s, CMPLX(-band, -band), CMPLX(band, band), &t->near_one)) {
    t->from = t->near_one > 0 ? band : 0;
    return;
  }
  t->near_one = 2 * unit_circle_near_one(s, band);
  t->from = 0;
}

/* Uses contours closer and closer to the unit circle and sharper bounds on it, until all multipliers are counted. A
 * search of the circle comes last: multipliers outside decide without it. */
static ric_status count_all(secular *s, const ric_orbit_multiplier_options *o, multiplier_counts *t, ric_error *error) {
  static const int depth[] = {4, 40};
  const double distances[] = {fmax(0.1, o->judge.band), fmax(1e-3, o->judge.band), o->judge.band};
  *t = (multiplier_counts){0};
  count_near_one(s, o->judge.band_at_one, t);
  size_t close = 1 + (t->from > 0 ? t->near_one / 2 : 0); /* pairs */
  for (int stage = 0; stage < 3 && !all_counted(s, t); stage++) {
    if (stage < 2)
      t->on_circle = close + unit_circle_count(s, t->from, depth[stage]);
    bool counted = all_counted(s, t) || count_outside(s, distances[stage], t);
    if (s->stopped)
      return ric_fail(error, RIC_ESTOPPED, "stopped at |mu| = 1 + %g", distances[stage]);
    if (!counted)
      return ric_fail(error, RIC_ENUMERIC, "winding number along |mu| = 1 + %g is not an integer", distances[stage]);
  }
  if (all_counted(s, t) || t->outside > 0)
    return RIC_OK;
  size_t found;
  RIC_TRY(unit_circle_find(s, t->from, s->particles - close, NULL, &found, error));
  t->on_circle = close + found > t->on_circle ? close + found : t->on_circle;
  return RIC_OK;
}

/* Locates those beyond the farther contour, then those between the two. */
static void locate(secular *s, const multiplier_counts *t, ric_multipliers *m) {
  size_t between = 0;
  m->count = 0;
  if (t->farther > 0)
    multipliers_outside_find(s, t->far, INFINITY, t->farther, m->mu, m->dimension, &m->count);
  if (t->outside > t->farther && t->outside - t->farther <= MOST_BETWEEN)
    multipliers_outside_find(s, t->contour, t->far, t->outside - t->farther, m->mu + m->count, m->dimension - m->count,
                             &between);
  m->count += between;
}

/* On the unit circle each pair contributes two. */
static void put_on_circle(ric_multipliers *m, const double *angles, size_t count) {
  for (size_t i = 0; i < count && m->count + 2 <= m->dimension; i++) {
    double re, im;
    ric_sincos(angles[i], &im, &re);
    m->mu[m->count++] = (ric_complex){re, im};
    m->mu[m->count++] = (ric_complex){re, -im};
  }
}

static void put_inverses(ric_multipliers *m) {
  for (size_t i = 0, outside = m->count; i < outside && m->count < m->dimension; i++) {
    double square = m->mu[i].re * m->mu[i].re + m->mu[i].im * m->mu[i].im;
    m->mu[m->count++] = (ric_complex){m->mu[i].re / square, -m->mu[i].im / square};
  }
}

/* All 2n multipliers: those outside, their inverses, those on the circle, and the double 1. The search on the circle
 * may miss multipliers of opposite sign that nearly coincide; then fewer are known. */
static ric_status complete(secular *s, double from, const ric_orbit_multiplier_options *o, ric_multipliers *m,
                           ric_error *error) {
  size_t found = 0, wanted = s->particles - 1 - m->count;
  double *angles = malloc(s->particles * sizeof *angles);
  if (!angles)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu multipliers", s->particles);
  ric_status status = unit_circle_find(s, from, wanted, angles, &found, error);
  put_inverses(m);
  put_on_circle(m, angles, found);
  free(angles);
  for (int i = 0; i < 2 && m->count < m->dimension; i++)
    m->mu[m->count++] = (ric_complex){1, 0};
  RIC_TRY(status);
  if (m->count == m->dimension && found == wanted)
    multipliers_judge(m, 2, &o->judge);
  else
    multipliers_sort(m); /* the verdict is not changed */
  return RIC_OK;
}

ric_status determinant_multipliers(secular *s, const ric_orbit_multiplier_options *o, ric_multipliers *m,
                                   ric_error *error) {
  multiplier_counts t;
  s->poll = o->poll;
  s->stopped = false;
  RIC_TRY(count_all(s, o, &t, error));
  size_t n = s->particles, unlocated = t.on_circle + t.outside < n ? n - t.on_circle - t.outside : 0;
  locate(s, &t, m);
  if (s->stopped)
    return ric_fail(error, RIC_ESTOPPED, "stopped before the multipliers outside the unit circle were located");
  size_t missing = t.outside > m->count ? t.outside - m->count : 0;
  multipliers_judge_outside(m, unlocated, t.near_one, &o->judge);
  if (missing > t.near_one) {
    m->stable = RIC_UNSTABLE;
    m->outside = t.outside;
    snprintf(m->reason, sizeof m->reason, "%zu multipliers lie outside the unit circle, %zu of them not located",
             t.outside, missing);
    return RIC_OK;
  }
  return o->on_circle ? complete(s, t.from, o, m, error) : RIC_OK;
}
