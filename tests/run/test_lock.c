/* Locks between processes: the holders are children that are told apart from the test by their process number. */
#include "temporary_folder.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>

#include "run/lock.h"
#include "run/stop.h"

enum { HOLD_FOREVER = -1 };
static const double wait_forever = INFINITY; /* a test that waits where it should not never ends */

static const char *output_folder(void **state) {
  static char folder[128];
  snprintf(folder, sizeof folder, "%s/out.h5.ckpt", (const char *)*state);
  return folder;
}

static const char *lock_path(void **state) {
  static char path[160];
  snprintf(path, sizeof path, "%s/lock", output_folder(state));
  return path;
}

static void pause_seconds(double seconds) {
  nanosleep(&(struct timespec){.tv_sec = (time_t)seconds, .tv_nsec = (long)(1e9 * fmod(seconds, 1))}, NULL);
}

/* A child that takes the lock (rank 0) or joins it, holds it for that long and then releases it; it holds when this
 * returns. */
static pid_t start_holder(const char *folder, int rank, double seconds, int remove) {
  int ready[2];
  assert_int_equal(pipe(ready), 0);
  const pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    lock *held;
    message why;
    if (rank == 0 ? lock_take(folder, 0, &held, &why) : lock_join(folder, rank, &held, &why))
      _exit(1);
    if (write(ready[1], "x", 1) != 1)
      _exit(2);
    if (seconds == HOLD_FOREVER)
      pause();
    pause_seconds(seconds);
    lock_release(&held, remove);
    _exit(0);
  }
  char byte;
  close(ready[1]);
  assert_int_equal(read(ready[0], &byte, 1), 1);
  close(ready[0]);
  return child;
}

static void finish(pid_t child, int with_signal) {
  if (with_signal)
    kill(child, with_signal);
  assert_int_equal(waitpid(child, NULL, 0), child);
}

static void second_taker_is_refused_and_told_the_holder(void **state) {
  lock *mine;
  message why;
  const pid_t holder = start_holder(output_folder(state), 0, HOLD_FOREVER, 0);
  assert_int_equal(lock_take(output_folder(state), 0.3, &mine, &why), EXIT_FILES);
  assert_null(mine);
  char process[64], host[256] = "";
  snprintf(process, sizeof process, "process %ld, since ", (long)holder);
  gethostname(host, sizeof host - 1);
  assert_non_null(strstr(why.text, process));
  assert_non_null(strstr(why.text, host));
  assert_non_null(strstr(why.text, lock_path(state)));
  assert_non_null(strstr(why.text, "; waited "));
  finish(holder, SIGKILL);
}

static void a_stop_ends_the_waiting(void **state) {
  lock *mine;
  message why;
  const pid_t holder = start_holder(output_folder(state), 0, HOLD_FOREVER, 0);
  stop_watch(0.3);
  assert_int_equal(lock_take(output_folder(state), wait_forever, &mine, &why), EXIT_STOPPED);
  assert_null(mine);
  stop_watch(INFINITY);
  finish(holder, SIGKILL);
}

/* It was held by the child, which alone can have let go of it. */
static void taker_waits_for_a_holder_that_leaves(void **state) {
  lock *mine;
  message why;
  const pid_t holder = start_holder(output_folder(state), 0, 0.5, 0);
  assert_int_equal(lock_take(output_folder(state), wait_forever, &mine, &why), 0);
  assert_int_equal(lock_check(mine, &why), 0);
  lock_release(&mine, 1);
  finish(holder, 0);
}

static void taker_follows_when_the_holder_removes_file_and_folder(void **state) {
  lock *mine;
  message why;
  const pid_t holder = start_holder(output_folder(state), 0, 0.3, 1);
  assert_int_equal(lock_take(output_folder(state), wait_forever, &mine, &why), 0);
  assert_int_equal(lock_check(mine, &why), 0);
  lock_release(&mine, 1);
  finish(holder, 0);
}

static void lock_is_free_once_its_holder_is_killed(void **state) {
  lock *mine;
  message why;
  finish(start_holder(output_folder(state), 0, HOLD_FOREVER, 0), SIGKILL);
  assert_int_equal(lock_take(output_folder(state), 0, &mine, &why), 0);
  lock_release(&mine, 0);
  assert_null(mine);
}

static void joined_rank_keeps_the_lock_after_rank_0_died(void **state) {
  lock *mine;
  message why;
  const pid_t owner = start_holder(output_folder(state), 0, HOLD_FOREVER, 0);
  const pid_t joined = start_holder(output_folder(state), 3, HOLD_FOREVER, 0);
  finish(owner, SIGKILL);
  assert_int_equal(lock_take(output_folder(state), 0.1, &mine, &why), EXIT_FILES);
  char process[64];
  snprintf(process, sizeof process, "process %ld, since ", (long)owner);
  assert_non_null(strstr(why.text, process)); /* the run is named after its rank 0 */
  finish(joined, SIGKILL);
  assert_int_equal(lock_take(output_folder(state), 0, &mine, &why), 0);
  lock_release(&mine, 0);
}

static void two_ranks_cannot_have_one_place(void **state) {
  lock *owner, *joined, *again;
  message why;
  assert_int_equal(lock_take(output_folder(state), 0, &owner, &why), 0);
  assert_int_equal(lock_join(output_folder(state), 1, &joined, &why), 0);
  assert_int_equal(lock_join(output_folder(state), 1, &again, &why), EXIT_FILES);
  assert_null(again);
  assert_non_null(strstr(why.text, "rank 1"));
  lock_release(&joined, 0);
  lock_release(&owner, 0);
}

static void removed_or_replaced_file_is_noticed(void **state) {
  lock *owner, *thief;
  message why;
  assert_int_equal(lock_take(output_folder(state), 0, &owner, &why), 0);
  assert_int_equal(lock_check(owner, &why), 0);
  assert_int_equal(unlink(lock_path(state)), 0);
  assert_int_equal(lock_check(owner, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, lock_path(state)));
  assert_int_equal(lock_take(output_folder(state), 0, &thief, &why), 0);
  assert_int_equal(lock_check(owner, &why), EXIT_FILES);
  lock_release(&owner, 1); /* does not remove what is not its own */
  assert_int_equal(lock_check(thief, &why), 0);
  lock_release(&thief, 1);
}

static void last_release_leaves_nothing_behind(void **state) {
  lock *owner;
  message why;
  assert_int_equal(lock_take(output_folder(state), 0, &owner, &why), 0);
  lock_release(&owner, 1);
  assert_int_equal(access(output_folder(state), F_OK), -1);
  lock_release(&owner, 1); /* NULL by now */
}

static void what_waiting_cannot_mend_is_refused_at_once(void **state) {
  lock *mine;
  message why;
  char path[200], long_name[5000];
  snprintf(path, sizeof path, "%s/absent/out.h5.ckpt", (const char *)*state);
  assert_int_equal(lock_take(path, wait_forever, &mine, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, path));
  snprintf(path, sizeof path, "%s/file", (const char *)*state);
  write_whole_file(path, "", 0);
  assert_int_equal(lock_take(path, wait_forever, &mine, &why), EXIT_FILES);
  assert_int_equal(lock_join(output_folder(state), 1, &mine, &why), EXIT_FILES);
  memset(long_name, 'x', sizeof long_name - 1);
  long_name[sizeof long_name - 1] = '\0';
  assert_int_equal(lock_take(long_name, wait_forever, &mine, &why), EXIT_FILES);
}

#define lock_test(name) cmocka_unit_test_setup_teardown(name, make_temporary_folder, remove_temporary_folder)

int main(void) {
  const struct CMUnitTest tests[] = {
      lock_test(second_taker_is_refused_and_told_the_holder),
      lock_test(a_stop_ends_the_waiting),
      lock_test(taker_waits_for_a_holder_that_leaves),
      lock_test(taker_follows_when_the_holder_removes_file_and_folder),
      lock_test(lock_is_free_once_its_holder_is_killed),
      lock_test(joined_rank_keeps_the_lock_after_rank_0_died),
      lock_test(two_ranks_cannot_have_one_place),
      lock_test(removed_or_replaced_file_is_noticed),
      lock_test(last_release_leaves_nothing_behind),
      lock_test(what_waiting_cannot_mend_is_refused_at_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
