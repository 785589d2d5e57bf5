#include "digest.h"

static const uint64_t basis = UINT64_C(0xcbf29ce484222325), prime = UINT64_C(0x100000001b3);

uint64_t digest_bytes(uint64_t seed, const void *bytes, size_t size) {
  const unsigned char *byte = bytes;
  uint64_t digest = seed ? seed : basis;
  for (size_t i = 0; i < size; i++)
    digest = (digest ^ byte[i]) * prime;
  return digest;
}
