/* Running the Taylor flow of an M-C-K system in tests: makes, moves, asserts that nothing fails. */
#ifndef RICOCHET_TESTS_MCK_MOTION_H
#define RICOCHET_TESTS_MCK_MOTION_H

#include "support.h"

#include <ricochet/flow.h>

static inline ric_system *mck_system_made(const ric_mck *model, const ric_obstacle *obstacles, size_t count) {
  ric_system *system;
  ric_error error = {0};
  if (ric_system_create_mck(model, obstacles, count, &system, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return system;
}

static inline ric_flow *mck_flow_made(const ric_system *system, ric_flow_options options) {
  ric_flow *flow;
  ric_error error = {0};
  options.method = RIC_FLOW_TAYLOR;
  if (ric_flow_create(system, &options, &flow, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return flow;
}

static inline void mck_step_once(ric_flow *flow, double stop) {
  ric_error error = {0};
  if (ric_flow_step(flow, stop, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

/** Moves to `end`, exactly; returns the number of steps. */
static inline int mck_move(ric_flow *flow, double end) {
  int steps = 0;
  for (; ric_flow_time(flow) != end; steps++) {
    mck_step_once(flow, end);
    ric_flow_accept(flow, 1);
    assert_true(steps < 1000000);
  }
  return steps;
}

/** Starts at (t, q, u) and moves to `end`. */
static inline void mck_run(ric_flow *flow, double t, const double *q, const double *u, double end) {
  assert_int_equal(ric_flow_start(flow, t, q, u, NULL), RIC_OK);
  mck_move(flow, end);
}

static inline double mck_difference(const double *a, const double *b, size_t n) {
  double most = 0;
  for (size_t i = 0; i < n; i++)
    most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

#endif
