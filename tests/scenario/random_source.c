#include "random_source.h"

static uint64_t next(random_source *source) {
  uint64_t z = source->state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double random_uniform(random_source *source, double low, double high) {
  return low + (high - low) * ((double)(next(source) >> 11) * 0x1p-53);
}

size_t random_below(random_source *source, size_t count) {
  return (size_t)(next(source) % count); /* counts are small: the bias is below 1e-15 */
}
