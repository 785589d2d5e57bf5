/* Constants of mathematics: internal to the library. */
#ifndef RICOCHET_CONSTANTS_H
#define RICOCHET_CONSTANTS_H

static const double pi = 3.14159265358979323846;
static const double two_pi = 6.28318530717958647692;
static const double ln_2 = 0.69314718055994530942;

#endif
