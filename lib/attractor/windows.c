/* Windows of a diagram: bracketed on the attractor, located on the cycle. */
#include "ricochet/windows.h"
#include "numeric/required.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Width of brackets on the attractor, relative to the parameter; of brackets that converge to zero, as at d = 0
 * itself, relative to the distance of two points of the line. */
static const double bracket_width = 1e-2, bracket_least = 1e-9;

/* If the parameter has one sign on the line, the search for edges on the cycle extends to values this many times
 * smaller and larger. */
static const double far_beyond = 10;

/* Period and impacts of a cycle, from a run. */
typedef struct signature {
  size_t period;   /* 0: no period */
  int64_t impacts; /* in a period; -1: too few iterates are measured */
} signature;

/* Consecutive points of one signature. */
typedef struct span {
  size_t first, last;
  signature of;
} span;

typedef struct search {
  const ric_window_line *line;
  signature *signatures; /* [points] */
  double *from;          /* [size] the end of the run that the next one continues */
  double *end;           /* [size] the end of the last run */
  ric_windows *found;
  size_t room; /* of found */
  ric_error *error;
} search;

/* --- on the attractor --------------------------------------------------------------------------------------------- */

/* If the measured iterates are no multiple of the period, the remainder has at most as many impacts as a period. */
static signature signature_of(const search *s, const ric_attractor *a) {
  const size_t period = a->kind == RIC_ATTRACTOR_PERIODIC ? a->period : 0, measured = s->line->measured;
  const double of_period = a->impacts * (double)period;
  if (period == 0)
    return (signature){0};
  const bool known = measured % period == 0 || (double)measured > 2 * (of_period + 1) * (double)period;
  return (signature){.period = period, .impacts = known ? llround(of_period) : -1};
}

/* Whether two attractors may belong to one window. */
static bool are_alike(signature a, signature b) {
  return a.period == b.period && (a.impacts == b.impacts || a.impacts < 0 || b.impacts < 0);
}

/* Whether the next run may start at its end. */
static bool can_continue(const ric_attractor *a) {
  return a->kind == RIC_ATTRACTOR_PERIODIC || a->kind == RIC_ATTRACTOR_APERIODIC;
}

/* Bisects between a value inside and one outside until the bracket is narrow.
 * @param earlier  the one of both from which a line that is followed reaches the edge */
static ric_status narrow_bracket(search *s, const span *w, size_t earlier, double *inside, double *outside) {
  const ric_window_line *line = s->line;
  const size_t bytes = line->size * sizeof *s->from;
  const double least = bracket_least * fabs(*inside - *outside);
  const bool starts_inside = earlier >= w->first, follows = line->follow && can_continue(&line->attractors[earlier]);
  memcpy(s->from, line->attractors[earlier].z, bytes);
  while (fabs(*inside - *outside) > fmax(least, bracket_width * fmax(fabs(*inside), fabs(*outside)))) {
    const double middle = (*inside + *outside) / 2;
    ric_attractor there = {.z = s->end};
    RIC_TRY(line->run(middle, follows ? s->from : NULL, &there, line->user, s->error));
    const bool is_inside = are_alike(signature_of(s, &there), w->of);
    *(is_inside ? inside : outside) = middle;
    if (is_inside == starts_inside && can_continue(&there))
      memcpy(s->from, s->end, bytes);
  }
  return RIC_OK;
}

/* The beginning and the end of a window on the attractor. */
static ric_status find_bracket(search *s, const span *w, ric_window *window) {
  const ric_window_line *line = s->line;
  double first[2] = {line->p[w->first], NAN}, last[2] = {line->p[w->last], NAN}; /* inside, outside */
  if (w->first > 0) {
    first[1] = line->p[w->first - 1];
    RIC_TRY(narrow_bracket(s, w, w->first - 1, &first[0], &first[1]));
  }
  if (w->last + 1 < line->points) {
    last[1] = line->p[w->last + 1];
    RIC_TRY(narrow_bracket(s, w, w->last, &last[0], &last[1]));
  }
  const bool rises = line->p[line->points - 1] >= line->p[0];
  const double *low = rises ? first : last, *high = rises ? last : first;
  window->low_outside = low[1];
  window->low_inside = low[0];
  window->high_inside = high[0];
  window->high_outside = high[1];
  return RIC_OK;
}

/* --- on the cycle ------------------------------------------------------------------------------------------------- */

/* Bounds of the search for edges: well beyond the line, where the parameter does not change its sign. */
static void find_bounds(const ric_window_line *line, double *low, double *high) {
  const double a = fmin(line->p[0], line->p[line->points - 1]), b = fmax(line->p[0], line->p[line->points - 1]);
  *low = a > 0 ? a / far_beyond : b < 0 ? a * far_beyond : a - (b - a);
  *high = b < 0 ? b / far_beyond : a > 0 ? b * far_beyond : b + (b - a);
}

static void set_not_located(ric_window *window) {
  window->located = false;
  window->impacts = -1;
  window->low = window->high = NAN;
  window->low_kind = window->high_kind = -1;
  window->largest = (ric_complex){NAN, NAN};
}

static ric_status locate(search *s, ric_window *window) {
  double low, high;
  ric_error why = {0};
  set_not_located(window);
  find_bounds(s->line, &low, &high);
  const double *z = s->line->attractors[window->point].z;
  const ric_status status = s->line->locate(z, low, high, window, s->line->user, &why);
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    return ric_fail(s->error, status, "%s", why.message);
  window->located = status == RIC_OK;
  if (status != RIC_OK) {
    set_not_located(window);
    snprintf(window->reason, sizeof window->reason, "%.*s", (int)sizeof window->reason - 1, why.message);
  }
  return RIC_OK;
}

ric_status ric_window_locate_cycle(const ric_map_line *maps, double p, const double *z, double low, double high,
                                   ric_poll poll, ric_window *window, ric_error *error) {
  REQUIRE(error, {"maps", maps}, {"z", z}, {"window", window});
  ric_cycle_window found = {0};
  double *state = malloc(maps->size * sizeof *state);
  if (!state)
    return ric_fail(error, RIC_ENOMEM, "no memory for a state of %zu numbers", maps->size);
  memcpy(state, z, maps->size * sizeof *state);
  ric_status status = ric_cycle_find(maps, p, window->period, state, &found, error);
  if (status == RIC_OK)
    status = ric_cycle_window_find(maps, p, window->period, low, high, 0, state, poll, &found, error);
  free(state);
  if (status != RIC_OK)
    return status;
  window->low = found.low.p;
  window->high = found.high.p;
  window->low_kind = (int)found.low.kind;
  window->high_kind = (int)found.high.kind;
  window->impacts = (int64_t)found.impacts;
  window->largest = found.largest;
  return RIC_OK;
}

/* The reason for which the family ended at no special point; "" if it ended at one, or at a bound of the search. */
static void set_reason(const ric_motion_window *found, ric_window *window) {
  const bool at_low = found->low.reason[0] != '\0';
  const char *reason = at_low ? found->low.reason : found->high.reason;
  if (reason[0])
    snprintf(window->reason, sizeof window->reason, "%s: %.110s", at_low ? "low" : "high", reason);
}

ric_status ric_window_locate_motion(const ric_family_problem *problem, double p, double t, const double *z, double low,
                                    double high, ric_window *window, ric_error *error) {
  REQUIRE(error, {"problem", problem}, {"z", z}, {"window", window});
  REQUIRE(error, {"system", problem->system});
  ric_motion_window found = {0};
  RIC_TRY(ric_motion_window_find(problem, window->period, p, low, high, t, z,
                                 z + ric_system_coordinates(problem->system), NULL, &found, error));
  window->low = found.low.p;
  window->high = found.high.p;
  window->low_kind = (int)found.low.kind;
  window->high_kind = (int)found.high.kind;
  window->impacts = (int64_t)found.impacts;
  window->largest = found.largest;
  set_reason(&found, window);
  return RIC_OK;
}

/* --- all windows of a line ---------------------------------------------------------------------------------------- */

/* Whether a known window contains a value, with this period or a divisor of it, and its impacts: near a flip
 * convergence is slow, and the period is not found, or is twice that of the window. */
static bool is_known(const search *s, signature of, double value) {
  for (size_t i = s->found->count; i-- > 0;) {
    const ric_window *w = &s->found->windows[i];
    const size_t times = of.period / w->period;
    if (of.period == times * w->period && (of.impacts < 0 || of.impacts == (int64_t)times * w->impacts) &&
        w->low < value && w->high > value)
      return true;
  }
  return false;
}

/* Removes windows with an unknown number of impacts that are part of a window found later. */
static void remove_known(search *s) {
  ric_windows *found = s->found;
  size_t kept = 0;
  for (size_t i = 0; i < found->count; i++) {
    const ric_window *w = &found->windows[i];
    const signature of = {.period = w->period, .impacts = w->impacts};
    if (of.impacts >= 0 || !is_known(s, of, s->line->p[w->point]))
      found->windows[kept++] = *w;
  }
  found->count = kept;
}

/* Makes room for one more. @returns NULL without memory */
static ric_window *grow(search *s) {
  ric_windows *found = s->found;
  if (found->count == s->room) {
    const size_t room = s->room ? 2 * s->room : 8;
    ric_window *more = realloc(found->windows, room * sizeof *more);
    if (!more)
      return NULL;
    found->windows = more;
    s->room = room;
  }
  return &found->windows[found->count];
}

static ric_status add_window(search *s, const span *w) {
  const size_t point = w->first + (w->last - w->first) / 2;
  if (is_known(s, w->of, s->line->p[point]))
    return RIC_OK;
  ric_window *window = grow(s);
  if (!window)
    return ric_fail(s->error, RIC_ENOMEM, "no memory for a window");
  *window = (ric_window){.first = w->first, .last = w->last, .point = point, .period = w->of.period};
  RIC_TRY(find_bracket(s, w, window));
  RIC_TRY(locate(s, window));
  s->found->count++;
  return RIC_OK;
}

static ric_status find_windows(search *s) {
  const ric_window_line *line = s->line;
  for (size_t i = 0; i < line->points; i++)
    s->signatures[i] = signature_of(s, &line->attractors[i]);
  for (size_t i = 0, next; i < line->points; i = next) {
    for (next = i + 1; next < line->points && are_alike(s->signatures[next], s->signatures[i]);)
      next++;
    if (s->signatures[i].period > 0)
      RIC_TRY(add_window(s, &(span){.first = i, .last = next - 1, .of = s->signatures[i]}));
  }
  remove_known(s);
  return RIC_OK;
}

ric_status ric_windows_find(const ric_window_line *line, ric_windows *found, ric_error *error) {
  REQUIRE(error, {"line", line}, {"found", found});
  REQUIRE(error, {"p", unless_empty(line->points, line->p)},
          {"attractors", unless_empty(line->points, line->attractors)}, {"run", called(line->run != NULL)},
          {"locate", called(line->locate != NULL)});
  search s = {.line = line, .found = found, .error = error};
  *found = (ric_windows){0};
  if (line->points == 0 || line->size == 0)
    return ric_fail(error, RIC_EINVAL, "points = %zu, size = %zu, expected at least 1", line->points, line->size);
  s.signatures = calloc(line->points, sizeof *s.signatures);
  s.from = calloc(2 * line->size, sizeof *s.from);
  ric_status status = s.signatures && s.from ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for windows");
  if (status == RIC_OK) {
    s.end = s.from + line->size;
    status = find_windows(&s);
  }
  free(s.signatures);
  free(s.from);
  if (status != RIC_OK)
    ric_windows_clear(found);
  return status;
}

void ric_windows_clear(ric_windows *windows) {
  if (!windows)
    return;
  free(windows->windows);
  *windows = (ric_windows){0};
}
