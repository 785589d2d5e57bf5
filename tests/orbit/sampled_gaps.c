#include "sampled_gaps.h"

#include "support.h"

static int counts(const solved_orbit *x, size_t particle, int free_only) {
  int is_free = ric_pattern_role(x->scenario.pattern, particle) == RIC_ROLE_FREE;
  return ric_chain_floor(&x->scenario.chain, particle) > -INFINITY && (is_free || !free_only);
}

static sampled_gap smallest(const solved_orbit *x, modal_motion *motion, double low, double high, size_t samples,
                            int free_only) {
  sampled_gap best = {.gap = INFINITY};
  double *q = calloc(motion->n, sizeof *q);
  assert_non_null(q);
  for (size_t k = 0; k <= samples; k++) {
    double t = low + (high - low) * (double)k / (double)samples;
    modal_motion_state(motion, t, q, NULL);
    for (size_t i = 0; i < motion->n; i++) {
      double gap = q[i] - ric_chain_floor(&x->scenario.chain, i);
      if (counts(x, i, free_only) && gap < best.gap)
        best = (sampled_gap){.gap = gap, .time = t, .particle = i};
    }
  }
  free(q);
  return best;
}

sampled_gap sampled_clearance(const solved_orbit *x, modal_motion *motion, size_t samples) {
  return smallest(x, motion, 0, x->orbit.period / 2, samples, 1);
}

sampled_gap sampled_any(const solved_orbit *x, modal_motion *motion, double low, double high, size_t samples) {
  return smallest(x, motion, low, high, samples, 0);
}

sampled_gap refined_gap(const solved_orbit *x, const modal_motion *motion, sampled_gap near, double step) {
  double low = fmax(0, near.time - step), high = fmin(x->orbit.period / 2, near.time + step), v;
  for (int k = 0; k < 60; k++) { /* bisection on the sign of the velocity */
    double t = (low + high) / 2;
    modal_motion_particle(motion, near.particle, t, &v);
    if (v < 0)
      low = t;
    else
      high = t;
  }
  double q = modal_motion_particle(motion, near.particle, low, NULL);
  double gap = q - ric_chain_floor(&x->scenario.chain, near.particle);
  return gap < near.gap ? (sampled_gap){.gap = gap, .time = low, .particle = near.particle} : near;
}
