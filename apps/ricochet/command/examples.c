/* ricochet examples: lists or prints the studies that the program ships; never starts MPI. */
#include <stdio.h>
#include <string.h>

#include "base/embedded.h"
#include "command.h"

extern const embedded_text shipped_studies[];

static const char help[] = "usage: ricochet examples [NAME]\n"
                           "\n"
                           "Lists the studies that ricochet ships, or prints one:\n"
                           "  ricochet examples example1 > example1.yaml\n"
                           "  ricochet run example1.yaml\n";

/* Text after "title:" on its line. */
static void print_title(const char *text) {
  const char *title = strstr(text, "\ntitle:");
  if (!title)
    return;
  title += strlen("\ntitle:");
  title += strspn(title, " ");
  printf("%.*s", (int)strcspn(title, "\n"), title);
}

static void list(void) {
  for (const embedded_text *e = shipped_studies; e->name; e++) {
    printf("%-24s ", e->name);
    print_title(e->text);
    putchar('\n');
  }
}

int command_examples(int argc, char **argv) {
  message why;
  if (argc > 2)
    return complain(refuse(&why, EXIT_USAGE, "ricochet examples: %d names given, expected at most one", argc - 1),
                    &why);
  if (argc == 1)
    list();
  else if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)
    fputs(help, stdout);
  else {
    const char *text = embedded_find(shipped_studies, argv[1]);
    if (!text)
      return complain(
          refuse(&why, EXIT_USAGE, "ricochet examples: no study named %s (ricochet examples lists them)", argv[1]),
          &why);
    fputs(text, stdout);
  }
  return finish_output(0);
}
