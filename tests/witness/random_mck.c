#include "random_mck.h"

/* shift I + scale G^T G / n. */
static void definite(random_source *source, size_t n, double shift, double scale, double *a) {
  double g[RANDOM_MCK_MOST * RANDOM_MCK_MOST];
  for (size_t e = 0; e < n * n; e++)
    g[e] = random_uniform(source, -1, 1);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      double sum = 0;
      for (size_t k = 0; k < n; k++)
        sum += g[k * n + i] * g[k * n + j];
      a[i * n + j] = scale * sum / (double)n + (i == j ? shift : 0);
    }
}

void random_mck_make(random_mck *m, size_t n, int diagonal, random_source *source) {
  m->n = n;
  definite(source, n, 0.5, 1, m->mass);
  definite(source, n, 0, 0.2, m->damping);
  definite(source, n, 0.3, 3, m->stiffness);
  for (size_t e = 0; diagonal && e < n * n; e++)
    m->mass[e] = e / n == e % n ? m->mass[e] : 0;
  for (size_t i = 0; i < n; i++) {
    m->force_cos[i] = random_uniform(source, -1, 1);
    m->force_sin[i] = random_uniform(source, -1, 1);
  }
  m->model = (ric_mck){.coordinates = n,
                       .mass.values = m->mass,
                       .damping.values = m->damping,
                       .stiffness.values = m->stiffness,
                       .frequency = random_uniform(source, 0.5, 2),
                       .force_cos = m->force_cos,
                       .force_sin = m->force_sin};
}

ric_matrix random_sparse_of(random_sparse *sparse, const double *dense, size_t n) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    sparse->row_start[i] = count;
    for (size_t j = 0; j < n; j++)
      if (dense[i * n + j] != 0) {
        sparse->values[count] = dense[i * n + j];
        sparse->column[count++] = j;
      }
  }
  sparse->row_start[n] = count;
  return (ric_matrix){.values = sparse->values, .row_start = sparse->row_start, .column = sparse->column};
}

void random_state(random_source *source, size_t n, double *q, double *u) {
  for (size_t i = 0; i < n; i++) {
    q[i] = random_uniform(source, -1, 1);
    u[i] = random_uniform(source, -1, 1);
  }
}
