#include "map_lines.h"

#include "support.h"

void map_copy(const ric_grazing_map *from, ric_grazing_map *to) {
  memcpy(to->L, from->L, from->size * from->size * sizeof *to->L);
  memcpy(to->eta, from->eta, from->size * sizeof *to->eta);
  memcpy(to->xi, from->xi, from->size * sizeof *to->xi);
  memcpy(to->kappa, from->kappa, from->size * sizeof *to->kappa);
  to->stretch = from->stretch;
}

static ric_status along_d(double p, ric_grazing_map *map, double *d, void *user, ric_error *error) {
  (void)error;
  map_copy(user, map);
  *d = p;
  return RIC_OK;
}

ric_map_line map_line_along_d(ric_grazing_map *map) {
  return (ric_map_line){.size = map->size, .at = along_d, .user = map};
}

ric_cycle_window cycle_window_of(const ric_map_line *line, double p, size_t period, double low, double high,
                                 double *z) {
  ric_cycle_window window;
  ric_error error = {0};
  if (ric_cycle_window_find(line, p, period, low, high, 0, z, (ric_poll){NULL, NULL}, &window, &error) != RIC_OK)
    fail_msg("period %zu at %g: %s", period, p, error.message);
  assert_int_equal(window.period, period);
  assert_true(window.stable && window.low.p < p && p < window.high.p);
  return window;
}
