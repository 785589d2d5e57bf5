#include "section_attractor.h"

#include "witness/recorded_run.h"
#include "support.h"

ric_motion_section *section_of(const ric_system *system, const ric_motion_section_options *options) {
  ric_motion_section *section = NULL;
  ric_error error = {0};
  if (ric_motion_section_create(system, options, &section, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return section;
}

void section_run(ric_motion_section *section, const ric_attractor_options *options, section_attractor *f) {
  ric_error error = {0};
  f->attractor = (ric_attractor){.z = f->z, .exponents = f->exponents, .values = f->values, .states = f->states};
  assert_true(options->keep <= SECTION_ATTRACTOR_KEPT && ric_motion_section_size(section) <= SECTION_ATTRACTOR_SIZE);
  if (ric_motion_section_run(section, options, &f->attractor, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

ric_attractor_options section_attractor_options(size_t transient, size_t measure) {
  ric_attractor_options o = ric_attractor_options_default();
  o.transient = transient;
  o.keep = o.measure = measure;
  return o;
}

void section_run_on(const ric_system *system, const ric_motion_section_options *section,
                    const ric_attractor_options *options, section_attractor *f) {
  ric_motion_section *s = section_of(system, section);
  section_run(s, options, f);
  ric_motion_section_destroy(&s);
}

ric_system *section_oscillator(double damping, double w, double force, const ric_obstacle *obstacles, size_t count) {
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  mass.on_site.damping = damping;
  mass.force_cos = &force;
  mass.frequency = w;
  return lattice_system(&mass, obstacles, count);
}
