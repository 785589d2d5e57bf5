/* A child that reads a file: what it prints and replies arrives, its crash is a sentence, and it ends with its parent.
 */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS is not in POSIX */
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "result/child.h"
#include "support.h"

#define FILE_READ "read_by_a_child"
enum { FILE_BYTES = 3000000 };

static int read_in_child(int (*read)(void *user, FILE *reply, message *why), void *user, message *why) {
  return child_read(FILE_READ, &(child_task){.read = read, .user = user}, why);
}

/* --- what arrives --- */

static int reply_lines(void *user, FILE *reply, message *why) {
  (void)why;
  for (int i = 0; i < *(int *)user; i++)
    fprintf(reply, "line %d\n", i);
  return 0;
}

static int count_lines(void *user, FILE *reply, message *why) {
  int count = 0, number;
  (void)why;
  while (fscanf(reply, "line %d\n", &number) == 1)
    count += number == count;
  *(int *)user = count;
  return 0;
}

static void reply_of_any_length_arrives(void **state) {
  (void)state;
  for (int lines = 0, taken; lines <= 100000; lines = 10 * lines + 1) {
    message why;
    taken = lines;
    assert_int_equal(
        child_read(FILE_READ, &(child_task){.read = reply_lines, .take = count_lines, .user = &taken}, &why), 0);
    assert_int_equal(taken, lines);
  }
}

static int take_nothing(void *user, FILE *reply, message *why) {
  (void)user;
  (void)reply;
  return refuse(why, EXIT_RUN, "no taste");
}

static void refused_reply_ends_in_its_message_however_long_it_is(void **state) {
  (void)state;
  message why;
  int lines = 100000;
  const child_task task = {.read = reply_lines, .take = take_nothing, .user = &lines};
  assert_int_equal(child_read(FILE_READ, &task, &why), EXIT_RUN);
  assert_string_equal(why.text, "no taste");
}

static int refuse_in_child(void *user, FILE *reply, message *why) {
  (void)user;
  (void)reply;
  return refuse(why, EXIT_USAGE, "words of the file: \x1b[2J");
}

static void message_of_the_child_arrives_with_control_characters_escaped(void **state) {
  (void)state;
  message why;
  assert_int_equal(read_in_child(refuse_in_child, NULL, &why), EXIT_USAGE);
  assert_string_equal(why.text, "words of the file: \\x1b[2J");
}

static int print(void *user, FILE *reply, message *why) {
  (void)reply;
  (void)why;
  printf("%s", (const char *)user);
  return 0;
}

static void what_was_printed_before_is_printed_once(void **state) {
  (void)state;
  message why;
  char text[64] = "";
  fflush(stdout);
  const int saved = dup(STDOUT_FILENO), file = open("printed_by_a_child", O_RDWR | O_CREAT | O_TRUNC, 0666);
  assert_true(saved >= 0 && file >= 0 && dup2(file, STDOUT_FILENO) >= 0);
  printf("before ");
  const int code = read_in_child(print, (void *)(uintptr_t) "in the child ", &why);
  printf("after");
  fflush(stdout);
  dup2(saved, STDOUT_FILENO);
  assert_int_equal(code, 0);
  assert_true(pread(file, text, sizeof text - 1, 0) > 0);
  assert_string_equal(text, "before in the child after");
  close(saved);
  close(file);
}

/* --- crashes and limits --- */

static int end_by_signal(void *user, FILE *reply, message *why) {
  (void)reply;
  (void)why;
  signal(*(int *)user, SIG_DFL); /* sanitizers handle some */
  raise(*(int *)user);
  return 0;
}

static void crash_is_the_fault_of_the_file(void **state) {
  (void)state;
  const int numbers[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    message why;
    char words[64];
    int number = numbers[i];
    assert_int_equal(read_in_child(end_by_signal, &number, &why), EXIT_FILES);
    snprintf(words, sizeof words, FILE_READ ": HDF5 crashed while it read it (signal %d)", number);
    assert_non_null(strstr(why.text, words));
  }
}

static void limit_of_time_and_a_kill_have_words_of_their_own(void **state) {
  (void)state;
  message why;
  assert_int_equal(read_in_child(end_by_signal, &(int){SIGXCPU}, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "not read within 1560 s"));
  assert_int_equal(read_in_child(end_by_signal, &(int){SIGKILL}, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, "was killed (signal 9)"));
}

static int leave(void *user, FILE *reply, message *why) {
  (void)user;
  (void)reply;
  (void)why;
  _exit(0);
}

static void end_that_a_library_makes_is_no_success(void **state) {
  (void)state;
  message why;
  assert_int_equal(read_in_child(leave, NULL, &why), EXIT_FILES);
  assert_non_null(strstr(why.text, FILE_READ ": HDF5 ended while it read it (code 0)"));
}

static bool can_map(size_t gigabytes) {
  const size_t bytes = gigabytes << 30;
  void *at = mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return at != MAP_FAILED && munmap(at, bytes) == 0;
}

static int look_at_limits(void *user, FILE *reply, message *why) {
  struct rlimit time, core;
  (void)user;
  (void)reply;
  (void)why;
  getrlimit(RLIMIT_CPU, &time);
  getrlimit(RLIMIT_CORE, &core);
  return can_map(1) && !can_map(3) && time.rlim_cur == 60 + FILE_BYTES / 2000 && core.rlim_cur == 0 ? 0 : EXIT_RUN;
}

static void child_has_limits_and_the_parent_has_not(void **state) {
  (void)state;
  message why;
  assert_int_equal(read_in_child(look_at_limits, NULL, &why), 0);
  assert_true(can_map(3));
}

/* --- signals: a process in between stands for the program --- */

static void note(int number) {
  (void)number;
}

static int tell_and_wait(void *user, FILE *reply, message *why) {
  (void)reply;
  (void)why;
  if (write(*(int *)user, "", 1) == 1)
    for (;;)
      pause();
  return 0;
}

/* Ends a program whose child waits. @param handled  it has a handler for the signal, as a run has */
static int status_of_ended(int number, bool handled) {
  int ends[2], status;
  char byte;
  assert_int_equal(pipe(ends), 0);
  const pid_t program = fork();
  if (program == 0) {
    message why;
    close(ends[0]);
    if (handled)
      signal(number, note);
    read_in_child(tell_and_wait, &ends[1], &why);
    _exit(0);
  }
  close(ends[1]);
  assert_int_equal(read(ends[0], &byte, 1), 1);
  kill(program, number);
  assert_int_equal(waitpid(program, &status, 0), program);
  assert_int_equal(read(ends[0], &byte, 1), 0); /* nobody has it any more: the child has ended, too */
  close(ends[0]);
  return status;
}

static void child_ends_with_its_parent(void **state) {
  (void)state;
  const int numbers[] = {SIGKILL, SIGTERM, SIGINT, SIGHUP};
  alarm(60); /* a test that waits in vain */
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    for (int handled = 0; handled <= (numbers[i] == SIGTERM || numbers[i] == SIGINT); handled++) {
      const int status = status_of_ended(numbers[i], handled);
      assert_true(WIFSIGNALED(status) && WTERMSIG(status) == numbers[i]);
    }
  alarm(0);
}

static void handlers_are_as_before_afterwards(void **state) {
  (void)state;
  message why;
  signal(SIGTERM, note);
  signal(SIGINT, SIG_IGN);
  assert_int_equal(read_in_child(print, (void *)(uintptr_t) "", &why), 0);
  assert_true(signal(SIGTERM, SIG_DFL) == note);
  assert_true(signal(SIGINT, SIG_DFL) == SIG_IGN);
}

static void closed_pipe_ends_the_program_as_it_ends_the_child(void **state) {
  (void)state;
  int status;
  const pid_t program = fork();
  if (program == 0) {
    message why;
    signal(SIGPIPE, SIG_DFL);
    read_in_child(end_by_signal, &(int){SIGPIPE}, &why);
    _exit(0);
  }
  assert_int_equal(waitpid(program, &status, 0), program);
  assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reply_of_any_length_arrives),
      cmocka_unit_test(refused_reply_ends_in_its_message_however_long_it_is),
      cmocka_unit_test(message_of_the_child_arrives_with_control_characters_escaped),
      cmocka_unit_test(what_was_printed_before_is_printed_once),
      cmocka_unit_test(crash_is_the_fault_of_the_file),
      cmocka_unit_test(limit_of_time_and_a_kill_have_words_of_their_own),
      cmocka_unit_test(end_that_a_library_makes_is_no_success),
      cmocka_unit_test(child_has_limits_and_the_parent_has_not),
      cmocka_unit_test(child_ends_with_its_parent),
      cmocka_unit_test(handlers_are_as_before_afterwards),
      cmocka_unit_test(closed_pipe_ends_the_program_as_it_ends_the_child),
  };
  const int file = open(FILE_READ, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0 || ftruncate(file, FILE_BYTES) != 0)
    return 1;
  close(file);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
