#include "parameter.h"

#include <stdlib.h>
#include <string.h>

/* A name being looked up. */
typedef struct lookup {
  const study *s;
  const document *d;
  const parameter_use *use;
  message *why;
} lookup;

/* Splits "model.floor[3]" into key path and item; item -1 without an index, -2 for a malformed or huge one. */
static long split_name(const char *text, char *path, size_t size) {
  const size_t length = strcspn(text, "[");
  snprintf(path, size, "%.*s", (int)(length < size ? length : size - 1), text);
  if (!text[length])
    return -1;
  const char *digits = text + length + 1;
  const size_t count = strspn(digits, "0123456789");
  if (count == 0 || count > 9 || strcmp(digits + count, "]") != 0)
    return -2;
  return strtol(digits, NULL, 10);
}

static int refuse_unknown(const lookup *l, const char *name, const char *path) {
  char near[64], shown[80];
  const parameter_use *u = l->use;
  source_quote(name, strlen(name), shown, sizeof shown);
  schema_nearest_parameter(path, near, sizeof near);
  if (*near)
    return document_refuse(l->d, u->node, l->why, "unknown %s parameter '%s'; did you mean '%s'?", u->noun, shown,
                           near);
  return document_refuse(l->d, u->node, l->why, "unknown %s parameter '%s', expected %s", u->noun, shown, u->example);
}

static int refuse_model(const lookup *l, const char *path, const char *types) {
  char models[64];
  schema_either(types, models, sizeof models);
  return document_refuse(l->d, l->use->node, l->why, "%s = %s is a key of model.type: %s, and this is model.type: %s",
                         l->use->label, path, models, study_model(l->s));
}

/* A parameter must name one number: a scalar by its key, an element of a list by its index. */
static int check_item(const lookup *l, const schema_entry *row, const study_parameter *p) {
  const typed_value *value = &l->s->values[p->key];
  const int node = l->use->node;
  const char *path = row->path, *label = l->use->label;
  if (!value->list)
    return p->item == -1
               ? 0
               : document_refuse(l->d, node, l->why,
                                 "%s = %s, but %s is a single number here: %s %s without an index, or give a list",
                                 label, p->name, path, l->use->verb, path);
  if (value->count == 0)
    return document_refuse(l->d, node, l->why, "%s = %s, but %s is an empty list: give the elements to %s", label,
                           p->name, path, l->use->verb);
  if (p->item == -1)
    return document_refuse(l->d, node, l->why, "%s = %s, but %s is a list: %s one element by its index, such as %s[0]",
                           label, path, path, l->use->verb, path);
  if (!(p->item >= 0 && (size_t)p->item < value->count))
    return document_refuse(l->d, node, l->why, "%s = %s, but %s has %zu elements: expected an index from 0 to %zu",
                           label, p->name, path, value->count, value->count - 1);
  return 0;
}

int parameter_find(const study *s, const document *d, const parameter_use *use, const char *name,
                   study_parameter *parameter, message *why) {
  char path[64];
  const lookup l = {.s = s, .d = d, .use = use, .why = why};
  const long item = split_name(name, path, sizeof path);
  const study_key key = schema_find(path);
  if (key == KEY_COUNT)
    return refuse_unknown(&l, name, path);
  const schema_entry *row = schema_row(key);
  if (!row->sweep)
    return document_refuse(d, use->node, why, "%s = %s %s: %s", use->label, path, use->done, row->no_sweep);
  if (study_model(s) && !schema_concerns_model(row, study_model(s)))
    return refuse_model(&l, path, row->models);
  *parameter = (study_parameter){.key = key, .item = item};
  if (item >= 0)
    snprintf(parameter->name, sizeof parameter->name, "%s[%ld]", path, item);
  else
    snprintf(parameter->name, sizeof parameter->name, "%s", name);
  return check_item(&l, row, parameter);
}

int parameter_supply(study *s, const document *d, const parameter_use *use, int key_node, study_key key, double value,
                     message *why) {
  typed_value *to = &s->values[key];
  if (to->node)
    return 0;
  const char *assigned = document_assigned_by(d, use->node);
  typed_clear(to);
  *to = (typed_value){.present = true, .count = 1, .line = document_line(d, key_node)};
  to->numbers = calloc(1, sizeof *to->numbers);
  to->assigned = assigned ? strdup(assigned) : NULL;
  if (!to->numbers || (assigned && !to->assigned))
    return refuse(why, EXIT_RUN, "%s: out of memory", s->name);
  to->numbers[0] = value;
  return 0;
}
