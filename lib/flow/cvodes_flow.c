/* The flow of CVODES: for every system, on the state (q, u). */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cvodes_solver.h"
#include "flow_method.h"

typedef struct cvodes_flow {
  ric_flow base;
  cvodes_solver solver;
  int direction; /* of time since the last restart */
  bool restart;  /* the solver knows nothing of the present state */
  bool whole;    /* the solver stands at the end of the step */
  bool callback_failed;
  double *coef; /* [CVODES_ORDER + 1][n + m] of the step */
  int degree;
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

static ric_status start(ric_flow *flow, ric_error *error) {
  (void)error;
  ((cvodes_flow *)flow)->restart = true;
  return RIC_OK;
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
  const char *trouble = lost ? creep(f, stop) : advance(f, stop);
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
  flow_clear(flow);
  free(f);
}

static const flow_method method = {.start = start, .step = step, .piece = piece, .accept = accept, .destroy = destroy};

static ric_status allocate(cvodes_flow *f, const ric_system *system, const ric_flow_options *options,
                           ric_error *error) {
  size_t n = system->coordinates, m = system->speeds;
  RIC_TRY(flow_init(&f->base, &method, system, options, error));
  f->solver = (cvodes_solver){.size = n + m, .tolerance = options->tolerance, .rate = rate, .user = f};
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
