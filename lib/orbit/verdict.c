/* The outcome of an orbit and its reason in words, however the orbit was found. */
#include "verdict.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *ric_outcome_name(ric_outcome outcome) {
  switch (outcome) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_OUTCOME_LIST(X)
#undef X
  case RIC_OUTCOME_COUNT:
    break;
  }
  return "unknown outcome";
}

/* --- words -------------------------------------------------------------------------------------------------------- */

obstacle_names obstacle_names_of(const ric_system *s) {
  const char *noun = s->taylor == SYSTEM_LATTICE ? "particle" : "coordinate";
  return (obstacle_names){.noun = s->obstacles ? noun : NULL, .obstacles = s->obstacles, .count = s->obstacle_count};
}

enum { PHRASE_BYTES = 96 };

/* "particle 3". */
static const char *owner(const obstacle_names *n, size_t obstacle, char *text) {
  snprintf(text, PHRASE_BYTES, "%s %zu", n->noun ? n->noun : "obstacle",
           n->obstacles ? n->obstacles[obstacle].coordinate : obstacle);
  return text;
}

/* Whether its coordinate has another one on the same side. */
static bool is_ambiguous(const obstacle_names *n, size_t obstacle) {
  for (size_t j = 0; n->obstacles && j < n->count; j++)
    if (j != obstacle && n->obstacles[j].coordinate == n->obstacles[obstacle].coordinate &&
        n->obstacles[j].side == n->obstacles[obstacle].side)
      return true;
  return false;
}

/* "particle 3 passes its wall". */
static const char *phrase(const obstacle_names *n, size_t obstacle, const char *verb, char *text) {
  char who[PHRASE_BYTES];
  const char *side = n->obstacles && n->obstacles[obstacle].side < 0 ? "wall" : "floor";
  if (!n->noun)
    snprintf(text, PHRASE_BYTES, "the motion %s obstacle %zu", verb, obstacle);
  else if (is_ambiguous(n, obstacle))
    snprintf(text, PHRASE_BYTES, "%.40s %s its %s (obstacle %zu)", owner(n, obstacle, who), verb, side, obstacle);
  else
    snprintf(text, PHRASE_BYTES, "%.40s %s its %s", owner(n, obstacle, who), verb, side);
  return text;
}

__attribute__((format(printf, 2, 3))) static void add(ric_orbit *o, const char *format, ...) {
  size_t used = strlen(o->reason);
  va_list list;
  va_start(list, format);
  vsnprintf(o->reason + used, sizeof o->reason - used, format, list);
  va_end(list);
}

void verdict_write_mode(char *text, size_t bytes, size_t mode, double harmonic) {
  snprintf(text, bytes, "mode %zu is at resonance (harmonic %.0f): the impulses vanish, the orbit is a linear mode",
           mode, harmonic);
}

void verdict_write_grazing(char *text, size_t bytes, const obstacle_names *names, const gap_found *gap) {
  char words[PHRASE_BYTES];
  snprintf(text, bytes, "%s at t = %.6g (gap %.2g)", phrase(names, gap->obstacle, "touches", words), gap->time,
           gap->value);
}

/* --- outcomes ----------------------------------------------------------------------------------------------------- */

static double time_in_period(const ric_orbit *o, double time) {
  double t = fmod(time, o->period);
  return t < 0 ? t + o->period : t;
}

/* The impact that comes in slowest, SIZE_MAX without impacts. */
static size_t weakest_impact(const ric_orbit *o) {
  size_t weakest = o->impacts > 0 ? 0 : SIZE_MAX;
  for (size_t k = 1; k < o->impacts; k++)
    if (o->gap_rate[k] > o->gap_rate[weakest])
      weakest = k;
  return weakest;
}

/* The first impact whose impulse pulls. */
static size_t first_pulling(const orbit_facts *f, const ric_orbit *o) {
  size_t first = SIZE_MAX;
  for (size_t k = 0; k < o->impacts; k++)
    if (o->gap_rate[k] > f->slow && (first == SIZE_MAX || o->impact_time[k] < o->impact_time[first]))
      first = k;
  return first;
}

static void explain_pulling(const orbit_facts *f, ric_orbit *o, size_t k) {
  char words[PHRASE_BYTES];
  add(o, "%s at t = %.6g: gap rate %.3g before the impact, must be negative",
      phrase(&f->names, o->impact_obstacle[k], "is pulled by", words), o->impact_time[k], o->gap_rate[k]);
}

static void explain_passing(const orbit_facts *f, ric_orbit *o) {
  const gap_found *least = gap_watch_least(f->gaps), *first = &f->gaps->first;
  char words[PHRASE_BYTES];
  if (first->obstacle == NO_OBSTACLE)
    first = least; /* below -zero by rounding alone */
  double time = time_in_period(o, first->time);
  add(o, "%s at t = %.6g", phrase(&f->names, first->obstacle, time > 0 ? "passes" : "is beyond", words), time);
  if (least->value < 0 && !least->divided)
    add(o, "; smallest gap %.6g, %s at t = %.6g", least->value, owner(&f->names, least->obstacle, words),
        time_in_period(o, least->time));
}

static void explain_violation(const orbit_facts *f, ric_orbit *o) {
  const gap_found *passed = &f->gaps->first;
  size_t pulling = first_pulling(f, o);
  if (f->out_of_order)
    add(o, "impacts are out of order");
  else if (pulling != SIZE_MAX &&
           !(passed->obstacle != NO_OBSTACLE && time_in_period(o, passed->time) < o->impact_time[pulling]))
    explain_pulling(f, o, pulling);
  else
    explain_passing(f, o);
}

static void explain_grazing(const orbit_facts *f, ric_orbit *o, size_t weakest, bool slow) {
  char words[PHRASE_BYTES];
  gap_found least = *gap_watch_least(f->gaps);
  least.time = time_in_period(o, least.time);
  if (slow)
    add(o, "%s at t = %.6g with the gap rate %.2g", phrase(&f->names, o->impact_obstacle[weakest], "hits", words),
        o->impact_time[weakest], o->gap_rate[weakest]);
  else
    verdict_write_grazing(o->reason, sizeof o->reason, &f->names, &least);
}

void verdict_clearance(const orbit_facts *f, ric_orbit *o) {
  const gap_found *g = &f->gaps->free;
  bool any = g->obstacle != NO_OBSTACLE;
  o->clearance = any ? g->value : NAN;
  o->clearance_time = any ? time_in_period(o, g->time) : NAN;
  o->clearance_particle =
      any ? (long long)(f->names.obstacles ? f->names.obstacles[g->obstacle].coordinate : g->obstacle) : -1;
}

void verdict_find(const orbit_facts *f, ric_orbit *o) {
  size_t weakest = weakest_impact(o);
  double least = gap_watch_least(f->gaps)->value, zero = f->gaps->zero;
  double rate = weakest == SIZE_MAX ? -INFINITY : o->gap_rate[weakest];
  o->reason[0] = '\0';
  if (f->out_of_order || rate > f->slow || least < -zero) {
    o->outcome = RIC_INADMISSIBLE;
    explain_violation(f, o);
  } else if (rate >= -f->slow || least <= zero) {
    o->outcome = RIC_GRAZING;
    explain_grazing(f, o, weakest, rate >= -f->slow);
  } else {
    o->outcome = RIC_ADMISSIBLE;
  }
}

void verdict_add_violation(const orbit_facts *f, ric_orbit *o) {
  const gap_found *least = gap_watch_least(f->gaps);
  size_t pulling = first_pulling(f, o);
  char words[PHRASE_BYTES];
  if (least->value < -f->gaps->zero)
    add(o, "; inadmissible, %s", phrase(&f->names, least->obstacle, "passes", words));
  else if (pulling != SIZE_MAX)
    add(o, "; inadmissible, %s", phrase(&f->names, o->impact_obstacle[pulling], "is pulled by", words));
}

void verdict_violated(ric_orbit *o, double residual, double allowed) {
  o->outcome = RIC_FAILED;
  snprintf(o->reason, sizeof o->reason, "equations are violated by %.3g, allowed %.3g", residual, allowed);
}

void verdict_resonant(ric_orbit *o, bool carried, size_t mode, unsigned harmonic) {
  o->outcome = carried ? RIC_GRAZING : RIC_RESONANT;
  o->mode = (long long)mode;
  o->harmonic = harmonic;
  if (carried)
    verdict_write_mode(o->reason, sizeof o->reason, mode, harmonic);
  else
    snprintf(o->reason, sizeof o->reason,
             "mode %zu is at resonance (harmonic %u) and vanishes at the contacts: its amplitude is free", mode,
             harmonic);
}

void verdict_without_state(ric_orbit *o, ric_outcome outcome) {
  o->outcome = outcome;
  for (size_t i = 0; i < 2 * (o->particles + o->speeds) + 3 * o->impacts; i++)
    o->q[i] = NAN; /* the one block behind all arrays of numbers */
  o->energy = o->residual = o->clearance = o->clearance_time = NAN;
  o->clearance_particle = -1;
}

void ric_orbit_fail(ric_orbit *o, const char *reason) {
  verdict_without_state(o, RIC_FAILED);
  o->condition = NAN;
  o->mode = -1;
  o->harmonic = 0;
  snprintf(o->reason, sizeof o->reason, "%s", reason);
}
