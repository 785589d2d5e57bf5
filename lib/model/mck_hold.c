#include "mck_hold.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include <gsl/gsl_linalg.h>

/* Only rigid obstacles hold; without states any of them may. */
static int may_hold(const ric_system *s, const unsigned char *contact, size_t obstacle) {
  return isinf(s->obstacles[obstacle].stiffness) && (!contact || contact[obstacle] == CONTACT_HELD);
}

static size_t coordinates_to_hold(const ric_system *s, const unsigned char *contact) {
  size_t count = 0, last = SIZE_MAX;
  for (size_t k = 0; k < s->obstacle_count; k++) {
    size_t coordinate = s->obstacles[s->by_coordinate[k]].coordinate;
    if (!may_hold(s, contact, s->by_coordinate[k]) || coordinate == last)
      continue;
    last = coordinate;
    count++;
  }
  return count;
}

int mck_hold_init(mck_hold *hold, const mck_system *s, const unsigned char *contact) {
  size_t size = coordinates_to_hold(&s->base, contact), room = size ? size : 1;
  *hold = (mck_hold){0};
  hold->coordinate = malloc(room * sizeof *hold->coordinate);
  hold->sharing = malloc(room * sizeof *hold->sharing);
  hold->force = malloc(room * sizeof *hold->force);
  hold->order = malloc(room * sizeof *hold->order);
  if (!s->base.uncoupled)
    hold->factor = malloc(room * room * sizeof *hold->factor); /* M itself is no smaller */
  return hold->coordinate && hold->sharing && hold->force && hold->order && (s->base.uncoupled || hold->factor);
}

void mck_hold_clear(mck_hold *hold) {
  free(hold->coordinate);
  free(hold->sharing);
  free(hold->force);
  free(hold->order);
  free(hold->factor);
  *hold = (mck_hold){0};
}

static void collect(mck_hold *hold, const ric_system *s, const unsigned char *contact) {
  hold->count = 0;
  for (size_t k = 0; k < s->obstacle_count; k++) {
    size_t obstacle = s->by_coordinate[k], coordinate = s->obstacles[obstacle].coordinate;
    if (!may_hold(s, contact, obstacle))
      continue;
    if (hold->count > 0 && hold->coordinate[hold->count - 1] == coordinate) {
      hold->sharing[hold->count - 1]++;
      continue;
    }
    hold->coordinate[hold->count] = coordinate;
    hold->sharing[hold->count++] = 1;
  }
}

/* Pivoted, because GSL's plain Cholesky calls its error handler where a matrix is not positive definite. */
static const char *factorise(mck_hold *hold, const mck_system *s) {
  size_t size = hold->count, n = s->base.coordinates;
  for (size_t i = 0; i < size; i++)
    for (size_t j = 0; j < size; j++)
      hold->factor[i * size + j] = s->inverse[hold->coordinate[i] * n + hold->coordinate[j]];
  gsl_matrix_view a = gsl_matrix_view_array(hold->factor, size, size);
  gsl_permutation p = {.size = size, .data = hold->order};
  gsl_linalg_pcholesky_decomp(&a.matrix, &p);
  for (size_t i = 0; i < size; i++)
    if (!(hold->factor[i * size + i] > 0))
      return "the inverse of the mass matrix is not positive definite at the held coordinates";
  return NULL;
}

const char *mck_hold_set(mck_hold *hold, const mck_system *s, const unsigned char *contact) {
  collect(hold, &s->base, contact);
  return s->base.uncoupled || hold->count == 0 ? NULL : factorise(hold, s);
}

static void find_forces(mck_hold *hold, const mck_system *s, const double *acceleration) {
  for (size_t k = 0; k < hold->count; k++)
    hold->force[k] = -acceleration[hold->coordinate[k]];
  if (s->base.uncoupled) {
    for (size_t k = 0; k < hold->count; k++)
      hold->force[k] *= s->mass[hold->coordinate[k]];
    return;
  }
  gsl_matrix_view a = gsl_matrix_view_array(hold->factor, hold->count, hold->count);
  gsl_vector_view x = gsl_vector_view_array(hold->force, hold->count);
  gsl_permutation p = {.size = hold->count, .data = hold->order};
  gsl_linalg_pcholesky_svx(&a.matrix, &p, &x.vector);
}

void mck_hold_project(mck_hold *hold, const mck_system *s, double *acceleration) {
  if (hold->count == 0)
    return;
  find_forces(hold, s, acceleration);
  for (size_t k = 0; k < hold->count; k++)
    mck_push(s, hold->coordinate[k], hold->force[k], acceleration);
  for (size_t k = 0; k < hold->count; k++)
    acceleration[hold->coordinate[k]] = 0;
}

size_t mck_hold_find(const mck_hold *hold, size_t coordinate) {
  size_t low = 0, high = hold->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (hold->coordinate[middle] < coordinate)
      low = middle + 1;
    else
      high = middle;
  }
  return low < hold->count && hold->coordinate[low] == coordinate ? low : hold->count;
}
