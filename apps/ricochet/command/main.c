/* ricochet: the program. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../kind/kind.h"
#include "command.h"

static const char help[] = "usage: ricochet COMMAND ...\n"
                           "\n"
                           "Periodic motions, grazing bifurcations and parameter sweeps of impact oscillators.\n"
                           "\n"
                           "  run STUDY.yaml     computes a study; under mpirun on many ranks\n"
                           "  check STUDY.yaml   validates a study; prints tasks, memory and size of the result\n"
                           "  show FILE.h5       prints what is in a result; --csv, --verify\n"
                           "  examples [NAME]    lists or prints the studies that ricochet ships\n"
                           "\n"
                           "  COMMAND --help     options of a command\n"
                           "  --version          versions of ricochet and its libraries\n";

static void print_choices(const char *title, const schema_choice *const *choices) {
  printf("\n%s\n", title);
  for (; *choices; choices++)
    printf("  %-14s     %s\n", (*choices)->name, (*choices)->summary);
}

static void print_help(void) {
  fputs(help, stdout);
  print_choices("Kinds of study (`kind:` in STUDY.yaml; keys: ricochet check --reference)", studies.kinds);
  print_choices("Models (`model.type:`)", studies.models);
}

int complain(int code, const message *why) {
  int has_place = strchr(why->text, ':') != NULL;
  fprintf(stderr, "%s%s\n", has_place ? "" : "ricochet: ", why->text);
  return code;
}

int finish_output(int code) {
  message why;
  const int flushed = flush_output(code, &why);
  return flushed == code ? code : complain(flushed, &why);
}

static int print_version(void) {
  printf("ricochet %s (%s)\nlibricochet %s (%s)\n%s\n%s\n", build_version(), build_git_sha(), ric_version(),
         ric_libraries(), build_libraries(), build_compiler());
  return finish_output(0);
}

int main(int argc, char **argv) {
  static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
  } commands[] = {
      {"run", command_run}, {"check", command_check}, {"show", command_show}, {"examples", command_examples}};
  const char *word = argc > 1 ? argv[1] : "";
  message why;
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
    if (strcmp(word, commands[i].name) == 0)
      return commands[i].run(argc - 1, argv + 1);
  if (strcmp(word, "--version") == 0)
    return print_version();
  if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
    print_help();
    return finish_output(0);
  }
  if (argc > 1)
    return complain(refuse(&why, EXIT_USAGE, "unknown command %s (see ricochet --help)", word), &why);
  fputs(help, stderr);
  return EXIT_USAGE;
}
