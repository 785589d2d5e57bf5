#include "cvodes_solver.h"

#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "numeric/sundials_context.h"

/* States below it count as of this size: a state passes through zero, and rests there, without steps that shrink. */
static const double least_size = 1e-3;
/* States beyond it blow up: their squares soon leave the range of numbers. */
static const double greatest_size = 1e100;
/* Steps grow as soon as they may grow by it; CVODES would wait for 1.5, and needs half as many evaluations again. */
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
  if (s->trouble) /* whatever CVODES tries after a failure */
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

double *cvodes_solver_state(const cvodes_solver *s) {
  return N_VGetArrayPointer(s->y);
}

static int set_up(cvodes_solver *s, double longest_step) {
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

ric_status cvodes_solver_init(cvodes_solver *s, double longest_step, ric_error *error) {
  if (sundials_context_create(&s->context) == 0) {
    s->y = N_VNew_Serial((sunindextype)s->size, s->context);
    s->row = N_VNewEmpty_Serial((sunindextype)s->size, s->context);
    s->memory = CVodeCreate(CV_ADAMS, s->context);
    if (s->y && s->row && s->memory && set_up(s, longest_step) == 0)
      return RIC_OK;
  }
  cvodes_solver_clear(s);
  return ric_fail(error, RIC_ENOMEM, "no memory for CVODES with %zu numbers", s->size);
}

void cvodes_solver_clear(cvodes_solver *s) {
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

const char *cvodes_solver_restart(cvodes_solver *s, double t) {
  s->origin = t;
  if (CVodeReInit(s->memory, 0, s->y))
    return "CVODES refuses to start";
  return s->tangents.carried ? cvodes_tangents_restart(s) : NULL;
}

static const char *text_of(int code) {
  switch (code) {
  case CV_ERR_FAILURE:
  case CV_CONV_FAILURE:
    return "steps shrink to nothing: the motion blows up, or its forces jump";
  case CV_TOO_MUCH_ACC:
    return "the tolerance is beyond the precision of numbers";
  default:
    return "CVODES gave up";
  }
}

const char *cvodes_solver_step(cvodes_solver *s, double stop, double *t) {
  double end;
  s->trouble = NULL;
  CVodeGetCurrentTime(s->memory, &s->begin);
  s->trouble_time = s->origin + s->begin;
  int code = CVodeSetStopTime(s->memory, stop - s->origin);
  if (code == CV_SUCCESS)
    code = CVode(s->memory, stop - s->origin, s->y, &end, CV_ONE_STEP);
  if (code < 0 || s->trouble) /* CVODES may get past a failure with a shorter step; a callback that fails is the end */
    return s->trouble ? s->trouble : text_of(code);
  if (end == s->begin)
    return "steps shrink to nothing: the motion blows up, or its forces jump";
  if (!(root_mean_square(cvodes_solver_state(s), s->size) < greatest_size))
    return "the motion blows up";
  s->end = end;
  *t = code == CV_TSTOP_RETURN ? stop : s->origin + end;
  return NULL;
}

double cvodes_solver_span(const cvodes_solver *s) {
  double last = 0, next = 0;
  CVodeGetLastStep(s->memory, &last);
  CVodeGetCurrentStep(s->memory, &next);
  return fmax(fabs(last), fabs(next));
}

int cvodes_solver_polynomial(cvodes_solver *s, double *coef) {
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
