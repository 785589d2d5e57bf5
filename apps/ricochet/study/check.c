/* Checks of every study that concern more than one key: missing keys, keys of another kind or model, list lengths. */
#include "check.h"

#include <stdarg.h>
#include <string.h>

/* A sweep over a key or an element of its list, NULL when there is none. */
static const sweep_entry *any_sweep_over(const study *s, study_key key) {
  for (size_t i = 0; i < s->sweep_count; i++)
    if (s->sweeps[i].view.key == key)
      return &s->sweeps[i];
  return NULL;
}

int check_node_of_key(const study *s, study_key key) {
  const sweep_entry *e = any_sweep_over(s, key);
  const int node = study_value(s, key)->node;
  return node ? node : e ? e->nodes[SWEEP_PARAMETER] : 0;
}

int check_node_of_section(const study *s, const document *d, const char *section) {
  const size_t length = strlen(section);
  int node = document_find(d, DOCUMENT_ROOT, section);
  for (size_t i = 0; i < s->schema->key_count && !node; i++) {
    const char *path = s->schema->keys[i]->path;
    if (strncmp(path, section, length) == 0 && path[length] == '.')
      node = check_node_of_key(s, s->schema->keys[i]);
  }
  return node;
}

int check_refuse(const study *s, message *why, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int code = source_refuse_list(&(source){.name = s->name}, 0, why, format, arguments);
  va_end(arguments);
  return code;
}

/* The node of a given value that differs from the default; 0 for none. */
static int find_other_given(const study *s, const document *d, study_key key, double fallback, char *label, size_t size,
                            double *value) {
  const typed_value *given = study_value(s, key);
  for (size_t i = 0; given->node && i < given->count; i++)
    if (given->numbers[i] != fallback) {
      snprintf(label, size, given->list ? "%s[%zu]" : "%s", key->path, i);
      *value = given->numbers[i];
      return typed_item_node(d, given, i);
    }
  return 0;
}

static int find_other_swept(const study *s, const document *d, study_key key, double fallback, char *label, size_t size,
                            double *value) {
  for (size_t k = 0; k < s->sweep_count; k++) {
    const sweep_entry *e = &s->sweeps[k];
    for (size_t i = 0; e->view.key == key && i < e->view.points; i++)
      if (e->values[i] != fallback) {
        snprintf(label, size, "swept %s", e->view.name);
        *value = e->values[i];
        return sweep_value_node(d, e, i);
      }
  }
  return 0;
}

int check_find_other(const study *s, const document *d, study_key key, char *label, size_t size, double *value) {
  typed_value fallback;
  if (!typed_default(key, s->model, &fallback))
    return -1;
  const double number = fallback.numbers[0];
  typed_clear(&fallback);
  const int node = find_other_given(s, d, key, number, label, size, value);
  return node ? node : find_other_swept(s, d, key, number, label, size, value);
}

/* --- every study --- */

static bool is_needed(const study *s, const document *d, study_key key) {
  if (!key->required || (s->kind && !schema_kind_takes(s->kind, key)) ||
      (s->model && !schema_model_takes(s->model, key)))
    return false;
  return !s->kind || !s->kind->wants || s->kind->wants(s, d, key);
}

static int check_missing(const study *s, const document *d, message *why) {
  for (size_t i = 0; i < s->schema->key_count; i++) {
    const study_key key = s->schema->keys[i];
    if (s->values[i].present || !is_needed(s, d, key))
      continue;
    char allowed[256];
    schema_allowed(key, allowed, sizeof allowed);
    return check_refuse(s, why, "missing key %s (%s)", key->path, allowed);
  }
  return 0;
}

static int check_kind(const study *s, const document *d, message *why) {
  for (size_t i = 0; i < s->schema->key_count; i++) {
    const study_key key = s->schema->keys[i];
    const int node = check_node_of_key(s, key);
    char kinds[96];
    if (!node || schema_kind_takes(s->kind, key))
      continue;
    schema_kinds_of(s->schema, key, kinds, sizeof kinds);
    return document_refuse(d, node, why, "%s is a key of kind: %s, and this is kind: %s", key->path, kinds,
                           s->kind->name);
  }
  return 0;
}

/* Refuses a word, of a key or the kind itself, that needs features which the model lacks. */
static int refuse_word(const study *s, const document *d, study_key key, unsigned needs, message *why) {
  char models[96];
  schema_models_with(s->schema, needs, models, sizeof models);
  return document_refuse(d, check_node_of_key(s, key), why, "%s = %s is for model.type: %s, and this is model.type: %s",
                         key->path, study_word(s, key), models, s->model->name);
}

/* The model accepts the keys, and has the features that the kind and the words of keys need. */
static int check_model(const study *s, const document *d, message *why) {
  if (s->kind->features && !(s->kind->features & s->model->features))
    return refuse_word(s, d, s->schema->kind, s->kind->features, why);
  for (size_t i = 0; i < s->schema->key_count; i++) {
    const study_key key = s->schema->keys[i];
    const int node = check_node_of_key(s, key);
    char models[96];
    if (node && !schema_model_takes(s->model, key)) {
      schema_models_of(s->schema, key, models, sizeof models);
      return document_refuse(d, node, why, "%s is a key of model.type: %s, and this is model.type: %s", key->path,
                             models, s->model->name);
    }
    const unsigned needs = node ? schema_word_needs(key, s->values[i].text) : 0;
    if (needs && !(needs & s->model->features))
      return refuse_word(s, d, key, needs, why);
  }
  return 0;
}

static int check_lengths(const study *s, const document *d, message *why) {
  const size_t particles = s->model->particles ? s->model->particles(s) : 0;
  for (size_t i = 0; particles && i < s->schema->key_count; i++) {
    const typed_value *value = &s->values[i];
    const schema_entry *row = s->schema->keys[i];
    if (row->per_particle && value->list && value->count != particles)
      return document_refuse(d, value->node, why,
                             "%s has %zu elements, expected %zu, one per particle, or a single number", row->path,
                             value->count, particles);
  }
  return 0;
}

int study_check(const study *s, const document *d, message *why) {
  static int (*const checks[])(const study *, const document *, message *) = {check_missing, check_kind, check_model,
                                                                              check_lengths};
  int code = 0;
  for (size_t i = 0; i < sizeof checks / sizeof *checks && !code; i++)
    code = checks[i](s, d, why);
  if (!code && s->model->check)
    code = s->model->check(s, d, why);
  return code || !s->kind->check ? code : s->kind->check(s, d, why);
}
