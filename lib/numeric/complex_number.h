/* <complex.h> with CMPLX, which glibc defines for GCC only, and with functions that give the same bits on every
 * processor (ricochet/elementary.h). */
#ifndef RICOCHET_COMPLEX_NUMBER_H
#define RICOCHET_COMPLEX_NUMBER_H

#include <complex.h>
#include <math.h>

#include "ricochet/elementary.h"

#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

static inline double complex_modulus(double complex z) {
  return ric_hypot(creal(z), cimag(z));
}

static inline double complex complex_exp(double complex z) {
  double sine, cosine, size = ric_exp(creal(z));
  ric_sincos(cimag(z), &sine, &cosine);
  return CMPLX(size * cosine, size * sine);
}

static inline void complex_sinh_cosh(double complex z, double complex *sinh, double complex *cosh) {
  double sine, cosine, re_sinh = ric_sinh(creal(z)), re_cosh = ric_cosh(creal(z));
  ric_sincos(cimag(z), &sine, &cosine);
  *sinh = CMPLX(re_sinh * cosine, re_cosh * sine);
  *cosh = CMPLX(re_cosh * cosine, re_sinh * sine);
}

/** The root with a real part that is not negative; on the cut the sign of a zero imaginary part decides. |z| < 4e307 */
static inline double complex complex_sqrt(double complex z) {
  const double larger = sqrt((fabs(creal(z)) + complex_modulus(z)) / 2);
  if (larger == 0)
    return CMPLX(0, cimag(z));
  const double smaller = fabs(cimag(z)) / (2 * larger);
  return creal(z) < 0 ? CMPLX(smaller, copysign(larger, cimag(z))) : CMPLX(larger, copysign(smaller, cimag(z)));
}

#endif
