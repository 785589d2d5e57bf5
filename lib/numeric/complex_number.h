/* <complex.h> with CMPLX, which glibc defines for GCC only. */
#ifndef RICOCHET_COMPLEX_NUMBER_H
#define RICOCHET_COMPLEX_NUMBER_H

#include <complex.h>

#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

#endif
