/* The textbook impact oscillator x'' + 0.1 x' + x = A cos(w t), x <= 1, restitution 0.8, and families of its motions
 * along A, with w as the second parameter: for tests. */
#ifndef RICOCHET_TESTS_FORCED_OSCILLATOR_H
#define RICOCHET_TESTS_FORCED_OSCILLATOR_H

#include <ricochet/ricochet.h>

typedef struct forced_oscillator {
  ric_lattice lattice;
  ric_system *system;
  double force;
} forced_oscillator;

/** Makes it; `o` must stay where it is. Asserts that this works. */
void forced_oscillator_init(forced_oscillator *o);
void forced_oscillator_clear(forced_oscillator *o);

/** The families of `impacts` impacts in so many forcing periods. */
ric_family_problem forced_oscillator_problem(forced_oscillator *o, size_t impacts, size_t periods, double frequency);

/** Amplitude at which the smooth motion touches the wall: sqrt((1 - w^2)^2 + 0.01 w^2). */
double forced_oscillator_grazing(double frequency);

#endif
