/* The values of one task, and those that a result stores. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

/* Numbers are those of the study, except of keys whose value varies: these have a copy, which each task rewrites. */
struct study_values {
  const study *s;
  const double **numbers; /* [keys] */
  double **copies;        /* [keys] NULL where nothing varies */
};

static size_t place_of(long item) {
  return item < 0 ? 0 : (size_t)item;
}

static bool copy_varied(study_values *v, study_key key) {
  const size_t at = study_place_of(v->s, key);
  const typed_value *value = &v->s->values[at];
  if (v->copies[at] || !value->present) /* before a restart is resolved, its parameter has no value */
    return true;
  v->copies[at] = malloc(value->count * sizeof *value->numbers);
  if (!v->copies[at])
    return false;
  memcpy(v->copies[at], value->numbers, value->count * sizeof *value->numbers);
  v->numbers[at] = v->copies[at];
  return true;
}

static bool copy_all(study_values *v) {
  const study *s = v->s;
  bool done = true;
  for (size_t i = 0; i < s->sweep_count; i++)
    done = done && copy_varied(v, s->sweeps[i].view.key);
  for (size_t i = 0; i < s->moved_count; i++)
    done = done && copy_varied(v, s->moved[i].parameter.key);
  return done;
}

study_values *study_values_create(const study *s) {
  study_values *v = calloc(1, sizeof *v);
  if (!v)
    return NULL;
  v->s = s;
  v->numbers = calloc(s->schema->key_count, sizeof *v->numbers);
  v->copies = calloc(s->schema->key_count, sizeof *v->copies);
  for (size_t i = 0; v->numbers && i < s->schema->key_count; i++)
    v->numbers[i] = s->values[i].numbers;
  if (!v->numbers || !v->copies || !copy_all(v)) {
    study_values_destroy(&v);
    return NULL;
  }
  study_values_at(v, 0);
  return v;
}

void study_values_destroy(study_values **v) {
  if (!*v)
    return;
  for (size_t i = 0; (*v)->copies && i < (*v)->s->schema->key_count; i++)
    free((*v)->copies[i]);
  free((*v)->copies);
  free((*v)->numbers);
  free(*v);
  *v = NULL;
}

const study *study_values_of(const study_values *v) {
  return v->s;
}

static void put(study_values *v, study_key key, long item, double value) {
  double *copy = v->copies[study_place_of(v->s, key)];
  if (copy)
    copy[place_of(item)] = value;
}

void study_values_at(study_values *v, uint64_t task) {
  const study *s = v->s;
  for (size_t i = 0; i < s->moved_count; i++)
    put(v, s->moved[i].parameter.key, s->moved[i].parameter.item, s->moved[i].start);
  for (size_t i = 0; i < s->sweep_count; i++)
    study_values_sweep(v, i, study_sweep_value(s, i, task));
}

void study_values_sweep(study_values *v, size_t index, double value) {
  const study_sweep *sweep = &v->s->sweeps[index].view;
  put(v, sweep->key, sweep->item, value);
}

void study_values_move(study_values *v, study_key by, double value) {
  const study_parameter *p = study_moved(v->s, by);
  if (p)
    put(v, p->key, p->item, value);
}

/* --- all of them, for results --- */

/* Copies the numbers of a key that is swept, as they are at the first task; NULL where nothing is swept. False: out of
 * memory. */
static bool copy_first(const study *s, study_key key, const typed_value *value, double **copy) {
  *copy = NULL;
  for (size_t i = 0; i < s->sweep_count; i++) {
    const study_sweep *sweep = &s->sweeps[i].view;
    if (sweep->key != key)
      continue;
    if (!*copy) {
      *copy = malloc(value->count * sizeof **copy);
      if (!*copy)
        return false;
      memcpy(*copy, value->numbers, value->count * sizeof **copy);
    }
    (*copy)[place_of(sweep->item)] = sweep->values[0];
  }
  return true;
}

static int call_for(const study *s, study_key key, study_entry_call *call, void *user, message *why) {
  const typed_value *value = study_value(s, key);
  double *copy;
  if (!copy_first(s, key, value, &copy))
    return refuse(why, EXIT_RUN, "%s: out of memory", s->name);
  const study_entry entry = {.key = key,
                             .list = value->list,
                             .given = study_gives(s, key),
                             .count = value->list ? value->count : 1,
                             .numbers = copy ? copy : value->numbers,
                             .text = value->numbers ? NULL : study_word(s, key)};
  const int code = call(user, &entry, why);
  free(copy);
  return code;
}

int study_each(const study *s, study_entry_call *call, void *user, message *why) {
  int code = 0;
  for (size_t i = 0; i < s->schema->key_count && !code; i++) {
    const study_key key = s->schema->keys[i];
    const bool holds = s->values[i].present || s->values[i].text || strcmp(key->path, "title") == 0;
    if (holds && schema_kind_takes(s->kind, key) && schema_model_takes(s->model, key))
      code = call_for(s, key, call, user, why);
  }
  return code;
}

/* --- a value --- */

bool value_present(const study_values *v, study_key key) {
  return study_value(v->s, key)->present;
}
bool value_is_list(const study_values *v, study_key key) {
  return study_value(v->s, key)->list;
}
size_t value_count(const study_values *v, study_key key) {
  return study_value(v->s, key)->count;
}
double value_number(const study_values *v, study_key key, size_t i) {
  return v->numbers[study_place_of(v->s, key)][i];
}
double value_of_particle(const study_values *v, study_key key, size_t particle) {
  const long item = study_item(v->s, key, particle);
  return item < 0 ? -INFINITY : v->numbers[study_place_of(v->s, key)][item];
}
bool value_flag(const study_values *v, study_key key) {
  return v->numbers[study_place_of(v->s, key)][0] != 0;
}

const char *value_word(const study_values *v, study_key key) {
  const char *text = study_value(v->s, key)->text;
  return text ? text : "";
}
