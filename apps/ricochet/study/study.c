#include "study.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "document.h"
#include "parts.h"

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

static int read_key(study *s, const document *d, int key_node, int node, study_key key, message *why) {
  typed_value *value = &s->values[key];
  if (value->node) /* read ahead of the others */
    return 0;
  typed_clear(value);
  return typed_read(d, key_node, node, schema_row(key), schema_row(key)->path, value, why);
}

/* Text of a key node if it is short, without a dot and printable as a C string, "" otherwise: such a name is in no
 * table. */
static const char *key_text(const document *d, int key) {
  const yaml_node_t *n = document_node(d, key);
  const char *text = (const char *)n->data.scalar.value;
  const bool sound = n->data.scalar.length < 64 && strlen(text) == n->data.scalar.length && !strchr(text, '.');
  return sound ? text : "";
}

static int read_section(study *s, const document *d, const char *section, int node, message *why);

/* One key of a section, or a section within it. */
static int read_pair(study *s, const document *d, const char *section, const yaml_node_pair_t *pair, message *why) {
  char path[128];
  snprintf(path, sizeof path, "%s.%s", section, key_text(d, pair->key));
  if (schema_is_section(path))
    return read_section(s, d, path, pair->value, why);
  const study_key key = schema_find(path);
  return key == KEY_COUNT ? refuse_unknown_key(d, pair->key, section, why)
                          : read_key(s, d, pair->key, pair->value, key, why);
}

static int read_section(study *s, const document *d, const char *section, int node, message *why) {
  const yaml_node_t *n = document_node(d, node);
  if (n->type != YAML_MAPPING_NODE) {
    char held[128], names[256];
    document_show(d, node, held, sizeof held);
    schema_names(section, names, sizeof names);
    return document_refuse(d, node, why, "%s = %s, expected a mapping of the keys %s", section, held, names);
  }
  int code = 0;
  for (const yaml_node_pair_t *pair = n->data.mapping.pairs.start; pair < n->data.mapping.pairs.top && !code; pair++)
    code = read_pair(s, d, section, pair, why);
  return code;
}

static int read_top(study *s, const document *d, const yaml_node_pair_t *pair, message *why) {
  const char *name = key_text(d, pair->key);
  if (schema_is_section(name))
    return read_section(s, d, name, pair->value, why);
  const study_key key = schema_find(name);
  if (key != KEY_COUNT)
    return read_key(s, d, pair->key, pair->value, key, why);
  return strcmp(name, "sweep") == 0 ? 0 : refuse_unknown_key(d, pair->key, "", why);
}

/* Reads one key of a mapping ahead of its neighbours, where it is given. */
static int read_ahead(study *s, const document *d, int mapping, const char *name, study_key key, message *why) {
  if (!mapping || document_node(d, mapping)->type != YAML_MAPPING_NODE)
    return 0;
  const long at = document_find_pair(d, mapping, name, strlen(name));
  if (at < 0)
    return 0;
  const yaml_node_pair_t *pair = document_node(d, mapping)->data.mapping.pairs.start + at;
  return read_key(s, d, pair->key, pair->value, key, why);
}

/* Defaults of the keys that are not read yet, as the type of the model has them. */
static int set_defaults(study *s, message *why) {
  for (int key = 0; key < KEY_COUNT; key++)
    if (!s->values[key].node && !typed_default(schema_row((study_key)key), study_model(s), &s->values[key]))
      return refuse(why, EXIT_RUN, "%s: out of memory", s->name);
  return 0;
}

/* The kind and the model's type come first: under one of a later version, the other keys are not unknown. */
static int read_keys(study *s, const document *d, message *why) {
  int code = read_ahead(s, d, DOCUMENT_ROOT, "kind", KEY_KIND, why);
  if (!code)
    code = read_ahead(s, d, document_find(d, DOCUMENT_ROOT, "model"), "type", KEY_MODEL_TYPE, why);
  if (!code)
    code = set_defaults(s, why);
  const yaml_node_t *root = document_node(d, DOCUMENT_ROOT);
  for (const yaml_node_pair_t *pair = root->data.mapping.pairs.start; pair < root->data.mapping.pairs.top && !code;
       pair++)
    code = read_top(s, d, pair, why);
  return code;
}

static int check_root(const document *d, message *why) {
  if (document_node(d, DOCUMENT_ROOT)->type == YAML_MAPPING_NODE)
    return 0;
  char held[128], names[256];
  document_show(d, DOCUMENT_ROOT, held, sizeof held);
  schema_names("", names, sizeof names);
  return document_refuse(d, DOCUMENT_ROOT, why, "the study is %s, expected a mapping with the keys %s",
                         document_is_null(d, DOCUMENT_ROOT) ? "empty" : held, names);
}

static int read_tree(study *s, const document *d, message *why) {
  int code = read_keys(s, d, why);
  if (!code)
    code = sweep_read(s, d, document_find(d, DOCUMENT_ROOT, "sweep"), why);
  if (!code)
    code = branch_read(s, d, why);
  if (!code)
    code = iterate_read(s, why);
  return code ? code : study_check(s, d, why);
}

/* The text written out again can be longer than the file was, and a result's study must be one that can be read. */
static int emit_text(study *s, const document *d, message *why) {
  const int code = document_emit(d, &s->text, why);
  if (code || strlen(s->text) <= STUDY_MAX_BYTES)
    return code;
  return refuse(why, EXIT_USAGE, "%s: %zu bytes when written out with its --set values, expected at most %d", s->name,
                strlen(s->text), STUDY_MAX_BYTES);
}

static int keep_text(study *s, const document *d, const char *text, size_t length, message *why) {
  if (d->assignment_count)
    return emit_text(s, d, why);
  s->text = malloc(length + 1);
  if (!s->text)
    return refuse(why, EXIT_RUN, "%s: out of memory", s->name);
  memcpy(s->text, text, length);
  s->text[length] = 0;
  return 0;
}

static int fill(study *s, document *d, const char *const *sets, size_t n_sets, message *why) {
  int code = check_root(d, why);
  for (size_t i = 0; i < n_sets && !code; i++)
    code = document_assign(d, sets[i], why);
  if (!code)
    code = read_tree(s, d, why);
  s->digest = code ? 0 : study_compute_digest(s);
  return code;
}

int study_parse(const char *name, const char *text, size_t length, const char *const *sets, size_t n_sets, study **out,
                message *why) {
  study *s = calloc(1, sizeof *s);
  if (!s || !(s->name = strdup(name))) {
    free(s);
    return refuse(why, EXIT_RUN, "%s: out of memory", name);
  }
  s->followed.key = s->traced.key = KEY_COUNT;
  document *d = NULL;
  int code = document_read((source){.name = s->name, .lines = true}, text, length, &d, why);
  if (!code)
    code = fill(s, d, sets, n_sets, why);
  if (!code)
    code = keep_text(s, d, text, length, why);
  document_destroy(&d);
  if (code)
    study_destroy(&s);
  *out = s;
  return code;
}

void study_destroy(study **s) {
  if (!*s)
    return;
  for (int key = 0; key < KEY_COUNT; key++)
    typed_clear(&(*s)->values[key]);
  for (size_t i = 0; i < STUDY_MAX_SWEEPS; i++) /* all: a refused study may hold values of an entry it does not count */
    free((*s)->sweeps[i].values);
  free((*s)->text);
  free((*s)->name);
  free(*s);
  *s = NULL;
}

const char *study_kind(const study *s) {
  return s->values[KEY_KIND].text;
}

bool study_is_kind(const study *s, const char *kind) {
  return s->values[KEY_KIND].text && strcmp(s->values[KEY_KIND].text, kind) == 0;
}

const char *study_model(const study *s) {
  return s->values[KEY_MODEL_TYPE].text;
}

const char *study_method(const study *s) {
  return s->values[KEY_ORBIT_METHOD].text;
}

long study_item(const study *s, study_key key, size_t particle) {
  const char *alone = schema_row(key)->last_models, *model = study_model(s);
  if (s->values[key].list)
    return (long)particle;
  const bool last = (double)particle + 1 == s->values[KEY_MODEL_PARTICLES].numbers[0];
  return last || !schema_is_among(model, strlen(model), alone) ? 0 : -1;
}

const char *study_name(const study *s) {
  return s->name;
}

const char *study_text(const study *s) {
  return s->text;
}
uint64_t study_digest(const study *s) {
  return s->digest;
}
bool study_follows(const study *s) {
  return study_is_kind(s, "branch") || study_is_kind(s, "grazing") || study_is_beyond(s);
}

bool study_restarts(const study *s) {
  return study_is_kind(s, "branch") && s->values[KEY_RESTART_FILE].node != 0;
}

const study_parameter *study_followed(const study *s) {
  return &s->followed;
}
const study_parameter *study_traced(const study *s) {
  return &s->traced;
}
uint64_t study_tasks(const study *s) {
  return s->tasks;
}
size_t study_sweeps(const study *s) {
  return s->sweep_count;
}
const study_sweep *study_sweep_at(const study *s, size_t index) {
  return &s->sweeps[index].view;
}
size_t study_line(const study *s, study_key key) {
  return s->values[key].line;
}

bool study_gives(const study *s, study_key key) {
  return s->values[key].line > 0 || s->values[key].assigned;
}

void study_place(const study *s, study_key key, char *text, size_t size) {
  const typed_value *value = &s->values[key];
  const char *path = schema_row(key)->path;
  if (value->assigned)
    snprintf(text, size, "%s: %s", value->assigned, path);
  else if (value->line)
    snprintf(text, size, "%s:%zu: %s", s->name, value->line, path);
  else
    snprintf(text, size, "%s: %s", s->name, path);
}

double study_sweep_value(const study *s, size_t index, uint64_t task) {
  const sweep_entry *e = &s->sweeps[index];
  return e->values[task / e->stride % e->view.points];
}
