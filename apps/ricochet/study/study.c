/* Reading a study, its digest, and its queries. */
#include "study.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../base/digest.h"
#include "check.h"

int refuse_unknown_key(const study *s, const document *d, int key, const char *section, message *why) {
  char name[80], path[128], near[64], names[256];
  const yaml_node_t *n = document_node(d, key);
  source_quote((const char *)n->data.scalar.value, n->data.scalar.length, name, sizeof name);
  const char *dot = *section ? "." : "", *in = *section ? " in " : "";
  snprintf(path, sizeof path, "%s%s%s", section, dot, name);
  schema_nearest(s->schema, path, near, sizeof near);
  if (!*near) {
    schema_names(s->schema, section, names, sizeof names);
    return document_refuse(d, key, why, "unknown key '%s'%s%s, expected one of %s", name, in, section, names);
  }
  const size_t length = strlen(section);
  const bool here = length && strncmp(near, section, length) == 0 && near[length] == '.';
  return document_refuse(d, key, why, "unknown key '%s'%s%s; did you mean '%s'?", name, in, section,
                         here ? near + length + 1 : near);
}

static int read_key(study *s, const document *d, int key_node, int node, study_key key, message *why) {
  typed_value *value = &s->values[study_place_of(s, key)];
  if (value->node) /* already read by read_ahead */
    return 0;
  typed_clear(value);
  return typed_read(d, key_node, node, key, key->path, value, why);
}

/* Text of a key node; "" if it is long or contains a dot or a NUL, as no key of the schema does. */
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
  if (schema_is_section(s->schema, path))
    return read_section(s, d, path, pair->value, why);
  const study_key key = schema_find(s->schema, path);
  return key ? read_key(s, d, pair->key, pair->value, key, why) : refuse_unknown_key(s, d, pair->key, section, why);
}

static int read_section(study *s, const document *d, const char *section, int node, message *why) {
  const yaml_node_t *n = document_node(d, node);
  if (n->type != YAML_MAPPING_NODE) {
    char held[128], names[256];
    document_show(d, node, held, sizeof held);
    schema_names(s->schema, section, names, sizeof names);
    return document_refuse(d, node, why, "%s = %s, expected a mapping of the keys %s", section, held, names);
  }
  int code = 0;
  for (const yaml_node_pair_t *pair = n->data.mapping.pairs.start; pair < n->data.mapping.pairs.top && !code; pair++)
    code = read_pair(s, d, section, pair, why);
  return code;
}

static int read_top(study *s, const document *d, const yaml_node_pair_t *pair, message *why) {
  const char *name = key_text(d, pair->key);
  if (schema_is_section(s->schema, name))
    return read_section(s, d, name, pair->value, why);
  const study_key key = schema_find(s->schema, name);
  if (key)
    return read_key(s, d, pair->key, pair->value, key, why);
  return strcmp(name, "sweep") == 0 ? 0 : refuse_unknown_key(s, d, pair->key, "", why);
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
  for (size_t i = 0; i < s->schema->key_count; i++)
    if (!s->values[i].node && !typed_default(s->schema->keys[i], s->model, &s->values[i]))
      return refuse(why, EXIT_RUN, "%s: out of memory", s->name);
  return 0;
}

/* The kind and the model's type are read first: if one of them is of a later version, the study is refused for that
 * and not for its other keys. */
static int read_keys(study *s, const document *d, message *why) {
  int code = read_ahead(s, d, DOCUMENT_ROOT, "kind", s->schema->kind, why);
  if (!code)
    code = read_ahead(s, d, document_find(d, DOCUMENT_ROOT, "model"), "type", s->schema->model, why);
  s->kind = schema_choice_of(s->schema->kinds, study_value(s, s->schema->kind)->text);
  s->model = schema_choice_of(s->schema->models, study_value(s, s->schema->model)->text);
  if (!code)
    code = set_defaults(s, why);
  const yaml_node_t *root = document_node(d, DOCUMENT_ROOT);
  for (const yaml_node_pair_t *pair = root->data.mapping.pairs.start; pair < root->data.mapping.pairs.top && !code;
       pair++)
    code = read_top(s, d, pair, why);
  return code;
}

static int check_root(const study *s, const document *d, message *why) {
  if (document_node(d, DOCUMENT_ROOT)->type == YAML_MAPPING_NODE)
    return 0;
  char held[128], names[256];
  document_show(d, DOCUMENT_ROOT, held, sizeof held);
  schema_names(s->schema, "", names, sizeof names);
  return document_refuse(d, DOCUMENT_ROOT, why, "the study is %s, expected a mapping with the keys %s",
                         document_is_null(d, DOCUMENT_ROOT) ? "empty" : held, names);
}

/* Called only if kind and model are given; study_check refuses a study without them later. */
static int complete(study *s, const document *d, message *why) {
  if (!s->kind || !s->model)
    return 0;
  const int code = s->model->complete ? s->model->complete(s, d, why) : 0;
  return code || !s->kind->complete ? code : s->kind->complete(s, d, why);
}

static int read_tree(study *s, const document *d, message *why) {
  int code = read_keys(s, d, why);
  if (!code)
    code = sweep_read(s, d, document_find(d, DOCUMENT_ROOT, "sweep"), why);
  if (!code)
    code = complete(s, d, why);
  return code ? code : study_check(s, d, why);
}

/* The emitted text can be longer than the file, and the study of a result must be readable. */
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

/* --- its digest --- */

/* Least significant byte first: the digest is the same on every machine. */
static void add_integer(uint64_t *digest, uint64_t value) {
  unsigned char bytes[8];
  for (int i = 0; i < 8; i++)
    bytes[i] = (unsigned char)(value >> (8 * i));
  *digest = digest_bytes(*digest, bytes, sizeof bytes);
}

/* Lengths first: two different sequences of texts or lists never give the same bytes. */
static void add_text(uint64_t *digest, const char *text) {
  add_integer(digest, strlen(text));
  *digest = digest_bytes(*digest, text, strlen(text));
}

static void add_numbers(uint64_t *digest, const double *numbers, size_t count) {
  add_integer(digest, count);
  for (size_t i = 0; i < count; i++) {
    uint64_t bits;
    memcpy(&bits, &numbers[i], sizeof bits);
    add_integer(digest, bits);
  }
}

static void add_value(uint64_t *digest, const typed_value *value) {
  const char *tag = !value->present ? "absent" : value->text ? "text" : value->list ? "list" : "number";
  add_text(digest, tag);
  if (value->text)
    add_text(digest, value->text);
  else
    add_numbers(digest, value->numbers, value->count);
}

static uint64_t compute_digest(const study *s) {
  uint64_t digest = 0;
  for (size_t i = 0; i < s->schema->key_count; i++) {
    add_text(&digest, s->schema->keys[i]->path);
    add_value(&digest, &s->values[i]);
  }
  for (size_t i = 0; i < s->sweep_count; i++) {
    add_text(&digest, s->sweeps[i].view.name);
    add_numbers(&digest, s->sweeps[i].values, s->sweeps[i].view.points);
  }
  return digest;
}

/* --- life --- */

static int fill(study *s, document *d, const study_source *from, message *why) {
  int code = check_root(s, d, why);
  for (size_t i = 0; i < from->set_count && !code; i++)
    code = document_assign(d, from->sets[i], why);
  for (size_t i = 0; i < from->assignment_count && !code; i++)
    code = document_assign_value(d, from->assigned_by, &from->assignments[i], why);
  if (!code)
    code = read_tree(s, d, why);
  s->digest = code ? 0 : compute_digest(s);
  return code;
}

static size_t first_slot(study_key key) {
  return ((uintptr_t)key / sizeof *key) % STUDY_SLOTS;
}

static void set_slots(study *s) {
  for (size_t i = 0; i < s->schema->key_count; i++) {
    size_t at = first_slot(s->schema->keys[i]);
    while (s->slots[at])
      at = (at + 1) % STUDY_SLOTS;
    s->slots[at] = (unsigned short)(i + 1);
  }
}

size_t study_place_of(const study *s, study_key key) {
  size_t at = first_slot(key);
  while (s->schema->keys[s->slots[at] - 1] != key)
    at = (at + 1) % STUDY_SLOTS;
  return s->slots[at] - 1u;
}

static study *create(const study_source *from) {
  study *s = calloc(1, sizeof *s);
  if (!s)
    return NULL;
  s->schema = from->schema;
  s->name = strdup(from->name);
  s->values = calloc(from->schema->key_count, sizeof *s->values);
  if (!s->name || !s->values)
    study_destroy(&s);
  else
    set_slots(s);
  return s;
}

int study_parse(const study_source *from, study **out, message *why) {
  study *s = *out = create(from);
  if (!s)
    return refuse(why, EXIT_RUN, "%s: out of memory", from->name);
  document *d = NULL;
  int code = document_read((source){.name = s->name, .lines = true}, from->text, from->length, &d, why);
  if (!code)
    code = fill(s, d, from, why);
  if (!code)
    code = keep_text(s, d, from->text, from->length, why);
  document_destroy(&d);
  if (code)
    study_destroy(out);
  return code;
}

void study_destroy(study **s) {
  if (!*s)
    return;
  for (size_t i = 0; (*s)->values && i < (*s)->schema->key_count; i++)
    typed_clear(&(*s)->values[i]);
  free((*s)->values);
  for (size_t i = 0; i < STUDY_MAX_SWEEPS; i++) /* all: a refused entry is not counted but may own values */
    free((*s)->sweeps[i].values);
  free((*s)->text);
  free((*s)->name);
  free(*s);
  *s = NULL;
}

/* --- queries --- */

const char *study_kind(const study *s) {
  return s->kind->name;
}

const schema_choice *study_kind_choice(const study *s) {
  return s->kind;
}

const schema_choice *study_model_choice(const study *s) {
  return s->model;
}

bool study_is_kind(const study *s, const char *kind) {
  return s->kind && strcmp(s->kind->name, kind) == 0;
}

const typed_value *study_value(const study *s, study_key key) {
  return &s->values[study_place_of(s, key)];
}

bool study_has(const study *s, study_key key) {
  const typed_value *value = study_value(s, key);
  return value->present && value->numbers[0] > -INFINITY;
}

double study_number(const study *s, study_key key) {
  return study_value(s, key)->numbers[0];
}

const char *study_word(const study *s, study_key key) {
  const char *text = study_value(s, key)->text;
  return text ? text : "";
}

long study_item(const study *s, study_key key, size_t particle) {
  if (study_value(s, key)->list)
    return (long)particle;
  const bool last = particle + 1 == s->model->particles(s);
  return last || !schema_is_among(key->path, strlen(key->path), s->model->last_keys) ? 0 : -1;
}

const char *study_name(const study *s) {
  return s->name;
}

const char *study_title(const study *s) {
  return study_word(s, schema_find(s->schema, "title"));
}

const char *study_text(const study *s) {
  return s->text;
}
uint64_t study_digest(const study *s) {
  return s->digest;
}
const study_parameter *study_moved(const study *s, study_key by) {
  for (size_t i = 0; i < s->moved_count; i++)
    if (s->moved[i].by == by)
      return &s->moved[i].parameter;
  return NULL;
}

void study_move(study *s, study_key by, const study_parameter *parameter, double start) {
  s->moved[s->moved_count++] = (moved_number){.by = by, .parameter = *parameter, .start = start};
}

void study_fill_number(study *s, study_key key, double value) {
  s->values[study_place_of(s, key)].numbers[0] = value;
}

int study_fill_word(study *s, study_key key, const char *word, message *why) {
  typed_value *value = &s->values[study_place_of(s, key)];
  free(value->text);
  value->text = strdup(word);
  return value->text ? 0 : refuse(why, EXIT_RUN, "%s: out of memory", s->name);
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
  return study_value(s, key)->line;
}

bool study_gives(const study *s, study_key key) {
  return study_value(s, key)->line > 0 || study_value(s, key)->assigned;
}

void study_place(const study *s, study_key key, char *text, size_t size) {
  const typed_value *value = study_value(s, key);
  const char *path = key->path;
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
