/* The outcome of an orbit and its reason in words, for all methods; and the verdict on orbits of chains: their gaps
 * on the segments of their motion, and modes at resonance. */
#include "admissibility.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "impulse.h"
#include "model/image_ring.h"
#include "numeric/constants.h"
#include "ricochet/elementary.h"
#include "solver.h"

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

/* Whether its coordinate has another obstacle on the same side. */
static bool is_ambiguous(const obstacle_names *n, size_t obstacle) {
  for (size_t j = 0; n->obstacles && j < n->count; j++)
    if (j != obstacle && n->obstacles[j].coordinate == n->obstacles[obstacle].coordinate &&
        n->obstacles[j].side == n->obstacles[obstacle].side)
      return true;
  return false;
}

static bool is_wall(const obstacle_names *n, size_t obstacle) {
  return n->obstacles && n->obstacles[obstacle].side < 0;
}

/* "particle 3 passes its wall". */
static const char *phrase(const obstacle_names *n, size_t obstacle, const char *verb, char *text) {
  char who[PHRASE_BYTES];
  const char *side = is_wall(n, obstacle) ? "wall" : "floor";
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

void admissibility_write_mode(char *text, size_t bytes, size_t mode, double harmonic) {
  snprintf(text, bytes, "mode %zu is at resonance (harmonic %.0f): the impulses vanish, the orbit is a linear mode",
           mode, harmonic);
}

void admissibility_write_grazing(char *text, size_t bytes, const obstacle_names *names, const gap_found *gap) {
  char words[PHRASE_BYTES];
  snprintf(text, bytes, "%s at t = %.6g (gap %.2g)", phrase(names, gap->obstacle, "touches", words), gap->time,
           gap->value);
}

/* --- outcomes ----------------------------------------------------------------------------------------------------- */

static double time_in_period(const ric_orbit *o, double time) {
  double t = fmod(time, o->period);
  return t < 0 ? t + o->period : t;
}

/* The impact with the smallest impact speed, SIZE_MAX without impacts. */
static size_t weakest_impact(const ric_orbit *o) {
  size_t weakest = o->impacts > 0 ? 0 : SIZE_MAX;
  for (size_t k = 1; k < o->impacts; k++)
    if (o->gap_rate[k] > o->gap_rate[weakest])
      weakest = k;
  return weakest;
}

/* The first impact with a negative impulse. */
static size_t first_pulling(const orbit_facts *f, const ric_orbit *o) {
  size_t first = SIZE_MAX;
  for (size_t k = 0; k < o->impacts; k++)
    if (o->gap_rate[k] > f->slow && (first == SIZE_MAX || o->impact_time[k] < o->impact_time[first]))
      first = k;
  return first;
}

/* Gives the impulse along the gap, where the orbit has one: impact maps of users have none. */
static void explain_pulling(const orbit_facts *f, ric_orbit *o, size_t k) {
  char words[PHRASE_BYTES], time[32];
  snprintf(time, sizeof time, "%.6g", o->impact_time[k]);
  if (isfinite(o->impulse[k]) && f->names.noun) {
    add(o, "impulse of %s at t = %s is %.6g, must be positive", owner(&f->names, o->impact_obstacle[k], words),
        o->impact_time[k] == o->period / 2 ? "T/2" : time, o->impulse[k]);
    return;
  }
  add(o, "%s at t = %.6g: gap rate %.3g before the impact, must be negative",
      phrase(&f->names, o->impact_obstacle[k], "is pulled by", words), o->impact_time[k], o->gap_rate[k]);
}

static void explain_penetration(const orbit_facts *f, ric_orbit *o) {
  const gap_found *least = gap_watch_least(f->gaps), *first = &f->gaps->first;
  char words[PHRASE_BYTES];
  if (first->obstacle == NO_OBSTACLE)
    first = least; /* below -zero by rounding alone */
  double time = time_in_period(o, first->time);
  const char *beyond = !f->names.noun ? "is beyond" : is_wall(&f->names, first->obstacle) ? "is above" : "is below";
  add(o, "%s at t = %.6g", phrase(&f->names, first->obstacle, time > 0 ? "passes" : beyond, words), time);
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
    explain_penetration(f, o);
}

void admissibility_clearance(const orbit_facts *f, ric_orbit *o) {
  const gap_found *g = &f->gaps->free;
  bool any = g->obstacle != NO_OBSTACLE;
  o->clearance = any ? g->value : NAN;
  o->clearance_time = any ? time_in_period(o, g->time) : NAN;
  o->clearance_particle =
      any ? (long long)(f->names.obstacles ? f->names.obstacles[g->obstacle].coordinate : g->obstacle) : -1;
}

static bool is_violated(const orbit_facts *f, const ric_orbit *o) {
  return f->out_of_order || first_pulling(f, o) != SIZE_MAX || gap_watch_least(f->gaps)->value < -f->gaps->zero;
}

void admissibility_find(const orbit_facts *f, ric_orbit *o) {
  size_t weakest = weakest_impact(o);
  gap_found least = *gap_watch_least(f->gaps);
  char words[PHRASE_BYTES];
  o->outcome = RIC_ADMISSIBLE;
  o->reason[0] = '\0';
  if (is_violated(f, o)) {
    o->outcome = RIC_INADMISSIBLE;
    explain_violation(f, o);
  } else if (weakest != SIZE_MAX && o->gap_rate[weakest] >= -f->slow) {
    o->outcome = RIC_GRAZING;
    add(o, "%s at t = %.6g with the gap rate %.2g", phrase(&f->names, o->impact_obstacle[weakest], "hits", words),
        o->impact_time[weakest], o->gap_rate[weakest]);
  } else if (least.value <= f->gaps->zero) {
    o->outcome = RIC_GRAZING;
    least.time = time_in_period(o, least.time);
    admissibility_write_grazing(o->reason, sizeof o->reason, &f->names, &least);
  }
}

void admissibility_add_violation(const orbit_facts *f, ric_orbit *o) {
  if (!is_violated(f, o))
    return;
  add(o, "; inadmissible, ");
  explain_violation(f, o);
}

void admissibility_violated(ric_orbit *o, double residual, double allowed) {
  o->outcome = RIC_FAILED;
  snprintf(o->reason, sizeof o->reason, "equations are violated by %.3g, allowed %.3g", residual, allowed);
}

void admissibility_resonant(ric_orbit *o, bool without_impulses, size_t mode, unsigned harmonic) {
  o->outcome = without_impulses ? RIC_GRAZING : RIC_RESONANT;
  o->mode = (long long)mode;
  o->harmonic = harmonic;
  if (without_impulses)
    admissibility_write_mode(o->reason, sizeof o->reason, mode, harmonic);
  else
    snprintf(o->reason, sizeof o->reason,
             "mode %zu is at resonance (harmonic %u) and vanishes at the contacts: its amplitude is free", mode,
             harmonic);
}

void admissibility_without_state(ric_orbit *o, ric_outcome outcome) {
  o->outcome = outcome;
  for (size_t i = 0; i < 2 * (o->particles + o->speeds) + 3 * o->impacts; i++)
    o->q[i] = NAN; /* the one block behind all arrays of numbers */
  o->energy = o->residual = o->clearance = o->clearance_time = NAN;
  o->clearance_particle = -1;
}

void ric_orbit_fail(ric_orbit *o, const char *reason) {
  admissibility_without_state(o, RIC_FAILED);
  o->condition = NAN;
  o->mode = -1;
  o->harmonic = 0;
  snprintf(o->reason, sizeof o->reason, "%s", reason);
}

/* --- orbits of chains: gaps --------------------------------------------------------------------------------------- */

typedef struct gap_search {
  const unit_cell *cell;
  gap_watch *watch;
} gap_search;

/* At an impact of this site the gap is zero at x = 0. */
static void watch_site(const gap_search *s, const motion_piece *piece, size_t i, ric_role role) {
  const ric_segment *segment = &piece->segment;
  double c[RIC_POLY_DEGREE + 1];
  size_t site = segment->first + i;
  bool divided = piece->at_contact && role == (piece->from_half ? RIC_ROLE_HALF : RIC_ROLE_START);
  ric_segment_gap(segment, i, ric_chain_floor(&s->cell->chain, site), c);
  gap_watch_value(s->watch, &(gap_piece){.c = c + divided,
                                         .degree = segment->degree - divided,
                                         .start = segment->start,
                                         .length = segment->length,
                                         .to = 1,
                                         .obstacle = site,
                                         .hit = role != RIC_ROLE_FREE,
                                         .divided = divided});
}

static void watch_piece(const motion_piece *piece, void *user) {
  const gap_search *s = user;
  const ric_segment *segment = &piece->segment;
  double lower[LATTICE_SERIES_BLOCK], from = segment->start + (piece->from_half ? segment->length : 0);
  ric_segment_bounds(segment, lower, NULL);
  for (size_t i = 0; i < segment->coordinates; i++) {
    size_t site = segment->first + i;
    double bound = lower[i] - ric_chain_floor(&s->cell->chain, site); /* infinite without a floor */
    ric_role role = unit_cell_role(s->cell, site);
    if (bound < INFINITY && gap_watch_cares(s->watch, role != RIC_ROLE_FREE, bound, from))
      watch_site(s, piece, i, role);
  }
}

/* Converts a site of the cell to a particle of the chain. */
static void convert_site(const unit_cell *cell, gap_found *found) {
  if (found->obstacle != NO_OBSTACLE)
    found->obstacle = unit_cell_particle(cell, found->obstacle);
}

/* @param zero  gaps below it count as zero; gaps above it of sites that are hit are skipped */
static ric_status find_gaps(motion *m, const unit_cell *cell, const boundary_state *state, double tolerance,
                            double zero, double period, gap_watch *watch, double *mismatch, ric_poll poll,
                            ric_error *error) {
  gap_search s = {.cell = cell, .watch = watch};
  gap_watch_begin(watch, tolerance, zero, zero);
  RIC_TRY(motion_run(m, &cell->chain, period, state, watch_piece, &s, mismatch, poll, error));
  convert_site(cell, &watch->free);
  convert_site(cell, &watch->own);
  convert_site(cell, &watch->first);
  return RIC_OK;
}

/* --- modes of a chain at resonance with the period, and their amplitudes at the contacts of a pattern ------------- */

/* Wave index (a real number) at which the image ring has a frequency, clamped to the band. */
static double wave_index(const ric_chain *chain, double frequency) {
  double s2 = (frequency * frequency - 1) / (4 * image_ring_gamma(chain));
  return ric_asin(sqrt(fmin(fmax(s2, 0), 1))) / pi * (double)image_ring_sites(chain);
}

static size_t add_wave(const ric_chain *chain, size_t wave, unsigned harmonic, border_mode *modes, size_t count) {
  size_t pair[2], members = response_modes(chain, wave, pair);
  for (size_t i = 0; i < members && count < BORDER_MODES; i++)
    modes[count++] = (border_mode){.mode = pair[i], .harmonic = harmonic};
  return count;
}

/** Modes with |omega_j T / (2 pi) - l| <= tolerance, found from (12) without a loop over all modes; at most
 *  BORDER_MODES of them. @returns their number. */
static size_t resonant_modes(const ric_chain *chain, double period, double tolerance, border_mode *modes) {
  double turns = period / (2 * pi), fastest = ric_chain_frequency_max(chain) * turns;
  double first_wave = chain->ends == RIC_ENDS_FIXED ? 1 : 0;
  double last_wave =
      chain->ends == RIC_ENDS_PERIODIC ? (double)(chain->particles / 2) : (double)(chain->particles - 1) + first_wave;
  size_t count = 0;
  for (double l = fmax(1, ceil(turns - tolerance)); l <= fastest + tolerance; l++) {
    double low = floor(wave_index(chain, (l - tolerance) / turns)) - 1;
    double high = ceil(wave_index(chain, (l + tolerance) / turns)) + 1;
    if (image_ring_gamma(chain) == 0) {
      low = first_wave;
      high = last_wave;
    }
    for (double j = fmax(low, first_wave); j <= fmin(high, last_wave) && count < BORDER_MODES; j++) {
      double p = 2 * pi * j / (double)image_ring_sites(chain);
      if (fabs(ric_dispersion(image_ring_gamma(chain), p) * turns - l) <= tolerance)
        count = add_wave(chain, (size_t)j, (unsigned)l, modes, count);
    }
  }
  return count;
}

/** Whether some combination of the modes vanishes at every contact, so that its amplitude is free; `hidden` is set to
 *  a mode among them that vanishes at every contact, 0 when only combinations do. */
static ric_status resonant_free(const unit_cell *whole, const border_mode *modes, size_t count, bool *free_amplitude,
                                size_t *hidden, ric_error *error) {
  size_t observable, least_rank = 1;
  *free_amplitude = false;
  *hidden = 0;
  if (count == 0)
    return RIC_OK;
  RIC_TRY(contact_observable(whole, modes, count, NULL, &observable, error));
  *free_amplitude = observable < count;
  for (size_t i = 0; *free_amplitude && least_rank == 1 && i < count; i++) {
    RIC_TRY(contact_observable(whole, &modes[i], 1, NULL, &least_rank, error));
    if (least_rank == 0)
      *hidden = i;
  }
  return RIC_OK;
}

/* Combination v of the modes at a contact. */
static double combined(const unit_cell *whole, const border_mode *modes, size_t count, const double *rotation, size_t v,
                       const contact *k) {
  double u = 0;
  for (size_t a = 0; a < count; a++)
    u += rotation[a * count + v] * contact_shape(whole, &modes[a], k);
  return u;
}

/** Whether the modes alone satisfy the contact conditions, so that the orbit tends to a linear mode without
 *  impulses. Observable combinations are orthogonal at the contacts: the floors less their projections must vanish. */
static ric_status resonant_without_impulses(const unit_cell *whole, const border_mode *modes, size_t count,
                                            bool *without_impulses, ric_error *error) {
  double rotation[BORDER_MODES * BORDER_MODES], all = 0, reached = 0;
  size_t observable;
  RIC_TRY(contact_observable(whole, modes, count, rotation, &observable, error));
  for (size_t k = 0; k < whole->impacts; k++) {
    double b = ric_chain_floor(&whole->chain, whole->contacts[k].site);
    all += b * b;
  }
  for (size_t v = 0; v < observable; v++) {
    double along = 0, square = 0;
    for (size_t k = 0; k < whole->impacts; k++) {
      double u = combined(whole, modes, count, rotation, v, &whole->contacts[k]);
      along += u * ric_chain_floor(&whole->chain, whole->contacts[k].site);
      square += u * u;
    }
    reached += along * along / square;
  }
  *without_impulses = all - reached <= 1e-12 * all; /* squares: a millionth of the floors, far above rounding */
  return RIC_OK;
}

/** The mode with the largest amplitude in positions q [n]. */
static size_t resonant_dominant(const ric_chain *chain, const border_mode *modes, size_t count, const double *q) {
  size_t dominant = 0;
  double largest = -1;
  for (size_t a = 0; a < count; a++) {
    double amplitude = 0;
    for (size_t i = 0; i < chain->particles; i++)
      amplitude += q[i] * ric_chain_mode_shape(chain, modes[a].mode, i);
    if (fabs(amplitude) > largest) {
      largest = fabs(amplitude);
      dominant = a;
    }
  }
  return dominant;
}

/* --- the verdict on orbits of chains ------------------------------------------------------------------------------ */

/* The largest displacement at t = 0 and T/2, and the velocities over the largest frequency, which stand for
 * displacements between the impacts. */
static double largest_displacement(const boundary_state *state, const ric_chain *chain) {
  double largest = 0, slowest = 1 / ric_chain_frequency_max(chain);
  for (size_t i = 0; i < chain->particles; i++) {
    double q = fmax(fabs(state->q[i]), fabs(state->q_half[i]));
    double v = fmax(fabs(state->v[i]), fabs(state->v_half[i]));
    largest = fmax(largest, fmax(q, v * slowest));
  }
  return largest;
}

static double largest_contact_error(const unit_cell *cell, const boundary_state *state) {
  double largest = 0;
  for (size_t k = 0; k < cell->impacts; k++) {
    const contact *c = &cell->contacts[k];
    const double *q = c->role == RIC_ROLE_START ? state->q : state->q_half;
    largest = fmax(largest, fabs(q[c->site] - ric_chain_floor(&cell->chain, c->site)));
  }
  return largest;
}

/* Whether the resonant modes satisfy the contact conditions without impulses, or an amplitude is free; `decided`
 * where one of both is true. */
static ric_status classify_modes(const unit_cell *whole, const border_mode *modes, size_t count, ric_orbit *orbit,
                                 bool *decided, ric_error *error) {
  size_t which = 0;
  bool without_impulses;
  RIC_TRY(resonant_without_impulses(whole, modes, count, &without_impulses, error));
  if (without_impulses)
    which = resonant_dominant(&whole->chain, modes, count, orbit->q);
  else
    RIC_TRY(resonant_free(whole, modes, count, decided, &which, error));
  *decided = *decided || without_impulses;
  if (*decided)
    admissibility_resonant(orbit, without_impulses, modes[which].mode, modes[which].harmonic);
  return RIC_OK;
}

/* Resonances are those of the whole chain: its cell does not have all modes. */
static ric_status classify_resonances(const ric_chain *chain, const ric_pattern *pattern, double tolerance,
                                      ric_orbit *orbit, bool *decided, ric_error *error) {
  border_mode modes[BORDER_MODES];
  size_t count = resonant_modes(chain, orbit->period, tolerance, modes);
  *decided = false;
  if (count == 0)
    return RIC_OK;
  unit_cell whole = {0};
  ric_status status = unit_cell_whole(&whole, chain, pattern, error);
  if (status == RIC_OK)
    status = classify_modes(&whole, modes, count, orbit, decided, error);
  unit_cell_clear(&whole);
  return status;
}

/* Adds the condition, which explains large numbers, where the contact matrix is nearly singular. */
static void add_condition(ric_orbit *orbit) {
  if (orbit->condition > 1e3 && orbit->outcome == RIC_INADMISSIBLE)
    add(orbit, "; near a singular contact matrix, condition %.2g", orbit->condition);
}

ric_status chain_verdict(ric_orbit_solver *s, const ric_chain *chain, const ric_pattern *pattern,
                         const boundary_state *state, bool one_of_many, ric_orbit *orbit, ric_error *error) {
  const ric_orbit_options *o = &s->options;
  double mismatch, scale = largest_displacement(state, &s->cell.chain), zero = o->grazing_tol * scale;
  gap_watch gaps;
  const orbit_facts f = {.names = {.noun = "particle"}, .gaps = &gaps, .slow = zero / 2}; /* of impulses: zero */
  RIC_TRY(find_gaps(&s->motion, &s->cell, state, o->clearance_tol * scale / 2, zero, orbit->period, &gaps, &mismatch,
                    o->poll, error));
  orbit->residual = isnan(mismatch) ? NAN : fmax(mismatch, largest_contact_error(&s->cell, state));
  admissibility_clearance(&f, orbit);
  if (!(orbit->residual <= o->residual_tol * scale)) {
    admissibility_violated(orbit, orbit->residual, o->residual_tol * scale);
    return RIC_OK;
  }
  bool decided;
  RIC_TRY(classify_resonances(chain, pattern, o->resonance_tol, orbit, &decided, error));
  if (!decided && one_of_many) {
    decided = true;
    orbit->outcome = RIC_RESONANT;
    snprintf(orbit->reason, sizeof orbit->reason,
             "equations are singular (condition %.3g) but solvable: the orbit is one of many", orbit->condition);
  }
  if (decided) {
    admissibility_add_violation(&f, orbit);
    return RIC_OK;
  }
  admissibility_find(&f, orbit);
  if (o->method == RIC_METHOD_IMPULSE)
    add_condition(orbit);
  return RIC_OK;
}
