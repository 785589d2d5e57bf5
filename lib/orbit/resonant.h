/* Modes of a chain at resonance with a period, and whether the contacts of a pattern see them. Internal. */
#ifndef RICOCHET_RESONANT_H
#define RICOCHET_RESONANT_H

#include "contact.h"

/** Modes with |omega_j T / (2 pi) - l| <= tolerance, found from (12) without looking at every mode; at most
 *  BORDER_MODES of them. @returns their number. */
size_t resonant_modes(const ric_chain *chain, double period, double tolerance, border_mode *modes);

/** Whether some combination of the modes vanishes at every contact, so that its amplitude is free; `hidden` is set to
 *  a mode among them that vanishes at every contact, 0 when only combinations do. */
ric_status resonant_free(const unit_cell *whole, const border_mode *modes, size_t count, bool *free_amplitude,
                         size_t *hidden, ric_error *error);

/** Whether the modes alone satisfy the contact conditions, so that the orbit tends to a linear mode without impulses.
 */
ric_status resonant_carries(const unit_cell *whole, const border_mode *modes, size_t count, bool *carries,
                            ric_error *error);

/** The mode with the largest amplitude in positions q [n]. */
size_t resonant_dominant(const ric_chain *chain, const border_mode *modes, size_t count, const double *q);

#endif
