#include "arithmetic.h"

#include <math.h>
#include <ricochet/ricochet.h>

#include "base/digest.h"

enum { SAMPLES = 64 };

/* The three of libm stand for what the libraries call themselves: see libm.c. */
static uint64_t digest_functions(uint64_t digest) {
  double (*const one[])(double) = {ric_sin, ric_cos,  ric_tan, ric_asin, ric_sinh, ric_cosh,
                                   ric_exp, ric_exp2, ric_log, ric_log2, ric_cbrt};
  double (*const two[])(double, double) = {ric_atan2, ric_pow, ric_hypot, pow, hypot};
  for (int i = 1; i <= SAMPLES; i++) {
    const double x = (double)i / SAMPLES;
    for (size_t f = 0; f < sizeof one / sizeof *one; f++) {
      const double value = one[f](x);
      digest = digest_bytes(digest, &value, sizeof value);
    }
    for (size_t f = 0; f < sizeof two / sizeof *two; f++) {
      const double value = two[f](x, 0.3 + x);
      digest = digest_bytes(digest, &value, sizeof value);
    }
  }
  return digest;
}

/* The orbit of a chain whose first particle hits once per period. What fails adds nothing. */
static uint64_t digest_orbit(uint64_t digest, ric_chain chain, ric_orbit_method method) {
  const size_t hit = 0;
  ric_orbit_options options = ric_orbit_options_default();
  ric_orbit_solver *solver = NULL;
  ric_pattern *pattern = NULL;
  ric_orbit orbit = {0};
  options.method = method;
  if (ric_pattern_create(chain.particles, &hit, 1, NULL, 0, &pattern, NULL) == RIC_OK &&
      ric_orbit_solver_create(&options, &solver, NULL) == RIC_OK &&
      ric_orbit_init(&orbit, chain.particles, 1, NULL) == RIC_OK &&
      ric_orbit_solve(solver, &chain, pattern, 4.5, &orbit, NULL) == RIC_OK)
    digest = digest_bytes(digest, orbit.q, orbit.particles * sizeof *orbit.q);
  ric_orbit_clear(&orbit);
  ric_orbit_solver_destroy(&solver);
  ric_pattern_destroy(&pattern);
  return digest;
}

uint64_t arithmetic_digest(void) {
  const size_t sizes[] = {64, 90, 101}; /* different codelets; a prime */
  uint64_t digest = digest_functions(0);
  ric_chain chain = {.gamma = 0.1, .floor = -1};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
    for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
      chain.particles = sizes[i];
      chain.ends = (ric_ends)ends;
      digest = digest_orbit(digest, chain, RIC_METHOD_IMPULSE);
    }
  chain.particles = 6;
  return digest_orbit(digest, chain, RIC_METHOD_DENSE);
}
