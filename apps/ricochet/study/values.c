#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "parts.h"

/* Numbers point into the study, but for keys with a value that varies: those have a copy here, which each task
 * rewrites. */
struct study_values {
  const study *s;
  const double *numbers[KEY_COUNT];
  double *copies[KEY_COUNT];
};

static size_t place_of(long item) {
  return item < 0 ? 0 : (size_t)item;
}

static bool copy_varied(study_values *v, study_key key) {
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

/* The parameter of a branch that restarts may have no value yet. */
static bool follows(const study *s) {
  return s->followed.key != KEY_COUNT && s->values[s->followed.key].present;
}

/* The same of a period that it takes from there. */
static bool traces(const study *s) {
  return s->traced.key != KEY_COUNT && s->values[s->traced.key].present;
}

study_values *study_values_create(const study *s) {
  study_values *v = calloc(1, sizeof *v);
  if (!v)
    return NULL;
  v->s = s;
  for (int key = 0; key < KEY_COUNT; key++)
    v->numbers[key] = s->values[key].numbers;
  for (size_t i = 0; i < s->sweep_count; i++)
    if (!copy_varied(v, s->sweeps[i].view.key)) {
      study_values_destroy(&v);
      return NULL;
    }
  if ((follows(s) && !(copy_varied(v, s->followed.key) && copy_varied(v, KEY_BRANCH_FROM))) ||
      (traces(s) && !copy_varied(v, s->traced.key)))
    study_values_destroy(&v);
  if (v)
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
  for (size_t i = 0; i < v->s->sweep_count; i++)
    study_values_sweep(v, i, study_sweep_value(v->s, i, task));
  if (follows(v->s))
    study_values_begin(v, v->s->values[KEY_BRANCH_FROM].numbers[0]);
  if (traces(v->s))
    study_values_trace(v, v->s->values[v->s->traced.key].numbers[place_of(v->s->traced.item)]);
}

void study_values_sweep(study_values *v, size_t index, double value) {
  const study_sweep *sweep = &v->s->sweeps[index].view;
  v->copies[sweep->key][place_of(sweep->item)] = value;
}

void study_values_follow(study_values *v, double value) {
  v->copies[v->s->followed.key][place_of(v->s->followed.item)] = value;
}

void study_values_begin(study_values *v, double value) {
  v->copies[KEY_BRANCH_FROM][0] = value;
  study_values_follow(v, value);
}

void study_values_trace(study_values *v, double value) {
  v->copies[v->s->traced.key][place_of(v->s->traced.item)] = value;
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
double value_of_particle(const study_values *v, study_key key, size_t particle) {
  const long item = study_item(v->s, key, particle);
  return item < 0 ? -INFINITY : v->numbers[key][item];
}
bool value_flag(const study_values *v, study_key key) {
  return v->numbers[key][0] != 0;
}

const char *value_word(const study_values *v, study_key key) {
  const char *text = v->s->values[key].text;
  return text ? text : "";
}
