/* The spectrum of the chain: dispersion relation, normal modes, and the resonances of a period with them. */
#include <math.h>
#include <stdlib.h>

#include "image_ring.h"
#include "numeric/constants.h"
#include "numeric/required.h"
#include "ricochet/chain.h"
#include "ricochet/elementary.h"
#include "ricochet/resonance.h"

double ric_dispersion(double gamma, double wave_number) {
  double s = ric_sin(wave_number / 2);
  return sqrt(1 + 4 * gamma * s * s); /* [JAP] (12) */
}

double ric_gamma_c(double period) {
  double frequency = 2 * pi / period;
  return (frequency * frequency - 1) / 4; /* [JAP] (13) */
}

double ric_chain_wave_number(const ric_chain *chain, size_t mode) {
  size_t n = chain->particles;
  switch (chain->ends) {
  case RIC_ENDS_PERIODIC:
    return 2 * pi * (double)(2 * mode <= n ? mode : n - mode) / (double)n;
  case RIC_ENDS_FIXED:
    return pi * (double)(mode + 1) / (double)(n + 1);
  case RIC_ENDS_FREE:
    return pi * (double)mode / (double)n;
  }
  return NAN;
}

double ric_chain_frequency(const ric_chain *chain, size_t mode) {
  return ric_dispersion(image_ring_gamma(chain), ric_chain_wave_number(chain, mode));
}

double ric_chain_frequency_max(const ric_chain *chain) {
  size_t n = chain->particles;
  return ric_chain_frequency(chain, chain->ends == RIC_ENDS_PERIODIC ? n / 2 : n - 1);
}

/* cos(pi a / b) for whole a, reduced first so that large particle numbers cost no digits. */
static double cos_pi(unsigned long long a, unsigned long long b) {
  return ric_cos(pi * (double)(a % (2 * b)) / (double)b);
}

static double sin_pi(unsigned long long a, unsigned long long b) {
  return ric_sin(pi * (double)(a % (2 * b)) / (double)b);
}

double ric_chain_mode_shape(const ric_chain *chain, size_t mode, size_t particle) {
  size_t n = chain->particles, j = mode, i = particle;
  switch (chain->ends) {
  case RIC_ENDS_PERIODIC:
    if (j == 0 || 2 * j == n)
      return cos_pi(2 * j * i, n) / sqrt((double)n);
    return sqrt(2 / (double)n) * (2 * j < n ? cos_pi(2 * j * i, n) : sin_pi(2 * (n - j) * i, n));
  case RIC_ENDS_FIXED:
    return sqrt(2 / (double)(n + 1)) * sin_pi((j + 1) * (i + 1), n + 1);
  case RIC_ENDS_FREE:
    return sqrt((j == 0 ? 1 : 2) / (double)n) * cos_pi(j * (2 * i + 1), 2 * n);
  }
  return NAN;
}

/* The list under construction: counts everything, keeps what fits. */
typedef struct collection {
  double low, high;
  ric_resonance *list;
  size_t capacity, count;
} collection;

static void collect(collection *c, double parameter, size_t mode, unsigned harmonic) {
  if (!(parameter >= c->low && parameter <= c->high))
    return;
  if (c->count < c->capacity)
    c->list[c->count] = (ric_resonance){.parameter = parameter, .mode = mode, .harmonic = harmonic};
  c->count++;
}

/* d omega^2 / d gamma of a mode, (12). */
static double coupling_factor(const ric_chain *chain, size_t mode) {
  ric_chain unit = {.particles = chain->particles, .ends = chain->ends, .gamma = 1};
  double s = ric_sin(ric_chain_wave_number(chain, mode) / 2);
  return 4 * image_ring_gamma(&unit) * s * s;
}

/* (12) solved for gamma at omega = 2 pi l / T. */
static double resonant_gamma(double factor, double period, unsigned harmonic) {
  double frequency = 2 * pi * harmonic / period;
  return (frequency * frequency - 1) / factor;
}

static void collect_along_gamma(collection *c, const ric_chain *chain, double period, size_t mode) {
  double factor = coupling_factor(chain, mode);
  for (unsigned l = 1; factor > 0 && resonant_gamma(factor, period, l) <= c->high; l++)
    collect(c, resonant_gamma(factor, period, l), mode, l);
}

static void collect_along_period(collection *c, const ric_chain *chain, size_t mode) {
  double shortest = 2 * pi / ric_chain_frequency(chain, mode);
  for (unsigned l = 1; shortest * l <= c->high; l++)
    collect(c, shortest * l, mode, l);
}

static int by_parameter(const void *a, const void *b) {
  const ric_resonance *x = a, *y = b;
  if (x->parameter != y->parameter)
    return x->parameter < y->parameter ? -1 : 1;
  return x->mode < y->mode ? -1 : x->mode > y->mode;
}

ric_status ric_chain_resonances(const ric_chain *chain, ric_along along, double period, double low, double high,
                                ric_resonance *list, size_t capacity, size_t *count, ric_error *error) {
  REQUIRE(error, {"chain", chain}, {"list", unless_empty(capacity, list)}, {"count", count});
  RIC_TRY(ric_chain_check(chain, error));
  if (!(low >= 0 && low <= high && high < INFINITY))
    return ric_fail(error, RIC_EINVAL, "range [%g, %g], expected 0 <= low <= high < infinity", low, high);
  if (along == RIC_ALONG_GAMMA && !(period > 0 && period < INFINITY))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected 0 < period < infinity", period);
  ric_chain extreme = *chain;
  if (along == RIC_ALONG_GAMMA)
    extreme.gamma = high;
  double harmonics = ric_chain_frequency_max(&extreme) * (along == RIC_ALONG_GAMMA ? period : high) / (2 * pi);
  if (!(harmonics <= RIC_MOST_HARMONICS))
    return ric_fail(error, RIC_ELIMIT, "%.3g oscillations per period, expected at most %.3g", harmonics,
                    (double)RIC_MOST_HARMONICS);
  collection c = {.low = low, .high = high, .list = list, .capacity = capacity};
  for (size_t mode = 0; mode < chain->particles; mode++)
    if (along == RIC_ALONG_GAMMA)
      collect_along_gamma(&c, chain, period, mode);
    else
      collect_along_period(&c, chain, mode);
  if (list && c.count > 0)
    qsort(list, c.count < capacity ? c.count : capacity, sizeof *list, by_parameter);
  *count = c.count;
  return RIC_OK;
}

double ric_chain_first_resonance(const ric_chain *chain, double period) {
  size_t n = chain->particles, highest = chain->ends == RIC_ENDS_PERIODIC ? n / 2 : n - 1;
  double factor = coupling_factor(chain, highest);
  return factor > 0 && period < 2 * pi ? resonant_gamma(factor, period, 1) : NAN;
}

/* The system of a chain: its lattice, and its floors as obstacles. */
