/* Attractors of motions on sections, for tests. Each function asserts that it works. */
#ifndef RICOCHET_TESTS_SECTIONED_H
#define RICOCHET_TESTS_SECTIONED_H

#include <ricochet/ricochet.h>

enum { SECTIONED_SIZE = 11, SECTIONED_KEPT = 4000 };

/** An attractor with its arrays. */
typedef struct sectioned {
  ric_attractor attractor;
  double z[SECTIONED_SIZE], exponents[SECTIONED_SIZE]; /* z is the start, set by the caller */
  double values[SECTIONED_KEPT], states[SECTIONED_KEPT * SECTIONED_SIZE];
} sectioned;

/** Options with so many iterates, of which all measured ones are kept. */
ric_attractor_options sectioned_iterates(size_t transient, size_t measure);

ric_motion_section *section_of(const ric_system *system, const ric_motion_section_options *options);
void section_run(ric_motion_section *section, const ric_attractor_options *options, sectioned *f);

/** Both, of a section that is made for it. */
void section_run_on(const ric_system *system, const ric_motion_section_options *section,
                    const ric_attractor_options *options, sectioned *f);

/** x'' + c x' + x = force cos(w t) with obstacles. */
ric_system *sectioned_oscillator(double damping, double frequency, double force, const ric_obstacle *obstacles,
                                 size_t count);

#endif
