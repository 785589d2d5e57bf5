#include "ricochet/chain.h"

#include <math.h>

#include "image_ring.h"
#include "numeric/constants.h"

ric_chain ric_chain_default(size_t particles, double gamma) {
  return (ric_chain){.particles = particles, .ends = RIC_ENDS_PERIODIC, .gamma = gamma, .floor = -1};
}

static ric_status check_floors(const ric_chain *chain, ric_error *error) {
  for (size_t i = 0; i < (chain->floors ? chain->particles : 1); i++) {
    double b = ric_chain_floor(chain, i);
    if (!(b < INFINITY))
      return ric_fail(error, RIC_EINVAL, "floor of particle %zu = %g, expected a finite number or -infinity", i, b);
  }
  return RIC_OK;
}

ric_status ric_chain_check(const ric_chain *chain, ric_error *error) {
  if (chain->particles < 1)
    return ric_fail(error, RIC_EINVAL, "particles = 0, expected at least 1");
  if (chain->ends != RIC_ENDS_PERIODIC && chain->ends != RIC_ENDS_FIXED && chain->ends != RIC_ENDS_FREE)
    return ric_fail(error, RIC_EINVAL, "ends = %d, expected periodic, fixed or free", (int)chain->ends);
  if (!(chain->gamma >= 0 && chain->gamma < INFINITY))
    return ric_fail(error, RIC_EINVAL, "gamma = %g, expected 0 <= gamma < infinity", chain->gamma);
  return check_floors(chain, error);
}

double ric_dispersion(double gamma, double wave_number) {
  double s = sin(wave_number / 2);
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
  return cos(pi * (double)(a % (2 * b)) / (double)b);
}
static double sin_pi(unsigned long long a, unsigned long long b) {
  return sin(pi * (double)(a % (2 * b)) / (double)b);
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

void ric_chain_acceleration(const ric_chain *chain, const double *q, double *acceleration) {
  ptrdiff_t n = (ptrdiff_t)chain->particles;
  double gamma = image_ring_gamma(chain);
  for (ptrdiff_t i = 0; i < n; i++) {
    double left = i > 0 ? q[i - 1] : image_ring_value(chain, q, -1);
    double right = i < n - 1 ? q[i + 1] : image_ring_value(chain, q, n);
    acceleration[i] = -q[i] + gamma * (left - 2 * q[i] + right); /* [JAP] (1) */
  }
}

double ric_chain_energy(const ric_chain *chain, const double *q, const double *v) {
  size_t last = chain->particles - 1;
  double twice = 0, stretched = 0;
  for (size_t i = 0; i <= last; i++)
    twice += v[i] * v[i] + q[i] * q[i];
  for (size_t i = 0; i < last; i++)
    stretched += (q[i + 1] - q[i]) * (q[i + 1] - q[i]);
  if (chain->ends == RIC_ENDS_PERIODIC && last >= 2)
    stretched += (q[0] - q[last]) * (q[0] - q[last]);
  if (chain->ends == RIC_ENDS_FIXED)
    stretched += q[0] * q[0] + q[last] * q[last];
  return (twice + chain->gamma * stretched) / 2;
}
