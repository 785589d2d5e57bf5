/* What the processor and the libraries underneath make of a few fixed numbers. */
#ifndef RICOCHET_APP_ARITHMETIC_H
#define RICOCHET_APP_ARITHMETIC_H

#include <stdint.h>

/** Digest of samples of elementary functions, orbits by transforms (FFTW) and of an orbit by eigenvalues and matrices
 *  (GSL): equal where results are equal in every bit, as far as a few milliseconds show. */
uint64_t arithmetic_digest(void);

#endif
