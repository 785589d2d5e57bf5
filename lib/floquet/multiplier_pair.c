#include "multiplier_pair.h"

#include <complex.h>
#include <math.h>

static ric_complex plain(double complex z) {
  return (ric_complex){creal(z), cimag(z)};
}

/* alpha^2 - 1 as a product: close to 1 it keeps its digits. */
static void real_pair(double alpha, ric_complex pair[2]) {
  double square = (alpha - 1) * (alpha + 1), root = sqrt(fabs(square));
  if (square <= 0) {
    pair[0] = (ric_complex){alpha, root};
    pair[1] = (ric_complex){alpha, -root};
    return;
  }
  double large = alpha > 0 ? alpha + root : alpha - root;
  pair[0] = (ric_complex){large, 0};
  pair[1] = (ric_complex){1 / large, 0};
}

void multiplier_pair(ric_complex alpha, ric_complex pair[2]) {
  if (alpha.im == 0) {
    real_pair(alpha.re, pair);
    return;
  }
  double complex a = CMPLX(alpha.re, fabs(alpha.im)), root = csqrt(a - 1) * csqrt(a + 1);
  double complex large = creal(conj(a) * root) >= 0 ? a + root : a - root, small = 1 / large;
  pair[0] = plain(alpha.im > 0 ? large : conj(large));
  pair[1] = plain(alpha.im > 0 ? small : conj(small));
}
