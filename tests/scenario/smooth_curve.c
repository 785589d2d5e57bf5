#include "smooth_curve.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "random_source.h"

static ric_status wave(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error) {
  (void)error;
  ++*(size_t *)user;
  F[0] = u[0] - sin(p);
  F[1] = u[1] - u[0] * u[0];
  F[2] = u[2] + u[1] * u[0];
  memset(J, 0, 9 * sizeof *J);
  J[0] = J[4] = J[8] = 1;
  J[3] = -2 * u[0];
  J[6] = u[1];
  J[7] = u[0];
  F_p[0] = -cos(p);
  F_p[1] = F_p[2] = 0;
  return RIC_OK;
}

ric_curve_problem smooth_wave(size_t *calls) {
  return (ric_curve_problem){.unknowns = 3, .residual = wave, .user = calls};
}

int smooth_line_init(smooth_line *line, size_t unknowns) {
  random_source source = {7};
  line->unknowns = unknowns;
  line->matrix = calloc(unknowns * unknowns, sizeof *line->matrix);
  if (!line->matrix)
    return 1;
  double scale = sqrt(3 / (double)unknowns); /* eigenvalues of the random part fill the unit circle */
  for (size_t i = 0; i < unknowns * unknowns; i++)
    line->matrix[i] = scale * random_uniform(&source, -1, 1);
  for (size_t i = 0; i < unknowns; i++)
    line->matrix[i * unknowns + i] += 2;
  return 0;
}

void smooth_line_clear(smooth_line *line) {
  free(line->matrix);
  *line = (smooth_line){0};
}

static ric_status straight(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error) {
  const smooth_line *line = user;
  size_t n = line->unknowns;
  (void)error;
  memcpy(J, line->matrix, n * n * sizeof *J);
  for (size_t i = 0; i < n; i++) {
    F[i] = -p;
    F_p[i] = -1;
    for (size_t j = 0; j < n; j++)
      F[i] += J[i * n + j] * u[j];
  }
  return RIC_OK;
}

ric_curve_problem smooth_line_problem(const smooth_line *line) {
  return (ric_curve_problem){.unknowns = line->unknowns, .residual = straight, .user = (void *)(uintptr_t)line};
}
