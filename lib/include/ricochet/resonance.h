/* Resonances of a chain: parameters at which a mode has l oscillations per period, omega_j T = 2 pi l.
 *
 * A linear normal mode of period T exists there, and families of impacting orbits whose pattern excites it end on it in
 * a grazing bifurcation ([JAP] before (13)). The resonances follow in closed form from (12), for all three kinds of
 * ends. */
#ifndef RICOCHET_RESONANCE_H
#define RICOCHET_RESONANCE_H

#include <stddef.h>

#include "chain.h"

RIC_BEGIN_DECLARATIONS

enum { RIC_MOST_HARMONICS = 1000000 /* limit of oscillations per period */ };

/** The parameter that varies. */
typedef enum ric_along { RIC_ALONG_GAMMA, RIC_ALONG_PERIOD } ric_along;

/** A resonance of a mode. */
typedef struct ric_resonance {
  double parameter;  /* gamma or period */
  size_t mode;       /* j */
  unsigned harmonic; /* l >= 1 */
} ric_resonance;

/** Lists the resonances with low <= parameter <= high, ordered by parameter, then by mode.
 *
 *  Along gamma the period is fixed and `chain->gamma` is not used; the mode p = 0, whose frequency is 1 for every
 *  gamma, resonates for every gamma or for none and is omitted. Along the period gamma is fixed and `period` is not
 *  used.
 *  @param list  [capacity], may be NULL when capacity is 0
 *  @param count  set to the number of resonances in the range, also if it exceeds the capacity; the list then holds an
 *                arbitrary `capacity` of them: call again with enough room
 *  @returns RIC_EINVAL for a range that is not 0 <= low <= high < infinity or a period that is not positive; RIC_ELIMIT
 *           for a range that extends beyond RIC_MOST_HARMONICS oscillations per period. */
RIC_API ric_status ric_chain_resonances(const ric_chain *chain, ric_along along, double period, double low, double high,
                                        ric_resonance *list, size_t capacity, size_t *count, ric_error *error);

/** First resonance along gamma at a period T < 2 pi: the mode of largest wave number, harmonic 1. The gamma_c of this
 *  chain; NaN if there is none (one particle on a ring, T >= 2 pi). */
RIC_API double ric_chain_first_resonance(const ric_chain *chain, double period);

RIC_END_DECLARATIONS

#endif
