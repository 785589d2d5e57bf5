/* What becomes of an orbit: its smallest gaps, modes at resonance, the outcome and its reason. */
#include "verdict.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "impulse.h"
#include "model/image_ring.h"
#include "numeric/constants.h"

/* Gap of a site over a piece as a polynomial; returns its degree. At its own contact the gap is x times the result. */
static int gap_of(const motion_piece *piece, const unit_cell *cell, size_t i, double *c) {
  size_t site = piece->segment.first + i;
  ric_role role = unit_cell_role(cell, site);
  ric_segment_gap(&piece->segment, i, ric_chain_floor(&cell->chain, site), c);
  if (!piece->at_contact || role != (piece->from_half ? RIC_ROLE_HALF : RIC_ROLE_START))
    return piece->segment.degree;
  for (int j = 0; j < piece->segment.degree; j++)
    c[j] = c[j + 1];
  return piece->segment.degree - 1;
}

static double time_at(const motion_piece *piece, double x) {
  return piece->segment.start + x * piece->segment.length;
}

typedef struct search {
  const unit_cell *cell;
  double tolerance, small;
  gaps *found;
} search;

/* Ties within half the tolerance go to the first in time, then to the first particle. */
static void find_smallest_gap(const search *s, const motion_piece *piece, size_t i) {
  size_t site = piece->segment.first + i;
  int is_free = unit_cell_role(s->cell, site) == RIC_ROLE_FREE;
  located *best = is_free ? &s->found->free : &s->found->impact;
  double c[RIC_POLY_DEGREE + 1], x, value, cutoff = best->value - s->tolerance / 2;
  if (!is_free)
    cutoff = fmin(cutoff, s->small);
  int degree = gap_of(piece, s->cell, i, c);
  if (ric_poly_minimum(c, degree, cutoff, s->tolerance / 2, &x, &value))
    *best = (located){.value = value, .time = time_at(piece, x), .site = site};
}

static void search_piece(const motion_piece *piece, void *user) {
  const search *s = user;
  double lower[LATTICE_SERIES_BLOCK];
  ric_segment_bounds(&piece->segment, lower, NULL);
  for (size_t i = 0; i < piece->segment.coordinates; i++) {
    size_t site = piece->segment.first + i;
    double gap = lower[i] - ric_chain_floor(&s->cell->chain, site); /* infinite without a floor */
    double interesting =
        unit_cell_role(s->cell, site) == RIC_ROLE_FREE ? s->found->free.value - s->tolerance / 2 : s->small;
    if (gap <= interesting && gap < INFINITY)
      find_smallest_gap(s, piece, i);
  }
}

/** Finds the smallest gaps.
 *  @param tolerance  absolute, on the smallest free gap
 *  @param small  gaps of impacting sites above it are of no interest
 *  @param mismatch  as motion_run */
static ric_status gaps_find(motion *m, const unit_cell *cell, double period, const boundary_state *state,
                            double tolerance, double small, gaps *found, double *mismatch, ric_poll poll,
                            ric_error *error) {
  search s = {.cell = cell, .tolerance = tolerance, .small = small, .found = found};
  found->free = found->impact = (located){.value = INFINITY, .time = NAN, .site = SIZE_MAX};
  return motion_run(m, &cell->chain, period, state, search_piece, &s, mismatch, poll, error);
}

typedef struct violation {
  const unit_cell *cell;
  double tolerance;
  located *first;
} violation;

static void violation_in_piece(const motion_piece *piece, void *user) {
  const violation *s = user;
  for (size_t i = 0; i < piece->segment.coordinates; i++) {
    size_t site = piece->segment.first + i;
    if (ric_chain_floor(&s->cell->chain, site) == -INFINITY)
      continue;
    double c[RIC_POLY_DEGREE + 1], r[RIC_POLY_DEGREE + 1], x;
    int degree = gap_of(piece, s->cell, i, c);
    c[0] += s->tolerance;
    if (ric_poly_lower_bound(c, degree) > 0)
      continue;
    if (piece->from_half) /* the segment runs back in time: first in time is last in x */
      ric_poly_reflect(c, degree, r);
    if (!ric_poly_first_root(piece->from_half ? r : c, degree, &x))
      continue;
    double time = time_at(piece, piece->from_half ? 1 - x : x);
    if (time < s->first->time)
      *s->first = (located){.value = 0, .time = time, .site = site};
  }
}

/** First time in [0, T/2] at which any gap falls below -tolerance; site SIZE_MAX if none does. */
static ric_status gaps_first_violation(motion *m, const unit_cell *cell, double period, const boundary_state *state,
                                       double tolerance, located *first, ric_poll poll, ric_error *error) {
  violation s = {.cell = cell, .tolerance = tolerance, .first = first};
  *first = (located){.value = NAN, .time = INFINITY, .site = SIZE_MAX};
  return motion_run(m, &cell->chain, period, state, violation_in_piece, &s, NULL, poll, error);
}

/* Modes of a chain at resonance with a period, and whether the contacts of a pattern see them. */

/* Wave index (a real number) at which the image ring has a frequency, clamped to the band. */
static double wave_index(const ric_chain *chain, double frequency) {
  double s2 = (frequency * frequency - 1) / (4 * image_ring_gamma(chain));
  return asin(sqrt(fmin(fmax(s2, 0), 1))) / pi * (double)image_ring_sites(chain);
}

static size_t add_wave(const ric_chain *chain, size_t wave, unsigned harmonic, border_mode *modes, size_t count) {
  size_t pair[2], members = response_modes(chain, wave, pair);
  for (size_t i = 0; i < members && count < BORDER_MODES; i++)
    modes[count++] = (border_mode){.mode = pair[i], .harmonic = harmonic};
  return count;
}

/** Modes with |omega_j T / (2 pi) - l| <= tolerance, found from (12) without looking at every mode; at most
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
  size_t visible, least_rank = 1;
  *free_amplitude = false;
  *hidden = 0;
  if (count == 0)
    return RIC_OK;
  RIC_TRY(contact_visible(whole, modes, count, NULL, &visible, error));
  *free_amplitude = visible < count;
  for (size_t i = 0; *free_amplitude && least_rank == 1 && i < count; i++) {
    RIC_TRY(contact_visible(whole, &modes[i], 1, NULL, &least_rank, error));
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

/** Whether the modes alone satisfy the contact conditions, so that the orbit tends to a linear mode without impulses.
 */
/* The visible combinations are orthogonal at the contacts: the floors less their projections must vanish. */
static ric_status resonant_carries(const unit_cell *whole, const border_mode *modes, size_t count, bool *carries,
                                   ric_error *error) {
  double rotation[BORDER_MODES * BORDER_MODES], all = 0, reached = 0;
  size_t visible;
  RIC_TRY(contact_visible(whole, modes, count, rotation, &visible, error));
  for (size_t k = 0; k < whole->impacts; k++) {
    double b = ric_chain_floor(&whole->chain, whole->contacts[k].site);
    all += b * b;
  }
  for (size_t v = 0; v < visible; v++) {
    double along = 0, square = 0;
    for (size_t k = 0; k < whole->impacts; k++) {
      double u = combined(whole, modes, count, rotation, v, &whole->contacts[k]);
      along += u * ric_chain_floor(&whole->chain, whole->contacts[k].site);
      square += u * u;
    }
    reached += along * along / square;
  }
  *carries = all - reached <= 1e-12 * all; /* squares: a millionth of the floors, far above rounding */
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

/* What the judgement looks at. */
typedef struct facts {
  const unit_cell *cell;
  const ric_pattern *pattern;
  const ric_orbit_options *options;
  double scale; /* largest displacement */
  double zero;  /* gaps and impulses below it count as zero */
  gaps gaps;
} facts;

/* Velocities over the largest frequency stand for what is reached between the impacts. */
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

/* The impact with the smallest impulse. */
static size_t weakest_impact(const ric_orbit *orbit) {
  size_t weakest = 0;
  for (size_t r = 1; r < orbit->impacts; r++)
    if (orbit->impulse[r] < orbit->impulse[weakest])
      weakest = r;
  return weakest;
}

/* What the resonant modes do: they carry the orbit without impulses, or an amplitude is free, or neither. */
static ric_status judge_modes(const unit_cell *whole, const border_mode *modes, size_t count, ric_orbit *orbit,
                              size_t *which, bool *decided, ric_error *error) {
  RIC_TRY(resonant_carries(whole, modes, count, decided, error));
  if (*decided) {
    *which = resonant_dominant(&whole->chain, modes, count, orbit->q);
    orbit->outcome = RIC_GRAZING;
    snprintf(orbit->reason, sizeof orbit->reason,
             "mode %zu is at resonance (harmonic %u): the impulses vanish, the orbit is a linear mode",
             modes[*which].mode, modes[*which].harmonic);
    return RIC_OK;
  }
  RIC_TRY(resonant_free(whole, modes, count, decided, which, error));
  if (*decided) {
    orbit->outcome = RIC_RESONANT;
    snprintf(orbit->reason, sizeof orbit->reason,
             "mode %zu is at resonance (harmonic %u) and vanishes at the contacts: its amplitude is free",
             modes[*which].mode, modes[*which].harmonic);
  }
  return RIC_OK;
}

/* Resonances are those of the whole chain: its cell does not know all modes. */
static ric_status judge_resonances(const facts *f, const ric_chain *chain, ric_orbit *orbit, bool *decided,
                                   ric_error *error) {
  border_mode modes[BORDER_MODES];
  size_t count = resonant_modes(chain, orbit->period, f->options->resonance_tol, modes), which = 0;
  *decided = false;
  if (count == 0)
    return RIC_OK;
  unit_cell whole = {0};
  ric_status status = unit_cell_whole(&whole, chain, f->pattern, error);
  if (status == RIC_OK)
    status = judge_modes(&whole, modes, count, orbit, &which, decided, error);
  unit_cell_clear(&whole);
  if (status == RIC_OK && *decided) {
    orbit->mode = (long long)modes[which].mode;
    orbit->harmonic = modes[which].harmonic;
  }
  return status;
}

/* Which condition fails first in [0, T/2]: an impulse at 0, a gap, an impulse at T/2. */
static ric_status explain_violation(motion *m, const facts *f, const boundary_state *state, ric_orbit *orbit,
                                    ric_error *error) {
  for (size_t r = 0; r < orbit->impacts; r++) {
    size_t particle = ric_pattern_impact(f->pattern, r);
    if (ric_pattern_role(f->pattern, particle) == RIC_ROLE_START && orbit->impulse[r] < -f->zero) {
      snprintf(orbit->reason, sizeof orbit->reason, "impulse of particle %zu at t = 0 is %.6g, must be positive",
               particle, orbit->impulse[r]);
      return RIC_OK;
    }
  }
  located first;
  RIC_TRY(gaps_first_violation(m, f->cell, orbit->period, state, f->zero, &first, f->options->poll, error));
  if (first.site == SIZE_MAX) { /* then an impulse at T/2 alone has the wrong sign */
    size_t weakest = weakest_impact(orbit);
    snprintf(orbit->reason, sizeof orbit->reason, "impulse of particle %zu at t = T/2 is %.6g, must be positive",
             ric_pattern_impact(f->pattern, weakest), orbit->impulse[weakest]);
    return RIC_OK;
  }
  const located *deepest = unit_cell_role(f->cell, first.site) == RIC_ROLE_FREE ? &f->gaps.free : &f->gaps.impact;
  int used = snprintf(orbit->reason, sizeof orbit->reason, "particle %zu %s its floor at t = %.6g",
                      unit_cell_particle(f->cell, first.site), first.time > 0 ? "passes" : "is below", first.time);
  if (deepest->value < 0 && deepest == &f->gaps.free)
    snprintf(orbit->reason + used, sizeof orbit->reason - (size_t)used, "; smallest gap %.6g, particle %zu at t = %.6g",
             deepest->value, unit_cell_particle(f->cell, deepest->site), deepest->time);
  return RIC_OK;
}

static void explain_grazing(const facts *f, ric_orbit *orbit) {
  const located *touch = f->gaps.free.value <= f->zero ? &f->gaps.free : &f->gaps.impact;
  if (touch->value <= f->zero) {
    snprintf(orbit->reason, sizeof orbit->reason, "particle %zu touches its floor at t = %.6g (gap %.2g)",
             unit_cell_particle(f->cell, touch->site), touch->time, touch->value);
    return;
  }
  size_t weakest = weakest_impact(orbit);
  snprintf(orbit->reason, sizeof orbit->reason, "impulse of particle %zu vanishes (%.2g)",
           ric_pattern_impact(f->pattern, weakest), orbit->impulse[weakest]);
}

/* A linear mode, or one orbit of many, need not be admissible: says so. */
static void mention_violation(const facts *f, ric_orbit *orbit) {
  size_t used = strlen(orbit->reason);
  const located *worst = f->gaps.free.value <= f->gaps.impact.value ? &f->gaps.free : &f->gaps.impact;
  double weakest = orbit->impulse[weakest_impact(orbit)];
  if (worst->value < -f->zero)
    snprintf(orbit->reason + used, sizeof orbit->reason - used, "; inadmissible, gap %.3g of particle %zu",
             worst->value, unit_cell_particle(f->cell, worst->site));
  else if (weakest < -f->zero)
    snprintf(orbit->reason + used, sizeof orbit->reason - used, "; inadmissible, impulse %.3g", weakest);
}

/* Says why the numbers are large where the contact matrix is nearly singular. */
static void mention_condition(ric_orbit *orbit) {
  size_t used = strlen(orbit->reason);
  if (orbit->condition > 1e3 && orbit->outcome == RIC_INADMISSIBLE)
    snprintf(orbit->reason + used, sizeof orbit->reason - used, "; near a singular contact matrix, condition %.2g",
             orbit->condition);
}

static ric_status judge_admissibility(motion *m, const facts *f, const boundary_state *state, ric_orbit *orbit,
                                      ric_error *error) {
  double smallest = fmin(f->gaps.free.value, f->gaps.impact.value);
  double weakest = orbit->impulse[weakest_impact(orbit)];
  if (smallest < -f->zero || weakest < -f->zero) {
    orbit->outcome = RIC_INADMISSIBLE;
    RIC_TRY(explain_violation(m, f, state, orbit, error));
    if (f->options->method == RIC_METHOD_IMPULSE)
      mention_condition(orbit);
  } else if (smallest <= f->zero || weakest <= f->zero) {
    orbit->outcome = RIC_GRAZING;
    explain_grazing(f, orbit);
  } else {
    orbit->outcome = RIC_ADMISSIBLE;
    orbit->reason[0] = '\0';
  }
  return RIC_OK;
}

static void copy_clearance(const facts *f, ric_orbit *orbit) {
  int any = f->gaps.free.site != SIZE_MAX;
  orbit->clearance = any ? f->gaps.free.value : NAN;
  orbit->clearance_time = any ? f->gaps.free.time : NAN;
  orbit->clearance_particle = any ? (long long)unit_cell_particle(f->cell, f->gaps.free.site) : -1;
}

ric_status verdict_find(motion *m, const unit_cell *cell, const ric_chain *chain, const ric_pattern *pattern,
                        const boundary_state *state, bool one_of_many, const ric_orbit_options *options,
                        ric_orbit *orbit, ric_error *error) {
  facts f = {.cell = cell, .pattern = pattern, .options = options};
  double mismatch;
  f.scale = largest_displacement(state, &cell->chain);
  f.zero = options->grazing_tol * f.scale;
  RIC_TRY(gaps_find(m, cell, orbit->period, state, options->clearance_tol * f.scale, f.zero, &f.gaps, &mismatch,
                    options->poll, error));
  orbit->residual = isnan(mismatch) ? NAN : fmax(mismatch, largest_contact_error(cell, state));
  copy_clearance(&f, orbit);
  if (!(orbit->residual <= options->residual_tol * f.scale)) {
    orbit->outcome = RIC_FAILED;
    snprintf(orbit->reason, sizeof orbit->reason, "equations violated by %.3g, allowed %.3g", orbit->residual,
             options->residual_tol * f.scale);
    return RIC_OK;
  }
  bool decided;
  RIC_TRY(judge_resonances(&f, chain, orbit, &decided, error));
  if (!decided && one_of_many) {
    decided = true;
    orbit->outcome = RIC_RESONANT;
    snprintf(orbit->reason, sizeof orbit->reason,
             "equations are singular (condition %.3g) but solvable: the orbit is one of many", orbit->condition);
  }
  if (!decided)
    return judge_admissibility(m, &f, state, orbit, error);
  mention_violation(&f, orbit);
  return RIC_OK;
}

void verdict_without_state(ric_orbit *orbit, ric_outcome outcome) {
  orbit->outcome = outcome;
  for (size_t i = 0; i < 2 * (orbit->particles + orbit->speeds) + 3 * orbit->impacts; i++)
    orbit->q[i] = NAN; /* the one block behind all arrays of numbers */
  orbit->energy = orbit->residual = orbit->clearance = orbit->clearance_time = NAN;
  orbit->clearance_particle = -1;
}

void ric_orbit_fail(ric_orbit *orbit, const char *reason) {
  verdict_without_state(orbit, RIC_FAILED);
  orbit->condition = NAN;
  orbit->mode = -1;
  orbit->harmonic = 0;
  snprintf(orbit->reason, sizeof orbit->reason, "%s", reason);
}
