/* Newton's method by KINSOL. */
#include "newton.h"

#include <math.h>
#include <stdlib.h>

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "vector.h"
#include "sundials_context.h"

enum { MOST_STEPS = 200, VECTORS = 16 /* at least as many as KINSOL makes */ };

/* Residuals below this multiple of the tolerance that no longer decrease are rounding of ill-conditioned problems. */
static const double rounding = 1e4;

typedef struct search {
  const newton_problem *problem;
  ric_status status; /* of the last residual that failed permanently */
  ric_error *error;
  double *J;
  SUNContext context;
  N_Vector z, z_scale, F_scale;
  SUNMatrix matrix;
  SUNLinearSolver solver;
  void *memory;
} search;

/* Return codes of KINSOL: 0; 1 if a shorter step may help; -1 if not. */
static int code_of(search *k, ric_status status) {
  k->status = status;
  return status == RIC_OK ? 0 : status == RIC_ENUMERIC ? 1 : -1;
}

static ric_status evaluate_residual(search *k, N_Vector z, N_Vector F, double *J) {
  return k->problem->residual(N_VGetArrayPointer(z), N_VGetArrayPointer(F), J, k->problem->user, k->error);
}

static int kinsol_residual(N_Vector z, N_Vector F, void *user) {
  search *k = user;
  return code_of(k, evaluate_residual(k, z, F, NULL));
}

static int jacobian(N_Vector z, N_Vector F, SUNMatrix J, void *user, N_Vector spare, N_Vector other) {
  search *k = user;
  size_t n = k->problem->unknowns;
  (void)F, (void)other;
  ric_status status = evaluate_residual(k, z, spare, k->J);
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
  sunindextype n = (sunindextype)k->problem->unknowns;
  double *z = N_VGetArrayPointer(k->z), size = 1 + largest(z, k->problem->unknowns);
  N_VConst(1, k->z_scale);
  N_VConst(1 / size, k->F_scale);
  int failed = silence(k->memory) || KINInit(k->memory, kinsol_residual, k->z) || KINSetUserData(k->memory, k);
  failed = failed || KINSetLinearSolver(k->memory, k->solver, k->matrix) || KINSetJacFn(k->memory, jacobian);
  failed = failed || KINSetFuncNormTol(k->memory, tolerance) || KINSetScaledStepTol(k->memory, 1e-15);
  failed = failed || KINSetMaxSetupCalls(k->memory, 1) || KINSetNumMaxIters(k->memory, MOST_STEPS);
  return failed || KINSetMaxNewtonStep(k->memory, 100 * size * sqrt((double)n));
}

static ric_status search_init(search *k, double *z, double tolerance, ric_error *error) {
  size_t unknowns = k->problem->unknowns;
  sunindextype n = (sunindextype)unknowns;
  k->J = malloc(unknowns * unknowns * sizeof *k->J);
  if (k->J && sundials_has_room((unknowns + VECTORS) * unknowns) && sundials_context_create(&k->context) == 0) {
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

static ric_status run_kinsol(search *k, double tolerance, int *iterations, ric_error *error) {
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
    return RIC_ENUMERIC;            /* with the message of the residual */
  KINGetFuncNorm(k->memory, &left); /* Euclidean, scaled: not below the largest entry */
  if (left <= rounding * tolerance)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "%s does not converge in %d steps: %s; the residual is %.3g", k->problem->name,
                  *iterations, text_of(code), left);
}

ric_status newton_solve(const newton_problem *problem, double *z, double tolerance, int *iterations, ric_error *error) {
  ric_error own;
  search k = {.problem = problem, .error = error ? error : &own};
  *iterations = 0;
  ric_status status = search_init(&k, z, tolerance, k.error);
  if (status == RIC_OK)
    status = run_kinsol(&k, tolerance, iterations, k.error);
  search_clear(&k);
  return status;
}
