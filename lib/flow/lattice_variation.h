/* Tangent vectors of a lattice along a step of its Taylor flow: internal to the flow.
 *
 * Along the motion q(x) of a step, 0 <= x <= 1, tangent vectors obey the linearised equations. Their coefficients are
 * found by the recurrence of the state, several vectors side by side,
 *
 *   (j + 1) (j + 2) c_{j+2} = h^2 / m [-(K c_j) - (j + 1) / h (C c_{j+1}) - sum_l k_l c_{j-l}],
 *
 * where K and C are the constant part and k_l the coefficients of what stiffness varies along the step: 2 a q + 3 b q^2
 * for quadratic and cubic springs, 3/2 k u^{1/2} for Hertz contacts, whose coefficients obey u r' = u' r / 2. Of the
 * springs whose stiffness varies the extensions are kept; else a coefficient is forgotten when it has been added up. */
#ifndef RICOCHET_LATTICE_VARIATION_H
#define RICOCHET_LATTICE_VARIATION_H

#include "lattice_series.h"
#include "model/system_model.h"

typedef struct lattice_variation lattice_variation;

/** @param compliant  most Hertz contacts that press at a time */
ric_status lattice_variation_create(const ric_lattice *lattice, int order, size_t compliant,
                                    lattice_variation **variation, ric_error *error);
void lattice_variation_destroy(lattice_variation **variation);

/** The numbers of the lattice are others: takes them over. @returns false when there is no room for its terms */
bool lattice_variation_renew(lattice_variation *variation);

/** Whether the stiffness may vary along a step; then the coordinates of the step are needed. */
bool lattice_variation_varies(const lattice_variation *variation, const lattice_contacts *acting);

/** Begins a step of the accepted length: no coordinates are known yet. */
void lattice_variation_begin(lattice_variation *variation, double length);

/** Takes a piece of the step, of which the part [0, x] is accepted. Pieces cover all particles. */
void lattice_variation_take(lattice_variation *variation, const ric_segment *piece, double x);

/** The pieces are there: finds the varying stiffness, that of the acting Hertz contacts included. */
void lattice_variation_stiffen(lattice_variation *variation, const lattice_contacts *acting);

/** Moves tangent vectors to the end of the accepted part.
 *  @param held  coordinates that stay where they are */
void lattice_variation_transport(lattice_variation *variation, const lattice_contacts *held, const tangents *d);

#endif
