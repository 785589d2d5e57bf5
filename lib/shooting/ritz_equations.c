/* F(c) and its derivatives, point by point of the quadrature. */
#include <math.h>
#include <string.h>

#include "model/lattice_system.h"
#include "numeric/constants.h"
#include "numeric/required.h"
#include "numeric/vector.h"
#include "ritz.h"

typedef struct equations {
  ric_ritz *r;
  const ric_lattice *lattice;
  const double *c;
  double w, period;
  size_t width, unknowns;
  double *F, *J, *F_period; /* the last two may be NULL */
} equations;

/* A point of the quadrature. */
typedef struct node {
  const double *psi;    /* [N'] */
  double weight, lever; /* lever: T/2 - t over the period */
} node;

/* Derivatives of q_k and of its second derivative by w and by T. */
typedef struct hit_slopes {
  double q_w, q_period, bend_w, bend_period;
} hit_slopes;

ric_status ritz_check_numbers(const ric_ritz *r, const double *c, double period, ric_error *error) {
  for (size_t i = 0; i < ric_ritz_unknowns(r); i++)
    if (!isfinite(c[i]))
      return ric_fail(error, RIC_ENUMERIC, "c[%zu] = %g, expected a finite number", i, c[i]);
  if (period > 0 && period < INFINITY)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "period = %g, expected > 0", period);
}

/* Sets r->q, r->bend, r->rate, and cosines and sines, at a point of the quadrature. */
static void evaluate_node(const equations *e, const node *at) {
  ric_ritz *r = e->r;
  ritz_functions_at(r, e->w * e->period * at->lever, r->cosine, r->sine);
  for (size_t j = 0; j < r->coordinates; j++) {
    const double *f = j == r->hit ? r->cosine : at->psi, *c = e->c + j * e->width;
    double frequency = j == r->hit ? e->w : two_pi / e->period;
    r->q[j] = dot(c, f, e->width);
    r->bend[j] = 0;
    for (size_t m = 0; m < e->width; m++)
      r->bend[j] -= ritz_number(r, m) * ritz_number(r, m) * c[m] * f[m];
    r->bend[j] *= frequency * frequency;
  }
  ric_lattice_acceleration(e->lattice, 0, r->q, r->nothing, r->rate);
}

static void project(const equations *e, const node *at) {
  const ric_ritz *r = e->r;
  for (size_t j = 0; j < r->coordinates; j++) {
    double left = at->weight * (r->bend[j] - r->rate[j]), *F = e->F + j * e->width;
    for (size_t m = 0; m < e->width; m++)
      F[m] += left * at->psi[m];
  }
}

/* Entries of J: equations of coordinate j by the coefficients of coordinate k. */
static void project_block(const equations *e, const node *at, size_t j, size_t k) {
  const ric_ritz *r = e->r;
  const double *f = k == r->hit ? r->cosine : at->psi;
  double pull = r->stiffness[j * r->coordinates + k], frequency = k == r->hit ? e->w : two_pi / e->period;
  double square = j == k ? frequency * frequency : 0;
  if (pull == 0 && j != k)
    return;
  for (size_t l = 0; l < e->width; l++) {
    double *row = e->J + (j * e->width + l) * e->unknowns + k * e->width, project = at->weight * at->psi[l];
    for (size_t m = 0; m < e->width; m++)
      row[m] -= project * (square * ritz_number(r, m) * ritz_number(r, m) + pull) * f[m];
  }
}

static hit_slopes slopes_of_hit(const equations *e, const node *at) {
  const ric_ritz *r = e->r;
  const double *a = e->c + r->hit * e->width;
  double by_phase = 0, bend = 0, bend_by_phase = 0, w = e->w; /* bend: over w^2 */
  for (size_t m = 0; m < e->width; m++) {
    double number = ritz_number(r, m);
    by_phase -= number * a[m] * r->sine[m];
    bend -= number * number * a[m] * r->cosine[m];
    bend_by_phase += w * w * number * number * number * a[m] * r->sine[m];
  }
  return (hit_slopes){.q_w = e->period * at->lever * by_phase,
                      .q_period = w * at->lever * by_phase,
                      .bend_w = 2 * w * bend + e->period * at->lever * bend_by_phase,
                      .bend_period = w * at->lever * bend_by_phase};
}

/* Derivatives by w and by the period. */
static void project_slopes(const equations *e, const node *at) {
  const ric_ritz *r = e->r;
  const hit_slopes s = slopes_of_hit(e, at);
  for (size_t j = 0; j < r->coordinates; j++) {
    double pull = r->stiffness[j * r->coordinates + r->hit];
    double by_w = (j == r->hit ? s.bend_w : 0) - pull * s.q_w;
    double by_period = (j == r->hit ? s.bend_period : -2 / e->period * r->bend[j]) - pull * s.q_period;
    for (size_t l = 0; l < e->width; l++) {
      size_t row = j * e->width + l;
      double project = at->weight * at->psi[l];
      e->J[row * e->unknowns + e->unknowns - 1] += project * by_w;
      if (e->F_period)
        e->F_period[row] += project * by_period;
    }
  }
}

static void project_derivatives(const equations *e, const node *at) {
  ric_ritz *r = e->r;
  size_t n = r->coordinates;
  const tangents unit = {.columns = n, .q = r->unit, .u = r->nothing};
  lattice_tangent(e->lattice, r->q, &unit, r->stiffness);
  for (size_t j = 0; j < n; j++)
    for (size_t k = 0; k < n; k++)
      project_block(e, at, j, k);
  project_slopes(e, at);
}

/* The equation q_k(0) = b. */
static void contact_equation(const equations *e) {
  ric_ritz *r = e->r;
  const double *a = e->c + r->hit * e->width;
  size_t last = e->unknowns - 1;
  double by_phase = 0;
  ritz_functions_at(r, e->w * e->period / 2, r->cosine, r->sine);
  e->F[last] = dot(a, r->cosine, e->width) - r->system->obstacles[r->obstacle].position;
  if (!e->J)
    return;
  for (size_t m = 0; m < e->width; m++) {
    e->J[last * e->unknowns + r->hit * e->width + m] = r->cosine[m];
    by_phase -= ritz_number(r, m) * a[m] * r->sine[m];
  }
  e->J[last * e->unknowns + last] = by_phase * e->period / 2;
  if (e->F_period)
    e->F_period[last] = by_phase * e->w / 2;
}

ric_status ric_ritz_residual(ric_ritz *r, const double *c, double period, double *F, double *J, double *F_period,
                             ric_error *error) {
  REQUIRE(error, {"ritz", r}, {"c", c}, {"F", F});
  RIC_TRY(ritz_check_system(r, error));
  RIC_TRY(ritz_check_numbers(r, c, period, error));
  const equations e = {.r = r,
                       .lattice = lattice_system_lattice(r->system),
                       .c = c,
                       .w = ritz_frequency(r, c),
                       .period = period,
                       .width = ritz_width(r),
                       .unknowns = ric_ritz_unknowns(r),
                       .F = F,
                       .J = J,
                       .F_period = J ? F_period : NULL};
  memset(F, 0, e.unknowns * sizeof *F);
  if (J)
    memset(J, 0, e.unknowns * e.unknowns * sizeof *J);
  if (e.F_period)
    memset(F_period, 0, e.unknowns * sizeof *F_period);
  for (size_t p = 0; p < r->points; p++) {
    const node at = {.psi = r->psi + p * r->stride, .weight = r->weight[p], .lever = 0.5 - r->tau[p]};
    evaluate_node(&e, &at);
    project(&e, &at);
    if (J)
      project_derivatives(&e, &at);
  }
  contact_equation(&e);
  return RIC_OK;
}
