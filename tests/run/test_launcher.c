/* Whether MPI is started, from what launchers leave in the environment. */
#include "support.h"

#include "run/launcher.h"

static const char *const variables[] = {
    "OMPI_COMM_WORLD_SIZE", "PMIX_RANK",    "PMI_RANK",     "PMI_FD",        "PMI_SIZE",
    "SLURM_JOB_ID",         "SLURM_NTASKS", "SLURM_PROCID", "SLURM_STEP_ID", "SLURM_STEP_NUM_TASKS"};

/* Nothing of what started the test itself. */
static int forget_launchers(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof variables / sizeof *variables; i++)
    unsetenv(variables[i]);
  return 0;
}

static void set(const char *variable, const char *value) {
  assert_int_equal(setenv(variable, value, 1), 0);
}

static void assert_decides(launcher_mode mode, bool parallel) {
  launcher_decision decision;
  message why;
  assert_int_equal(launcher_decide(mode, &decision, &why), 0);
  assert_int_equal(decision.parallel, parallel);
  assert_false(decision.silent);
}

static void what_no_launcher_started_is_alone(void **state) {
  (void)state;
  assert_decides(LAUNCHER_AUTO, false);
  assert_decides(LAUNCHER_ON, true);
  assert_decides(LAUNCHER_OFF, false);
}

static void each_launcher_is_recognised(void **state) {
  static const char *const signs[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_FD"};
  for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
    forget_launchers(state);
    set(signs[i], "1");
    assert_decides(LAUNCHER_AUTO, true);
    assert_decides(LAUNCHER_OFF, false);
  }
}

/* A script of sbatch has these, and what it starts by itself is alone. */
static void a_batch_script_is_no_launcher(void **state) {
  (void)state;
  set("SLURM_JOB_ID", "17");
  set("SLURM_NTASKS", "2");
  set("SLURM_PROCID", "0");
  assert_decides(LAUNCHER_AUTO, false);
}

static void a_step_of_one_task_is_alone(void **state) {
  (void)state;
  set("SLURM_STEP_ID", "0");
  set("SLURM_STEP_NUM_TASKS", "1");
  assert_decides(LAUNCHER_AUTO, false);
}

static void a_step_of_several_tasks_without_pmi_is_refused_once(void **state) {
  launcher_decision decision;
  message why;
  set("SLURM_STEP_NUM_TASKS", "2");
  for (int task = 0; task < 2; task++) {
    set("SLURM_PROCID", task ? "1" : "0");
    assert_int_equal(launcher_decide(LAUNCHER_AUTO, &decision, &why), EXIT_USAGE);
    assert_false(decision.parallel);
    assert_int_equal(decision.silent, task != 0);
    assert_non_null(strstr(why.text, "2 tasks"));
    assert_non_null(strstr(why.text, "srun --mpi=pmix"));
    assert_non_null(strstr(why.text, "--mpi off"));
    assert_decides(LAUNCHER_OFF, false);
    assert_decides(LAUNCHER_ON, true);
  }
  set("PMIX_RANK", "1"); /* srun --mpi=pmix */
  assert_decides(LAUNCHER_AUTO, true);
  forget_launchers(state);
}

/* mpiexec of MPICH starts two processes, each of which Open MPI takes for the only one. */
static void the_launcher_of_another_mpi_is_refused(void **state) {
  (void)state;
  message why;
  assert_int_equal(launcher_check(1, &why), 0);
  set("PMI_SIZE", "2");
  assert_int_equal(launcher_check(2, &why), 0);
  assert_int_equal(launcher_check(1, &why), EXIT_USAGE);
  assert_non_null(strstr(why.text, "2 processes"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup(what_no_launcher_started_is_alone, forget_launchers),
      cmocka_unit_test_setup(each_launcher_is_recognised, forget_launchers),
      cmocka_unit_test_setup(a_batch_script_is_no_launcher, forget_launchers),
      cmocka_unit_test_setup(a_step_of_one_task_is_alone, forget_launchers),
      cmocka_unit_test_setup(the_launcher_of_another_mpi_is_refused, forget_launchers),
      cmocka_unit_test_setup(a_step_of_several_tasks_without_pmi_is_refused_once, forget_launchers),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
