/* The flow of CVODES, for every system: its solver on the state (q, u), tangent vectors, and the flow. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "flow_method.h"
#include "model/system_model.h"
#include "numeric/sundials_context.h"
#include "ricochet/status.h"

/* A thin layer over SUNDIALS CVODES: the only place that uses its interface.
 *
 * Adams formulas of orders 1 to 12 with variable steps; fixed-point iteration for the implicit equations. The local
 * error of a step, in root mean square over the numbers of a state, is below `tolerance` times the root mean square of
 * the state. Functions return NULL or a static text that describes the failure. */

enum { CVODES_ORDER = 12, VECTORS = 3 * CVODES_ORDER /* at least as many as CVODES makes of a state, or tangent */ };

/** Tangent vectors in CVODES' forward sensitivity analysis (staggered, under the error control of the state). */
typedef struct cvodes_tangents {
  size_t columns;   /* allocated, also in CVODES; 0: none */
  bool active;      /* they are integrated */
  N_Vector *vector; /* [columns] */
  SUNNonlinearSolver iteration;
  double *absolute;     /* [columns] tolerances */
  double **d, **d_rate; /* [columns] data of the vectors, for the callback */
} cvodes_tangents;

typedef struct cvodes_solver {
  SUNContext context;
  void *memory;
  SUNNonlinearSolver iteration;
  N_Vector y, row;
  size_t size;
  double origin; /* of the time of CVODES: the time of the last restart, so that early steps are not lost in rounding */
  double begin, end; /* of the last step, from the origin */
  double tolerance;
  /** Rates of the state [size]. */
  const char *(*rate)(void *user, double t, const double *y, double *y_rate);
  /** Rates of the tangent vectors d [columns][size] at a state. */
  const char *(*tangent_rate)(void *user, double t, const double *y, double *const *d, double *const *d_rate);
  void *user;
  cvodes_tangents tangents;
  const char *trouble; /* reason and time of the last call of `rate` that failed */
  double trouble_time;
} cvodes_solver;

/* Smaller states count as this size: a state can pass through zero, or rest there, without ever smaller steps. */
static const double least_size = 1e-3;

/* States beyond it blow up: their squares would soon overflow. */
static const double greatest_size = 1e100;

/* Steps grow as soon as they can grow by this factor; with the default of CVODES, 1.5, 50 % more evaluations are
 * needed. */
static const double least_growth = 1.05;

static int silence(void *memory) {
#if SUNDIALS_VERSION_MAJOR >= 7
  (void)memory;
  return 0;
#else
  return CVodeSetErrHandlerFn(memory, sundials_say_nothing, NULL);
#endif
}

static double root_mean_square(const double *y, size_t size) {
  double most = 0, sum = 0;
  for (size_t i = 0; i < size; i++)
    most = fmax(most, fabs(y[i]));
  if (!(most > 0 && most < INFINITY))
    return most;
  for (size_t i = 0; i < size; i++)
    sum += (y[i] / most) * (y[i] / most);
  return most * sqrt(sum / (double)size);
}

static int rate_of_state(double t, N_Vector y, N_Vector y_rate, void *user) {
  cvodes_solver *s = user;
  if (s->trouble) /* CVODES may call again after a failure */
    return -1;
  const char *trouble = s->rate(s->user, s->origin + t, N_VGetArrayPointer(y), N_VGetArrayPointer(y_rate));
  if (!trouble)
    return 0;
  s->trouble = trouble;
  s->trouble_time = s->origin + t;
  return -1; /* a smaller step would not help */
}

static int weights(N_Vector y, N_Vector weight, void *user) {
  const cvodes_solver *s = user;
  N_VConst(1 / (s->tolerance * fmax(root_mean_square(N_VGetArrayPointer(y), s->size), least_size)), weight);
  return 0;
}

/** The state [size]; written before a restart, read after a step. */
static double *cvodes_solver_state(const cvodes_solver *s) {
  return N_VGetArrayPointer(s->y);
}

static int set_up_steps(cvodes_solver *s, double longest_step) {
  N_VConst(0, s->y);
  int failed = silence(s->memory) || CVodeInit(s->memory, rate_of_state, 0, s->y);
  failed = failed || CVodeWFtolerances(s->memory, weights) || CVodeSetUserData(s->memory, s);
  failed = failed || CVodeSetMaxHnilWarns(s->memory, -1) || CVodeSetEtaFixedStepBounds(s->memory, 0, least_growth);
  if (!failed && longest_step < INFINITY)
    failed = CVodeSetMaxStep(s->memory, longest_step);
  if (failed)
    return failed;
  s->iteration = SUNNonlinSol_FixedPoint(s->y, 0, s->context);
  return !s->iteration || CVodeSetNonlinearSolver(s->memory, s->iteration);
}

static void cvodes_tangents_clear(cvodes_solver *s) {
  cvodes_tangents *d = &s->tangents;
  if (d->columns > 0)
    CVodeSensFree(s->memory);
  if (d->iteration)
    SUNNonlinSolFree(d->iteration);
  if (d->vector)
    N_VDestroyVectorArray(d->vector, (int)d->columns);
  free(d->absolute);
  free(d->d);
  *d = (cvodes_tangents){0};
}

static void cvodes_solver_clear(cvodes_solver *s) {
  cvodes_tangents_clear(s);
  if (s->memory)
    CVodeFree(&s->memory);
  if (s->iteration)
    SUNNonlinSolFree(s->iteration);
  if (s->row)
    N_VDestroy(s->row);
  if (s->y)
    N_VDestroy(s->y);
  if (s->context)
    SUNContext_Free(&s->context);
  s->iteration = NULL;
  s->y = s->row = NULL;
}

static ric_status cvodes_solver_init(cvodes_solver *s, double longest_step, ric_error *error) {
  if (sundials_has_room(VECTORS * s->size) && sundials_context_create(&s->context) == 0) {
    s->y = N_VNew_Serial((sunindextype)s->size, s->context);
    s->row = N_VNewEmpty_Serial((sunindextype)s->size, s->context);
    s->memory = CVodeCreate(CV_ADAMS, s->context);
    if (s->y && s->row && s->memory && set_up_steps(s, longest_step) == 0)
      return RIC_OK;
  }
  cvodes_solver_clear(s);
  return ric_fail(error, RIC_ENOMEM, "no memory for CVODES with %zu numbers", s->size);
}

/** Passes the tangent vectors to CVODES, after a restart. */
static const char *cvodes_tangents_restart(cvodes_solver *s) {
  cvodes_tangents *d = &s->tangents;
  for (size_t k = 0; k < d->columns; k++)
    d->absolute[k] = s->tolerance * fmax(N_VMaxNorm(d->vector[k]), 1e-290);
  int failed = CVodeSensReInit(s->memory, CV_STAGGERED, d->vector);
  failed = failed || CVodeSensSStolerances(s->memory, s->tolerance, d->absolute);
  return failed ? "CVODES refuses to start with tangent vectors" : NULL;
}

/** Discards the history. */
static const char *cvodes_solver_restart(cvodes_solver *s, double t) {
  s->origin = t;
  if (CVodeReInit(s->memory, 0, s->y))
    return "CVODES refuses to start";
  return s->tangents.active ? cvodes_tangents_restart(s) : NULL;
}

static const char *text_of(int code) {
  switch (code) {
  case CV_ERR_FAILURE:
  case CV_CONV_FAILURE:
    return "steps become too short: the motion blows up, or its forces are discontinuous";
  case CV_TOO_MUCH_ACC:
    return "the tolerance is below the precision of double numbers";
  default:
    return "CVODES gave up";
  }
}

/** One step towards `stop`, and not beyond. @param t  set to the time after it; `stop` itself if it was reached */
static const char *cvodes_solver_step(cvodes_solver *s, double stop, double *t) {
  double end;
  s->trouble = NULL;
  CVodeGetCurrentTime(s->memory, &s->begin);
  s->trouble_time = s->origin + s->begin;
  int code = CVodeSetStopTime(s->memory, stop - s->origin);
  if (code == CV_SUCCESS)
    code = CVode(s->memory, stop - s->origin, s->y, &end, CV_ONE_STEP);
  if (code < 0 ||
      s->trouble) /* CVODES may recover from a failure with a shorter step; here a failed callback is final */
    return s->trouble ? s->trouble : text_of(code);
  if (end == s->begin)
    return "steps become too short: the motion blows up, or its forces are discontinuous";
  if (!(root_mean_square(cvodes_solver_state(s), s->size) < greatest_size))
    return "the motion blows up";
  s->end = end;
  *t = code == CV_TSTOP_RETURN ? stop : s->origin + end;
  return NULL;
}

/** Length of the last step and of the next one that is planned, the larger of the two, >= 0. */
static double cvodes_solver_span(const cvodes_solver *s) {
  double last = 0, next = 0;
  CVodeGetLastStep(s->memory, &last);
  CVodeGetCurrentStep(s->memory, &next);
  return fmax(fabs(last), fabs(next));
}

/** The state on the last step as a polynomial in [0, 1], coef [CVODES_ORDER + 1][size]; its degree, -1 if there is
 *  none. */
static int cvodes_solver_polynomial(cvodes_solver *s, double *coef) {
  int degree = 0;
  if (CVodeGetLastOrder(s->memory, &degree))
    return -1;
  double scale = 1, length = s->end - s->begin; /* scale: length^k / k! */
  for (int k = 0; k <= degree; k++) {
    N_VSetArrayPointer(coef + (size_t)k * s->size, s->row);
    if (CVodeGetDky(s->memory, s->begin, k, s->row))
      return -1;
    N_VScale(scale, s->row, s->row);
    scale *= length / (k + 1);
  }
  return degree;
}

/* Tangent vectors by the forward sensitivity analysis of CVODES. */

/** Tangent vector [size]; written before a restart, read after cvodes_tangents_at. */
static double *cvodes_solver_tangent(const cvodes_solver *s, size_t column) {
  return N_VGetArrayPointer(s->tangents.vector[column]);
}

static int rates(int count, sunrealtype t, N_Vector y, N_Vector y_rate, N_Vector *d, N_Vector *d_rate, void *user,
                 N_Vector work, N_Vector more_work) {
  cvodes_solver *s = user;
  (void)y_rate, (void)work, (void)more_work;
  if (s->trouble)
    return -1;
  for (int k = 0; k < count; k++) {
    s->tangents.d[k] = N_VGetArrayPointer(d[k]);
    s->tangents.d_rate[k] = N_VGetArrayPointer(d_rate[k]);
  }
  s->trouble = s->tangent_rate(s->user, s->origin + t, N_VGetArrayPointer(y), s->tangents.d, s->tangents.d_rate);
  s->trouble_time = s->origin + t;
  return s->trouble ? -1 : 0;
}

static ric_status allocate_sensitivities(cvodes_solver *s, size_t columns, ric_error *error) {
  cvodes_tangents *d = &s->tangents;
  if (columns < 1u << 20 && sundials_has_room(VECTORS * s->size * columns))
    d->vector = N_VCloneVectorArray((int)columns, s->y);
  d->absolute = malloc(columns * sizeof *d->absolute);
  d->d = malloc(2 * columns * sizeof *d->d);
  d->d_rate = d->d + columns;
  d->columns = d->vector ? columns : 0;
  if (d->vector && d->absolute && d->d)
    return RIC_OK;
  cvodes_tangents_clear(s);
  return ric_fail(error, RIC_ENOMEM, "no memory for CVODES with %zu tangent vectors", columns);
}

static int set_up_sensitivities(cvodes_solver *s) {
  cvodes_tangents *d = &s->tangents;
  for (size_t k = 0; k < d->columns; k++)
    N_VConst(0, d->vector[k]);
  if (CVodeSensInit(s->memory, (int)d->columns, CV_STAGGERED, rates, d->vector) ||
      CVodeSetSensErrCon(s->memory, SUNTRUE))
    return -1;
  d->iteration = SUNNonlinSol_FixedPointSens((int)d->columns, s->y, 0, s->context);
  return d->iteration ? CVodeSetNonlinearSolverSensStg(s->memory, d->iteration) : -1;
}

/** Makes room for tangent vectors; 0 removes them but keeps the memory. A restart must follow. */
static ric_status cvodes_solver_carry(cvodes_solver *s, size_t columns, ric_error *error) {
  s->tangents.active = columns > 0;
  if (columns == 0 && s->tangents.columns > 0)
    CVodeSensToggleOff(s->memory); /* the next restart with them turns them on */
  if (columns == 0 || columns == s->tangents.columns)
    return RIC_OK;
  cvodes_tangents_clear(s);
  RIC_TRY(allocate_sensitivities(s, columns, error));
  s->tangents.active = true;
  if (set_up_sensitivities(s) == 0)
    return RIC_OK;
  cvodes_tangents_clear(s);
  return ric_fail(error, RIC_ENOMEM, "no memory for CVODES with %zu tangent vectors", columns);
}

/** Sets the tangent vectors to those at a position of the last step, 0 <= x <= 1. */
static const char *cvodes_tangents_at(cvodes_solver *s, double x) {
  double t = x == 1 ? s->end : s->begin + x * (s->end - s->begin);
  return CVodeGetSensDky(s->memory, t, 0, s->tangents.vector) ? "CVODES has no tangent vectors for its step" : NULL;
}

/* The flow of CVODES: for every system, on the state (q, u). */

typedef struct cvodes_flow {
  ric_flow base;
  cvodes_solver solver;
  int direction; /* of time since the last restart */
  bool restart;  /* the solver does not have the current state */
  bool whole;    /* the solver is at the end of the step */
  bool callback_failed;
  double *coef; /* [CVODES_ORDER + 1][n + m] of the step */
  int degree;
  double *work;        /* of system_tangent, and d and d_rate; NULL: there have been no tangent vectors */
  tangents d, d_rate;  /* [n + m][columns] work; d_rate: the rates, on a step lost in the rounding of time */
  const char *trouble; /* of the last transport, reported by the next step */
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

/* Converts tangent vectors between CVODES (one after another) and the library (interleaved). */
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

/* Restarts the solver at the flow's state if it has another one or the direction of time changes. */
static const char *synchronise_solver(cvodes_flow *f, double stop) {
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

/* An interval to `stop` that is lost in the rounding of time: a linear step. */
static const char *step_straight(cvodes_flow *f, double stop) {
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

static const char *advance_solver(cvodes_flow *f, double stop) {
  ric_flow *flow = &f->base;
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  double t = flow->time;
  const char *trouble = synchronise_solver(f, stop);
  if (!trouble)
    trouble = cvodes_solver_step(&f->solver, stop, &t);
  if (trouble)
    return trouble;
  f->degree = cvodes_solver_polynomial(&f->solver, f->coef);
  if (f->degree < 0)
    return "CVODES has no polynomial for its step";
  memcpy(f->coef, flow->q, n * sizeof *flow->q); /* equal up to rounding: pieces join exactly */
  memcpy(f->coef + n, flow->u, m * sizeof *flow->u);
  flow->length = f->solver.end - f->solver.begin;
  flow->end = t;
  f->whole = true;
  return NULL;
}

static ric_status cvodes_step(ric_flow *flow, double stop, ric_error *error) {
  cvodes_flow *f = (cvodes_flow *)flow;
  double span = f->restart ? 0 : cvodes_solver_span(&f->solver);
  bool lost = fabs(stop - flow->time) <= 256 * DBL_EPSILON * fmax(span, fmax(fabs(stop), fabs(flow->time)));
  f->solver.trouble_time = flow->time;
  f->whole = f->callback_failed = false;
  const char *trouble = f->trouble ? f->trouble : lost ? step_straight(f, stop) : advance_solver(f, stop);
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
                                   .step = cvodes_step,
                                   .piece = piece,
                                   .accept = accept,
                                   .carry = carry,
                                   .transport = transport,
                                   .destroy = destroy};

static ric_status allocate_flow(cvodes_flow *f, const ric_system *system, const ric_flow_options *options,
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
  ric_status status = allocate_flow(f, system, options, error);
  if (status == RIC_OK)
    *flow = &f->base;
  else
    destroy(&f->base);
  return status;
}
