#include "verdict.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "resonant.h"

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
