/* The flow of CVODES: for every system, on the state (q, u). */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cvodes_solver.h"
#include "flow_method.h"
#include "model/tangent.h"

typedef struct cvodes_flow {
  ric_flow base;
  cvodes_solver solver;
  int direction; /* of time since the last restart */
  bool restart;  /* the solver knows nothing of the present state */
  bool whole;    /* the solver stands at the end of the step */
  bool callback_failed;
  double *coef; /* [CVODES_ORDER + 1][n + m] of the step */
  int degree;
  double *work;        /* of system_tangent, and d and d_rate; NULL: no tangent vectors have been carried */
  tangents d, d_rate;  /* [n + m][columns] work; d_rate: on a step lost in the rounding of time, the rates there */
  const char *trouble; /* of the last transport, for the next step to tell */
} cvodes_flow;

static const char *rate(void *user, double t, const double *y, double *y_rate) {
  cvodes_flow *f = user;
  const ric_system *s = f->base.system;
  size_t n = s->coordinates, size = n + s->speeds;
  f->base.counts.force_evaluations++;
  const char *trouble = s->model->rate(s, f->base.contact, t, y, y + n, y_rate, y_rate + n);
  f->callback_failed = trouble != NULL;
  for (size_t i = 0; i < size && !trouble; i++)
    if (!isfinite(y_rate[i]))
      trouble = "the rates are not finite: the motion blows up";
  return trouble;
}

/* The tangent vectors of CVODES, one after the other, to and from those of the library, side by side. */
static void gather(double *const *columns, size_t size, const tangents *d) {
  for (size_t i = 0; i < size; i++)
    for (size_t k = 0; k < d->columns; k++)
      d->q[i * d->columns + k] = columns[k][i];
}

static void scatter(const tangents *d, size_t size, double *const *columns) {
  for (size_t i = 0; i < size; i++)
    for (size_t k = 0; k < d->columns; k++)
      columns[k][i] = d->q[i * d->columns + k];
}

static const char *tangent_rate(void *user, double t, const double *y, double *const *d, double *const *d_rate) {
  cvodes_flow *f = user;
  const ric_system *s = f->base.system;
  size_t n = s->coordinates, size = n + s->speeds;
  gather(d, size, &f->d);
  const char *trouble = system_tangent(s, f->base.contact, t, y, y + n, &f->d, &f->d_rate, f->work);
  f->callback_failed = trouble != NULL;
  scatter(&f->d_rate, size, d_rate);
  return trouble;
}

static ric_status carry(ric_flow *flow, ric_error *error) {
  cvodes_flow *f = (cvodes_flow *)flow;
  size_t n = flow->system->coordinates, size = n + flow->system->speeds, columns = flow->tangent.columns;
  RIC_TRY(cvodes_solver_carry(&f->solver, columns, error));
  if (columns == 0 || (f->work && columns == f->d.columns))
    return RIC_OK;
  free(f->work);
  f->work = malloc((system_tangent_work(flow->system) + 2 * size * columns) * sizeof *f->work);
  if (!f->work)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors of %zu numbers", columns, size);
  double *d = f->work + system_tangent_work(flow->system), *d_rate = d + size * columns;
  f->d = (tangents){.columns = columns, .q = d, .u = d + n * columns};
  f->d_rate = (tangents){.columns = columns, .q = d_rate, .u = d_rate + n * columns};
  return RIC_OK;
}

static void transport(ric_flow *flow, double x) {
  cvodes_flow *f = (cvodes_flow *)flow;
  size_t size = flow->system->coordinates + flow->system->speeds, columns = flow->tangent.columns;
  if (f->whole) {
    f->trouble = cvodes_tangents_at(&f->solver, x);
    for (size_t k = 0; k < columns; k++)
      for (size_t i = 0; i < size; i++)
        flow->tangent.q[i * columns + k] = f->trouble ? NAN : cvodes_solver_tangent(&f->solver, k)[i];
    return;
  }
  for (size_t i = 0; i < size * columns; i++)
    flow->tangent.q[i] += x * flow->length * f->d_rate.q[i];
}

static ric_status start(ric_flow *flow, ric_error *error) {
  cvodes_flow *f = (cvodes_flow *)flow;
  f->restart = true;
  f->trouble = NULL;
  return flow->tangent.columns == 0 ? cvodes_solver_carry(&f->solver, 0, error) : RIC_OK;
}

/* The solver at the flow's state, when it is not there yet or time is to turn round. */
static const char *catch_up(cvodes_flow *f, double stop) {
  ric_flow *flow = &f->base;
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  int direction = stop > flow->time ? 1 : -1;
  if (!f->restart && f->direction == direction)
    return NULL;
  double *y = cvodes_solver_state(&f->solver);
  memcpy(y, flow->q, n * sizeof *y);
  memcpy(y + n, flow->u, m * sizeof *y);
  size_t columns = flow->tangent.columns;
  for (size_t k = 0; k < columns; k++)
    for (size_t i = 0; i < n + m; i++)
      cvodes_solver_tangent(&f->solver, k)[i] = flow->tangent.q[i * columns + k];
  f->direction = direction;
  return cvodes_solver_restart(&f->solver, flow->time);
}

/* A way to `stop` that is lost in the rounding of time: straight on. */
static const char *creep(cvodes_flow *f, double stop) {
  ric_flow *flow = &f->base;
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  double *slope = f->coef + n + m;
  memcpy(f->coef, flow->q, n * sizeof *slope);
  memcpy(f->coef + n, flow->u, m * sizeof *slope);
  const char *trouble = rate(f, flow->time, f->coef, slope);
  for (size_t i = 0; i < n + m; i++)
    slope[i] *= stop - flow->time;
  if (!trouble && flow->tangent.columns > 0)
    trouble =
        system_tangent(flow->system, flow->contact, flow->time, flow->q, flow->u, &flow->tangent, &f->d_rate, f->work);
  f->degree = 1;
  flow->length = stop - flow->time;
  flow->end = stop;
  return trouble;
}

static const char *advance(cvodes_flow *f, double stop) {
  ric_flow *flow = &f->base;
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  double t = flow->time;
  const char *trouble = catch_up(f, stop);
  if (!trouble)
    trouble = cvodes_solver_step(&f->solver, stop, &t);
  if (trouble)
    return trouble;
  f->degree = cvodes_solver_polynomial(&f->solver, f->coef);
  if (f->degree < 0)
    return "CVODES gives no polynomial for its step";
  memcpy(f->coef, flow->q, n * sizeof *flow->q); /* equal up to rounding: pieces join exactly */
  memcpy(f->coef + n, flow->u, m * sizeof *flow->u);
  flow->length = f->solver.end - f->solver.begin;
  flow->end = t;
  f->whole = true;
  return NULL;
}

static ric_status step(ric_flow *flow, double stop, ric_error *error) {
  cvodes_flow *f = (cvodes_flow *)flow;
  double span = f->restart ? 0 : cvodes_solver_span(&f->solver);
  bool lost = fabs(stop - flow->time) <= 256 * DBL_EPSILON * fmax(span, fmax(fabs(stop), fabs(flow->time)));
  f->solver.trouble_time = flow->time;
  f->whole = f->callback_failed = false;
  const char *trouble = f->trouble ? f->trouble : lost ? creep(f, stop) : advance(f, stop);
  f->restart = true; /* unless the whole step is accepted */
  if (!trouble)
    return RIC_OK;
  flow->length = 0;
  flow->end = flow->time;
  return ric_fail(error, f->callback_failed ? RIC_ECALLBACK : RIC_ENUMERIC, "at t = %.10g: %s", f->solver.trouble_time,
                  trouble);
}

static ric_segment piece(ric_flow *flow, size_t index) {
  const cvodes_flow *f = (const cvodes_flow *)flow;
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  (void)index; /* there is one */
  return (ric_segment){.coordinates = n,
                       .speeds = m,
                       .stride = n + m,
                       .degree = f->degree,
                       .start = flow->time,
                       .length = flow->length,
                       .coef = f->coef};
}

static void accept(ric_flow *flow, double x) {
  cvodes_flow *f = (cvodes_flow *)flow;
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  if (x == 1 && f->whole) {
    const double *y = cvodes_solver_state(&f->solver);
    memcpy(flow->q, y, n * sizeof *y);
    memcpy(flow->u, y + n, m * sizeof *y);
    f->restart = false;
    return;
  }
  ric_segment segment = piece(flow, 0);
  ric_segment_state(&segment, x, flow->q, m ? flow->u : NULL);
}

static void destroy(ric_flow *flow) {
  cvodes_flow *f = (cvodes_flow *)flow;
  cvodes_solver_clear(&f->solver);
  free(f->coef);
  free(f->work);
  flow_clear(flow);
  free(f);
}

static const flow_method method = {.start = start,
                                   .step = step,
                                   .piece = piece,
                                   .accept = accept,
                                   .carry = carry,
                                   .transport = transport,
                                   .destroy = destroy};

static ric_status allocate(cvodes_flow *f, const ric_system *system, const ric_flow_options *options,
                           ric_error *error) {
  size_t n = system->coordinates, m = system->speeds;
  RIC_TRY(flow_init(&f->base, &method, system, options, error));
  f->solver = (cvodes_solver){
      .size = n + m, .tolerance = options->tolerance, .rate = rate, .tangent_rate = tangent_rate, .user = f};
  f->restart = true;
  f->coef = calloc(CVODES_ORDER + 1, (n + m) * sizeof *f->coef);
  if (!f->coef)
    return ric_fail(error, RIC_ENOMEM, "no memory for the polynomials of %zu numbers", n + m);
  return cvodes_solver_init(&f->solver, options->longest_step, error);
}

ric_status cvodes_flow_create(const ric_system *system, const ric_flow_options *options, ric_flow **flow,
                              ric_error *error) {
  *flow = NULL;
  cvodes_flow *f = calloc(1, sizeof *f);
  if (!f)
    return ric_fail(error, RIC_ENOMEM, "no memory for a flow");
  ric_status status = allocate(f, system, options, error);
  if (status == RIC_OK)
    *flow = &f->base;
  else
    destroy(&f->base);
  return status;
}
