/* Standard error is a file while progress is shown, so that what was printed can be counted. */
#include "temporary_folder.h"

#include <fcntl.h>
#include <time.h>

#include "run/progress.h"
#include "run/stop.h"

static int terminal_error = -1; /* standard error itself while it is captured, -1 otherwise */

static void capture(void **state) {
  char path[100];
  snprintf(path, sizeof path, "%s/stderr", (const char *)*state);
  const int file = open(path, O_CREAT | O_WRONLY | O_APPEND, 0666);
  assert_true(file >= 0);
  fflush(stderr);
  terminal_error = dup(STDERR_FILENO);
  assert_true(dup2(file, STDERR_FILENO) >= 0);
  close(file);
}

/* Back to the real standard error, where failures of assertions are to be seen. */
static void release(void) {
  if (terminal_error < 0)
    return;
  fflush(stderr);
  dup2(terminal_error, STDERR_FILENO);
  close(terminal_error);
  terminal_error = -1;
}

static int set_up(void **state) {
  unsetenv("OMPI_COMM_WORLD_RANK"); /* as if not under mpirun, wherever the tests run */
  if (make_temporary_folder(state))
    return -1;
  capture(state);
  return 0;
}

static int tear_down(void **state) {
  release();
  return remove_temporary_folder(state);
}

/* Ends the capture. @returns all that was captured so far */
static const char *printed(void **state) {
  static char text[4096];
  char path[100];
  size_t size;
  release();
  snprintf(path, sizeof path, "%s/stderr", (const char *)*state);
  unsigned char *bytes = read_whole_file(path, &size);
  assert_true(size < sizeof text);
  memcpy(text, bytes, size);
  text[size] = '\0';
  free(bytes);
  return text;
}

static int count(const char *text, char which) {
  int found = 0;
  for (; *text; text++)
    found += *text == which;
  return found;
}

static void never_is_silent(void **state) {
  progress p;
  progress_begin(&p, PROGRESS_NEVER, 100, 0);
  p.shown -= 100;
  progress_show(&p, 50);
  progress_end(&p, 100);
  assert_string_equal(printed(state), "");
}

static void without_terminal_lines_come_every_half_minute(void **state) {
  progress p;
  progress_begin(&p, PROGRESS_AUTO, 100000, 0);
  for (uint64_t done = 0; done < 100000; done++)
    progress_show(&p, done);
  assert_string_equal(printed(state), "");
  capture(state);
  p.shown -= 31;
  progress_show(&p, 60000);
  progress_show(&p, 60001);
  assert_int_equal(count(printed(state), '\n'), 1);
  assert_non_null(strstr(printed(state), " 60 %  60000/100000 tasks"));
  assert_non_null(strstr(printed(state), " left\n"));
  capture(state);
  progress_end(&p, 100000);
  assert_int_equal(count(printed(state), '\n'), 2);
  assert_int_equal(count(printed(state), '\r'), 0);
  assert_null(strchr(printed(state), '['));
}

/* The clock of the bar is set, so that the test does not depend on how fast the machine is. */
static void bar_is_redrawn_in_place_at_most_five_times_a_second(void **state) {
  progress p;
  progress_begin(&p, PROGRESS_ALWAYS, 1000, 0);
  p.shown = clock_seconds() + 1e6; /* however long the calls take, the last output was less than 0.2 s ago */
  for (int i = 0; i < 1000; i++)
    progress_show(&p, 500);
  assert_int_equal(count(printed(state), '\r'), 0);
  capture(state);
  p.shown = clock_seconds() - 0.201;
  progress_show(&p, 500);
  assert_int_equal(count(printed(state), '\r'), 1);
  assert_int_equal(count(printed(state), '\n'), 0);
  assert_non_null(strstr(printed(state), "\r[##########..........]  50 %  500/1000 tasks"));
  capture(state);
  progress_end(&p, 1000);
  assert_non_null(strstr(printed(state), "\r[####################] 100 %  1000/1000 tasks"));
  assert_int_equal(count(printed(state), '\n'), 1);
}

static void resumed_tasks_do_not_count_in_the_rate(void **state) {
  progress p;
  progress_begin(&p, PROGRESS_AUTO, 2000, 1000);
  p.began -= 10; /* 500 tasks in 10 s, so another 10 s for the other 500 */
  p.shown -= 31;
  progress_show(&p, 1500);
  assert_non_null(strstr(printed(state), " 75 %  1500/2000 tasks  50/s  10 s left"));
}

static void rate_is_left_out_until_something_is_done(void **state) {
  progress p;
  progress_begin(&p, PROGRESS_AUTO, 2000, 1000);
  progress_end(&p, 1000);
  assert_string_equal(printed(state), "ricochet:  50 %  1000/2000 tasks\n");
}

static void long_waits_are_told_in_hours_and_minutes(void **state) {
  progress p;
  progress_begin(&p, PROGRESS_AUTO, 1001, 0);
  p.began -= 10.001; /* 10 s a task, so 10 000 s */
  progress_end(&p, 1);
  assert_non_null(strstr(printed(state), "  0.1/s  2 h 46 min left\n"));
}

static void study_without_tasks_is_done(void **state) {
  progress p;
  progress_begin(&p, PROGRESS_AUTO, 0, 0);
  progress_end(&p, 0);
  assert_string_equal(printed(state), "ricochet: 100 %  0/0 tasks\n");
}

#define progress_test(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
  const struct CMUnitTest tests[] = {
      progress_test(never_is_silent),
      progress_test(without_terminal_lines_come_every_half_minute),
      progress_test(bar_is_redrawn_in_place_at_most_five_times_a_second),
      progress_test(resumed_tasks_do_not_count_in_the_rate),
      progress_test(rate_is_left_out_until_something_is_done),
      progress_test(long_waits_are_told_in_hours_and_minutes),
      progress_test(study_without_tasks_is_done),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
