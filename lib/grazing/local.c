/* The coefficients of grazing at a state. */
#include "grazing.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/required.h"
#include "numeric/vector.h"

/* If more than this fraction of the gap rate is still negative after an impact, the impact map is invalid. */
static const double turn_tol = 1e-6;

ric_status grazing_check_obstacle(const ric_system *system, size_t obstacle, ric_error *error) {
  if (!(obstacle < system->obstacle_count))
    return ric_fail(error, RIC_EINVAL, "obstacle = %zu, expected less than %zu", obstacle, system->obstacle_count);
  if (system_complies(system, obstacle))
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: stiffness = %g, expected a rigid one (infinity)", obstacle,
                    system->obstacles[obstacle].stiffness);
  return RIC_OK;
}

ric_status grazing_callback_error(double t, size_t obstacle, const char *trouble, ric_error *error) {
  return ric_fail(error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", t, obstacle, trouble);
}

ric_status grazing_rates(const ric_system *s, size_t obstacle, double t, const double *x, double *rates, double *rate,
                         double *acceleration, ric_error *error) {
  size_t n = s->coordinates;
  RIC_TRY(ric_system_rate(s, t, x, x + n, rates, rates + n, error));
  const char *trouble = s->model->gap_rate(s, obstacle, t, x, x + n, rate);
  if (!trouble)
    trouble = s->model->gap_acceleration(s, obstacle, t, x, x + n, rates, rates + n, acceleration);
  return trouble ? grazing_callback_error(t, obstacle, trouble, error) : RIC_OK;
}

ric_status grazing_check_local(const ric_grazing_local *local, const ric_system *system, ric_error *error) {
  size_t size = system->coordinates + system->speeds;
  if (local->numbers != size)
    return ric_fail(error, RIC_EINVAL, "a grazing point of %zu numbers, expected %zu", local->numbers, size);
  if (!(local->acceleration > 0 && local->acceleration < INFINITY))
    return ric_fail(error, RIC_EINVAL, "acceleration of the gap at grazing = %g, expected > 0", local->acceleration);
  return RIC_OK;
}

ric_status ric_grazing_local_init(ric_grazing_local *local, size_t numbers, ric_error *error) {
  REQUIRE(error, {"local", local});
  *local = (ric_grazing_local){.numbers = numbers};
  local->eta = calloc(2 * (numbers ? numbers : 1), sizeof *local->eta);
  if (!local->eta)
    return ric_fail(error, RIC_ENOMEM, "no memory for a grazing point of %zu numbers", numbers);
  local->xi = local->eta + numbers;
  return RIC_OK;
}

void ric_grazing_local_clear(ric_grazing_local *local) {
  if (!local)
    return;
  free(local->eta);
  *local = (ric_grazing_local){0};
}

static ric_status check_state(const ric_system *s, double t, const double *x, ric_error *error) {
  if (!isfinite(t))
    return ric_fail(error, RIC_EINVAL, "t = %g, expected a finite time", t);
  for (size_t i = 0; i < s->coordinates + s->speeds; i++)
    if (!isfinite(x[i]))
      return ric_fail(error, RIC_EINVAL, "x[%zu] = %g, expected a finite number", i, x[i]);
  return RIC_OK;
}

/* Gaps do not depend on speeds; first-order systems have coordinates only. @param unit  [n + m], zeros */
static const char *find_eta(const ric_system *s, size_t obstacle, double t, const double *x, double *unit,
                            double *eta) {
  const tangents direction = {.columns = 1, .q = unit, .u = unit + s->coordinates};
  const char *trouble = NULL;
  for (size_t i = 0; i < s->coordinates && !trouble; i++) {
    unit[i] = 1;
    trouble = s->model->gap_derivative(s, obstacle, t, x, &direction, &eta[i]);
    unit[i] = 0;
  }
  return trouble;
}

/* xi = (0, (1 + e) M^-1 g / (g^T M^-1 g)), by [FN97] (2.9) and (4.5). @param work  [2 m] */
static const char *find_impulse(const ric_system *s, double t, const double *x, double *work,
                                ric_grazing_local *local) {
  contact_direction d = {.g = work, .w = work + s->speeds};
  double inverse_mass = 0;
  const char *trouble = s->model->direction(s, local->obstacle, t, x, &d);
  for (size_t k = 0; k < d.count && !trouble; k++)
    inverse_mass += d.g[k] * d.w[k];
  local->restitution = s->model->restitution(s, local->obstacle);
  for (size_t k = 0; k < d.count && !trouble; k++)
    local->xi[s->coordinates + d.first + k] = (1 + local->restitution) * d.w[k] / inverse_mass;
  return trouble;
}

/* [FN97] (4.4)-(4.6) require a change of state that is smooth in the gap rate and vanishes with it. */
static ric_status check_map_slope(size_t obstacle, const impact_slope *found, ric_error *error) {
  if (!found->exists && !(found->power > 0.05))
    return ric_fail(error, RIC_EINVAL,
                    "obstacle %zu: the impact map moves the state by %.3g at the gap rate %.3g, expected one that "
                    "tends to the identity",
                    obstacle, found->moved, found->rate);
  if (!found->exists)
    return ric_fail(error, RIC_EINVAL,
                    "obstacle %zu: the impact map moves the state by %.3g at the gap rate %.3g, as its power %.2f, "
                    "expected a derivative at vanishing gap rates",
                    obstacle, found->moved, found->rate, found->power);
  if (!(found->turn >= 1 - turn_tol))
    return ric_fail(error, RIC_EINVAL,
                    "obstacle %zu: the impact map changes small gap rates v < 0 to %.3g v, expected them >= 0",
                    obstacle, 1 - found->turn);
  return RIC_OK;
}

static ric_status find_map(const ric_system *s, double t, const double *x, ric_grazing_local *local, ric_error *error) {
  impact_slope found;
  const char *trouble = s->model->impact_slope(s, local->obstacle, t, x, local->xi, &found);
  if (trouble)
    return grazing_callback_error(t, local->obstacle, trouble, error);
  local->restitution = found.turn - 1;
  return check_map_slope(local->obstacle, &found, error);
}

/* @param work  [3 (n + m)], zeros */
static ric_status find_all(const ric_system *s, double t, const double *x, double *work, ric_grazing_local *local,
                           ric_error *error) {
  size_t size = s->coordinates + s->speeds, j = local->obstacle;
  const char *trouble = find_eta(s, j, t, x, work, local->eta);
  if (!trouble)
    trouble = s->model->gap(s, j, t, x, &local->gap);
  if (trouble)
    return grazing_callback_error(t, j, trouble, error);
  RIC_TRY(grazing_rates(s, j, t, x, work, &local->rate, &local->acceleration, error));
  if (!s->model->direction)
    return find_map(s, t, x, local, error);
  trouble = find_impulse(s, t, x, work + size, local);
  return trouble ? grazing_callback_error(t, j, trouble, error) : RIC_OK;
}

ric_status ric_grazing_local_find(const ric_system *s, size_t obstacle, double t, const double *x,
                                  ric_grazing_local *local, ric_error *error) {
  REQUIRE(error, {"system", s}, {"x", x}, {"local", local});
  size_t size = s->coordinates + s->speeds;
  RIC_TRY(grazing_check_obstacle(s, obstacle, error));
  RIC_TRY(check_state(s, t, x, error));
  if (local->numbers != size)
    return ric_fail(error, RIC_EINVAL, "room for %zu numbers, expected %zu", local->numbers, size);
  double *work = calloc(5 * size, sizeof *work);
  if (!work)
    return ric_fail(error, RIC_ENOMEM, "no memory for a grazing point of %zu numbers", size);
  ric_grazing_local found = {.numbers = size, .obstacle = obstacle, .eta = work + 3 * size, .xi = work + 4 * size};
  ric_status status = find_all(s, t, x, work, &found, error);
  if (status == RIC_OK) {
    memcpy(local->eta, found.eta, size * sizeof *work);
    memcpy(local->xi, found.xi, size * sizeof *work);
    found.eta = local->eta;
    found.xi = local->xi;
    *local = found;
  }
  free(work);
  return status;
}
