#include "predictor.h"

#include <string.h>

/* What the polynomial runs over: p, which natural steps give; else arclength, in which a circle is as smooth as can be.
 * (Over the progress its sixth derivative is 45 times as large.) */
static double place_of(const ric_curve *c, const curve_node *node) {
  size_t n = c->problem.unknowns;
  return c->options.natural ? c->row[n] * (node->x[n] - c->from.x[n]) : node->arclength - c->from.arclength;
}

static double scale_of(const ric_curve *c, const curve_node *node) {
  return c->options.natural ? 1 / curve_row_dot(c, c->row, node->t) : 1;
}

/* Hermite's polynomial through the last points along their tangents, by its basis. */
static void extrapolate(const ric_curve *c, size_t count, double h, double *x) {
  const curve_node *nodes[1 + CURVE_PAST] = {&c->from};
  double at[1 + CURVE_PAST] = {0};
  for (size_t k = 1; k < count; k++) {
    nodes[k] = &c->past[k - 1];
    at[k] = place_of(c, nodes[k]);
  }
  memset(x, 0, c->linear.size * sizeof *x);
  for (size_t k = 0; k < count; k++) {
    double l = 1, slope = 0, ahead = h - at[k];
    for (size_t j = 0; j < count; j++)
      if (j != k) {
        l *= (h - at[j]) / (at[k] - at[j]);
        slope += 1 / (at[k] - at[j]);
      }
    double of_x = (1 - 2 * slope * ahead) * l * l, of_t = ahead * l * l * scale_of(c, nodes[k]);
    for (size_t i = 0; i < c->linear.size; i++)
      x[i] += of_x * nodes[k]->x[i] + of_t * nodes[k]->t[i];
  }
}

double predictor_point(ric_curve *c, double h, double *x) {
  extrapolate(c, 1, h, x);
  double change = h, rounding = c->options.newton_tol * (1 + curve_norm(c, x));
  size_t count = 1;
  for (; count <= c->pasts; count++) {
    double before = change;
    extrapolate(c, count + 1, h, c->z);
    change = curve_distance(c, c->z, x);
    if (!(change > rounding && change < before / 2))
      break;
    memcpy(x, c->z, c->linear.size * sizeof *x);
  }
  return c->options.natural || count == 1 ? h : curve_progress(c, x);
}

/* The nodes change places; nothing is copied. */
void predictor_advance(ric_curve *c, bool keep) {
  curve_node oldest = c->past[CURVE_PAST - 1];
  for (size_t k = CURVE_PAST - 1; k > 0; k--)
    c->past[k] = c->past[k - 1];
  c->past[0] = c->from;
  c->from = c->to;
  c->to = oldest;
  c->pasts = !keep ? 0 : c->pasts < CURVE_PAST ? c->pasts + 1 : CURVE_PAST;
}
