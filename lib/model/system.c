#include "ricochet/system.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "system_model.h"

void ric_system_destroy(ric_system **system) {
  if (!system || !*system)
    return;
  free((*system)->obstacles);
  free((*system)->by_coordinate);
  (*system)->model->destroy(*system);
  *system = NULL;
}

size_t ric_system_coordinates(const ric_system *system) {
  return system->coordinates;
}

size_t ric_system_speeds(const ric_system *system) {
  return system->speeds;
}

size_t ric_system_obstacles(const ric_system *system) {
  return system->obstacle_count;
}

double ric_system_gap(const ric_system *system, size_t obstacle, double t, const double *q) {
  double gap;
  return system->model->gap(system, obstacle, t, q, &gap) == NULL ? gap : NAN;
}

double ric_system_gap_rate(const ric_system *system, size_t obstacle, double t, const double *q, const double *u) {
  double rate;
  return system->model->gap_rate(system, obstacle, t, q, u, &rate) == NULL ? rate : NAN;
}

double ric_system_energy(const ric_system *system, double t, const double *q, const double *u) {
  double energy;
  return system->model->energy(system, t, q, u, &energy) == NULL ? energy : NAN;
}

ric_status ric_system_rate(const ric_system *system, double t, const double *q, const double *u, double *q_rate,
                           double *u_rate, ric_error *error) {
  const char *trouble = system->model->rate(system, NULL, t, q, u, q_rate, u_rate);
  return trouble ? ric_fail(error, RIC_ECALLBACK, "at t = %g: %s", t, trouble) : RIC_OK;
}

const char *system_list_held(const ric_system *s, const unsigned char *contact, size_t most, size_t *held,
                             size_t *count) {
  *count = 0;
  for (size_t j = 0; contact && j < s->obstacle_count; j++) {
    if (contact[j] != CONTACT_HELD)
      continue;
    if (*count == most)
      return "more contacts persist than the motion has directions";
    held[(*count)++] = j;
  }
  return NULL;
}
