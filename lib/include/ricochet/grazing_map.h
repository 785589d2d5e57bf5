/* The return map near a grazing bifurcation, a Poincare map with a square-root singularity. On a section, with the
 * periodic motion at 0 and the minimum eta z - d of the gap,
 *
 *   z -> L z                                               where eta z >  d: no impact,
 *   z -> s sqrt(d - eta z) xi + L z + (d - eta z) kappa    where eta z <= d: an impact,          [FN97] (5.11)
 *
 * s = sqrt(2 A_g). For d > 0 the motion would penetrate the obstacle by d if the obstacle were absent; before grazing d
 * <= 0. K(z, d) of the source, of first order and equal to L z where eta z = d, is L z + (d - eta z) kappa with one
 * vector kappa: no other map is linear and continuous.
 *
 * One-impact orbits of period n in closed form. With y = sqrt(d - eta z) at the impact and r = L^(n-1),
 *
 *   z = (I - L^n)^-1 r (y s xi + y^2 kappa),     d = y^2 (1 + k) + y s p,
 *   p = eta (I - L^n)^-1 r xi,   k = eta (I - L^n)^-1 r kappa,
 *
 * explicit in y. The iterate j after the impact has eta z_j - d = y (a_j + b_j y),
 *
 *   a_j = s eta (I - L^n)^-1 (L^(j-1) - r) xi,     b_j = eta (I - L^n)^-1 (L^(j-1) - r) kappa - 1,
 *
 * and reaches the border (border collision) where y = -a_j / b_j. The derivative of the n-th iterate, L^n - r ((s / 2y)
 * xi + kappa) eta, is L^n plus a matrix of rank one: it has the multiplier -1 where (s / 2y) eta (I + L^n)^-1 r xi +
 * eta (I + L^n)^-1 r kappa = 1, and +1 where s p / (2y) + k = -1, the fold of d(y). */
#ifndef RICOCHET_GRAZING_MAP_H
#define RICOCHET_GRAZING_MAP_H

#include <stdbool.h>
#include <stddef.h>

#include "multipliers.h"

RIC_BEGIN_DECLARATIONS

/** Coefficients of the map. ric_grazing_map_init allocates the arrays, ric_grazing_map_clear frees them. The caller, or
 *  ric_grazing_section, fills the arrays; do not replace the pointers. */
typedef struct ric_grazing_map {
  size_t size;                /* of z, >= 1 */
  double *L;                  /* [size][size] row-major */
  double *eta;                /* [size] */
  double *xi;                 /* [size] */
  double *kappa;              /* [size] */
  double stretch;             /* s > 0 */
  double eta_error, xi_error; /* how far an entry of eta, of xi may be off; 0: not by more than rounding of its own. An
                                 entry that is zero by symmetry is what cancels, and says nothing of its error */
} ric_grazing_map;

/** Allocates a map of this size, all zero except stretch = 1. @returns RIC_EINVAL for a size of 0; RIC_ENOMEM: nothing
 *  to clear then. */
RIC_API ric_status ric_grazing_map_init(ric_grazing_map *map, size_t size, ric_error *error);
RIC_API void ric_grazing_map_clear(ric_grazing_map *map);

/** @returns RIC_EINVAL naming the entry that is not finite, a stretch that is not positive, and eta or xi = 0. */
RIC_API ric_status ric_grazing_map_check(const ric_grazing_map *map, ric_error *error);

/** The example (6.1)-(6.5) of [FN97], initialised with size 3: L = diag(lambda, rotation by a right angle times
 *  omega), eta = (1, 0, 0), xi = (1, 1, 1), kappa = (lambda + 3, -5, 7), stretch 1.
 *  @param lambda, omega  finite; the source has 0 < |omega| < lambda < 1
 *  @returns RIC_EINVAL; RIC_ENOMEM: nothing to clear then */
RIC_API ric_status ric_grazing_map_example(ric_grazing_map *map, double lambda, double omega, ric_error *error);

/** Whether z has an impact: eta z <= d. @param z  [size] */
RIC_API bool ric_grazing_map_hits(const ric_grazing_map *map, double d, const double *z);

/** One iterate. @param z [size] @param next [size], not z; all NaN if d or an entry of z is */
RIC_API void ric_grazing_map_step(const ric_grazing_map *map, double d, const double *z, double *next);

/** Derivative of the iterate by z: L without an impact, else L - ((s / 2 sqrt(d - eta z)) xi + kappa) eta: entries with
 *  xi_i eta_j other than 0 are infinite at eta z = d, on the side of the impact.
 *  @param derivative  [size][size] row-major */
RIC_API void ric_grazing_map_derivative(const ric_grazing_map *map, double d, const double *z, double *derivative);

/** N(z) of [FN97] section 5: number of iterates without an impact between the impact of z and the next one; 0 if the
 *  next iterate has an impact.
 *  @param z  [size]; set to the state with the next impact
 *  @param most  iterates to try
 *  @param work  [size] overwritten
 *  @param count  set
 *  @returns RIC_EINVAL for a z without an impact; RIC_ENUMERIC if none follows within `most` iterates: z is then the
 *           last one and the count `most`. */
RIC_API ric_status ric_grazing_map_return(const ric_grazing_map *map, double d, double *z, size_t most, double *work,
                                          size_t *count, ric_error *error);

/** The one-dimensional limit map (5.14) of delta = eta z / d <= 1 from impact to impact,
 *  delta -> rho lambda^N sqrt(1 - delta), with the first N >= 0 for which the result is <= 1: the N of
 *  ric_grazing_map_return as d tends to 0. Its fixed points with N >= 1, orbits of period N + 1, lie in lambda < delta
 *  < 1 and have the derivative -delta / (2 (1 - delta)): they are stable up to delta = 2/3. So none is stable for
 *  lambda > 2/3; for smaller lambda they are stable in windows of rho from lambda^(1-N) / sqrt(1 - lambda) to lambda^-N
 *  2 / sqrt 3, which overlap for lambda < 1/4.
 *  @param rho  alpha sqrt(2 A_g / d) > 0; alpha is ric_grazing_criterion's
 *  @param lambda  in (0, 1)
 *  @param count  set to N; may be NULL
 *  @returns the next delta; NaN for arguments out of range */
RIC_API double ric_grazing_limit_map(double rho, double lambda, double delta, size_t *count);

/** A one-impact orbit of period n. */
typedef struct ric_grazing_cycle {
  size_t period;       /* n */
  double y;            /* sqrt(d - eta z) > 0 at the impact */
  double d;            /* at which it exists */
  bool admissible;     /* the other n - 1 iterates have no impact */
  size_t nearest;      /* iterate 1 .. n-1 after the impact nearest to the border: smallest eta z_j - d; 0 if n = 1 */
  double clearance;    /* eta z_j - d of it; INFINITY if n = 1 */
  ric_complex largest; /* multiplier of the largest modulus; of a pair the one with im > 0 */
  bool stable;         /* all multipliers inside the unit circle */
} ric_grazing_cycle;

/** The orbit of period n for a y.
 *  @param z  [size] at the impact, set; may be NULL
 *  @returns RIC_EINVAL for n = 0, n > 10000, y <= 0, and as ric_grazing_map_check; RIC_ENUMERIC where I - L^n
 *           is singular or a number overflows; RIC_ENOMEM. */
RIC_API ric_status ric_grazing_cycle_at(const ric_grazing_map *map, size_t period, double y, ric_grazing_cycle *cycle,
                                        double *z, ric_error *error);

/** All orbits of period n at a d of any sign: at most two, the one with the smaller y first.
 *  @param cycles  [2]  @param count  set  @returns as ric_grazing_cycle_at; RIC_EINVAL for a d that is not finite */
RIC_API ric_status ric_grazing_cycles(const ric_grazing_map *map, size_t period, double d, ric_grazing_cycle *cycles,
                                      size_t *count, ric_error *error);

/** What ends a window of d. */
#define RIC_GRAZING_EDGE_LIST(X)                                                                                       \
  X(RIC_EDGE_BORDER, "border")   /* another iterate reaches the border: border collision */                            \
  X(RIC_EDGE_FLIP, "flip")       /* a multiplier is -1: period doubling */                                             \
  X(RIC_EDGE_FOLD, "fold")       /* a multiplier is +1: two orbits merge */                                            \
  X(RIC_EDGE_COMPLEX, "complex") /* a complex pair leaves the unit circle: Neimark-Sacker; located to 1e-12 */         \
  X(RIC_EDGE_ZERO, "zero")       /* y = 0, d = 0 */                                                                    \
  X(RIC_EDGE_OPEN, "open")       /* none: the window is unbounded; y and d are infinite */

typedef enum ric_grazing_edge_kind {
#define X(name, text) name,
  RIC_GRAZING_EDGE_LIST(X)
#undef X
      RIC_GRAZING_EDGES
} ric_grazing_edge_kind;

typedef struct ric_grazing_edge {
  ric_grazing_edge_kind kind;
  double d, y;
  size_t iterate; /* of RIC_EDGE_BORDER: its index, 1 .. n-1; else 0 */
} ric_grazing_edge;

/** Name of an edge, "border". Never NULL. */
RIC_API const char *ric_grazing_edge_name(ric_grazing_edge_kind kind);

/** The window of a period: where its one-impact orbit is admissible and stable. */
typedef struct ric_grazing_window {
  size_t period;
  bool exists;
  ric_grazing_edge low, high; /* in d, low.d < high.d; undefined unless it exists */
} ric_grazing_window;

/** Computes the window. The orbits are admissible on at most one interval of y, which is cut where multipliers lie on
 *  the unit circle and at the fold of d. If several of the pieces are stable, the window is the widest in ln |d|; of
 *  those that reach d = 0, the one of the smallest y. Edges are exact to rounding, except for complex pairs. Windows of
 *  long periods whose d is below the smallest double are not found.
 *  @returns as ric_grazing_cycle_at; also RIC_ENUMERIC if I + L^n is singular */
RIC_API ric_status ric_grazing_window_find(const ric_grazing_map *map, size_t period, ric_grazing_window *window,
                                           ric_error *error);

RIC_END_DECLARATIONS

#endif
