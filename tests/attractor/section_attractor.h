/* Attractors of motions on Poincare sections, for tests. Each function asserts success. */
#ifndef RICOCHET_TESTS_SECTION_ATTRACTOR_H
#define RICOCHET_TESTS_SECTION_ATTRACTOR_H

#include <ricochet/ricochet.h>

enum { SECTION_ATTRACTOR_SIZE = 11, SECTION_ATTRACTOR_KEPT = 4000 };

/** An attractor with its arrays. */
typedef struct section_attractor {
  ric_attractor attractor;
  double z[SECTION_ATTRACTOR_SIZE], exponents[SECTION_ATTRACTOR_SIZE]; /* z is the start, set by the caller */
  double values[SECTION_ATTRACTOR_KEPT], states[SECTION_ATTRACTOR_KEPT * SECTION_ATTRACTOR_SIZE];
} section_attractor;

/** Options with these numbers of iterates, of which all measured ones are stored. */
ric_attractor_options section_attractor_options(size_t transient, size_t measure);

ric_motion_section *section_of(const ric_system *system, const ric_motion_section_options *options);
void section_run(ric_motion_section *section, const ric_attractor_options *options, section_attractor *f);

/** Both, with a section created for the run. */
void section_run_on(const ric_system *system, const ric_motion_section_options *section,
                    const ric_attractor_options *options, section_attractor *f);

/** x'' + c x' + x = force cos(w t) with obstacles. */
ric_system *section_oscillator(double damping, double frequency, double force, const ric_obstacle *obstacles,
                               size_t count);

#endif
