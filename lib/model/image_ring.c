#include "image_ring.h"

size_t image_ring_sites(const ric_chain *chain) {
  switch (chain->ends) {
  case RIC_ENDS_FIXED:
    return 2 * (chain->particles + 1);
  case RIC_ENDS_FREE:
    return 2 * chain->particles;
  case RIC_ENDS_PERIODIC:
    break;
  }
  return chain->particles;
}

double image_ring_gamma(const ric_chain *chain) {
  return chain->ends == RIC_ENDS_PERIODIC && chain->particles == 2 ? chain->gamma / 2 : chain->gamma;
}

double image_ring_value(const ric_chain *chain, const double *x, ptrdiff_t i) {
  ptrdiff_t n = (ptrdiff_t)chain->particles, sites = (ptrdiff_t)image_ring_sites(chain);
  i %= sites;
  if (i < 0)
    i += sites;
  if (i < n)
    return x[i];
  if (chain->ends == RIC_ENDS_FREE)
    return x[2 * n - 1 - i];
  return i == n || i == 2 * n + 1 ? 0 : -x[2 * n - i];
}

static double at_distance(const double *kernel, size_t sites, size_t d) {
  d %= sites;
  return kernel[2 * d <= sites ? d : sites - d];
}

double image_ring_entry(const ric_chain *chain, const double *kernel, size_t k, size_t l) {
  size_t sites = image_ring_sites(chain);
  double direct = at_distance(kernel, sites, k > l ? k - l : l - k);
  switch (chain->ends) {
  case RIC_ENDS_FIXED:
    return direct - at_distance(kernel, sites, k + l + 2);
  case RIC_ENDS_FREE:
    return direct + at_distance(kernel, sites, k + l + 1);
  case RIC_ENDS_PERIODIC:
    break;
  }
  return direct;
}
