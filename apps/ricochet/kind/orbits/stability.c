#include "stability.h"

#include <math.h>

bool stability_wanted(const study_values *v) {
  return value_flag(v, KEY_ORBIT_STABLE) || value_flag(v, KEY_ORBIT_MULTIPLIERS);
}

int stability_check(const study *s, const study_values *v, message *why) {
  const double n = value_number(v, KEY_MODEL_PARTICLES, 0);
  char place[256];
  if (!value_flag(v, KEY_ORBIT_MULTIPLIERS) || n <= RIC_REDUCED_PARTICLES)
    return 0;
  study_place(s, KEY_ORBIT_MULTIPLIERS, place, sizeof place);
  return refuse(why, EXIT_USAGE,
                "%s = true with %.0f particles, expected at most %d (or orbit.stable, the verdict alone)", place, n,
                RIC_REDUCED_PARTICLES);
}

/* The reduced method needs a few n x n matrices, the other one data of every mode and of its response at the impacts;
 * measured up to n = 10^5. */
double stability_bytes(const study_values *v) {
  const double n = value_number(v, KEY_MODEL_PARTICLES, 0);
  const double m = (double)(value_count(v, KEY_ORBIT_AT_START) + value_count(v, KEY_ORBIT_AT_HALF));
  if (!stability_wanted(v))
    return 0;
  return 2 * n * sizeof(ric_complex) + 8 * n * (n <= RIC_REDUCED_PARTICLES ? 6 * n : 14 + 2 * m);
}

void stability_put_tolerances(table *t) {
  const ric_multiplier_options judge = ric_orbit_multiplier_options_default().judge;
  table_put_attribute(t, "stable", "band", judge.band);
  table_put_attribute(t, "stable", "band_at_one", judge.band_at_one);
  table_put_attribute(t, "stable", "multiplier_tol", judge.multiplier_tol);
}

ric_status stability_init(stability *s, const study_values *v, ric_poll poll, ric_error *error) {
  *s = (stability){.wanted = stability_wanted(v), .options = ric_orbit_multiplier_options_default()};
  s->options.poll = poll;
  return s->wanted ? ric_multipliers_init(&s->found, 2 * (size_t)value_number(v, KEY_MODEL_PARTICLES, 0), error)
                   : RIC_OK;
}

void stability_clear(stability *s) {
  ric_multipliers_clear(&s->found);
}

ric_status stability_find(stability *s, ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                          const ric_orbit *orbit) {
  ric_error error = {0};
  if (!s->wanted)
    return RIC_OK;
  if (!pattern) {
    ric_multipliers_fail(&s->found, orbit->reason);
    return RIC_OK;
  }
  ric_status status = ric_orbit_multipliers(solver, chain, pattern, orbit, &s->options, &s->found, &error);
  if (status == RIC_OK || status == RIC_ESTOPPED)
    return status;
  ric_multipliers_fail(&s->found, error.message);
  return RIC_OK;
}

ric_status stability_find_motion(stability *s, ric_shooting *shooting, const double *z, const ric_orbit *orbit) {
  ric_error error = {0};
  if (!s->wanted)
    return RIC_OK;
  if (!shooting || orbit->outcome == RIC_FAILED) {
    ric_multipliers_fail(&s->found, orbit->reason);
    return RIC_OK;
  }
  const ric_status status = ric_shooting_multipliers(shooting, z, orbit->period, &s->options.judge, &s->found, &error);
  if (status == RIC_OK || status == RIC_ESTOPPED)
    return status;
  ric_multipliers_fail(&s->found, error.message);
  return RIC_OK;
}

void stability_put(stability *s, orbits_row *row) {
  ric_multipliers *found = &s->found;
  if (!s->wanted)
    return;
  const bool known = found->stable != RIC_STABILITY_UNKNOWN;
  for (size_t i = found->count; i < found->dimension; i++)
    found->mu[i] = (ric_complex){NAN, NAN};
  row->stable = (int)found->stable;
  row->stable_reason = found->reason;
  row->multiplier_max = found->largest;
  row->multipliers = found->mu;
  row->multiplier_outside = known ? (long long)found->outside : -1;
  row->multiplier_real_above = known ? (long long)found->real_above : -1;
  row->multiplier_real_below = known ? (long long)found->real_below : -1;
  row->multiplier_complex = known ? (long long)found->complex_outside : -1;
}
