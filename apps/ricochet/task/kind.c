#include "kind.h"

#include <string.h>

const kind *kind_of(const study *s) {
  static const kind *const kinds[] = {&kind_orbits, &kind_trajectory, &kind_branch};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (strcmp(kinds[i]->name, study_kind(s)) == 0)
      return kinds[i];
  return NULL;
}
