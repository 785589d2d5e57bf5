#include "window_edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/map_model.h"

const char *const *window_edge_names(const study *s, size_t *count) {
  static const char *const of_maps[RIC_GRAZING_EDGES + 1] = {
#define X(name, text) text,
      RIC_GRAZING_EDGE_LIST(X)
#undef X
          "none"};
  static const char *const of_motions[RIC_FAMILY_KINDS + 1] = {
#define X(name, text) text,
      RIC_FAMILY_LIST(X)
#undef X
          "none"};
  *count = study_is_map(s) ? RIC_GRAZING_EDGES + 1 : RIC_FAMILY_KINDS + 1;
  return study_is_map(s) ? of_maps : of_motions;
}

/* Index of the sweep that is followed: the last one. */
static size_t last_of(const iterated *it) {
  return study_sweeps(it->study) - 1;
}

/* --- of maps ------------------------------------------------------------------------------------------------------ */

static ric_status map_at(double p, ric_grazing_map *map, double *d, void *user, ric_error *error) {
  iterated *it = user;
  study_values_sweep(it->values, last_of(it), p);
  *d = value_number(it->values, KEY_MODEL_D, 0);
  return map_model_read(map, it->values, error);
}

/* The closed form, where it is for: one impact, along d. @param unit  of the parameter over d */
static ric_status add_closed_form(const ric_grazing_map *map, double unit, size_t period, window_edges *edges,
                                  ric_error *error) {
  ric_grazing_window window = {0};
  if (edges->impacts != 1)
    return RIC_OK;
  const ric_status status = ric_grazing_window_find(map, period, &window, error);
  if (status == RIC_OK && window.exists) {
    edges->map_low = unit * window.low.d;
    edges->map_high = unit * window.high.d;
  }
  return status == RIC_ENUMERIC ? RIC_OK : status; /* singular equations have no window */
}

static ric_status add_exact(iterated *it, double p, size_t period, window_edges *edges, ric_error *error) {
  ric_grazing_map map = {0};
  double d;
  if (study_sweep_at(it->study, last_of(it))->key != KEY_MODEL_D)
    return RIC_OK;
  ric_status status = map_at(p, &map, &d, it, error);
  if (status == RIC_OK)
    status = add_closed_form(&map, 1, period, edges, error);
  ric_grazing_map_clear(&map);
  return status;
}

static ric_status find_of_map(iterated *it, size_t period, double p, double low, double high, double *z,
                              window_edges *edges, ric_error *error) {
  const ric_map_line line = {.size = it->size, .at = map_at, .user = it};
  ric_cycle_window window = {0};
  RIC_TRY(ric_cycle_find(&line, p, period, z, &window, error));
  RIC_TRY(ric_cycle_window_find(&line, p, period, low, high, 0, z, it->poll, &window, error));
  edges->low = window.low.p;
  edges->high = window.high.p;
  edges->low_kind = (int)window.low.kind;
  edges->high_kind = (int)window.high.kind;
  edges->impacts = window.impacts;
  edges->multiplier = window.largest;
  return add_exact(it, p, period, edges, error);
}

/* --- of motions --------------------------------------------------------------------------------------------------- */

static ric_status put_parameter(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  iterated *it = user;
  study_values_sweep(it->values, last_of(it), *p);
  RIC_TRY(iterated_read_model(it, error));
  *given = iterated_period(&it->model);
  RIC_TRY(ric_system_set_lattice(system, &it->model.lattice, error));
  return ric_system_set_obstacles(system, it->model.obstacles, it->model.obstacle_count, error);
}

/* Why the curve came to an end at no special point; "" where it came to one, or to the end of the search. */
static void put_reason(window_edges *edges, const ric_motion_window *window) {
  const bool at_low = window->low.reason[0] != '\0';
  const char *reason = at_low ? window->low.reason : window->high.reason;
  if (reason[0])
    snprintf(edges->reason, sizeof edges->reason, "%s: %.110s", at_low ? "low" : "high", reason);
}

static ric_status find_of_motion(iterated *it, size_t period, double p, double low, double high, const double *z,
                                 window_edges *edges, ric_error *error) {
  const lattice_model *m = &it->model;
  ric_motion_window window = {0};
  ric_system *system = NULL;
  ric_status status = ric_system_create_lattice(&m->lattice, m->obstacles, m->obstacle_count, &system, error);
  const ric_family_problem problem = {
      .system = system,
      .motion = {.kind = RIC_MOTION_FORCED, .flow = it->section.trajectory.flow, .poll = it->poll},
      .set = put_parameter,
      .user = it,
      .parameters = 1,
      .given = it->section.period};
  if (status == RIC_OK)
    status = ric_motion_window_find(&problem, period, p, low, high, it->section.phase * it->section.period, z,
                                    z + m->lattice.particles, NULL, &window, error);
  ric_system_destroy(&system);
  if (status != RIC_OK)
    return status;
  edges->low = window.low.p;
  edges->high = window.high.p;
  edges->low_kind = (int)window.low.kind;
  edges->high_kind = (int)window.high.kind;
  edges->impacts = window.impacts;
  edges->multiplier = window.largest;
  put_reason(edges, &window);
  if (!it->beyond || study_sweep_at(it->study, last_of(it))->key != KEY_GRAZING_BEYOND)
    return RIC_OK;
  return add_closed_form(&it->beyond->map, -1 / (it->beyond->slope * it->beyond->parameter), period, edges, error);
}

ric_status window_edges_find(iterated *it, size_t period, double p, double low, double high, const double *z,
                             window_edges *edges) {
  ric_error error = {.message = "no memory"};
  double *state = calloc(it->size, sizeof *state);
  ric_status status = state ? RIC_OK : RIC_ENOMEM;
  *edges = (window_edges){.low = NAN,
                          .high = NAN,
                          .low_kind = it->maps ? (int)RIC_GRAZING_EDGES : (int)RIC_FAMILY_KINDS, /* none */
                          .high_kind = it->maps ? (int)RIC_GRAZING_EDGES : (int)RIC_FAMILY_KINDS,
                          .multiplier = {NAN, NAN},
                          .map_low = NAN,
                          .map_high = NAN};
  if (state) {
    iterated_take(it, 0, state); /* the model of the task; its start is not wanted */
    memcpy(state, z, it->size * sizeof *state);
    status = it->maps ? find_of_map(it, period, p, low, high, state, edges, &error)
                      : find_of_motion(it, period, p, low, high, state, edges, &error);
  }
  free(state);
  edges->located = status == RIC_OK;
  if (!edges->located)
    snprintf(edges->reason, sizeof edges->reason, "%.*s", (int)sizeof edges->reason - 1, error.message);
  return status == RIC_ESTOPPED ? status : RIC_OK;
}
