/* Functions of libm that the libraries underneath call: sincos FFTW for its twiddle factors, pow CVODES for its steps,
 * hypot GSL. libm chooses variants by the processor, which round a last bit otherwise. The program's own definitions
 * come first in the search of the dynamic linker, and give the same bits everywhere. */
#define _GNU_SOURCE
#include <math.h>
#include <ricochet/elementary.h>

#pragma GCC visibility push(default)

void sincos(double x, double *sine, double *cosine) {
  ric_sincos(x, sine, cosine);
}

double pow(double x, double y) {
  return ric_pow(x, y);
}

double hypot(double x, double y) {
  return ric_hypot(x, y);
}

#pragma GCC visibility pop
