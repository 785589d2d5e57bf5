/* NULL, and structs of zeros, in the place of every pointer of every public function: each call in a process of its
 * own, as some used to crash. The calls are written from the headers, by null_calls.py. */
#include "support.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <ricochet/ricochet.h>

typedef struct null_call {
  const char *function;
  const char *parameter; /* that is NULL; "" if none is */
  ric_status (*call)(ric_error *error);
} null_call;

enum { MOST_PARAMETERS = 16 };

static _Alignas(64) unsigned char zeros[MOST_PARAMETERS][8192];

#include "null_calls.inc"

/* What came back from the other process. */
typedef struct answer {
  bool returned;
  ric_status status;
  char message[256];
} answer;

static answer ask(const null_call *c) {
  int pipe_ends[2];
  answer a = {0};
  assert_int_equal(pipe(pipe_ends), 0);
  fflush(NULL);
  const pid_t child = fork();
  if (child == 0) {
    ric_error error = {0};
    for (int s = SIGILL; s <= SIGSEGV; s++)
      signal(s, SIG_DFL); /* cmocka's own would come back as a failed test */
    a.status = c->call(&error);
    a.returned = true;
    memcpy(a.message, error.message, sizeof a.message);
    _exit(write(pipe_ends[1], &a, sizeof a) != (ssize_t)sizeof a);
  }
  close(pipe_ends[1]);
  if (read(pipe_ends[0], &a, sizeof a) != (ssize_t)sizeof a)
    a = (answer){0};
  close(pipe_ends[0]);
  waitpid(child, NULL, 0);
  return a;
}

static bool names(const answer *a, const char *parameter) {
  const size_t length = strlen(parameter);
  return strncmp(a->message, parameter, length) == 0 && strncmp(a->message + length, " = NULL", 7) == 0;
}

static void null_is_refused_by_its_name(void **state) {
  (void)state;
  int failures = 0;
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    const null_call *c = &refused[i];
    const answer a = ask(c);
    if (a.returned && a.status == RIC_EINVAL && names(&a, c->parameter))
      continue;
    print_error("%s, %s = NULL: %s, status %d, \"%s\"\n", c->function, c->parameter,
                a.returned ? "returned" : "crashed", (int)a.status, a.message);
    failures++;
  }
  assert_int_equal(failures, 0);
}

static void check_that_all_return(const null_call *calls, size_t count) {
  int failures = 0;
  for (size_t i = 0; i < count; i++)
    if (!ask(&calls[i]).returned) {
      print_error("%s crashed\n", calls[i].function);
      failures++;
    }
  assert_int_equal(failures, 0);
}

static void ending_nothing_does_nothing(void **state) {
  (void)state;
  check_that_all_return(ended, sizeof ended / sizeof *ended);
}

static void data_of_zeros_do_not_crash(void **state) {
  (void)state;
  check_that_all_return(of_zeros, sizeof of_zeros / sizeof *of_zeros);
}

/* Arrays whose length depends on an object. */
static void speeds_are_needed_where_a_system_has_some(void **state) {
  (void)state;
  const ric_chain chain = ric_chain_default(2, 0.1);
  const double q[] = {0, 0};
  const size_t obstacle = 0;
  double rate[2], S[16];
  ric_system *system = NULL;
  ric_flow *flow = NULL;
  ric_trajectory *trajectory = NULL;
  ric_monodromy monodromy;
  ric_saltation_kind kind;
  ric_error error;
  assert_int_equal(ric_system_create_chain(&chain, &system, NULL), RIC_OK);
  assert_int_equal(ric_flow_create(system, NULL, &flow, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_flow_start(flow, 0, q, NULL, &error), RIC_EINVAL);
  assert_string_equal(error.message, "u = NULL, expected a pointer");
  assert_int_equal(ric_trajectory_start(trajectory, 0, q, NULL, NULL), RIC_EINVAL);
  assert_int_equal(ric_system_rate(system, 0, q, NULL, rate, rate, NULL), RIC_EINVAL);
  assert_int_equal(ric_system_rate(system, 0, q, q, rate, NULL, NULL), RIC_EINVAL);
  assert_int_equal(ric_saltation_find(system, 0, q, NULL, &obstacle, 1, 1e-10, S, NULL, &kind, NULL), RIC_EINVAL);
  assert_int_equal(ric_monodromy_find(system, 0, q, NULL, 1, NULL, S, &monodromy, NULL), RIC_EINVAL);
  assert_int_equal(ric_flow_start(flow, 0, q, q, NULL), RIC_OK);
  assert_int_equal(ric_flow_carry(flow, 1, q, NULL, NULL), RIC_EINVAL);
  assert_int_equal(ric_flow_carry(flow, 0, NULL, NULL, NULL), RIC_OK);
  ric_trajectory_destroy(&trajectory);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

static void a_first_state_and_times_are_needed_where_there_are_some(void **state) {
  (void)state;
  const ric_chain chain = ric_chain_default(1, 0);
  const size_t hit = 0;
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_CONSERVATIVE, .sequence = &hit, .count = 1, .flow = ric_flow_options_default()};
  ric_shooting_problem without = problem;
  const double q = -1, u = 1, time = 0;
  double z[8], states[2];
  ric_system *system = NULL;
  ric_shooting *shooting = NULL;
  ric_error error;
  without.sequence = NULL;
  assert_int_equal(ric_system_create_chain(&chain, &system, NULL), RIC_OK);
  assert_int_equal(ric_shooting_create(system, &without, &shooting, &error), RIC_EINVAL);
  assert_string_equal(error.message, "sequence = NULL, expected a pointer");
  assert_int_equal(ric_shooting_create(system, &problem, &shooting, NULL), RIC_OK);
  assert_int_equal(ric_shooting_guess(shooting, &q, NULL, &time, 5, z, NULL), RIC_EINVAL);
  assert_int_equal(ric_shooting_guess(shooting, &q, &u, NULL, 5, z, &error), RIC_EINVAL);
  assert_string_equal(error.message, "times = NULL, expected a pointer");
  assert_int_equal(ric_shooting_guess(shooting, &q, &u, &time, 5, z, NULL), RIC_OK);
  assert_int_equal(ric_shooting_states(shooting, z, 5, 2, states, NULL, NULL), RIC_EINVAL);
  ric_shooting_destroy(&shooting);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(null_is_refused_by_its_name),
      cmocka_unit_test(ending_nothing_does_nothing),
      cmocka_unit_test(data_of_zeros_do_not_crash),
      cmocka_unit_test(speeds_are_needed_where_a_system_has_some),
      cmocka_unit_test(a_first_state_and_times_are_needed_where_there_are_some),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
