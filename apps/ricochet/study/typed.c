#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "number.h"

/* One scalar being read: item is its index in a list, -1 outside. */
typedef struct reading {
  const document *d;
  int node;
  study_key row;
  const char *label;
  long item;
  message *why;
} reading;

static void write_label(const reading *r, char *label, size_t size) {
  if (r->item < 0)
    snprintf(label, size, "%s", r->label);
  else
    snprintf(label, size, "%s[%ld]", r->label, r->item);
}

/* "model.gamma = 0.1x is not a number, expected a number >= 0". @param fault  " is not a number" or such, or "" */
static int refuse_value(const reading *r, const char *fault) {
  char label[128], held[128], allowed[256];
  write_label(r, label, sizeof label);
  document_show(r->d, r->node, held, sizeof held);
  if (r->item < 0)
    schema_allowed(r->row, allowed, sizeof allowed);
  else
    schema_allowed_item(r->row, allowed, sizeof allowed);
  return document_refuse(r->d, r->node, r->why, "%s = %s%s, expected %s", label, held, fault, allowed);
}

static int read_number(const reading *r, double *number) {
  const yaml_node_t *n = document_node(r->d, r->node);
  if (document_is_null(r->d, r->node)) {
    *number = -INFINITY;
    return r->row->null ? 0 : refuse_value(r, "");
  }
  if (n->type != YAML_SCALAR_NODE || n->data.scalar.style != YAML_PLAIN_SCALAR_STYLE)
    return refuse_value(r, "");
  switch (number_read((const char *)n->data.scalar.value, n->data.scalar.length, number)) {
  case NUMBER_MALFORMED:
    return refuse_value(r, " is not a number");
  case NUMBER_TOO_LARGE:
    return refuse_value(r, " is out of range");
  case NUMBER_OK:
    break;
  }
  switch (schema_check(r->row, *number)) {
  case FIT_NOT_INTEGER:
    return refuse_value(r, "");
  case FIT_OUT_OF_RANGE:
    return refuse_value(r, " is out of range");
  case FIT_OK:
    break;
  }
  return 0;
}

static int read_flag(const reading *r, double *number) {
  const yaml_node_t *n = document_node(r->d, r->node);
  const bool plain = n->type == YAML_SCALAR_NODE && n->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
  if (plain && document_is(r->d, r->node, "true")) {
    *number = 1;
    return 0;
  }
  *number = 0;
  return plain && document_is(r->d, r->node, "false") ? 0 : refuse_value(r, "");
}

/* Whether a scalar node holds one of "a|b|c". */
static bool is_one_of(const reading *r, const char *words) {
  const yaml_node_t *n = document_node(r->d, r->node);
  return schema_is_among((const char *)n->data.scalar.value, n->data.scalar.length, words);
}

/* A word of a list as its index among the allowed words. */
static int read_place(const reading *r, double *place) {
  const yaml_node_t *n = document_node(r->d, r->node);
  const long found = n->type == YAML_SCALAR_NODE
                         ? schema_find_word((const char *)n->data.scalar.value, n->data.scalar.length, r->row->words)
                         : -1;
  *place = (double)found;
  return found < 0 ? refuse_value(r, "") : 0;
}

static int read_text(const reading *r, char **text) {
  const yaml_node_t *n = document_node(r->d, r->node);
  if (n->type != YAML_SCALAR_NODE || document_is_null(r->d, r->node))
    return refuse_value(r, "");
  if (r->row->type == VALUE_WORD && is_one_of(r, r->row->later_words))
    return refuse_value(r, " is not in this version");
  if (r->row->type == VALUE_WORD && !is_one_of(r, r->row->words))
    return refuse_value(r, "");
  const char *held = (const char *)n->data.scalar.value;
  if (memchr(held, 0, n->data.scalar.length))
    return refuse_value(r, " contains a NUL character");
  *text = strdup(held);
  return *text ? 0 : refuse(r->why, EXIT_RUN, "%s: out of memory", r->d->from.name);
}

static int read_scalar(const reading *r, typed_value *value, size_t i) {
  switch (r->row->type) {
  case VALUE_NUMBER:
  case VALUE_INTEGER:
    return read_number(r, &value->numbers[i]);
  case VALUE_FLAG:
    return read_flag(r, &value->numbers[i]);
  default:
    return value->list ? read_place(r, &value->numbers[i]) : read_text(r, &value->text);
  }
}

static int read_items(reading r, typed_value *value) {
  int code = 0;
  for (size_t i = 0; i < value->count && !code; i++) {
    r.node = typed_item_node(r.d, value, i);
    r.item = value->list ? (long)i : -1;
    code = read_scalar(&r, value, i);
  }
  return code;
}

int typed_read(const document *d, int key, int node, study_key row, const char *label, typed_value *value,
               message *why) {
  const yaml_node_t *n = document_node(d, node);
  const reading r = {d, node, row, label, -1, why};
  *value = (typed_value){.present = true, .list = n->type == YAML_SEQUENCE_NODE, .count = 1, .node = node};
  if (value->list ? !row->list : !row->scalar)
    return refuse_value(&r, "");
  if (value->list)
    value->count = (size_t)(n->data.sequence.items.top - n->data.sequence.items.start);
  const char *assigned = document_assigned_by(d, node);
  value->line = assigned ? 0 : document_line(d, key);
  value->assigned = assigned ? strdup(assigned) : NULL;
  const bool numeric = value->list || (row->type != VALUE_WORD && row->type != VALUE_TEXT);
  if (numeric)
    value->numbers = calloc(value->count + 1, sizeof *value->numbers);
  if ((assigned && !value->assigned) || (numeric && !value->numbers))
    return refuse(why, EXIT_RUN, "%s: out of memory", d->from.name);
  return read_items(r, value);
}

/* The default of a list: "[]", or words as in "[fold, grazing]". */
static bool default_list(study_key row, const char *fallback, typed_value *value) {
  size_t most = 1;
  for (const char *c = fallback; *c; c++)
    most += *c == ',';
  value->list = true;
  value->numbers = calloc(most + 1, sizeof *value->numbers);
  for (const char *word = fallback + 1; value->numbers && *word && *word != ']'; word += strspn(word, ", ")) {
    const size_t length = strcspn(word, ",]");
    value->numbers[value->count++] = (double)schema_find_word(word, length, row->words);
    word += length;
  }
  return value->numbers != NULL;
}

bool typed_default(study_key row, const schema_choice *model, typed_value *value) {
  const char *fallback = schema_fallback(row, model);
  *value = (typed_value){0};
  if (row->required || !fallback || !*fallback)
    return true;
  value->present = true;
  if (*fallback == '[')
    return default_list(row, fallback, value);
  value->count = 1;
  if (row->type == VALUE_WORD || row->type == VALUE_TEXT)
    return (value->text = strdup(fallback)) != NULL;
  value->numbers = calloc(value->count + 1, sizeof *value->numbers);
  if (!value->numbers)
    return false;
  if (row->type == VALUE_FLAG)
    value->numbers[0] = strcmp(fallback, "true") == 0;
  else if (strcmp(fallback, "null") == 0)
    value->numbers[0] = -INFINITY;
  else
    number_read(fallback, strlen(fallback), &value->numbers[0]);
  return true;
}

void typed_clear(typed_value *value) {
  free(value->numbers);
  free(value->text);
  free(value->assigned);
  *value = (typed_value){0};
}

int typed_item_node(const document *d, const typed_value *value, size_t i) {
  return value->list ? document_node(d, value->node)->data.sequence.items.start[i] : value->node;
}

int typed_check(const document *d, int node, study_key row, const char *label, double value, message *why) {
  const schema_fit fit = schema_check(row, value);
  if (fit == FIT_OK)
    return 0;
  char shown[32], allowed[256];
  number_show(value, shown, sizeof shown);
  schema_allowed_item(row, allowed, sizeof allowed);
  return document_refuse(d, node, why, "%s = %s%s, expected %s", label, shown,
                         fit == FIT_NOT_INTEGER ? "" : " is out of range", allowed);
}
