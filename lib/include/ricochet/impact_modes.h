/* Orbits with one impact per period of linear systems, in closed form: the modes of [VID] at eps = 0.
 *
 *   M q'' + K q = 0, where the coordinate k meets its rigid obstacle at b at t = 0 mod T and is thrown back, e = 1.
 *
 * With the normal modes (normal_modes.h), an impulse p on coordinate k at every multiple of T keeps up the motion
 *
 *   q(t) = p sum_j phi_j phi_j(k) cos(w_j (T/2 - t)) / (2 w_j sin(w_j T/2)),    0 <= t <= T,
 *
 * even about 0 and T/2, and q_k(0) = b says p = b / S(T), S(T) = sum_j phi_j(k)^2 cot(w_j T/2) / (2 w_j). Between two
 * resonances w_j T = 2 pi l of modes that move k, S falls from +infinity to -infinity: it has one zero there, where the
 * orbit blows up. S changes its sign at both, and with it the impulse, which pushes on one side and pulls on the other;
 * at a resonance it vanishes. So the periods at which that happens are known, and inside the pieces on which the
 * impulse pushes the orbits are admissible but for gaps, whose contacts end the admissible intervals (docs/theory.md).
 */
#ifndef RICOCHET_IMPACT_MODES_H
#define RICOCHET_IMPACT_MODES_H

#include "orbit.h"
#include "system.h"

RIC_BEGIN_DECLARATIONS

/** The modes of a system and the workspace of its orbits: a call for an orbit or a state allocates nothing. Not to be
 *  shared between threads. */
typedef struct ric_impact_modes ric_impact_modes;

/** @param system  linear lattice or M-C-K system without damping and forcing, K symmetric and positive definite;
 * copied. All its other obstacles, rigid or not, must not be touched: none may have its place and side
 *  @param obstacle  that is hit: rigid, not at 0, restitution 1
 *  @returns RIC_EINVAL naming what the system has and should not, a singular K among it; RIC_ENUMERIC where K is
 *           indefinite; RIC_ENOMEM. */
RIC_API ric_status ric_impact_modes_create(const ric_system *system, size_t obstacle, ric_impact_modes **modes,
                                           ric_error *error);
RIC_API void ric_impact_modes_destroy(ric_impact_modes **modes);

/** Angular frequencies [n], rising, as accurate as normal_modes.h says; equal where rounding cannot tell them apart.
 *  Borrowed. */
RIC_API const double *ric_impact_modes_frequencies(const ric_impact_modes *modes);
/** Shape of a mode, phi_j [n], phi_i^T M phi_j = delta_ij; of modes of one frequency only the first moves k. Borrowed;
 *  NULL where there is no such mode. */
RIC_API const double *ric_impact_modes_shape(const ric_impact_modes *modes, size_t mode);

/** The orbit of a period, judged as those of chains are, with the default tolerances of orbit.h: `admissible`;
 *  `inadmissible` with what is violated first; `grazing` where a gap is zero, and at a resonance of modes that move k,
 *  where the orbit is the limit of the family, those modes alone; `resonant` at a resonance of a mode that does not
 * move k (`mode` and `harmonic` say which one); `singular` where amplitudes blow up (states NaN); `failed` where the
 *  impulse underflows and the obstacle is not reached. `condition` bounds the largest displacement over |b|.
 *  @param period  > 0
 *  @param orbit  initialised for n coordinates and one impact
 *  @returns RIC_EINVAL; RIC_ELIMIT beyond RIC_MOST_HARMONICS oscillations of the fastest mode; the orbit is then left
 * as it was. */
RIC_API ric_status ric_impact_modes_orbit(ric_impact_modes *modes, double period, ric_orbit *orbit, ric_error *error);

/** State of the orbit of a period at any time, at an impact that after it.
 *  @param q, v  [n]; v may be NULL
 *  @returns RIC_EINVAL where there is no state, RIC_ELIMIT as above. */
RIC_API ric_status ric_impact_modes_state(ric_impact_modes *modes, double period, double t, double *q, double *v,
                                          ric_error *error);

#define RIC_INTERVAL_END_LIST(X)                                                                                       \
  X(RIC_INTERVAL_BOUND, "bound")                                                                                       \
  X(RIC_INTERVAL_GRAZING, "grazing")                                                                                   \
  X(RIC_INTERVAL_RESONANCE, "resonance")                                                                               \
  X(RIC_INTERVAL_BLOW_UP, "blow_up")

/** What ends an interval of periods: the range that was asked for; an obstacle that is touched; a resonance of a mode
 *  that moves k, at which the impulse vanishes and changes its sign; a zero of S, with energies without bound. */
typedef enum ric_interval_end {
#define X(name, text) name,
  RIC_INTERVAL_END_LIST(X)
#undef X
      RIC_INTERVAL_ENDS
} ric_interval_end;

/** Name of an end, "grazing". Never NULL. */
RIC_API const char *ric_interval_end_name(ric_interval_end end);

/** Periods at which the orbits of one family have one outcome. Families end at resonances and blow-ups: intervals do
 * not reach across them. */
typedef struct ric_impact_interval {
  double low, high;
  ric_outcome outcome;           /* RIC_ADMISSIBLE or RIC_INADMISSIBLE */
  char reason[RIC_REASON_BYTES]; /* what is violated in the middle of it; "" when admissible */
  ric_interval_end low_end, high_end;
  /* which obstacle is touched and when, which mode is at resonance; "" at bounds */
  char low_reason[RIC_REASON_BYTES], high_reason[RIC_REASON_BYTES];
} ric_impact_interval;

/** The intervals of [low, high], in order: they cover it. Resonances and blow-ups are found all and to rounding but for
 *  those within 1e-12 of each other, relatively, which are one. Grazing is located to rounding between periods at which
 *  the verdict differs, `samples` of them in each piece on which the impulse pushes, and at dips of the smallest gap
 *  between; two contacts closer than that may be missed. Periods at which a mode that does not move k is at resonance
 *  are no ends.
 *  @param samples  0: 64
 *  @param seen  borrows the interval; non-zero ends the search, with RIC_OK
 *  @returns RIC_EINVAL unless 0 < low < high < infinity; RIC_ELIMIT beyond RIC_MOST_HARMONICS oscillations in `high` or
 *           10^6 samples; RIC_ENOMEM. */
RIC_API ric_status ric_impact_modes_intervals(ric_impact_modes *modes, double low, double high, size_t samples,
                                              int (*seen)(const ric_impact_interval *interval, void *user), void *user,
                                              ric_error *error);

RIC_END_DECLARATIONS

#endif
