/* The multipliers of an orbit by its determinant: internal to the room.
 *
 * Two counts decide: a lower bound of the pairs on the circle by signature (circle.h), and the number outside of
 * |mu| = 1 + d by winding (winding.h), with d = 0.1, 1e-3 and the band. When they add up to n, every multiplier has
 * been told: `stable` is then a certificate. When they do not, even at the band and after a search of the circle, and
 * nothing is outside, the multipliers that are left lie within the band or on the circle: `undecided`. */
#ifndef RICOCHET_DETERMINANT_H
#define RICOCHET_DETERMINANT_H

#include "ricochet/orbit_multipliers.h"
#include "secular.h"

/** Fills the multipliers, with a verdict. @param s  prepared for the orbit */
ric_status determinant_multipliers(secular *s, const ric_orbit_multiplier_options *options, ric_multipliers *m,
                                   ric_error *error);

#endif
