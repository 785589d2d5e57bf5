/* The ring with images, and the modal transform of a chain on it. */
#include "image_ring.h"

#include <fftw3.h>
#include <limits.h>
#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

size_t image_ring_sites(const ric_chain *chain) {
  switch (chain->ends) {
  case RIC_ENDS_FIXED:
    return 2 * (chain->particles + 1);
  case RIC_ENDS_FREE:
    return 2 * chain->particles;
  case RIC_ENDS_PERIODIC:
    break;
  }
  return chain->particles;
}

double image_ring_gamma(const ric_chain *chain) {
  return chain->ends == RIC_ENDS_PERIODIC && chain->particles == 2 ? chain->gamma / 2 : chain->gamma;
}

double image_ring_value(const ric_chain *chain, const double *x, ptrdiff_t i) {
  ptrdiff_t n = (ptrdiff_t)chain->particles, sites = (ptrdiff_t)image_ring_sites(chain);
  i %= sites;
  if (i < 0)
    i += sites;
  if (i < n)
    return x[i];
  if (chain->ends == RIC_ENDS_FREE)
    return x[2 * n - 1 - i];
  return i == n || i == 2 * n + 1 ? 0 : -x[2 * n - i];
}

static double at_distance(const double *kernel, size_t sites, size_t d) {
  d %= sites;
  return kernel[2 * d <= sites ? d : sites - d];
}

double image_ring_entry(const ric_chain *chain, const double *kernel, size_t k, size_t l) {
  size_t sites = image_ring_sites(chain);
  double direct = at_distance(kernel, sites, k > l ? k - l : l - k);
  switch (chain->ends) {
  case RIC_ENDS_FIXED:
    return direct - at_distance(kernel, sites, k + l + 2);
  case RIC_ENDS_FREE:
    return direct + at_distance(kernel, sites, k + l + 1);
  case RIC_ENDS_PERIODIC:
    break;
  }
  return direct;
}

/* FFTW ends the program when it gets no memory, also for its buffers during a transform. Before it plans, there must be
 * room for what plans take; and room for its buffers is held, and given back for the time of a transform. Measured for
 * lengths with and without large prime factors: plans take up to 40 bytes per value each and 80 while they are made,
 * transforms up to 64. Short transforms take less than any process has left. */
enum { PLAN_BYTES = 200, BUFFER_BYTES = 72, SHORT = 1 << 14 };

typedef struct transform_room {
  void *bytes; /* NULL: none needed, or just given back */
  size_t size;
} transform_room;

struct lattice_transform {
  size_t sites, length;
  transform_room *room;
  fftw_plan forward, inverse, kernel; /* kernel is NULL on a ring: the inverse of an even spectrum */
};

static bool room_take(transform_room *room) {
  room->bytes = room->size ? malloc(room->size) : NULL;
  return room->bytes || !room->size;
}

static void room_give(transform_room *room) {
  free(room->bytes);
  room->bytes = NULL;
}

size_t lattice_transform_bytes(size_t length) {
  return length < SHORT ? 0 : PLAN_BYTES * length;
}

/* Whether there is room for plans of this length now. */
static bool has_room_for_plans(size_t length) {
  transform_room room = {.size = lattice_transform_bytes(length)};
  const bool has = room_take(&room);
  room_give(&room);
  return has;
}

static void execute(const lattice_transform *t, fftw_plan plan, double *x) {
  room_give(t->room);
  fftw_execute_r2r(plan, x, x);
  (void)room_take(t->room); /* if another thread was faster, the next transform takes its chance */
}

size_t lattice_transform_length(const lattice_transform *t) {
  return t->length;
}

double *lattice_transform_alloc(const lattice_transform *t) {
  double *x = fftw_malloc(t->length * sizeof *x);
  if (x)
    memset(x, 0, t->length * sizeof *x);
  return x;
}

void lattice_transform_free(double *x) {
  fftw_free(x);
}

/* Codelets for any processor: those with vector instructions round otherwise, and FFTW takes what the processor has.
 * For real transforms it takes scalar ones in any case, so this costs nothing. */
static const unsigned plan_flags = FFTW_ESTIMATE | FFTW_NO_SIMD;

/* FFTW's planner keeps what it has learned for all plans of the process, unguarded: one thread plans at a time. Plans
 * are used without it. */
static atomic_flag planning = ATOMIC_FLAG_INIT;

static void lock_planner(void) {
  while (atomic_flag_test_and_set_explicit(&planning, memory_order_acquire))
    thrd_yield();
}

static void unlock_planner(void) {
  atomic_flag_clear_explicit(&planning, memory_order_release);
}

static void make_plans(lattice_transform *t, const ric_chain *chain, double *x) {
  int n = (int)chain->particles;
  fftw_r2r_kind there = FFTW_R2HC, back = FFTW_HC2R;
  if (chain->ends == RIC_ENDS_FIXED)
    there = back = FFTW_RODFT00;
  if (chain->ends == RIC_ENDS_FREE) {
    there = FFTW_REDFT10;
    back = FFTW_REDFT01;
  }
  lock_planner();
  t->forward = fftw_plan_r2r_1d(n, x, x, there, plan_flags);
  t->inverse = fftw_plan_r2r_1d(n, x, x, back, plan_flags);
  if (chain->ends != RIC_ENDS_PERIODIC)
    t->kernel = fftw_plan_r2r_1d((int)(t->sites / 2 + 1), x, x, FFTW_REDFT00, plan_flags);
  unlock_planner();
}

void lattice_transform_destroy(lattice_transform **t) {
  if (!t || !*t)
    return;
  lock_planner();
  fftw_destroy_plan((*t)->forward);
  fftw_destroy_plan((*t)->inverse);
  fftw_destroy_plan((*t)->kernel);
  unlock_planner();
  if ((*t)->room)
    room_give((*t)->room);
  free((*t)->room);
  free(*t);
  *t = NULL;
}

ric_status lattice_transform_create(const ric_chain *chain, lattice_transform **out, ric_error *error) {
  ric_status status = RIC_ENOMEM;
  double *x = NULL;
  lattice_transform *t = calloc(1, sizeof *t);
  if (!t)
    goto out;
  if (chain->particles > INT_MAX / 4) {
    status = RIC_ELIMIT;
    goto out;
  }
  t->sites = image_ring_sites(chain);
  t->length = t->sites / 2 + 1 > chain->particles ? t->sites / 2 + 1 : chain->particles;
  x = lattice_transform_alloc(t);
  t->room = calloc(1, sizeof *t->room);
  if (!x || !t->room || !has_room_for_plans(t->length))
    goto out;
  make_plans(t, chain, x);
  t->room->size = t->length < SHORT ? 0 : BUFFER_BYTES * t->length;
  if (room_take(t->room) && t->forward && t->inverse && (t->kernel || chain->ends == RIC_ENDS_PERIODIC))
    status = RIC_OK;
out:
  lattice_transform_free(x);
  if (status != RIC_OK)
    lattice_transform_destroy(&t);
  *out = t;
  return status == RIC_OK ? RIC_OK
                          : ric_fail(error, status, "cannot plan a transform of %zu particles: %s", chain->particles,
                                     ric_status_text(status));
}

void lattice_transform_forward(const lattice_transform *t, double *x) {
  execute(t, t->forward, x);
}

void lattice_transform_inverse(const lattice_transform *t, double *x) {
  execute(t, t->inverse, x);
}

void lattice_transform_kernel(const lattice_transform *t, double *f) {
  if (t->kernel) {
    execute(t, t->kernel, f); /* f_0 + 2 sum f_j cos + (-1)^d f_{N/2} */
  } else {
    memset(f + t->sites / 2 + 1, 0, (t->length - t->sites / 2 - 1) * sizeof *f);
    lattice_transform_inverse(t, f); /* half-complex: real parts f, imaginary parts 0 */
  }
  for (size_t d = 0; d <= t->sites / 2; d++)
    f[d] /= (double)t->sites;
}

double lattice_transform_unit(const ric_chain *chain, size_t s) {
  double sites = (double)image_ring_sites(chain);
  if (chain->ends == RIC_ENDS_FIXED)
    return sqrt(sites);
  if (chain->ends == RIC_ENDS_FREE)
    return s == 0 ? sqrt(2 * sites) : sqrt(sites);
  if (s == 0 || 2 * s == chain->particles)
    return sqrt(sites);
  return 2 * s < chain->particles ? sqrt(sites / 2) : -sqrt(sites / 2); /* FFTW stores -sin above the middle */
}
