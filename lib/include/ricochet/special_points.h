/* Special points along a sweep: where the families of a pattern on a chain end, branch or lose stability.
 *
 * Along the coupling gamma or the period T there are three kinds of special parameters, each with its own search:
 *
 *   resonance  a mode has an integer number of oscillations per period (resonance.h): the contact equations blow up
 *              there
 *   singular   the contact matrix is singular (ric_orbit_singular_points): the impulses are not unique, or infinite
 *   critical   multipliers leave the unit circle or return to it (ric_orbit_critical_points), by the kind of
 *              ric_critical
 *
 * Here they are one list, ordered by parameter, each with the outcome of the orbit exactly there: most resonances have
 * no effect on a pattern that does not excite the mode, and the equations at a zero of the determinant may be solvable.
 */
#ifndef RICOCHET_SPECIAL_POINTS_H
#define RICOCHET_SPECIAL_POINTS_H

#include "orbit.h"
#include "orbit_multipliers.h"
#include "resonance.h"

RIC_BEGIN_DECLARATIONS

/** The critical ones in the order of ric_critical_kind. */
#define RIC_SPECIAL_LIST(X)                                                                                            \
  X(RIC_SPECIAL_RESONANCE, "resonance")                                                                                \
  X(RIC_SPECIAL_SINGULAR, "singular")                                                                                  \
  X(RIC_SPECIAL_PLUS_ONE, "plus_one")                                                                                  \
  X(RIC_SPECIAL_MINUS_ONE, "minus_one")                                                                                \
  X(RIC_SPECIAL_COLLISION, "collision")

typedef enum ric_special_kind {
#define X(name, text) name,
  RIC_SPECIAL_LIST(X)
#undef X
      RIC_SPECIAL_KINDS
} ric_special_kind;

/** Name of a kind, "singular". Never NULL. */
RIC_API const char *ric_special_name(ric_special_kind kind);

typedef struct ric_special_point {
  ric_special_kind kind;
  double parameter;       /* gamma or T */
  ric_outcome outcome;    /* of the orbit exactly there */
  size_t mode;            /* of a resonance; SIZE_MAX */
  unsigned harmonic;      /* oscillations of the mode in a period; 0 */
  ric_complex multiplier; /* of a critical point, on the circle, im >= 0; NaN */
  int change; /* of a critical point: +1 if the number of multipliers outside increases with the parameter, -1 if it
                 decreases; 0 */
  double uncertainty; /* of a critical parameter; NaN */
} ric_special_point;

/** Range of the search for special points. Borrowed. */
typedef struct ric_special_range {
  const ric_chain *chain;
  const ric_pattern *pattern;
  ric_along along;  /* gamma: at the period; period: at the gamma of the chain */
  double period;    /* along gamma */
  double low, high; /* 0 <= low <= high */
  size_t points;    /* of the grid of the search for critical parameters, >= 2; 0: without it */
} ric_special_range;

/** Reports the special points of a range, by parameter, then kind, then mode.
 *  @param solver  the method and poll of its options are used
 *  @param point  non-zero ends it
 *  @returns RIC_OK, also if `point` has ended it; as ric_chain_resonances, ric_orbit_singular_points,
 *           ric_orbit_critical_points and ric_orbit_solve; RIC_ENOMEM */
RIC_API ric_status ric_orbit_special_points(ric_orbit_solver *solver, const ric_special_range *range,
                                            int (*point)(const ric_special_point *point, void *user), void *user,
                                            ric_error *error);

RIC_END_DECLARATIONS

#endif
