#include <stdlib.h>
#include <string.h>

#include "parts.h"

/* Numbers point into the study, but for keys with a swept value: those have a copy here, which each task rewrites. */
struct study_values {
  const study *s;
  const double *numbers[KEY_COUNT];
  double *copies[KEY_COUNT];
};

static size_t swept_item(const study_sweep *sweep) {
  return sweep->item < 0 ? 0 : (size_t)sweep->item;
}

static bool copy_swept(study_values *v, study_key key) {
  if (v->copies[key])
    return true;
  const typed_value *value = &v->s->values[key];
  v->copies[key] = malloc(value->count * sizeof *value->numbers);
  if (!v->copies[key])
    return false;
  memcpy(v->copies[key], value->numbers, value->count * sizeof *value->numbers);
  v->numbers[key] = v->copies[key];
  return true;
}

study_values *study_values_create(const study *s) {
  study_values *v = calloc(1, sizeof *v);
  if (!v)
    return NULL;
  v->s = s;
  for (int key = 0; key < KEY_COUNT; key++)
    v->numbers[key] = s->values[key].numbers;
  for (size_t i = 0; i < s->sweep_count; i++)
    if (!copy_swept(v, s->sweeps[i].view.key)) {
      study_values_destroy(&v);
      return NULL;
    }
  study_values_at(v, 0);
  return v;
}

void study_values_destroy(study_values **v) {
  if (!*v)
    return;
  for (int key = 0; key < KEY_COUNT; key++)
    free((*v)->copies[key]);
  free(*v);
  *v = NULL;
}

void study_values_at(study_values *v, uint64_t task) {
  for (size_t i = 0; i < v->s->sweep_count; i++) {
    const study_sweep *sweep = &v->s->sweeps[i].view;
    v->copies[sweep->key][swept_item(sweep)] = study_sweep_value(v->s, i, task);
  }
}

bool value_present(const study_values *v, study_key key) {
  return v->s->values[key].present;
}
bool value_is_list(const study_values *v, study_key key) {
  return v->s->values[key].list;
}
size_t value_count(const study_values *v, study_key key) {
  return v->s->values[key].count;
}
double value_number(const study_values *v, study_key key, size_t i) {
  return v->numbers[key][i];
}
bool value_flag(const study_values *v, study_key key) {
  return v->numbers[key][0] != 0;
}

const char *value_word(const study_values *v, study_key key) {
  const char *text = v->s->values[key].text;
  return text ? text : "";
}
