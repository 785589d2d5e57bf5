#include "curves.h"

#include "support.h"

#define RESIDUAL(name)                                                                                                 \
  static ric_status name(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error)

RESIDUAL(circle_residual) {
  (void)user, (void)error;
  F[0] = *u * *u + p * p - 1;
  J[0] = 2 * *u;
  F_p[0] = 2 * p;
  return RIC_OK;
}

RESIDUAL(cubic_residual) {
  (void)user, (void)error;
  F[0] = *u - *u * *u * *u - p;
  J[0] = 1 - 3 * *u * *u;
  F_p[0] = -1;
  return RIC_OK;
}

RESIDUAL(pitchfork_residual) {
  (void)user, (void)error;
  F[0] = p * *u - *u * *u * *u;
  J[0] = p - 3 * *u * *u;
  F_p[0] = *u;
  return RIC_OK;
}

/* The equations are G = 0, mixed by a matrix. */
RESIDUAL(crossing_residual) {
  static const double mix[3][3] = {{1, 0.5, 0.2}, {0, 1, 0.7}, {0.3, 0, 1}};
  (void)error;
  double a = u[0] - 0.4 * sin(p), a_p = -0.4 * cos(p), q = p - 0.3;
  bool fork = *(const bool *)user;
  double G[3] = {fork ? a * (q - a * a) : a * (a - q), u[1] - cos(p) / 2, u[2] - u[0] * u[1]};
  double by_a = fork ? q - 3 * a * a : 2 * a - q, by_q = fork ? a : -a;
  double DG[3][4] = {{by_a, 0, 0, by_a * a_p + by_q}, {0, 1, 0, sin(p) / 2}, {-u[1], -u[0], 1, 0}};
  for (int i = 0; i < 3; i++) {
    F[i] = F_p[i] = J[3 * i] = J[3 * i + 1] = J[3 * i + 2] = 0;
    for (int k = 0; k < 3; k++) {
      F[i] += mix[i][k] * G[k];
      F_p[i] += mix[i][k] * DG[k][3];
      for (int j = 0; j < 3; j++)
        J[3 * i + j] += mix[i][k] * DG[k][j];
    }
  }
  return RIC_OK;
}

void crossing_point(double p, double u_0, double u[3]) {
  u[0] = u_0;
  u[1] = cos(p) / 2;
  u[2] = u[0] * u[1];
}

void crossing_tangent(double p, double u_0, double rate, double t[4]) {
  t[0] = rate;
  t[1] = -sin(p) / 2;
  t[2] = rate * cos(p) / 2 + u_0 * t[1];
  t[3] = 1;
  double length = sqrt((t[0] * t[0] + t[1] * t[1] + t[2] * t[2]) / 3 + 1);
  for (int i = 0; i < 4; i++)
    t[i] /= length;
}

/* v - 2 w <w, v> / <w, w> with w_i = 1 + i mod 3, of a column of a matrix. */
static void reflect(size_t n, double *column, size_t stride) {
  double product = 0, square = 0;
  for (size_t i = 0; i < n; i++) {
    double w = 1 + (double)(i % 3);
    product += w * column[i * stride];
    square += w * w;
  }
  for (size_t i = 0; i < n; i++)
    column[i * stride] -= 2 * (1 + (double)(i % 3)) * product / square;
}

RESIDUAL(wide_residual) {
  const wide_user *wide = user;
  size_t n = wide->unknowns;
  (void)error;
  double a = u[0] - 0.4 * sin(p), q = p - 0.3, by_q = wide->is_fork ? a : -a;
  memset(J, 0, n * n * sizeof *J);
  F[0] = wide->is_fork ? a * (q - a * a) : a * (a - q);
  J[0] = wide->is_fork ? q - 3 * a * a : 2 * a - q;
  F_p[0] = -0.4 * cos(p) * J[0] + by_q;
  for (size_t i = 1; i < n; i++) {
    F[i] = u[i] - u[0] * cos((double)i) - sin(p) / (double)(i + 1);
    J[i * n] = -cos((double)i);
    J[i * n + i] = 1;
    F_p[i] = -cos(p) / (double)(i + 1);
  }
  reflect(n, F, 1);
  reflect(n, F_p, 1);
  for (size_t j = 0; j < n; j++)
    reflect(n, J + j, n);
  return RIC_OK;
}

ric_curve_problem wide_crossing(const wide_user *user) {
  return (ric_curve_problem){.unknowns = user->unknowns, .residual = wide_residual, .user = (void *)(uintptr_t)user};
}

void wide_point(const wide_user *user, double p, double u_0, double *u) {
  u[0] = u_0;
  for (size_t i = 1; i < user->unknowns; i++)
    u[i] = u_0 * cos((double)i) + sin(p) / (double)(i + 1);
}

RESIDUAL(duffing_residual) {
  const duffing *d = user;
  (void)error;
  double a = u[0], b = u[1], stiffness = 1 - p * p + 0.75 * (a * a + b * b), drag = 2 * d->damping * p;
  F[0] = stiffness * a + drag * b - d->force;
  F[1] = stiffness * b - drag * a;
  J[0] = stiffness + 1.5 * a * a;
  J[1] = 1.5 * a * b + drag;
  J[2] = 1.5 * a * b - drag;
  J[3] = stiffness + 1.5 * b * b;
  F_p[0] = -2 * p * a + 2 * d->damping * b;
  F_p[1] = -2 * p * b - 2 * d->damping * a;
  return RIC_OK;
}

double duffing_force(const duffing *d, const double u[2], double p) {
  double amplitude = hypot(u[0], u[1]);
  return amplitude * hypot(1 - p * p + 0.75 * amplitude * amplitude, 2 * d->damping * p);
}

RESIDUAL(bratu_residual) {
  size_t n = *(const size_t *)user;
  double h2 = 1 / ((double)(n + 1) * (double)(n + 1));
  (void)error;
  memset(J, 0, n * n * sizeof *J);
  for (size_t i = 0; i < n; i++) {
    double left = i > 0 ? u[i - 1] : 0, right = i + 1 < n ? u[i + 1] : 0;
    F[i] = (left - 2 * u[i] + right) / h2 + p * exp(u[i]);
    J[i * n + i] = -2 / h2 + p * exp(u[i]);
    if (i > 0)
      J[i * n + i - 1] = 1 / h2;
    if (i + 1 < n)
      J[i * n + i + 1] = 1 / h2;
    F_p[i] = exp(u[i]);
  }
  return RIC_OK;
}

const ric_curve_problem circle = {.unknowns = 1, .residual = circle_residual};
const ric_curve_problem cubic_curve = {.unknowns = 1, .residual = cubic_residual};
const ric_curve_problem pitchfork = {.unknowns = 1, .residual = pitchfork_residual};
const ric_curve_problem duffing_response = {.unknowns = 2, .residual = duffing_residual};
const ric_curve_problem crossing = {.unknowns = 3, .residual = crossing_residual};

ric_curve_problem bratu(size_t unknowns) {
  static size_t sizes[1000];
  assert_true(unknowns < 1000);
  sizes[unknowns] = unknowns;
  return (ric_curve_problem){.unknowns = unknowns, .residual = bratu_residual, .user = &sizes[unknowns]};
}

static int keep(const ric_curve_point *point, void *user) {
  walked *w = user;
  assert_true(w->count < MOST_SHOWN);
  shown_point *s = &w->points[w->count++];
  *s = (shown_point){.kind = point->kind,
                     .which = point->which,
                     .p = point->p,
                     .u = point->u[0],
                     .t_p = point->t_p,
                     .t_u = point->t_u[0],
                     .arclength = point->arclength,
                     .step = point->step,
                     .test = w->tests ? point->tests[point->which] : NAN,
                     .iterations = point->iterations};
  if (w->unknowns <= 3) {
    memcpy(s->x, point->u, w->unknowns * sizeof *s->x);
    memcpy(s->t, point->t_u, w->unknowns * sizeof *s->t);
    s->x[w->unknowns] = point->p;
    s->t[w->unknowns] = point->t_p;
  }
  return 0;
}

ric_curve *made(const ric_curve_problem *problem, const ric_curve_options *options) {
  ric_curve *curve = NULL;
  ric_error error = {0};
  if (ric_curve_create(problem, options, &curve, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return curve;
}

walked *walk(const ric_curve_problem *problem, const ric_curve_options *options, const double *u, double p,
             const double *tangent) {
  walked *w = calloc(1, sizeof *w);
  double *start = calloc(problem->unknowns, sizeof *start);
  ric_curve *curve = made(problem, options);
  ric_error error = {0};
  assert_true(w && start);
  w->unknowns = problem->unknowns;
  w->tests = problem->tests;
  if (u)
    memcpy(start, u, problem->unknowns * sizeof *u);
  if (ric_curve_follow(curve, start, p, tangent, keep, w, &w->run, &error) != RIC_OK)
    fail_msg("%s", error.message);
  ric_curve_destroy(&curve);
  free(start);
  return w;
}

const shown_point *special(const walked *w, ric_curve_point_kind kind, size_t k) {
  for (size_t i = 0; i < w->count; i++)
    if (w->points[i].kind == kind && k-- == 0)
      return &w->points[i];
  fail_msg("no such %s among %zu points", ric_curve_point_name(kind), w->count);
  return NULL;
}

size_t count_special(const walked *w, ric_curve_point_kind kind) {
  size_t count = 0;
  for (size_t i = 0; i < w->count; i++)
    count += w->points[i].kind == kind;
  return count;
}

const shown_point *last(const walked *w) {
  assert_true(w->count > 0);
  return &w->points[w->count - 1];
}
