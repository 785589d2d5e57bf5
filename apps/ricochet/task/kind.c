#include "kind.h"

#include <string.h>

const kind *kind_of(const study *s) {
  static const kind *const kinds[] = {&kind_orbits, &kind_orbits_shooting, &kind_trajectory, &kind_branch};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (strcmp(kinds[i]->name, study_kind(s)) == 0 &&
        (!kinds[i]->methods || schema_is_among(study_method(s), strlen(study_method(s)), kinds[i]->methods)))
      return kinds[i];
  return NULL;
}

int kind_no_extra(const study *s, ric_poll poll, extra_rows *extra, message *why) {
  (void)s;
  (void)poll;
  (void)why;
  *extra = (extra_rows){0};
  return 0;
}
