#include "grazing_family.h"

#include "support.h"

ric_family_options grazing_family_options(double low, double high, double step) {
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.newton_tol = 1e-10;
  options.curve.p_low = low;
  options.curve.p_high = high;
  options.curve.step = options.curve.step_most = step;
  return options;
}

grazing_family grazing_family_from(const ric_family_problem *problem, const ric_family_options *options,
                                   double parameter, const double *q, const double *u, const double *times,
                                   double period) {
  grazing_family g = {.from = parameter};
  ric_error error;
  if (ric_family_create(problem, options, &g.family, &error) != RIC_OK)
    fail_msg("%s", error.message);
  g.z = calloc(ric_shooting_unknowns(ric_family_shooting(g.family)), sizeof *g.z);
  assert_non_null(g.z);
  if (ric_family_start(g.family, parameter, q, u, times, period, g.z, NULL, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_int_equal(ric_grazing_init(&g.grazing, ric_family_shooting(g.family), NULL), RIC_OK);
  return g;
}

void grazing_family_clear(grazing_family *g) {
  ric_grazing_clear(&g->grazing);
  ric_family_destroy(&g->family);
  free(g->z);
}

void grazing_family_find(grazing_family *g) {
  ric_error error;
  if (ric_grazing_find(g->family, g->z, g->from, NULL, &g->grazing, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

ric_grazing_map grazing_family_map(grazing_family *g, const ric_grazing_plane *plane) {
  ric_grazing_map map;
  ric_error error;
  const size_t size = ric_grazing_coordinates(&g->grazing, ric_family_shooting(g->family));
  assert_int_equal(ric_grazing_map_init(&map, size, NULL), RIC_OK);
  if (ric_grazing_section(g->family, &g->grazing, plane, &map, NULL, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return map;
}
