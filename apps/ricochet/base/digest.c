#include "digest.h"

#include <string.h>

static const uint64_t basis = UINT64_C(0xcbf29ce484222325), prime = UINT64_C(0x100000001b3);

uint64_t digest_bytes(uint64_t seed, const void *bytes, size_t size) {
  const unsigned char *byte = bytes;
  uint64_t digest = seed ? seed : basis;
  for (size_t i = 0; i < size; i++)
    digest = (digest ^ byte[i]) * prime;
  return digest;
}

/* Each step is a bijection of the digest and of the word: a changed word changes all that follows. The rotation brings
 * the high bits, where products collect, to where the next product uses them. */
uint64_t digest_words(const void *bytes, size_t size) {
  const unsigned char *at = bytes;
  uint64_t digest = basis, word;
  for (; size >= sizeof word; at += sizeof word, size -= sizeof word) {
    memcpy(&word, at, sizeof word);
    digest = (digest ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    digest = digest << 31 | digest >> 33;
  }
  return digest_bytes(digest, at, size);
}
