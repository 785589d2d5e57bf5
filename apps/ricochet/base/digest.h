/* Digest that identifies studies and verifies checkpoints and results: FNV-1a, 64 bits (draft-eastlake-fnv). Any single
 * changed byte changes it. About 1 GB/s. */
#ifndef RICOCHET_APP_DIGEST_H
#define RICOCHET_APP_DIGEST_H

#include <stddef.h>
#include <stdint.h>

/** Digest of bytes, continued from that of the bytes before. @param seed  0 to begin */
uint64_t digest_bytes(uint64_t seed, const void *bytes, size_t size);

/** Another digest of the same kind for large data of one process, word by word: about 5 GB/s. It is never stored. */
uint64_t digest_words(const void *bytes, size_t size);

#endif
