#include "support.h"

#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "run/stop.h"

static void nothing_stops_a_fresh_watch(void **state) {
  (void)state;
  stop_watch(INFINITY);
  assert_int_equal(stop_asked(), STOP_NONE);
}

static void user_signal_asks_for_a_stop(void **state) {
  (void)state;
  stop_watch(INFINITY);
  raise(SIGUSR1);
  assert_int_equal(stop_asked(), STOP_ASKED);
}

/* How a child ends that does something after it has begun to watch. */
static int status_of_child(void (*act)(int number), int number) {
  const pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    stop_watch(INFINITY);
    act(number);
    _exit(0);
  }
  int status;
  assert_int_equal(waitpid(child, &status, 0), child);
  return status;
}

enum { HELD = 7 };

static void raise_held(int number) {
  stop_hold_signals();
  raise(number);
  _exit(stop_asked() == STOP_SIGNAL ? HELD : 0);
}

static void raise_held_and_release(int number) {
  stop_hold_signals();
  raise(number);
  stop_release_signals();
}

static void raise_released(int number) {
  stop_hold_signals();
  stop_release_signals();
  raise(number);
}

static void raise_at_once(int number) {
  signal(number, SIG_IGN); /* as a shell starts what runs in the background */
  stop_watch(INFINITY);
  raise(number);
}

static void fatal_signals_end_the_process_unless_they_are_held(void **state) {
  (void)state;
  const int fatal[] = {SIGTERM, SIGINT};
  void (*const ways[])(int) = {raise_at_once, raise_held_and_release, raise_released};
  for (int i = 0; i < 2; i++) {
    const int held = status_of_child(raise_held, fatal[i]);
    assert_true(WIFEXITED(held) && WEXITSTATUS(held) == HELD);
    for (int k = 0; k < 3; k++) {
      const int status = status_of_child(ways[k], fatal[i]);
      assert_true(WIFSIGNALED(status) && WTERMSIG(status) == fatal[i]);
    }
  }
}

static void a_held_signal_outranks_the_others(void **state) {
  (void)state;
  stop_watch(0);
  stop_hold_signals();
  raise(SIGUSR1);
  raise(SIGTERM);
  assert_int_equal(stop_asked(), STOP_SIGNAL);
  stop_watch(INFINITY);
  stop_release_signals();
}

static void small_work_is_never_left_half_done(void **state) {
  (void)state;
  uint64_t since = 0;
  stop_watch(0);
  for (int i = 0; i < 16; i++)
    assert_false(stop_asked_after(1000000, &since));
  assert_true(stop_asked_after(1000000, &since));
  assert_false(stop_asked_after(1, &since));
}

static void time_limit_stops_when_it_has_passed(void **state) {
  (void)state;
  stop_watch(1e6);
  assert_int_equal(stop_asked(), STOP_NONE);
  stop_watch(0.01);
  while (stop_asked() == STOP_NONE)
    ;
  assert_int_equal(stop_asked(), STOP_TIME);
}

static void time_limit_that_is_no_number_stops_at_once(void **state) {
  (void)state;
  stop_watch(NAN);
  assert_int_equal(stop_asked(), STOP_TIME);
}

static void size_limit_and_closed_pipe_do_not_kill(void **state) {
  (void)state;
  stop_watch(INFINITY);
  raise(SIGXFSZ);
  int ends[2];
  assert_int_equal(pipe(ends), 0);
  close(ends[0]);
  assert_int_equal(write(ends[1], "x", 1), -1);
  close(ends[1]);
  assert_int_equal(stop_asked(), STOP_NONE);
}

static void clock_goes_forward(void **state) {
  (void)state;
  const double before = clock_seconds();
  nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
  assert_true(clock_seconds() - before >= 0.002);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nothing_stops_a_fresh_watch),
      cmocka_unit_test(user_signal_asks_for_a_stop),
      cmocka_unit_test(fatal_signals_end_the_process_unless_they_are_held),
      cmocka_unit_test(a_held_signal_outranks_the_others),
      cmocka_unit_test(small_work_is_never_left_half_done),
      cmocka_unit_test(time_limit_stops_when_it_has_passed),
      cmocka_unit_test(time_limit_that_is_no_number_stops_at_once),
      cmocka_unit_test(size_limit_and_closed_pipe_do_not_kill),
      cmocka_unit_test(clock_goes_forward),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
