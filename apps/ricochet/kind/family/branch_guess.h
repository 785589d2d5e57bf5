/* The first guess of a branch: where the equations are solved from. */
#ifndef RICOCHET_APP_BRANCH_GUESS_H
#define RICOCHET_APP_BRANCH_GUESS_H

#include "branch_family.h"

/** First state [particles] and period. */
typedef struct branch_guess {
  double *q, *v;
  double period;
  int rise; /* sign of the energy's change with which the branch sets out; 0: towards branch.to */
} branch_guess;

/** @returns 0, or -1 when out of memory. */
int branch_guess_init(branch_guess *g, size_t particles);
void branch_guess_clear(branch_guess *g);

/** Guesses for the present values of an open family: the state of the section `start`; particles that swing at the
 *  amplitude at which one alone has the period; a normal mode at the energy, or with an impact where it touches; the
 * motion with the impacts of the study at t = 0 and T/2, continued from that of the linear part (even_start.h; where
 * there are impacts in between that one itself), at Hertz contacts with the particles that press them at rest as deep
 * as their speed takes them; else rest.
 *  @param from_state  the study gives a state
 *  @returns RIC_EINVAL or RIC_ENUMERIC where there is no such motion, with the reason; RIC_ESTOPPED, RIC_ENOMEM */
ric_status branch_guess_find(branch_guess *g, const branch_family *b, bool from_state, ric_error *error);

/** Solves for the motion of the guess's period, of a family that starts at its energy, and takes it as the guess.
 *  @param energy  set
 *  @returns as ric_shooting_solve. */
ric_status branch_guess_settle(branch_guess *g, const branch_family *b, double *energy, ric_error *error);

/** Solves the equations of an open family for the motion at its start.
 *  @param z  [unknowns], set  @param parameter  the family's own at the start, set  @param iterations  may be NULL
 *  @returns as ric_family_start */
ric_status branch_guess_solve(const branch_guess *g, const branch_family *b, double *z, double *parameter,
                              int *iterations, ric_error *error);

#endif
