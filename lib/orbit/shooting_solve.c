/* Solving F(z) = 0 from afar, by KINSOL. */
#include <math.h>
#include <stdlib.h>

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "flow/sundials_context.h"
#include "model/largest.h"
#include "shooting_parts.h"

enum { MOST_STEPS = 200 };

static const double default_tolerance = 1e-13;
/* Residuals within this of the tolerance that no longer fall are rounding of unstable motions. */
static const double rounding = 1e4;
/* Ends of a conservative motion that are farther apart, relative to 1 + the largest unknown, are not one state. */
static const double lambda_tol = 1e-6;

/* Motions that take so many times the steps of the guess, and some, lead nowhere: Newton's method tries states of any
 * size, and fast ones would take for ever. */
enum { STEPS_GROW = 50, STEPS_MORE = 1000 };

typedef struct search {
  ric_shooting *s;
  double given;
  unsigned long long most_steps; /* of a motion; 0 before the first */
  ric_status status;             /* of the last residual that failed for good */
  ric_error *error;
  double *J;
  SUNContext context;
  N_Vector z, z_scale, F_scale;
  SUNMatrix matrix;
  SUNLinearSolver solver;
  void *memory;
} search;

/* To KINSOL: 0, 1 where a shorter step may help, -1 where nothing does. */
static int code_of(search *k, ric_status status) {
  k->status = status;
  return status == RIC_OK ? 0 : status == RIC_ENUMERIC ? 1 : -1;
}

static int residual(N_Vector z, N_Vector F, void *user) {
  search *k = user;
  arc_runner *runner = &k->s->runner;
  unsigned long long before = ric_flow_counted(arc_runner_flow(runner)).steps;
  runner->last_step = k->most_steps ? before + k->most_steps : 0;
  ric_status status =
      ric_shooting_residual(k->s, N_VGetArrayPointer(z), k->given, N_VGetArrayPointer(F), NULL, NULL, k->error);
  runner->last_step = 0;
  if (k->most_steps == 0)
    k->most_steps = STEPS_GROW * (ric_flow_counted(arc_runner_flow(runner)).steps - before) + STEPS_MORE;
  return code_of(k, status);
}

static int jacobian(N_Vector z, N_Vector F, SUNMatrix J, void *user, N_Vector spare, N_Vector other) {
  search *k = user;
  size_t n = k->s->arcs.unknowns;
  (void)F, (void)other;
  ric_status status =
      ric_shooting_residual(k->s, N_VGetArrayPointer(z), k->given, N_VGetArrayPointer(spare), k->J, NULL, k->error);
  for (size_t i = 0; i < n && status == RIC_OK; i++)
    for (size_t j = 0; j < n; j++)
      SM_ELEMENT_D(J, i, j) = k->J[i * n + j];
  return code_of(k, status);
}

static int silence(void *memory) {
#if SUNDIALS_VERSION_MAJOR >= 7
  (void)memory;
  return 0;
#else
  return KINSetErrHandlerFn(memory, sundials_say_nothing, NULL);
#endif
}

static int set_up(search *k, double tolerance) {
  sunindextype n = (sunindextype)k->s->arcs.unknowns;
  double *z = N_VGetArrayPointer(k->z), size = 1 + largest(z, k->s->arcs.unknowns);
  N_VConst(1, k->z_scale);
  N_VConst(1 / size, k->F_scale);
  int failed = silence(k->memory) || KINInit(k->memory, residual, k->z) || KINSetUserData(k->memory, k);
  failed = failed || KINSetLinearSolver(k->memory, k->solver, k->matrix) || KINSetJacFn(k->memory, jacobian);
  failed = failed || KINSetFuncNormTol(k->memory, tolerance) || KINSetScaledStepTol(k->memory, 1e-15);
  failed = failed || KINSetMaxSetupCalls(k->memory, 1) || KINSetNumMaxIters(k->memory, MOST_STEPS);
  return failed || KINSetMaxNewtonStep(k->memory, 100 * size * sqrt((double)n));
}

static ric_status search_init(search *k, double *z, double tolerance, ric_error *error) {
  size_t unknowns = k->s->arcs.unknowns;
  sunindextype n = (sunindextype)unknowns;
  k->J = malloc(unknowns * unknowns * sizeof *k->J);
  if (k->J && sundials_context_create(&k->context) == 0) {
    k->z = N_VMake_Serial(n, z, k->context);
    k->z_scale = N_VNew_Serial(n, k->context);
    k->F_scale = N_VNew_Serial(n, k->context);
    k->matrix = SUNDenseMatrix(n, n, k->context);
    if (k->z && k->matrix)
      k->solver = SUNLinSol_Dense(k->z, k->matrix, k->context);
    k->memory = KINCreate(k->context);
    if (k->z_scale && k->F_scale && k->solver && k->memory && set_up(k, tolerance) == 0)
      return RIC_OK;
  }
  return ric_fail(error, RIC_ENOMEM, "no memory for KINSOL with %zu unknowns", unknowns);
}

static void search_clear(search *k) {
  if (k->memory)
    KINFree(&k->memory);
  if (k->solver)
    SUNLinSolFree(k->solver);
  if (k->matrix)
    SUNMatDestroy(k->matrix);
  if (k->F_scale)
    N_VDestroy(k->F_scale);
  if (k->z_scale)
    N_VDestroy(k->z_scale);
  if (k->z)
    N_VDestroy(k->z);
  if (k->context)
    SUNContext_Free(&k->context);
  free(k->J);
}

static const char *text_of(int code) {
  switch (code) {
  case KIN_LSETUP_FAIL:
  case KIN_LINSOLV_NO_RECOVERY:
    return "the Jacobian is singular";
  case KIN_MAXITER_REACHED:
    return "too many steps";
  case KIN_LINESEARCH_NONCONV:
  case KIN_LINESEARCH_BCFAIL:
  case KIN_STEP_LT_STPTOL:
    return "no step along Newton's direction makes the residual smaller";
  case KIN_MXNEWT_5X_EXCEEDED:
    return "steps grow without bound";
  default:
    return "KINSOL gave up";
  }
}

static ric_status run(search *k, double tolerance, int *iterations, ric_error *error) {
  long count = 0;
  double left = INFINITY;
  int code = KINSol(k->memory, k->z, KIN_LINESEARCH, k->z_scale, k->F_scale);
  KINGetNumNonlinSolvIters(k->memory, &count);
  *iterations = (int)count;
  if (code == KIN_SUCCESS || code == KIN_INITIAL_GUESS_OK)
    return RIC_OK;
  if (k->status != RIC_OK && k->status != RIC_ENUMERIC)
    return k->status;
  if (code == KIN_FIRST_SYSFUNC_ERR)
    return RIC_ENUMERIC;            /* with the residual's own words */
  KINGetFuncNorm(k->memory, &left); /* Euclidean, scaled: not below the largest entry */
  if (left <= rounding * tolerance)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "shooting does not converge in %d steps: %s; the residual is %.3g", *iterations,
                  text_of(code), left);
}

/* E(x - lambda grad E) = E(x) has other solutions than lambda = 0: they close nothing. */
static ric_status check_lambda(const ric_shooting *s, const double *z, ric_error *error) {
  size_t index = s->arcs.lambda;
  double added = index == NO_UNKNOWN ? 0 : fabs(z[index]) * largest(s->gradient, s->arcs.size);
  if (added <= lambda_tol * (1 + largest(z, s->arcs.unknowns)))
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC,
                  "shooting converges to no motion: its ends are %.3g apart along the gradient of the energy", added);
}

ric_status ric_shooting_solve(ric_shooting *s, double *z, double given, double tolerance, int *iterations,
                              ric_error *error) {
  ric_error own;
  int count = 0;
  double tol = tolerance == 0 ? default_tolerance : tolerance;
  search k = {.s = s, .given = given, .error = error ? error : &own};
  if (!(tol > 0 && tol < 1))
    return ric_fail(error, RIC_EINVAL, "tolerance = %g, expected 0 to 1", tolerance);
  ric_status status = search_init(&k, z, tol, k.error);
  if (status == RIC_OK)
    status = run(&k, tol, &count, k.error);
  search_clear(&k);
  if (status == RIC_OK)
    status = check_lambda(s, z, error);
  if (iterations)
    *iterations = count;
  return status;
}
