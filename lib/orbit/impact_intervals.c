/* The intervals of periods at which the orbits of a family are admissible, and the reasons of their ends.
 *
 * Resonances cut the range into cells, in each of which S falls from +infinity to -infinity; its zero, the blow-up,
 * cuts a cell into two pieces. On one of them the impulse is negative. On the other the margin of the orbits
 * (impact_modes.h) is a continuous function of the period, and changes of its sign are grazing points. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include "impact_modes.h"
#include "numeric/constants.h"
#include "ricochet/elementary.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

enum { DEFAULT_SAMPLES = 64, MOST_SAMPLES = 1000000, MOST_ITERATIONS = 200, DIP_STEPS = 40 };

/* Resonances nearer to each other than this, relatively, count as one; shorter pieces are skipped. */
static const double merge_tol = 1e-12;
/* The first and the last sample of a piece have this distance from its ends, as a part of its length, but at least
 * merge_tol: within that there may be another resonance or blow-up. */
static const double end_part = 1e-9;

const char *ric_interval_end_name(ric_interval_end end) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_INTERVAL_END_LIST(X)
#undef X
  };
  return (unsigned)end < RIC_INTERVAL_ENDS ? names[end] : "unknown end";
}

/* A period at which an interval ends. */
typedef struct mark {
  double period;
  ric_interval_end end;
  char reason[RIC_REASON_BYTES];
} mark;

typedef struct sample {
  double period, margin;
} sample;

typedef struct search {
  ric_impact_modes *modes;
  double low, high;
  size_t samples;
  sample *list; /* [2 samples + 4] samples of a piece, with the minima added between them */
  size_t count;
  mark from;       /* the beginning of the next interval */
  ric_orbit orbit; /* in the middle of one */
  gsl_root_fsolver *brent;
  int (*visit)(const ric_impact_interval *interval, void *user);
  void *user;
  bool stopped;
  ric_error *error;
} search;

/* --- functions of the period and their zeros ---------------------------------------------------------------------- */

static double margin_function(double period, void *user) {
  return impact_modes_margin(user, period, NULL);
}

/* S between two resonances. Rounding may give a period at one of them the sign beyond the pole: the limit is
 * returned there. */
typedef struct cell {
  const ric_impact_modes *modes;
  double low, high;
} cell;

static double balance_function(double period, void *user) {
  const cell *c = user;
  if (period <= c->low)
    return 1;
  return period >= c->high ? -1 : response_balance(c->modes, period);
}

static ric_status find_zero(search *s, double (*function)(double, void *), void *user, double low, double high,
                            double *zero) {
  gsl_function f = {.function = function, .params = user};
  int code = gsl_root_fsolver_set(s->brent, &f, low, high);
  for (int i = 0; i < MOST_ITERATIONS && !code; i++) {
    code = gsl_root_fsolver_iterate(s->brent);
    double a = gsl_root_fsolver_x_lower(s->brent), b = gsl_root_fsolver_x_upper(s->brent);
    if (b - a <= 2 * DBL_EPSILON * b)
      break;
  }
  *zero = gsl_root_fsolver_root(s->brent);
  return code ? ric_fail(s->error, gsl_status(code), "end of an interval in [%.17g, %.17g]: %s", low, high,
                         gsl_text(code))
              : RIC_OK;
}

/* --- intervals ---------------------------------------------------------------------------------------------------- */

static void describe_middle(search *s, ric_impact_interval *interval) {
  if (interval->outcome == RIC_INADMISSIBLE &&
      ric_impact_modes_orbit(s->modes, interval->low / 2 + interval->high / 2, &s->orbit, NULL) == RIC_OK)
    snprintf(interval->reason, sizeof interval->reason, "%s", s->orbit.reason);
}

/* Reports the interval from s->from to this mark. */
static void report_interval(search *s, const mark *to, bool admissible) {
  ric_impact_interval interval = {.low = s->from.period,
                                  .high = to->period,
                                  .outcome = admissible ? RIC_ADMISSIBLE : RIC_INADMISSIBLE,
                                  .low_end = s->from.end,
                                  .high_end = to->end};
  snprintf(interval.low_reason, sizeof interval.low_reason, "%s", s->from.reason);
  snprintf(interval.high_reason, sizeof interval.high_reason, "%s", to->reason);
  describe_middle(s, &interval);
  s->from = *to;
  s->stopped = s->visit(&interval, s->user) != 0;
}

static ric_status end_at_grazing(search *s, const sample *before, const sample *after) {
  gap_found gap;
  mark grazing = {.end = RIC_INTERVAL_GRAZING};
  RIC_TRY(find_zero(s, margin_function, s->modes, before->period, after->period, &grazing.period));
  impact_modes_margin(s->modes, grazing.period, &gap);
  admissibility_write_grazing(grazing.reason, sizeof grazing.reason, &s->modes->names, &gap);
  report_interval(s, &grazing, before->margin > 0);
  return RIC_OK;
}

static void add_sample(search *s, double period) {
  s->list[s->count++] = (sample){period, margin_function(period, s->modes)};
}

/* Golden-section search for the smallest |margin| between two periods; it stops when the sign changes. */
static sample minimise_margin(search *s, const sample *left, const sample *right) {
  static const double golden = 0.61803398874989485;
  double a = left->period, b = right->period, sign = copysign(1, left->margin);
  sample x = {b - golden * (b - a), 0}, y = {a + golden * (b - a), 0};
  x.margin = margin_function(x.period, s->modes);
  y.margin = margin_function(y.period, s->modes);
  for (int i = 0; i < DIP_STEPS && sign * x.margin > 0 && sign * y.margin > 0; i++)
    if (sign * x.margin < sign * y.margin) {
      b = y.period;
      y = x;
      x.period = b - golden * (b - a);
      x.margin = margin_function(x.period, s->modes);
    } else {
      a = x.period;
      x = y;
      y.period = a + golden * (b - a);
      y.margin = margin_function(y.period, s->modes);
    }
  return sign * x.margin <= 0 ? x : y;
}

static int by_period(const void *a, const void *b) {
  const sample *x = a, *y = b;
  return x->period < y->period ? -1 : x->period > y->period;
}

/* Samples that bracket the changes of sign of the margin, including pairs of them next to a minimum of the first
 * samples. */
static void sample_margins(search *s, double low, double high) {
  double nearest = fmax(end_part * (high - low), fmin(merge_tol * high, (high - low) / 4));
  s->count = 0;
  low += nearest;
  high -= nearest;
  add_sample(s, low);
  for (size_t i = 0; i < s->samples; i++) /* denser at the ends, where amplitudes or impulses change fast */
    add_sample(s, low + (high - low) * (1 - ric_cos(pi * ((double)i + 0.5) / (double)s->samples)) / 2);
  add_sample(s, high);
  for (size_t i = 1, count = s->count; i + 1 < count; i++) {
    const sample *x = &s->list[i];
    double sign = copysign(1, x->margin), own = sign * x->margin;
    if (!(own <= sign * x[-1].margin && own < sign * x[1].margin))
      continue;
    sample dip = minimise_margin(s, x - 1, x + 1);
    if (sign * dip.margin <= 0)
      s->list[s->count++] = dip;
  }
  qsort(s->list, s->count, sizeof *s->list, by_period);
}

/* Intervals of the piece from s->from to this mark, on which the impulse is positive. */
static ric_status search_piece(search *s, const mark *to) {
  sample_margins(s, s->from.period, to->period);
  for (size_t i = 0; i + 1 < s->count && !s->stopped; i++)
    if ((s->list[i].margin > 0) != (s->list[i + 1].margin > 0))
      RIC_TRY(end_at_grazing(s, &s->list[i], &s->list[i + 1]));
  if (!s->stopped)
    report_interval(s, to, s->list[s->count - 1].margin > 0);
  return RIC_OK;
}

/* The part of a piece that lies in the range. @param sign  of S there */
static ric_status search_part(search *s, const mark *to, int sign) {
  const ric_obstacle *o = &s->modes->obstacles[s->modes->obstacle];
  mark end = *to;
  if (s->stopped || to->period <= s->low)
    return RIC_OK;
  if (to->period > s->high * (1 - merge_tol))
    end = (mark){.period = s->high, .end = RIC_INTERVAL_BOUND};
  if (!(end.period - s->from.period > merge_tol * end.period))
    return RIC_OK; /* both ends count as one: the next interval begins where the last one ends */
  bool pushes = o->side * o->position * sign > 0;
  if (pushes)
    return search_piece(s, &end);
  report_interval(s, &end, false);
  return RIC_OK;
}

/* --- cells -------------------------------------------------------------------------------------------------------- */

/* The last resonance up to a period, 0 if there is none, or the first one after it, of modes that move k. */
static mark resonance(const ric_impact_modes *m, double period, bool after) {
  mark found = {.period = after ? INFINITY : 0, .end = RIC_INTERVAL_RESONANCE};
  for (size_t j = 0; j < m->n; j++) {
    double shortest = 2 * pi / m->frequency[j], l = floor(period * (1 + merge_tol) / shortest) + (after ? 1 : 0);
    if (m->phi_hit[j] == 0 || !(after ? l * shortest < found.period : l * shortest > found.period))
      continue;
    found.period = l * shortest;
    admissibility_write_mode(found.reason, sizeof found.reason, j, l);
  }
  return found;
}

static ric_status find_blow_up(search *s, double low, double high, mark *blow_up) {
  cell c = {s->modes, low, high};
  blow_up->end = RIC_INTERVAL_BLOW_UP;
  snprintf(blow_up->reason, sizeof blow_up->reason,
           "an impulse does not move coordinate %zu at its contact: the energy grows without bound", s->modes->hit);
  return find_zero(s, balance_function, &c, low, high, &blow_up->period);
}

static ric_status search_cells(search *s) {
  mark pole = resonance(s->modes, s->low, false), blow_up = {0};
  s->from = (mark){.period = s->low, .end = RIC_INTERVAL_BOUND};
  while (pole.period < s->high && !s->stopped) {
    mark next = resonance(s->modes, pole.period, true);
    RIC_TRY(find_blow_up(s, pole.period, next.period, &blow_up));
    RIC_TRY(search_part(s, &blow_up, 1));
    if (blow_up.period < s->high)
      RIC_TRY(search_part(s, &next, -1));
    pole = next;
  }
  return RIC_OK;
}

static ric_status check_range(const ric_impact_modes *m, double low, double high, size_t samples, ric_error *error) {
  if (!(low > 0 && high - low > merge_tol * high && high < INFINITY))
    return ric_fail(error, RIC_EINVAL, "range [%.17g, %.17g], expected 0 < low < high < infinity", low, high);
  if (samples > MOST_SAMPLES)
    return ric_fail(error, RIC_ELIMIT, "samples = %zu, expected at most %d", samples, MOST_SAMPLES);
  double harmonics = m->fastest * high / (2 * pi);
  if (!(harmonics <= RIC_MOST_HARMONICS))
    return ric_fail(error, RIC_ELIMIT, "%.3g oscillations per period, expected at most %.3g", harmonics,
                    (double)RIC_MOST_HARMONICS);
  return RIC_OK;
}

ric_status ric_impact_modes_intervals(ric_impact_modes *modes, double low, double high, size_t samples,
                                      int (*visit)(const ric_impact_interval *interval, void *user), void *user,
                                      ric_error *error) {
  REQUIRE(error, {"modes", modes}, {"seen", called(visit != NULL)});
  RIC_TRY(check_range(modes, low, high, samples, error));
  search s = {.modes = modes,
              .low = low,
              .high = high,
              .samples = samples > 0 ? samples : DEFAULT_SAMPLES,
              .visit = visit,
              .user = user,
              .error = error};
  keep_gsl_quiet();
  s.list = malloc((2 * s.samples + 4) * sizeof *s.list);
  s.brent = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  ric_status status = ric_orbit_init(&s.orbit, modes->n, 1, error);
  if (status == RIC_OK)
    status = s.list && s.brent ? search_cells(&s) : ric_fail(error, RIC_ENOMEM, "no memory for %zu samples", s.samples);
  ric_orbit_clear(&s.orbit);
  free(s.list);
  if (s.brent)
    gsl_root_fsolver_free(s.brent);
  return status;
}
