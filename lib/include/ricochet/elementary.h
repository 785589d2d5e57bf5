/* Elementary functions with the same bits on every processor.
 *
 * libm chooses its variants by the processor: with fused multiply-add, sin, cos, exp, log, pow and others round a last
 * bit otherwise, and one last bit changes the steps of a branch. These functions are SLEEF's, whose `cinz` variants
 * never fuse: what they give depends on the argument and on SLEEF's version alone. Off by at most 1 unit in the last
 * place (hypot: 1.5). The library takes all its elementary functions from here; callbacks whose results must not depend
 * on the processor do the same. sqrt, fabs, fma, fmod, floor and ldexp are exactly rounded in any libm.
 *
 * Special values as in C's Annex F. No function sets errno. */
#ifndef RICOCHET_ELEMENTARY_H
#define RICOCHET_ELEMENTARY_H

#include "export.h"

RIC_BEGIN_DECLARATIONS
RIC_API double ric_sin(double x);
RIC_API double ric_cos(double x);
RIC_API double ric_tan(double x);
RIC_API double ric_asin(double x);
/** Angle of the point (x, y), in [-pi, pi]. */
RIC_API double ric_atan2(double y, double x);
/** sinh and cosh overflow up to 1 unit earlier than they have to, above 709. */
RIC_API double ric_sinh(double x);
RIC_API double ric_cosh(double x);
RIC_API double ric_exp(double x);
RIC_API double ric_exp2(double x);
RIC_API double ric_log(double x);
RIC_API double ric_log2(double x);
RIC_API double ric_pow(double x, double y);
RIC_API double ric_cbrt(double x);
/** sqrt(x^2 + y^2), without overflow of the squares. */
RIC_API double ric_hypot(double x, double y);

/** Both of one angle, in the time of one. A last bit may differ from ric_sin and ric_cos.
 * @param sine, cosine results */
RIC_API void ric_sincos(double x, double *sine, double *cosine);

RIC_END_DECLARATIONS

#endif
