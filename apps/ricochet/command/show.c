/* ricochet show: what is in a result; never starts MPI. */
#define _GNU_SOURCE /* getopt_long */
#include <getopt.h>
#include <stdio.h>

#include "../kind/kind.h"
#include "../result/child.h"
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
    "The file may be anybody's: another process reads it, within limits, so that a file that makes HDF5 crash is\n"
    "refused like a damaged one.\n"
    "\n"
    "Exit codes: 0 done, 2 bad usage, 3 cannot read, damaged or not a result.\n";

typedef enum what { SHOW_CONTENTS, SHOW_CSV, SHOW_VERIFY, SHOW_REFERENCE, SHOW_HELP } what;

typedef struct request {
  what what;
  const char *path, *group;
} request;

/* In a child: the file may be anybody's. */
static int show(void *user, FILE *reply, message *why) {
  const request *r = user;
  (void)reply; /* all goes to standard output */
  if (r->what == SHOW_CSV)
    return result_show_csv(r->path, r->group, why);
  if (r->what == SHOW_CONTENTS)
    return result_show(r->path, kind_card, why);
  const int code = result_verify(r->path, (ric_poll){0}, why);
  if (!code)
    printf("%s: sound\n", r->path);
  return code;
}

int command_show(int argc, char **argv) {
  static const struct option options[] = {{"csv", optional_argument, NULL, 'c'},
                                          {"verify", no_argument, NULL, 'v'},
                                          {"reference", no_argument, NULL, 'r'},
                                          {"help", no_argument, NULL, 'h'},
                                          {NULL, 0, NULL, 0}};
  message why;
  request r = {.what = SHOW_CONTENTS};
  int code = 0;
  opterr = 0;
  for (int option = 0; !code && option != -1;) {
    char text[3];
    option = getopt_long(argc, argv, "h", options, NULL);
    if (option == 'c') {
      r.what = SHOW_CSV;
      r.group = optarg;
    } else if (option == 'v')
      r.what = SHOW_VERIFY;
    else if (option == 'r')
      r.what = SHOW_REFERENCE;
    else if (option == 'h')
      r.what = SHOW_HELP;
    else if (option != -1)
      code = refuse(&why, EXIT_USAGE, "ricochet show: unknown option %s (see ricochet show --help)",
                    refused_option(argv, text));
  }
  if (!code && r.what >= SHOW_REFERENCE) {
    r.what == SHOW_HELP ? (void)fputs(help, stdout) : kind_results_reference(stdout);
    return finish_output(0);
  }
  if (!code && argc - optind != 1)
    code = refuse(&why, EXIT_USAGE, "ricochet show: %d files given, expected one (see ricochet show --help)",
                  argc - optind);
  r.path = argv[optind];
  if (!code)
    code = child_read(r.path, &(child_task){.read = show, .user = &r}, &why);
  return code ? complain(code, &why) : finish_output(0);
}
