/* getopt_long is not in POSIX. */
#define _GNU_SOURCE
#include "run.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"

/* Seconds of "30", "30s", "55m", "2h", "1.5h", "1d"; -1 when it is none of these or not positive. */
static double parse_duration(const char *text) {
  static const struct {
    const char *unit;
    double seconds;
  } units[] = {{"", 1}, {"s", 1}, {"m", 60}, {"h", 3600}, {"d", 86400}};
  char *end;
  if (strspn(text, "0123456789.") == 0)
    return -1;
  double value = strtod(text, &end);
  for (size_t i = 0; i < sizeof units / sizeof *units; i++)
    if (strcmp(end, units[i].unit) == 0 && value > 0 && value * units[i].seconds < INFINITY)
      return value * units[i].seconds;
  return -1;
}

static int read_duration(const char *name, const char *text, double *seconds, message *why) {
  *seconds = parse_duration(text);
  if (*seconds > 0)
    return 0;
  return refuse(why, EXIT_USAGE, "--%s %s: expected a positive duration such as 30s, 55m or 2h", name, text);
}

static int read_progress(const char *text, progress_mode *mode, message *why) {
  static const char *const words[] = {"auto", "always", "never"};
  static const progress_mode modes[] = {PROGRESS_AUTO, PROGRESS_ALWAYS, PROGRESS_NEVER};
  for (size_t i = 0; i < 3; i++)
    if (strcmp(text, words[i]) == 0) {
      *mode = modes[i];
      return 0;
    }
  return refuse(why, EXIT_USAGE, "--progress %s: expected auto, always or never", text);
}

static int read_mpi(const char *text, launcher_mode *mode, message *why) {
  static const char *const words[] = {[LAUNCHER_AUTO] = "auto", [LAUNCHER_ON] = "on", [LAUNCHER_OFF] = "off"};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strcmp(text, words[i]) == 0) {
      *mode = (launcher_mode)i;
      return 0;
    }
  return refuse(why, EXIT_USAGE, "--mpi %s: expected auto, on or off", text);
}

const char *refused_option(char **argv, char text[3]) {
  const char *word = argv[optind - 1];
  if (strncmp(word, "--", 2) == 0 || optopt == 0)
    return word;
  text[0] = '-';
  text[1] = (char)optopt;
  text[2] = '\0';
  return text;
}

static const struct option run_long_options[] = {{"output", required_argument, NULL, 'o'},
                                                 {"set", required_argument, NULL, 's'},
                                                 {"resume", no_argument, NULL, 'r'},
                                                 {"force", no_argument, NULL, 'f'},
                                                 {"checkpoint", required_argument, NULL, 'c'},
                                                 {"max-time", required_argument, NULL, 'm'},
                                                 {"progress", required_argument, NULL, 'p'},
                                                 {"mpi", required_argument, NULL, 'i'},
                                                 {"help", no_argument, NULL, 'h'},
                                                 {NULL, 0, NULL, 0}};

static int take_option(run_options *o, int option, const char *argument, const char *word, message *why) {
  switch (option) {
  case 'o':
    o->output = argument;
    return 0;
  case 's':
    o->sets[o->set_count++] = argument;
    return 0;
  case 'r':
    o->resume = true;
    return 0;
  case 'f':
    o->force = true;
    return 0;
  case 'c':
    return read_duration("checkpoint", argument, &o->checkpoint_seconds, why);
  case 'm':
    return read_duration("max-time", argument, &o->max_seconds, why);
  case 'p':
    return read_progress(argument, &o->progress, why);
  case 'i':
    return read_mpi(argument, &o->mpi, why);
  case 'h':
    o->help = true;
    return 0;
  case ':':
    return refuse(why, EXIT_USAGE, "ricochet run: %s needs a value (see ricochet run --help)", word);
  default:
    return refuse(why, EXIT_USAGE, "ricochet run: unknown option %s (see ricochet run --help)", word);
  }
}

static int take_study(run_options *o, int argc, char **argv, message *why) {
  if (argc - optind != 1)
    return refuse(why, EXIT_USAGE,
                  argc == optind ? "ricochet run: no study file given (see ricochet run --help)"
                                 : "ricochet run: more than one study file given: %s %s",
                  argv[optind], argc == optind ? "" : argv[optind + 1]);
  o->study_path = argv[optind];
  if (o->resume && o->force)
    return refuse(why, EXIT_USAGE, "ricochet run: --resume and --force exclude one another");
  return 0;
}

int run_options_parse(int argc, char **argv, run_options *o, message *why) {
  *o = (run_options){.checkpoint_seconds = 30, .max_seconds = INFINITY};
  o->sets = calloc((size_t)argc, sizeof *o->sets);
  if (!o->sets)
    return refuse(why, EXIT_RUN, "no memory for the options");
  optind = 1;
  opterr = 0;
  for (;;) {
    char text[3];
    int option = getopt_long(argc, argv, ":o:h", run_long_options, NULL);
    if (option == -1)
      break;
    int code = take_option(o, option, optarg, refused_option(argv, text), why);
    if (code)
      return code;
  }
  return o->help ? 0 : take_study(o, argc, argv, why);
}

void run_options_clear(run_options *o) {
  free(o->sets);
  o->sets = NULL;
}
