/* Scenarios of grazing and of what follows: x'' + 3 x' + x = a cos(w t) under a wall at 1, which it grazes at
 * a = hypot(1 - w^2, 3 w), and the map of [FN97] section 6. */
#include "rooms.h"

#include <math.h>
#include <string.h>

static const double damping = 3, frequency = 4, two_pi = 6.283185307179586;

typedef struct oscillator {
  ric_lattice lattice;
  double force;
  ric_system *system;
} oscillator;

static ric_status set_numbers(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  oscillator *o = user;
  o->force = p[0];
  o->lattice.frequency = p[1];
  *given = two_pi / p[1];
  return ric_system_set_lattice(system, &o->lattice, error);
}

/* @param o  must stay where it is */
static ric_status oscillator_create(oscillator *o, double force, ric_error *error) {
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  *o = (oscillator){.lattice = ric_lattice_default(1, RIC_ENDS_FREE), .force = force};
  o->lattice.on_site.damping = damping;
  o->lattice.force_cos = &o->force;
  o->lattice.frequency = frequency;
  wall.restitution = 0.8;
  return ric_system_create_lattice(&o->lattice, &wall, 1, &o->system, error);
}

static ric_family_problem family_of(oscillator *o) {
  return (ric_family_problem){.system = o->system,
                              .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                              .set = set_numbers,
                              .user = o,
                              .parameters = 2,
                              .second = frequency};
}

/* --- a grazing point, its section, its criterion, the curve in two parameters ------------------------------------- */

enum { COEFFICIENTS = 4 };

typedef struct grazing_work {
  oscillator o;
  ric_family *family;
  ric_grazing grazing;
  ric_grazing_map map;
  ric_bypass *bypass;
} grazing_work;

static ric_status find_grazing(grazing_work *w, ric_error *error) {
  const double rest[2] = {0, 0};
  ric_family_options options = ric_family_options_default();
  double z[2];
  options.curve.newton_tol = 1e-10;
  options.curve.p_low = 1;
  options.curve.p_high = 40;
  options.curve.step = options.curve.step_most = 4;
  RIC_TRY(oscillator_create(&w->o, 1, error));
  const ric_family_problem problem = family_of(&w->o);
  RIC_TRY(ric_family_create(&problem, &options, &w->family, error));
  RIC_TRY(ric_family_start(w->family, 1, rest, rest + 1, NULL, two_pi / frequency, z, NULL, error));
  RIC_TRY(ric_grazing_init(&w->grazing, ric_family_shooting(w->family), error));
  return ric_grazing_find(w->family, z, 1, NULL, &w->grazing, error);
}

static ric_status judge_grazing(grazing_work *w, double *value, ric_error *error) {
  const ric_grazing *g = &w->grazing;
  double c[COEFFICIENTS], image[2], x[2];
  ric_grazing_criterion criterion;
  ric_curve_options curve = ric_curve_options_default();
  ric_curve_run run;
  RIC_TRY(ric_grazing_map_init(&w->map, 2, error));
  RIC_TRY(ric_grazing_section(w->family, g, NULL, &w->map, NULL, error));
  RIC_TRY(ric_grazing_criterion_find(&w->map, NULL, &criterion, c, COEFFICIENTS, NULL, error));
  for (size_t i = 0; i < 2; i++)
    x[i] = g->x[i] - 1e-4 * g->local.eta[i];
  RIC_TRY(ric_bypass_create(w->o.system, 0, NULL, &w->bypass, error));
  RIC_TRY(ric_bypass_map(w->bypass, g->time, x, image, NULL, error));
  RIC_TRY(ric_bypass_leading(w->bypass, &g->local, g->time, x, x, NULL, error));
  *value = g->parameter + c[0] + c[3] + image[1] + x[1];
  curve.p_high = frequency + 0.3;
  curve.step = curve.step_most = 0.05;
  curve.newton_tol = 1e-11;
  RIC_TRY(ric_grazing_trace(w->family, g, &curve, COEFFICIENTS, NULL, NULL, &run, error));
  *value += (double)run.points;
  return run.end == RIC_CURVE_BOUND ? RIC_OK : ric_fail(error, RIC_ENUMERIC, "the curve of grazing points ends");
}

static ric_status grazing_of_an_oscillator(double *value, ric_error *error) {
  grazing_work w = {.family = NULL};
  ric_status status = find_grazing(&w, error);
  if (status == RIC_OK &&
      !(fabs(w.grazing.parameter / hypot(1 - frequency * frequency, damping * frequency) - 1) < 1e-9))
    status = ric_fail(error, RIC_ENUMERIC, "grazes at %.17g", w.grazing.parameter);
  if (status == RIC_OK)
    status = judge_grazing(&w, value, error);
  ric_bypass_destroy(&w.bypass);
  ric_grazing_map_clear(&w.map);
  ric_grazing_clear(&w.grazing);
  ric_family_destroy(&w.family);
  ric_system_destroy(&w.o.system);
  return status;
}

/* --- windows and basins of the map -------------------------------------------------------------------------------- */

enum { POINTS = 24, SIZE = 3 };

typedef struct map_work {
  ric_grazing_map map;
  ric_map_line maps;
  ric_map_runner *runner;
  double d[POINTS], z[POINTS][SIZE], lowest[POINTS][SIZE];
  ric_attractor attractors[POINTS];
  ric_windows windows;
  ric_basin *basin;
} map_work;

static ric_status map_at(double p, ric_grazing_map *map, double *d, void *user, ric_error *error) {
  const map_work *w = user;
  (void)error;
  memcpy(map->L, w->map.L, sizeof(double) * SIZE * SIZE);
  memcpy(map->eta, w->map.eta, sizeof(double) * SIZE);
  memcpy(map->xi, w->map.xi, sizeof(double) * SIZE);
  memcpy(map->kappa, w->map.kappa, sizeof(double) * SIZE);
  map->stretch = w->map.stretch;
  *d = p;
  return RIC_OK;
}

static ric_status run_map(double p, const double *start, ric_attractor *attractor, void *user, ric_error *error) {
  map_work *w = user;
  const ric_grazing_map *map = &w->map;
  for (size_t i = 0; i < SIZE; i++)
    attractor->z[i] = start ? start[i] : 0;
  return ric_map_runner_run(w->runner, 1, &map, &p, attractor, error);
}

static ric_status locate(const double *z, double low, double high, ric_window *window, void *user, ric_error *error) {
  map_work *w = user;
  return ric_window_locate_cycle(&w->maps, w->d[window->point], z, low, high, (ric_poll){0}, window, error);
}

static ric_status run_line(map_work *w, ric_error *error) {
  ric_attractor_options options = ric_attractor_options_default();
  options.keep = 0;
  RIC_TRY(ric_grazing_map_example(&w->map, 0.5, 0.3, error));
  RIC_TRY(ric_map_runner_create(SIZE, &options, RIC_MAP_LANES_ONE, &w->runner, error));
  RIC_TRY(ric_basin_create(SIZE, NULL, &w->basin, error));
  for (size_t i = 0; i < POINTS; i++) {
    int64_t label;
    w->d[i] = 0.004 + 0.0005 * (double)i;
    w->attractors[i] = (ric_attractor){.z = w->z[i], .lowest = w->lowest[i]};
    RIC_TRY(run_map(w->d[i], NULL, &w->attractors[i], w, error));
    RIC_TRY(ric_basin_add(w->basin, &w->attractors[i], &label, error));
    w->attractors[i].lowest = NULL;
  }
  w->maps = (ric_map_line){.size = SIZE, .at = map_at, .user = w};
  const ric_window_line line = {.points = POINTS,
                                .p = w->d,
                                .attractors = w->attractors,
                                .size = SIZE,
                                .measured = options.measure,
                                .run = run_map,
                                .locate = locate,
                                .user = w};
  return ric_windows_find(&line, &w->windows, error);
}

static ric_status add_windows(map_work *w, double *value, ric_error *error) {
  ric_grazing_window exact;
  ric_cycle_window cycle;
  if (w->windows.count == 0)
    return ric_fail(error, RIC_ENUMERIC, "no window");
  const ric_window *first = &w->windows.windows[0];
  RIC_TRY(ric_cycle_find(&w->maps, w->d[first->point], first->period, w->z[first->point], &cycle, error));
  RIC_TRY(ric_grazing_window_find(&w->map, first->period, &exact, error));
  *value = exact.high.d + cycle.largest.re + (double)ric_basin_count(w->basin);
  for (size_t i = 0; i < w->windows.count; i++)
    *value += w->windows.windows[i].located ? w->windows.windows[i].low + w->windows.windows[i].high : 0;
  return RIC_OK;
}

static ric_status windows_of_a_map(double *value, ric_error *error) {
  map_work w = {.runner = NULL};
  ric_status status = run_line(&w, error);
  if (status == RIC_OK)
    status = add_windows(&w, value, error);
  ric_windows_clear(&w.windows);
  ric_basin_destroy(&w.basin);
  ric_map_runner_destroy(&w.runner);
  ric_grazing_map_clear(&w.map);
  return status;
}

/* --- the window of a motion beyond grazing ------------------------------------------------------------------------ */

static ric_status find_window(oscillator *o, double p, double *value, ric_error *error) {
  const ric_family_problem problem = family_of(o);
  const ric_motion_section_options where = ric_motion_section_options_default(two_pi / frequency);
  ric_motion_section *section = NULL;
  ric_attractor_options options = ric_attractor_options_default();
  ric_motion_window window;
  double z[2] = {0, 0};
  ric_attractor attractor = {.z = z};
  options.keep = 0;
  ric_status status = ric_motion_section_create(o->system, &where, &section, error);
  if (status == RIC_OK)
    status = ric_motion_section_run(section, &options, &attractor, error);
  ric_motion_section_destroy(&section);
  RIC_TRY(status);
  if (attractor.kind != RIC_ATTRACTOR_PERIODIC)
    return ric_fail(error, RIC_ENUMERIC, "not a periodic motion");
  RIC_TRY(ric_motion_window_find(&problem, attractor.period, p, 0.99 * p, 1.1 * p, 0, z, z + 1, NULL, &window, error));
  *value = window.low.p + window.high.p + window.largest.re;
  return RIC_OK;
}

static ric_status window_of_a_motion(double *value, ric_error *error) {
  const double p = (1 + 4e-3) * hypot(1 - frequency * frequency, damping * frequency);
  oscillator o;
  ric_status status = oscillator_create(&o, p, error);
  if (status == RIC_OK)
    status = find_window(&o, p, value, error);
  ric_system_destroy(&o.system);
  return status;
}

const room_scenario grazing_scenarios[] = {{"grazing_of_an_oscillator", grazing_of_an_oscillator},
                                           {"windows_of_a_map", windows_of_a_map},
                                           {"window_of_a_motion", window_of_a_motion},
                                           {0}};
