/* Scenarios of motions on sections: x'' + 3 x' + x = a cos(4 t) under a wall at 1, just beyond grazing. */
#include <math.h>
#include <stdlib.h>

#include "bench.h"
#include "ricochet/ricochet.h"

static const double frequency = 4, two_pi = 6.283185307179586;

static ric_system *oscillator(double beyond) {
  double force = (1 + beyond) * hypot(1 - frequency * frequency, 3 * frequency);
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  ric_system *system = NULL;
  mass.on_site.damping = 3;
  mass.force_cos = &force;
  mass.frequency = frequency;
  wall.restitution = 0.8;
  ric_system_create_lattice(&mass, &wall, 1, &system, NULL);
  return system;
}

/* So many periods of the forcing, all measured. */
static work_done strobes(size_t periods, int exponents) {
  ric_system *system = oscillator(1e-3);
  ric_motion_section *section = NULL;
  ric_motion_section_options where = ric_motion_section_options_default(two_pi / frequency);
  ric_attractor_options options = ric_attractor_options_default();
  double z[2] = {0, 0}, lyapunov[2] = {0, 0};
  ric_attractor attractor = {.z = z, .exponents = lyapunov};
  options.transient = options.keep = 0;
  options.measure = periods;
  options.exponents = (size_t)exponents;
  int failed = !system || ric_motion_section_create(system, &where, &section, NULL) != RIC_OK;
  double began = bench_seconds();
  failed = failed || ric_motion_section_run(section, &options, &attractor, NULL) != RIC_OK;
  double seconds = bench_seconds() - began;
  failed = failed || attractor.kind > RIC_ATTRACTOR_APERIODIC || !(attractor.impacts > 0);
  ric_motion_section_destroy(&section);
  ric_system_destroy(&system);
  return (work_done){.tasks = 1,
                     .n = 1,
                     .failed = failed,
                     .seconds = seconds,
                     .measure = "microseconds_of_a_period",
                     .value = 1e6 * seconds / (double)(periods + 2 * options.period_limit)};
}

const benchmark section_benchmarks[] = {
    {"section_strobe", "100000 periods of a forced oscillator with a wall", 11, 100000, 0, strobes},
    {"section_strobe_exponents", "the same with both Lyapunov exponents", 5, 100000, 2, strobes},
    {0}};
