/* The schema page of results, printed from the lists of columns: a chapter for every kind of study. */
#include "kind.h"

static void print_type(FILE *out, const column *c) {
  static const char *const types[] = {[COLUMN_F64] = "float64",
                                      [COLUMN_I64] = "int64",
                                      [COLUMN_COMPLEX] = "complex",
                                      [COLUMN_ENUM] = "enum:",
                                      [COLUMN_TEXT] = "text"};
  fprintf(out, "%s", types[c->type]);
  for (size_t i = 0; i < c->name_count; i++)
    fprintf(out, "%s `%s`", i ? "," : "", c->names[i]);
}

static void print_column(FILE *out, const char *group, const char *row_axis, const column *c) {
  fprintf(out, "| `/%s/%s` | [%s", group, c->name, row_axis);
  for (int i = 0; i < column_axes(c); i++)
    fprintf(out, ", %s", c->axes[i]);
  fprintf(out, "] | ");
  print_type(out, c);
  fprintf(out, " | %s |\n", c->doc ? c->doc : c->long_name);
}

/* @param doc  lines above the columns; NULL continues the table before */
static void print_list(FILE *out, const column_list *list, const char *doc) {
  if (doc)
    fprintf(out, "\n%s\n| data set | axes | type | meaning |\n|---|---|---|---|\n", doc);
  if (list->offset)
    print_column(out, list->group, "task_edge",
                 &(column){.name = list->offset, .type = COLUMN_I64, .long_name = list->meaning});
  for (size_t i = 0; i < list->count; i++)
    print_column(out, list->group, list->row_axis, &list->columns[i]);
}

/* The text of a kind, where it has one, stands above its first list. */
static void print_kind(FILE *out, const kind *k) {
  char name[64];
  snprintf(name, sizeof name, "%s_results", k->choice.name);
  const char *text = embedded_find(studies.chapters, name);
  fprintf(out, "\n## kind: %s\n", k->choice.name);
  for (size_t i = 0; i < KIND_MOST_LISTS; i++)
    for (const column_list *list = k->lists[i]; list && list->group; list++, text = NULL)
      print_list(out, list, text ? text : list->doc);
}

void kind_results_reference(FILE *out) {
  fprintf(out, "%s", embedded_find(studies.chapters, "results"));
  for (const schema_choice *const *choice = studies.kinds; *choice; choice++)
    print_kind(out, (const kind *)*choice);
}
