#include "first_order.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "numeric/number_block.h"
#include "user_callback.h"

static const first_order *first_order_of(const ric_system *system) {
  return (const first_order *)system;
}

const char *first_order_free_rate(const first_order *s, double t, const double *x, double *rate) {
  return callback_check(s->model.rate(t, x, rate, s->model.user), rate, s->model.states, CALLBACK_TEXTS("rate"));
}

const char *first_order_map(const first_order *s, size_t obstacle, double t, const double *x, double *x_after) {
  int code = s->model.impact(t, x, obstacle, x_after, s->model.user);
  return callback_check(code, x_after, s->model.states, CALLBACK_TEXTS("impact"));
}

static const char *rate(const ric_system *system, const unsigned char *contact, double t, const double *x,
                        const double *u, double *x_rate, double *u_rate) {
  (void)u;
  (void)u_rate;
  size_t count;
  TRY_TEXT(first_order_free_rate(first_order_of(system), t, x, x_rate));
  return first_order_hold(first_order_of(system), contact, t, x, x_rate, &count);
}

static const char *gap(const ric_system *system, size_t obstacle, double t, const double *x, double *h) {
  return user_gap_value(&first_order_of(system)->gap, obstacle, t, x, h);
}

/* The restitution that an impact amounts to. Gap rates that cannot be had, or do not fall, say nothing about it. */
static void remember_ratio(const first_order *s, size_t obstacle, double t, const double *x, const double *x_after) {
  double before, after;
  if (first_order_gap_rate(&s->base, obstacle, t, x, NULL, &before) ||
      first_order_gap_rate(&s->base, obstacle, t, x_after, NULL, &after))
    return;
  double ratio = -after / before;
  if (before < 0 && isfinite(ratio))
    s->ratio[obstacle] = fmin(fmax(ratio, 0), 1);
}

static const char *impact(const ric_system *system, size_t obstacle, double t, const double *x, double *x_after) {
  const first_order *s = first_order_of(system);
  TRY_TEXT(first_order_map(s, obstacle, t, x, x_after));
  remember_ratio(s, obstacle, t, x, x_after);
  return NULL;
}

static const char *energy(const ric_system *system, double t, const double *x, const double *u, double *value) {
  const ric_first_order *model = &first_order_of(system)->model;
  (void)u;
  *value = NAN;
  if (!model->energy)
    return NULL;
  return callback_check(model->energy(t, x, value, model->user), value, 1, CALLBACK_TEXTS("energy"));
}

static double restitution(const ric_system *system, size_t obstacle) {
  return first_order_of(system)->ratio[obstacle];
}

static void destroy(ric_system *system) {
  first_order *s = (first_order *)system;
  free(s->ratio);
  free(s->numbers);
  free(s->held);
  free(s);
}

static const char *gap_derivative(const ric_system *system, size_t obstacle, double t, const double *q,
                                  const tangents *d, double *derivative) {
  const first_order *s = (const first_order *)system;
  return user_gap_derivative(&s->gap, obstacle, t, q, d, s->gradient, derivative);
}

static const system_model model_table = {.rate = rate,
                                         .gap = gap,
                                         .gap_derivative = gap_derivative,
                                         .gap_rate = first_order_gap_rate,
                                         .gap_acceleration = first_order_gap_acceleration,
                                         .impact = impact,
                                         .impact_slope = first_order_impact_slope,
                                         .reaction = first_order_reaction,
                                         .energy = energy,
                                         .restitution = restitution,
                                         .destroy = destroy};

static ric_status check(const ric_first_order *model, ric_error *error) {
  if (!(model->states >= 1 && model->states <= UINT32_MAX / 16))
    return ric_fail(error, RIC_EINVAL, "states = %zu, expected 1 to %u", model->states, UINT32_MAX / 16);
  if (!model->rate)
    return ric_fail(error, RIC_EINVAL, "rate = NULL, expected a callback");
  if (!model->gap && model->obstacles > 0)
    return ric_fail(error, RIC_EINVAL, "gap = NULL, expected a callback: obstacles = %zu", model->obstacles);
  if (!model->impact && model->obstacles > 0)
    return ric_fail(error, RIC_EINVAL, "impact = NULL, expected a callback: obstacles = %zu", model->obstacles);
  return RIC_OK;
}

static size_t lay_out(first_order *s, double *block) {
  size_t n = s->model.states, k = s->held_most, used = 0;
  s->gap.point = number_block_take(block, &used, n);
  s->gradient = number_block_take(block, &used, n);
  s->rate = number_block_take(block, &used, n);
  s->path = number_block_take(block, &used, n);
  s->before = number_block_take(block, &used, n);
  s->after = number_block_take(block, &used, n);
  s->free_rate = number_block_take(block, &used, n);
  s->table = number_block_take(block, &used, FIRST_ORDER_TRIALS * n);
  s->foot = number_block_take(block, &used, n);
  s->approach = number_block_take(block, &used, n);
  s->limit = number_block_take(block, &used, n);
  s->direction = number_block_take(block, &used, k * n);
  s->matrix = number_block_take(block, &used, k * k);
  s->lambda = number_block_take(block, &used, k);
  return used;
}

static bool allocate(first_order *s) {
  size_t count = s->model.obstacles;
  s->held_most = count < s->model.states ? count : s->model.states;
  s->numbers = calloc(lay_out(s, NULL), sizeof *s->numbers);
  s->ratio = calloc(count ? count : 1, sizeof *s->ratio);
  s->held = calloc(s->held_most ? s->held_most : 1, sizeof *s->held);
  if (!s->numbers || !s->ratio || !s->held)
    return false;
  lay_out(s, s->numbers);
  return true;
}

ric_status ric_system_create_first_order(const ric_first_order *model, ric_system **system, ric_error *error) {
  *system = NULL;
  RIC_TRY(check(model, error));
  first_order *s = calloc(1, sizeof *s);
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a system");
  s->base = (ric_system){.model = &model_table,
                         .coordinates = model->states,
                         .obstacle_count = model->obstacles,
                         .uncoupled = model->obstacles <= 1};
  s->model = *model;
  s->gap = (user_gap){model->states, model->gap, model->gap_gradient, model->user, NULL};
  if (!allocate(s)) {
    destroy(&s->base);
    return ric_fail(error, RIC_ENOMEM, "no memory for a system of %zu states", model->states);
  }
  for (size_t j = 0; j < model->obstacles; j++)
    s->ratio[j] = 1;
  *system = &s->base;
  return RIC_OK;
}
