/* Van der Pol's oscillator x'' = (1 - x^2) x' / 2 - x before a wall with restitution 0.8, in first-order form: for
 * tests. */
#ifndef RICOCHET_TESTS_VAN_DER_POL_H
#define RICOCHET_TESTS_VAN_DER_POL_H

#include <ricochet/ricochet.h>

/** @param wall  where it stands; must outlive the system, and may change. Asserts that this works. */
ric_system *van_der_pol_system(double *wall);

#endif
