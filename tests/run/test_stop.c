#include "support.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include "run/stop.h"

static void nothing_stops_a_fresh_watch(void **state) {
  (void)state;
  stop_watch(INFINITY);
  assert_int_equal(stop_asked(), STOP_NONE);
  assert_int_equal(stop_signal(), 0);
}

static void user_signal_asks_for_a_stop(void **state) {
  (void)state;
  stop_watch(INFINITY);
  raise(SIGUSR1);
  assert_int_equal(stop_asked(), STOP_ASKED);
  assert_int_equal(stop_signal(), 0);
}

static void fatal_signals_outrank_the_others(void **state) {
  (void)state;
  const int fatal[] = {SIGTERM, SIGINT};
  for (int i = 0; i < 2; i++) {
    stop_watch(0);
    raise(SIGUSR1);
    raise(fatal[i]);
    assert_int_equal(stop_asked(), STOP_SIGNAL);
    assert_int_equal(stop_signal(), fatal[i]);
  }
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
      cmocka_unit_test(fatal_signals_outrank_the_others),
      cmocka_unit_test(time_limit_stops_when_it_has_passed),
      cmocka_unit_test(time_limit_that_is_no_number_stops_at_once),
      cmocka_unit_test(size_limit_and_closed_pipe_do_not_kill),
      cmocka_unit_test(clock_goes_forward),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
