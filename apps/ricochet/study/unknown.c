#include "parts.h"

#include <stdio.h>
#include <string.h>

int refuse_unknown_key(const document *d, int key, const char *section, message *why) {
  char name[80], path[128], near[64], names[256];
  const yaml_node_t *n = document_node(d, key);
  source_quote((const char *)n->data.scalar.value, n->data.scalar.length, name, sizeof name);
  const char *dot = *section ? "." : "", *in = *section ? " in " : "";
  snprintf(path, sizeof path, "%s%s%s", section, dot, name);
  schema_nearest(path, near, sizeof near);
  if (!*near) {
    schema_names(section, names, sizeof names);
    return document_refuse(d, key, why, "unknown key '%s'%s%s, expected one of %s", name, in, section, names);
  }
  const size_t length = strlen(section);
  const bool here = length && strncmp(near, section, length) == 0 && near[length] == '.';
  return document_refuse(d, key, why, "unknown key '%s'%s%s; did you mean '%s'?", name, in, section,
                         here ? near + length + 1 : near);
}
