/* Orbits with one impact per period of linear systems in closed form: the vibro-impact nonlinear normal modes of
 * [VID] at eps = 0.
 *
 *   M q'' + K q = 0, where coordinate k hits its rigid obstacle at b at t = 0 mod T with restitution e = 1.
 *
 * With the normal modes (normal_modes.h), an impulse p on coordinate k at every multiple of T sustains the motion
 *
 *   q(t) = p sum_j phi_j phi_j(k) cos(w_j (T/2 - t)) / (2 w_j sin(w_j T/2)),    0 <= t <= T,
 *
 * even about 0 and T/2. The contact condition q_k(0) = b gives p = b / S(T), S(T) = sum_j phi_j(k)^2 cot(w_j T/2) /
 * (2 w_j). Between two resonances w_j T = 2 pi l of modes that move k, S decreases from +infinity to -infinity. It
 * has one zero there, at which the orbit blows up. S changes sign at both, and with it the impulse, which pushes on
 * one side and pulls on the other; at a resonance the impulse vanishes. So the periods at which this happens are
 * known. On the pieces where the impulse pushes, only gaps can make an orbit inadmissible, and grazing points end the
 * admissible intervals (docs/theory.md). */
#ifndef RICOCHET_IMPACT_MODES_H
#define RICOCHET_IMPACT_MODES_H

#include "orbit.h"
#include "system.h"

RIC_BEGIN_DECLARATIONS

/** The modes of a system and the workspace of its orbits. Computing an orbit or a state allocates nothing. Do not share
 *  it between threads. */
typedef struct ric_impact_modes ric_impact_modes;

/** @param system  linear lattice or M-C-K system without damping and forcing, K symmetric and positive definite;
 *         copied. The orbits must not touch any of its other obstacles, rigid or not; none may have the position and
 *         side of `obstacle`
 *  @param obstacle  that is hit: rigid, not at 0, restitution 1
 *  @returns RIC_EINVAL naming the unsupported property of the system, a singular K included; RIC_ENUMERIC if K is
 *           indefinite; RIC_ENOMEM. */
RIC_API ric_status ric_impact_modes_create(const ric_system *system, size_t obstacle, ric_impact_modes **modes,
                                           ric_error *error);
RIC_API void ric_impact_modes_destroy(ric_impact_modes **modes);

/** Angular frequencies [n], increasing, with the accuracy stated in normal_modes.h; equal if they agree to rounding.
 *  Borrowed. */
RIC_API const double *ric_impact_modes_frequencies(const ric_impact_modes *modes);
/** Shape of a mode, phi_j [n], phi_i^T M phi_j = delta_ij; of modes with equal frequency only the first moves k.
 *  Borrowed; NULL if there is no such mode. */
RIC_API const double *ric_impact_modes_shape(const ric_impact_modes *modes, size_t mode);

/** The orbit of a period, with an outcome as for chains and the default tolerances of orbit.h:
 *
 *    admissible    all gaps and the impulse are positive
 *    inadmissible  the reason names the first violation
 *    grazing       a gap is zero; also at a resonance of modes that move k, where the orbit is the limit of the family,
 *                  the resonant modes alone
 *    resonant      resonance of a mode that does not move k; `mode` and `harmonic` say which
 *    singular      amplitudes blow up; states are NaN
 *    failed        the impulse underflows and the obstacle is not reached
 *
 *  `condition` bounds the largest displacement over |b|.
 *  @param period  > 0
 *  @param orbit  initialised for n coordinates and one impact
 *  @returns RIC_EINVAL; RIC_ELIMIT beyond RIC_MOST_HARMONICS oscillations of the fastest mode. The orbit is then
 *           unchanged. */
RIC_API ric_status ric_impact_modes_orbit(ric_impact_modes *modes, double period, ric_orbit *orbit, ric_error *error);

/** State of the orbit of a period at any time; at an impact the state after it.
 *  @param q, v  [n]; v may be NULL
 *  @returns RIC_EINVAL if there is no state, RIC_ELIMIT as above. */
RIC_API ric_status ric_impact_modes_state(ric_impact_modes *modes, double period, double t, double *q, double *v,
                                          ric_error *error);

#define RIC_INTERVAL_END_LIST(X)                                                                                       \
  X(RIC_INTERVAL_BOUND, "bound")                                                                                       \
  X(RIC_INTERVAL_GRAZING, "grazing")                                                                                   \
  X(RIC_INTERVAL_RESONANCE, "resonance")                                                                               \
  X(RIC_INTERVAL_BLOW_UP, "blow_up")

/** What ends an interval of periods: a bound of the requested range; a grazing point; a resonance of a mode that moves
 *  k, at which the impulse vanishes and changes sign; a zero of S, where the energy is unbounded. */
typedef enum ric_interval_end {
#define X(name, text) name,
  RIC_INTERVAL_END_LIST(X)
#undef X
      RIC_INTERVAL_ENDS
} ric_interval_end;

/** Name of an end, "grazing". Never NULL. */
RIC_API const char *ric_interval_end_name(ric_interval_end end);

/** An interval of periods on which the orbits of one family have the same outcome. Families end at resonances and
 *  blow-ups: intervals do not extend across them. */
typedef struct ric_impact_interval {
  double low, high;
  ric_outcome outcome;           /* RIC_ADMISSIBLE or RIC_INADMISSIBLE */
  char reason[RIC_REASON_BYTES]; /* what is violated at its midpoint; "" when admissible */
  ric_interval_end low_end, high_end;
  /* which obstacle is grazed and when, or which mode is at resonance; "" at bounds */
  char low_reason[RIC_REASON_BYTES], high_reason[RIC_REASON_BYTES];
} ric_impact_interval;

/** The intervals of [low, high], in order and without gaps. All resonances and blow-ups are found, to rounding; those
 *  within 1e-12 of each other, relatively, count as one. Grazing points are bracketed between `samples` periods in
 *  each piece on which the impulse pushes, where the verdict differs between neighbours, and at dips of the smallest
 *  gap between them; then they are located to rounding. Two grazing points closer than the samples may be missed.
 *  Periods at which a mode that does not move k is at resonance end no interval.
 *  @param samples  0: 64
 *  @param seen  borrows the interval; non-zero ends the search, with RIC_OK
 *  @returns RIC_EINVAL unless 0 < low < high < infinity; RIC_ELIMIT beyond RIC_MOST_HARMONICS oscillations in `high`
 *           or 10^6 samples; RIC_ENOMEM. */
RIC_API ric_status ric_impact_modes_intervals(ric_impact_modes *modes, double low, double high, size_t samples,
                                              int (*seen)(const ric_impact_interval *interval, void *user), void *user,
                                              ric_error *error);

RIC_END_DECLARATIONS

#endif
