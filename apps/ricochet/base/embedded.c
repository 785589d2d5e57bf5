#include "embedded.h"

#include <string.h>

const char *embedded_find(const embedded_text *list, const char *name) {
  while (list->name && strcmp(list->name, name) != 0)
    list++;
  return list->text;
}
