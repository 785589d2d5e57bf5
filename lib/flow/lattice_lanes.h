/* Propagation of tangent vectors of a lattice through a step in SIMD lanes: internal to lattice_variation.c, which
 * includes this file once for each width.
 *
 *   LANE      a number or a vector of numbers with the operators of one LANES     how many NAMED(f)  the name of a
 *   function of this width
 *
 * Two levels are computed at a time, since the varying forces of both are known: this hides the latency of their sums.
 * Rows 0 and n + 1 of levels are the neighbours of the ends. */

static inline LANE *NAMED(level)(const lattice_variation *v, int j) {
  return (LANE *)v->levels + (size_t)(j % LEVELS) * (v->n + 2);
}

/* Neighbours of the first and the last row. */
RIC_INLINE void NAMED(close)(const lattice_variation *v, LANE *c) {
  const LANE wall = {0};
  *(c - 1) = v->ring ? c[v->n - 1] : wall;
  c[v->n] = v->ring ? c[0] : wall;
}

/* Forces j and j + 1 of springs, interleaved. */
typedef struct NAMED(force_pair) {
  LANE low, high;
} NAMED(force_pair);

/* Sums of k_{j-l} e_l and k_{j+1-l} e_l, l < count. */
RIC_INLINE void NAMED(products)(const double *k, const LANE *e, int j, int count, NAMED(force_pair) * sum) {
  LANE even_low = {0}, even_high = {0}, odd_low = {0}, odd_high = {0};
  int l = 0;
  for (; l + 1 < count; l += 2) {
    even_low += k[j - l] * e[l];
    even_high += k[j + 1 - l] * e[l];
    odd_low += k[j - l - 1] * e[l + 1];
    odd_high += k[j - l] * e[l + 1];
  }
  if (l < count) {
    even_low += k[j - l] * e[l];
    even_high += k[j + 1 - l] * e[l];
  }
  sum->low = even_low + odd_low;
  sum->high = even_high + odd_high;
}

/* Extension of a spring in a level. */
RIC_INLINE void NAMED(stretch)(const varying_spring *s, const LANE *c, LANE *e) {
  const LANE nothing = {0};
  *e = (s->to != NO_PARTICLE ? c[s->to + 1] : nothing) - (s->from != NO_PARTICLE ? c[s->from + 1] : nothing);
}

/* Varying forces j and j + 1; the last levels are added last, to shorten the chain of dependences. */
RIC_INLINE void NAMED(raise_springs)(const lattice_variation *v, int j) {
  size_t levels = (size_t)v->order + 1;
  const LANE *low = NAMED(level)(v, j), *high = NAMED(level)(v, j + 1);
  NAMED(force_pair) *force = (NAMED(force_pair) *)v->force, sum;
  LANE *e = (LANE *)v->stretch, first, second; /* kept in registers, not reloaded */
  const double *k = v->k;
  for (size_t i = 0; i < v->count; i++, e += levels, k += levels) {
    NAMED(stretch)(&v->varying[i], low, &first);
    NAMED(stretch)(&v->varying[i], high, &second);
    NAMED(products)(k, e, j, j, &sum);
    force[i].low = sum.low + k[0] * first;
    force[i].high = sum.high + (k[1] * first + k[0] * second);
    e[j] = first;
    e[j + 1] = second;
  }
}

/* A row of a stencil. */
RIC_INLINE void NAMED(weigh)(const stencil *s, size_t i, const LANE *c, LANE *value) {
  *value = s->own[i] * c[0] + (s->left[i] * *(c - 1) + s->right[i] * c[1]);
}

/* Row i of level j + 2 and, with `both`, of the next one, independently; `high`: the first one is the second of the
 * levels whose varying forces are known. */
RIC_INLINE void NAMED(raise_row)(const lattice_variation *v, int j, bool high, bool both, size_t i, LANE *row) {
  const NAMED(force_pair) *force = (const NAMED(force_pair) *)v->force;
  const LANE *c = NAMED(level)(v, j) + 1 + i, *d = NAMED(level)(v, j + 1) + 1 + i;
  LANE damping;
  NAMED(weigh)(&v->springs, i, c, &row[0]);
  if (both)
    NAMED(weigh)(&v->springs, i, d, &row[1]);
  if (v->damped) {
    NAMED(weigh)(&v->dampers, i, d, &damping);
    row[0] += (j + 1) / v->length * damping;
  }
  for (size_t k = v->first_pull[i]; k < v->first_pull[i + 1]; k++) {
    const spring_pull *p = &v->pulls[k];
    row[0] += p->weight * (high ? force[p->spring].high : force[p->spring].low);
    if (both)
      row[1] += p->weight * force[p->spring].high;
  }
}

/* One level or two in one pass, added to the sums. */
RIC_INLINE void NAMED(raise_levels)(const lattice_variation *v, int j, bool high, bool both) {
  LANE *low = NAMED(level)(v, j + 2) + 1, *next = NAMED(level)(v, j + 3) + 1;
  LANE *restrict q = (LANE *)v->sum_q, *restrict u = (LANE *)v->sum_u;
  const double low_scale = v->length * v->length / ((j + 1) * (j + 2)), slope = j + 2;
  const double next_scale = v->length * v->length / ((j + 2) * (j + 3)), next_slope = j + 3;
  for (size_t i = 0; i < v->n; i++) {
    LANE row[2] = {0};
    if (!v->still[i])
      NAMED(raise_row)(v, j, high, both, i, row);
    row[0] *= low_scale;
    low[i] = row[0];
    if (both) {
      row[1] *= next_scale;
      next[i] = row[1];
      q[i] += row[0] + row[1];
      u[i] += slope * row[0] + next_slope * row[1];
    } else {
      q[i] += row[0];
      u[i] += slope * row[0];
    }
  }
  NAMED(close)(v, low);
  if (both)
    NAMED(close)(v, next);
}

RIC_INLINE void NAMED(raise)(const lattice_variation *v) {
  for (int j = 0; j + 2 <= v->order; j += 2) {
    bool both = j + 3 <= v->order;
    NAMED(raise_springs)(v, j);
    if (both && !v->damped) {
      NAMED(raise_levels)(v, j, false, true);
      continue;
    }
    NAMED(raise_levels)(v, j, false, false);
    if (both)
      NAMED(raise_levels)(v, j + 1, true, false);
  }
}

/* Some columns of the tangents through the step: `count` of them in lanes, the others zero. */
RIC_INLINE void NAMED(move)(lattice_variation *v, const tangents *d, size_t first, size_t count) {
  size_t n = v->n, columns = d->columns;
  double *c0 = (double *)(NAMED(level)(v, 0) + 1), *c1 = (double *)(NAMED(level)(v, 1) + 1), h = v->length;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < LANES; k++) {
      c0[i * LANES + k] = k < count ? d->q[i * columns + first + k] : 0;
      c1[i * LANES + k] = k < count && !v->still[i] ? h * d->u[i * columns + first + k] : 0;
    }
  for (size_t i = 0; i < n * LANES; i++) {
    v->sum_q[i] = c0[i] + c1[i];
    v->sum_u[i] = c1[i];
  }
  for (int j = 0; j < LEVELS; j++) /* another width had another layout */
    NAMED(close)(v, NAMED(level)(v, j) + 1);
  NAMED(raise)(v);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < count; k++) {
      d->q[i * columns + first + k] = v->sum_q[i * LANES + k];
      d->u[i * columns + first + k] = v->sum_u[i * LANES + k] / h;
    }
}
