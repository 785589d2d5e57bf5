/* ricochet show: what is in a result; never starts MPI. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>

#include "../kind/kind.h"
#include "command.h"

static const char help[] =
    "usage: ricochet show FILE.h5 [--csv[=GROUP[/AXIS]]] [--verify]\n"
    "       ricochet show --reference\n"
    "\n"
    "Prints what is in a result: parameters, columns, outcomes, special points.\n"
    "\n"
    "  --csv[=GROUP]       the columns of a group (default: the first with a row per task) as CSV;\n"
    "                      elements of columns with more axes as q[3]\n"
    "  --csv=GROUP/AXIS    a row for each index of another axis: trajectory/impact_row,\n"
    "                      trajectory/sample, orbits/particle\n"
    "  --verify            reads everything through its checksums, says whether it is sound\n"
    "  --reference         prints the schema of results, every data set of every kind, in Markdown\n"
    "\n"
    "Exit codes: 0 done, 2 bad usage, 3 cannot read, damaged or not a result.\n";

typedef enum what { SHOW_CONTENTS, SHOW_CSV, SHOW_VERIFY, SHOW_REFERENCE, SHOW_HELP } what;

static int show(what w, const char *path, const char *group, message *why) {
  if (w == SHOW_CSV)
    return result_show_csv(path, group, why);
  if (w == SHOW_CONTENTS)
    return result_show(path, kind_card, why);
  int code = result_verify(path, (ric_poll){0}, why);
  if (!code)
    printf("%s: sound\n", path);
  return code;
}

int command_show(int argc, char **argv) {
  static const struct option options[] = {{"csv", optional_argument, NULL, 'c'},
                                          {"verify", no_argument, NULL, 'v'},
                                          {"reference", no_argument, NULL, 'r'},
                                          {"help", no_argument, NULL, 'h'},
                                          {NULL, 0, NULL, 0}};
  message why;
  what w = SHOW_CONTENTS;
  const char *group = NULL;
  int code = 0;
  opterr = 0;
  for (int option = 0; !code && option != -1;) {
    char text[3];
    option = getopt_long(argc, argv, "h", options, NULL);
    if (option == 'c') {
      w = SHOW_CSV;
      group = optarg;
    } else if (option == 'v')
      w = SHOW_VERIFY;
    else if (option == 'r')
      w = SHOW_REFERENCE;
    else if (option == 'h')
      w = SHOW_HELP;
    else if (option != -1)
      code = refuse(&why, EXIT_USAGE, "ricochet show: unknown option %s (see ricochet show --help)",
                    refused_option(argv, text));
  }
  if (!code && w >= SHOW_REFERENCE) {
    w == SHOW_HELP ? (void)fputs(help, stdout) : kind_results_reference(stdout);
    return finish_output(0);
  }
  if (!code && argc - optind != 1)
    code = refuse(&why, EXIT_USAGE, "ricochet show: %d files given, expected one (see ricochet show --help)",
                  argc - optind);
  if (!code)
    code = show(w, argv[optind], group, &why);
  return code ? complain(code, &why) : finish_output(0);
}
