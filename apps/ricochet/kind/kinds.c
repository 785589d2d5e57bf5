#include "kind.h"

#include <string.h>

const kind *kind_of(const study *s) {
  static const kind *const kinds[] = {&kind_orbits,  &kind_orbits_shooting, &kind_trajectory, &kind_branch,
                                      &kind_grazing, &kind_diagram,         &kind_basin};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (strcmp(kinds[i]->name, study_kind(s)) == 0 &&
        (!kinds[i]->methods || schema_is_among(study_method(s), strlen(study_method(s)), kinds[i]->methods)))
      return kinds[i];
  return NULL;
}

void kind_lay_out_tail(tail *to, const char *group, const char *row_axis, const char *offset, const char *meaning,
                       const column *columns, size_t count, const table_axis *axes, size_t axis_count) {
  *to = (tail){.records = {.group = group, .row_axis = row_axis}, .offset = offset, .meaning = meaning};
  table_add(&to->records, columns, count, axes, axis_count);
  table_lay_out(&to->records);
}

int kind_no_extra(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                  message *why) {
  (void)s;
  (void)plan;
  (void)done;
  (void)poll;
  (void)extra;
  (void)why;
  return 0;
}
