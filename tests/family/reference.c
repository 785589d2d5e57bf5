#include "reference.h"

#include "support.h"

#include <stdbool.h>
#include <stdio.h>

static reference_row parse(char *line) {
  reference_row row = {.word = ""};
  for (char *field = strtok(line, ",\n"); field && row.count < REFERENCE_FIELDS; field = strtok(NULL, ",\n")) {
    char *end;
    double value = strtod(field, &end);
    bool number = end != field && *end == '\0';
    if (row.count == 0 && !number)
      snprintf(row.word, sizeof row.word, "%.31s", field);
    row.value[row.count++] = number ? value : NAN;
  }
  return row;
}

reference reference_read(const char *name) {
  char path[512], line[8192];
  reference table = {0};
  snprintf(path, sizeof path, "%s/%s.csv", RICOCHET_REFERENCE, name);
  FILE *file = fopen(path, "r");
  if (!file)
    fail_msg("%s cannot be read", path);
  while (fgets(line, sizeof line, file)) {
    if (line[0] == '#' || line[0] == '\n')
      continue;
    table.rows = realloc(table.rows, (table.count + 1) * sizeof *table.rows);
    assert_non_null(table.rows);
    table.rows[table.count++] = parse(line);
  }
  fclose(file);
  assert_true(table.count > 0);
  return table;
}

void reference_clear(reference *table) {
  free(table->rows);
  *table = (reference){0};
}
