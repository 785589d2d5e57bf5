#include "derivative.h"

#include "support.h"

static ric_trajectory *trajectory_at(const ric_system *system, const ric_trajectory_options *options, double start,
                                     const double *x) {
  ric_trajectory *trajectory = NULL;
  assert_int_equal(ric_trajectory_create(system, options, &trajectory, NULL), RIC_OK);
  size_t n = ric_system_coordinates(system);
  assert_int_equal(ric_trajectory_start(trajectory, start, x, x + n, NULL), RIC_OK);
  return trajectory;
}

ric_run_outcome derivative_by_tangents(const ric_system *system, const ric_trajectory_options *options, double start,
                                       const double *x, double end, double *D) {
  size_t n = ric_system_coordinates(system), size = n + ric_system_speeds(system);
  ric_trajectory *trajectory = trajectory_at(system, options, start, x);
  ric_run run;
  ric_error error = {0};
  for (size_t i = 0; i < size * size; i++)
    D[i] = i % (size + 1) == 0;
  assert_int_equal(ric_trajectory_carry(trajectory, size, D, D + n * size, NULL), RIC_OK);
  if (ric_trajectory_run(trajectory, end, NULL, &run, &error) != RIC_OK)
    fail_msg("%s", error.message);
  if (run.outcome == RIC_RUN_COMPLETED) {
    memcpy(D, ric_trajectory_dq(trajectory), n * size * sizeof *D);
    memcpy(D + n * size, ric_trajectory_du(trajectory), (size - n) * size * sizeof *D);
  }
  ric_trajectory_destroy(&trajectory);
  return run.outcome;
}

static void reach(ric_trajectory *trajectory, double start, const double *x, size_t n, size_t m, double end,
                  double *out) {
  ric_run run;
  assert_int_equal(ric_trajectory_start(trajectory, start, x, x + n, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, end, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  memcpy(out, ric_trajectory_q(trajectory), n * sizeof *out);
  if (m > 0)
    memcpy(out + n, ric_trajectory_u(trajectory), m * sizeof *out);
}

/* Column k by steps +-h, added with a weight. */
static void add_column(ric_trajectory *trajectory, double start, const double *x, size_t n, size_t m, double end,
                       size_t k, double h, double weight, double *D) {
  size_t size = n + m;
  double *work = malloc(2 * size * sizeof *work), *moved = work + size;
  for (int sign = -1; sign <= 1; sign += 2) {
    memcpy(moved, x, size * sizeof *moved);
    moved[k] += sign * h;
    reach(trajectory, start, moved, n, m, end, work);
    for (size_t i = 0; i < size; i++)
      D[i * size + k] += weight * sign * work[i] / (2 * h);
  }
  free(work);
}

void derivative_by_differences(const ric_system *system, const ric_trajectory_options *options, double start,
                               const double *x, double end, double step, int order, double *D) {
  size_t n = ric_system_coordinates(system), m = ric_system_speeds(system), size = n + m;
  ric_trajectory *trajectory = trajectory_at(system, options, start, x);
  memset(D, 0, size * size * sizeof *D);
  for (size_t k = 0; k < size; k++) {
    add_column(trajectory, start, x, n, m, end, k, step, order == 4 ? -1.0 / 3 : 1, D);
    if (order == 4)
      add_column(trajectory, start, x, n, m, end, k, step / 2, 4.0 / 3, D);
  }
  ric_trajectory_destroy(&trajectory);
}

double derivative_error(const double *A, const double *B, size_t size) {
  double most = 0, scale = 0;
  for (size_t i = 0; i < size * size; i++) {
    most = fmax(most, isnan(A[i]) ? INFINITY : fabs(A[i] - B[i]));
    scale = fmax(scale, fabs(B[i]));
  }
  return most / scale;
}
