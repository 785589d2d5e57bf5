/* What `show` prints of the made-up result, for people and as CSV, without MPI. */
#include <fcntl.h>
#include <unistd.h>

#include "result/result.h"
#include "support.h"
#include "synthetic.h"

#define RESULT_FILE "to_be_shown.h5"

static char printed[1 << 16];

/* Runs a call with standard output going to a file, whose text is then in `printed`. */
#define PRINTED(call, expected_code)                                                                                   \
  do {                                                                                                                 \
    int saved = redirect("printed.txt");                                                                               \
    int code = (call);                                                                                                 \
    restore(saved);                                                                                                    \
    load_printed();                                                                                                    \
    assert_int_equal(code, (expected_code));                                                                           \
  } while (0)

static int redirect(const char *path) {
  fflush(stdout);
  int saved = dup(STDOUT_FILENO), file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  assert_true(saved >= 0 && file >= 0);
  assert_true(dup2(file, STDOUT_FILENO) >= 0);
  close(file);
  return saved;
}

static void restore(int saved) {
  fflush(stdout);
  clearerr(stdout);
  dup2(saved, STDOUT_FILENO);
  close(saved);
}

static void load_printed(void) {
  FILE *from = fopen("printed.txt", "r");
  assert_non_null(from);
  printed[fread(printed, 1, sizeof printed - 1, from)] = '\0';
  fclose(from);
}

static void assert_line(const char *line) {
  size_t length = strlen(line);
  for (const char *at = strstr(printed, line); at; at = strstr(at + 1, line))
    if ((at == printed || at[-1] == '\n') && at[length] == '\n')
      return;
  fail_msg("no line \"%s\" in:\n%s", line, printed);
}

static void show_names_the_study_and_its_sweeps(void **state) {
  (void)state;
  message why;
  PRINTED(result_show(RESULT_FILE, synthetic_card, &why), 0);
  assert_line("title      made up, \xc3\xa0 la carte");
  assert_line("command    ricochet run made-up.yaml");
  assert_line("sweep      model.gamma: 5 values from 0 to 0.4");
  assert_line("           model.floor[3]: 4 values from -4 to -1");
}

static void show_lists_columns_and_counts_words(void **state) {
  (void)state;
  message why;
  PRINTED(result_show(RESULT_FILE, synthetic_card, &why), 0);
  assert_line("/orbits");
  assert_line("  q                   float64     [task 20, particle 6]            length  a made-up number");
  assert_line("  path                float64     [task 20, sample 5, particle 6]  length  a made-up number");
  assert_line("  multipliers         complex128  [task 20, multiplier 12]         1       a made-up complex number");
  assert_line("  energy              float64     [task 20]                        length  a made-up number: q0");
  assert_line("  reason              text 32     [task 20]                                a made-up remark");
  assert_line("  outcome: admissible 10, inadmissible 10");
}

static void show_prints_special_points_up_to_forty(void **state) {
  (void)state;
  message why;
  PRINTED(result_show(RESULT_FILE, synthetic_card, &why), 0);
  assert_line("  kind       gamma             multiplier                          remark");
  assert_line("  zero       0.841470984808    0.841470984808+0.842010866288i      particle 3, \"at once\"");
  assert_line("  zero       nan               nan+0.140129945168i                 0123456789abcdef0123456789abcdef");
  assert_line("  ... 10 more");
}

static void csv_has_parameters_and_columns_of_the_first_group(void **state) {
  (void)state;
  message why;
  PRINTED(result_show_csv(RESULT_FILE, NULL, &why), 0);
  const char *begins[] = {"\nmodel.gamma,model.floor[3],", "\n0,-2,inadmissible,\"particle 3, \"\"at once\"\"\",",
                          "\n0,-4,inadmissible,0123456789abcdef0123456789abcdef,",
                          "\n0.10000000000000001,-1,admissible,,"};
  for (size_t i = 0; i < sizeof begins / sizeof *begins; i++)
    assert_non_null(i ? strstr(printed, begins[i]) : strstr(printed, begins[i] + 1));
  assert_non_null(strstr(printed, ",energy,"));
  assert_non_null(strstr(printed, ",0.8414709848078965,"));
}

/* Commas outside quotes. */
static size_t fields_of(const char *line) {
  size_t count = 1;
  for (bool quoted = false; *line && (quoted || *line != '\n'); line++) {
    quoted = quoted != (*line == '"');
    count += !quoted && *line == ',';
  }
  return count;
}

static void csv_has_a_column_for_each_element_of_sets_with_more_axes(void **state) {
  (void)state;
  message why;
  PRINTED(result_show_csv(RESULT_FILE, NULL, &why), 0);
  const char *const names[] = {",q[0],",       ",q[5],",           ",path[0][0],",
                               ",path[4][5],", "multipliers[0].r", "multipliers[11].i"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    assert_non_null(strstr(printed, names[i]));
  size_t lines = 0;
  for (const char *line = printed; *line; line = strchr(line, '\n') + 1, lines++)
    assert_int_equal(fields_of(line), fields_of(printed));
  assert_int_equal(lines, 21);
}

static void csv_along_the_second_axis_has_its_index_and_the_parameters(void **state) {
  (void)state;
  message why;
  PRINTED(result_show_csv(RESULT_FILE, "orbits/sample", &why), 0);
  assert_memory_equal(printed, "task,sample,model.gamma,model.floor[3],path[0],", 47);
  size_t lines = 0;
  for (const char *line = printed; *line; line = strchr(line, '\n') + 1)
    lines++;
  assert_int_equal(lines, 1 + 20 * 5);
}

static void csv_of_a_table_of_its_own_has_no_parameters(void **state) {
  (void)state;
  message why;
  PRINTED(result_show_csv(RESULT_FILE, "special", &why), 0);
  assert_line("kind,gamma,multiplier.r,multiplier.i,remark");
  assert_line("resonance,0.90929742682568171,0.90929742682568171,0.90888082540981685,caf\xc3\xa9");
}

static void csv_refuses_groups_without_columns(void **state) {
  (void)state;
  message why;
  PRINTED(result_show_csv(RESULT_FILE, "orbit", &why), EXIT_USAGE);
  assert_non_null(strstr(why.text, "no group orbit, expected one of orbits, special"));
  PRINTED(result_show_csv(RESULT_FILE, "run", &why), EXIT_USAGE);
  assert_non_null(strstr(why.text, "group run has no column"));
  PRINTED(result_show_csv(RESULT_FILE, "orbits/nothing", &why), EXIT_USAGE);
  assert_non_null(strstr(why.text, "no column with a row for each nothing; its rows can be task, "));
}

static void failing_output_is_an_error(void **state) {
  (void)state;
  message why;
  int saved = redirect("/dev/full");
  int plain = result_show(RESULT_FILE, synthetic_card, &why);
  clearerr(stdout);
  int csv = result_show_csv(RESULT_FILE, NULL, &why);
  restore(saved);
  assert_int_equal(plain, EXIT_FILES);
  assert_int_equal(csv, EXIT_FILES);
  assert_non_null(strstr(why.text, "cannot write to standard output"));
}

static int write_result(void **state) {
  (void)state;
  return synthetic_write(RESULT_FILE, 3);
}

static int remove_result(void **state) {
  (void)state;
  return unlink(RESULT_FILE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(show_names_the_study_and_its_sweeps),
      cmocka_unit_test(show_lists_columns_and_counts_words),
      cmocka_unit_test(show_prints_special_points_up_to_forty),
      cmocka_unit_test(csv_has_parameters_and_columns_of_the_first_group),
      cmocka_unit_test(csv_has_a_column_for_each_element_of_sets_with_more_axes),
      cmocka_unit_test(csv_along_the_second_axis_has_its_index_and_the_parameters),
      cmocka_unit_test(csv_of_a_table_of_its_own_has_no_parameters),
      cmocka_unit_test(csv_refuses_groups_without_columns),
      cmocka_unit_test(failing_output_is_an_error),
  };
  return cmocka_run_group_tests(tests, write_result, remove_result);
}
