/* ricochet check: validates a study and says what it will take; never starts MPI. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#include "../kind/kind.h"
#include "../kind/machine.h"
#include "command.h"

static const char help[] =
    "usage: ricochet check STUDY.yaml [--set KEY=VALUE ...]\n"
    "       ricochet check --reference\n"
    "\n"
    "Validates a study and prints its number of tasks, the memory of a rank and the size of the\n"
    "result. With --reference: prints the study-file reference in Markdown.\n"
    "\n"
    "Exit codes: 0 valid, 2 bad usage or study, 3 cannot read.\n";

static void print_plan(const study *s, const kind_plan *plan) {
  char memory[32], size[32];
  printf("%s: kind %s\n", study_name(s), study_kind(s));
  for (size_t i = 0; i < study_sweeps(s); i++) {
    const study_sweep *w = study_sweep_at(s, i);
    printf("  sweep   %s: %zu values from %.12g to %.12g\n", w->name, w->points, w->values[0],
           w->values[w->points - 1]);
  }
  printf("  tasks   %llu\n", (unsigned long long)study_tasks(s));
  printf("  memory  %s per rank\n", machine_size(plan->memory, memory, sizeof memory));
  printf("  result  %s%s (as much again for the checkpoint while it runs)\n",
         machine_size((double)study_tasks(s) * (double)plan->rows.row_bytes, size, sizeof size),
         plan->tail_count ? " plus events" : "");
}

static int check_study(const char *path, const char *const *sets, size_t set_count, message *why) {
  study *s = NULL;
  kind_plan plan;
  int code = kind_read_study(path, sets, set_count, (ric_poll){0}, &s, why);
  if (!code)
    code = kind_of(s)->plan(s, &plan, why);
  if (!code)
    print_plan(s, &plan);
  study_destroy(&s);
  return code;
}

int command_check(int argc, char **argv) {
  static const struct option options[] = {{"set", required_argument, NULL, 's'},
                                          {"reference", no_argument, NULL, 'r'},
                                          {"help", no_argument, NULL, 'h'},
                                          {NULL, 0, NULL, 0}};
  message why;
  const char **sets = calloc((size_t)argc, sizeof *sets);
  size_t set_count = 0;
  int code = sets ? 0 : refuse(&why, EXIT_RUN, "no memory for the options"), done = 0;
  opterr = 0;
  for (int option = 0; !code && !done && option != -1;) {
    char text[3];
    option = getopt_long(argc, argv, ":h", options, NULL);
    if (option == 's')
      sets[set_count++] = optarg;
    else if (option == 'r' || option == 'h') {
      option == 'h' ? (void)fputs(help, stdout) : schema_reference(&studies, stdout);
      done = 1;
    } else if (option != -1)
      code = refuse(&why, EXIT_USAGE,
                    option == ':' ? "ricochet check: %s needs a value (see ricochet check --help)"
                                  : "ricochet check: unknown option %s (see ricochet check --help)",
                    refused_option(argv, text));
  }
  if (!code && !done && argc - optind != 1)
    code = refuse(&why, EXIT_USAGE, "ricochet check: %d study files given, expected one (see ricochet check --help)",
                  argc - optind);
  if (!code && !done)
    code = check_study(argv[optind], sets, set_count, &why);
  free(sets);
  return code ? complain(code, &why) : finish_output(0);
}
