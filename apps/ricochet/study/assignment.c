#include "document.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One step of a path: a name, or an index where name is NULL. */
typedef struct step {
  const char *name;
  size_t length;
  size_t index;
} step;

/* Position of a node in the tree: pair or item `at` of a collection. Indices, because nodes move in memory as the tree
 * grows. The root is in no collection. */
typedef struct slot {
  int collection;
  size_t at;
} slot;

typedef struct edit {
  document *d;
  const char *path; /* as written, for messages: ends at `end` */
  const char *end;
  source place;
  message *why;
} edit;

static bool is_name_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/* Reads one step and advances the cursor past it; false if the path is malformed there. */
static bool read_step(const char *begin, const char **cursor, const char *end, step *out) {
  const char *p = *cursor;
  if (p > begin && p < end && *p == '[') {
    const char *digits = ++p;
    size_t index = 0;
    for (; p < end && *p >= '0' && *p <= '9' && p - digits < 9; p++)
      index = 10 * index + (size_t)(*p - '0');
    if (p == digits || p == end || *p != ']')
      return false;
    *out = (step){.index = index};
    *cursor = p + 1;
    return true;
  }
  if (p > begin && *p++ != '.')
    return false;
  const char *name = p;
  while (p < end && is_name_char(*p))
    p++;
  *out = (step){.name = name, .length = (size_t)(p - name)};
  *cursor = p;
  return p > name;
}

static int *slot_node(document *d, slot s, int *root) {
  if (!s.collection)
    return root;
  yaml_node_t *n = document_node(d, s.collection);
  return n->type == YAML_MAPPING_NODE ? &n->data.mapping.pairs.start[s.at].value : &n->data.sequence.items.start[s.at];
}

static int no_memory(const edit *e) {
  return refuse(e->why, EXIT_RUN, "%s: out of memory", e->place.name);
}

/* Adds `name: null` to a mapping. The next step turns the null into a mapping, or the value replaces it. */
static int add_key(const edit *e, int mapping, const step *name) {
  yaml_document_t *tree = &e->d->tree;
  const int key = yaml_document_add_scalar(tree, NULL, (const unsigned char *)name->name, (int)name->length,
                                           YAML_PLAIN_SCALAR_STYLE);
  const int value = yaml_document_add_scalar(tree, NULL, (const unsigned char *)"", 0, YAML_PLAIN_SCALAR_STYLE);
  if (!key || !value || !yaml_document_append_mapping_pair(tree, mapping, key, value))
    return no_memory(e);
  return 0;
}

static int step_into_key(const edit *e, int *node, const step *name, const char *so_far, slot *here) {
  document *d = e->d;
  if (document_is_null(d, *node)) {
    const int mapping = yaml_document_add_mapping(&d->tree, NULL, YAML_ANY_MAPPING_STYLE);
    if (!mapping)
      return no_memory(e);
    int root = DOCUMENT_ROOT;
    *slot_node(d, *here, &root) = *node = mapping;
  }
  if (document_node(d, *node)->type != YAML_MAPPING_NODE) {
    char held[128];
    document_show(d, *node, held, sizeof held);
    return source_refuse(&e->place, 0, e->why, "%.*s is %s, expected a mapping to set '%.*s' in",
                         (int)(so_far - e->path), e->path, held, (int)name->length, name->name);
  }
  long pair = document_find_pair(d, *node, name->name, name->length);
  if (pair < 0) {
    const int code = add_key(e, *node, name);
    if (code)
      return code;
    pair = document_find_pair(d, *node, name->name, name->length);
  }
  *here = (slot){*node, (size_t)pair};
  return 0;
}

static int step_into_item(const edit *e, int node, const step *item, const char *so_far, slot *here) {
  const yaml_node_t *n = document_node(e->d, node);
  const int shown = (int)(so_far - e->path);
  if (n->type != YAML_SEQUENCE_NODE) {
    char held[128];
    document_show(e->d, node, held, sizeof held);
    return source_refuse(&e->place, 0, e->why, "%.*s is %s, expected a list to set element %zu of", shown, e->path,
                         document_is_null(e->d, node) ? "not given" : held, item->index);
  }
  const size_t count = (size_t)(n->data.sequence.items.top - n->data.sequence.items.start);
  if (item->index >= count)
    return source_refuse(&e->place, 0, e->why, "%.*s has no element %zu: it has %zu, counted from 0", shown, e->path,
                         item->index, count);
  *here = (slot){node, item->index};
  return 0;
}

/* Finds the slot of the path; creates missing mappings. */
static int find_slot(const edit *e, slot *here) {
  int root = DOCUMENT_ROOT;
  *here = (slot){0};
  for (const char *cursor = e->path; cursor < e->end;) {
    const char *so_far = cursor;
    step next;
    if (!read_step(e->path, &cursor, e->end, &next))
      return source_refuse(&e->place, 0, e->why,
                           "malformed path, expected names joined by dots such as model.gamma or sweep[0].points");
    int node = *slot_node(e->d, *here, &root);
    const int code =
        next.name ? step_into_key(e, &node, &next, so_far, here) : step_into_item(e, node, &next, so_far, here);
    if (code)
      return code;
  }
  return 0;
}

static int copy_node(document *to, const document *from, int node);

static bool copy_items(document *to, int sequence, const document *from, const yaml_node_t *n) {
  for (const int *item = n->data.sequence.items.start; item < n->data.sequence.items.top; item++) {
    const int copy = copy_node(to, from, *item);
    if (!copy || !yaml_document_append_sequence_item(&to->tree, sequence, copy))
      return false;
  }
  return true;
}

static bool copy_pairs(document *to, int mapping, const document *from, const yaml_node_t *n) {
  for (const yaml_node_pair_t *pair = n->data.mapping.pairs.start; pair < n->data.mapping.pairs.top; pair++) {
    const int key = copy_node(to, from, pair->key);
    const int value = key ? copy_node(to, from, pair->value) : 0;
    if (!value || !yaml_document_append_mapping_pair(&to->tree, mapping, key, value))
      return false;
  }
  return true;
}

/* Copies a node with all below it; recursion is bounded by the guard. Returns 0 when out of memory. */
static int copy_node(document *to, const document *from, int node) {
  const yaml_node_t *n = document_node(from, node);
  int copy = 0;
  switch (n->type) {
  case YAML_SEQUENCE_NODE:
    copy = yaml_document_add_sequence(&to->tree, NULL, n->data.sequence.style);
    return copy && copy_items(to, copy, from, n) ? copy : 0;
  case YAML_MAPPING_NODE:
    copy = yaml_document_add_mapping(&to->tree, NULL, n->data.mapping.style);
    return copy && copy_pairs(to, copy, from, n) ? copy : 0;
  default: /* scalars: the guard refuses all other types of node */
    return yaml_document_add_scalar(&to->tree, NULL, n->data.scalar.value, (int)n->data.scalar.length,
                                    n->data.scalar.style);
  }
}

/* Registers an assignment: all nodes added after this call belong to it. @param place  owned after this call */
static bool register_assignment(document *d, char *place) {
  document_assignment *grown = place ? realloc(d->assignments, (d->assignment_count + 1) * sizeof *grown) : NULL;
  if (!grown) {
    free(place);
    return false;
  }
  d->assignments = grown;
  d->assignments[d->assignment_count++] = (document_assignment){document_node_count(d) + 1, place};
  return true;
}

/* "--set path=value" of an assignment, shortened: the value may be a list of a million elements. */
static char *place_of_set(const char *assignment) {
  const size_t length = strlen(assignment);
  const size_t size = length < 240 ? length + 8 : 240;
  char *place = malloc(size + sizeof "--set ");
  if (!place)
    return NULL;
  memcpy(place, "--set ", sizeof "--set ");
  source_quote(assignment, length, place + strlen(place), size);
  return place;
}

/* Puts a node at the end of the path. @param node  0: its allocation failed */
static int put_node(const edit *e, int node) {
  slot here;
  const int code = node ? find_slot(e, &here) : no_memory(e);
  int root = DOCUMENT_ROOT;
  if (!code)
    *slot_node(e->d, here, &root) = node;
  return code;
}

static int put_text(const edit *e) {
  document *value = NULL;
  const char *text = e->end + 1;
  if (text[strspn(text, " ")] == 0)
    return source_refuse(&e->place, 0, e->why, "no value after '=', expected one; null and '' are written out");
  int code = document_read(e->place, text, strlen(text), &value, e->why);
  if (!code)
    code = put_node(e, copy_node(e->d, value, DOCUMENT_ROOT));
  document_destroy(&value);
  return code;
}

int document_assign(document *d, const char *assignment, message *why) {
  if (!register_assignment(d, place_of_set(assignment)))
    return refuse(why, EXIT_RUN, "--set: out of memory");
  const char *place = d->assignments[d->assignment_count - 1].place;
  edit e = {.d = d, .path = assignment, .end = strchr(assignment, '='), .place = {.name = place}, .why = why};
  if (!e.end)
    return source_refuse(&e.place, 0, why, "no '=', expected path=value such as model.gamma=0.1");
  if (e.end == assignment)
    return source_refuse(&e.place, 0, why, "no path in front of '=', expected path=value such as model.gamma=0.1");
  return put_text(&e);
}

static int add_scalar(document *d, const char *text) {
  return yaml_document_add_scalar(&d->tree, NULL, (const unsigned char *)text, (int)strlen(text),
                                  YAML_PLAIN_SCALAR_STYLE);
}

static int add_number(document *d, double number) {
  char text[32];
  snprintf(text, sizeof text, "%.17g", number);
  return add_scalar(d, text);
}

static int add_list(document *d, const double *numbers, size_t count) {
  const int list = yaml_document_add_sequence(&d->tree, NULL, YAML_FLOW_SEQUENCE_STYLE);
  for (size_t i = 0; list && i < count; i++) {
    const int item = add_number(d, numbers[i]);
    if (!item || !yaml_document_append_sequence_item(&d->tree, list, item))
      return 0;
  }
  return list;
}

static int add_value(document *d, const study_assignment *value) {
  switch (value->what) {
  case ASSIGN_NUMBER:
    return add_number(d, value->numbers[0]);
  case ASSIGN_LIST:
    return add_list(d, value->numbers, value->count);
  case ASSIGN_NULL:
    return add_scalar(d, "null");
  case ASSIGN_EMPTY:
    return yaml_document_add_mapping(&d->tree, NULL, YAML_FLOW_MAPPING_STYLE);
  }
  return 0;
}

int document_assign_value(document *d, const char *place, const study_assignment *value, message *why) {
  if (!register_assignment(d, strdup(place)))
    return refuse(why, EXIT_RUN, "%s: out of memory", place);
  const edit e = {.d = d,
                  .path = value->path,
                  .end = value->path + strlen(value->path),
                  .place = {.name = d->assignments[d->assignment_count - 1].place},
                  .why = why};
  return put_node(&e, add_value(d, value));
}
