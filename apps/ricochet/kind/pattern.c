#include "pattern.h"

#include <math.h>
#include <stdlib.h>

#include "keys.h"
#include "model/lattice_model.h"
#include "study/number.h"

static void read_particles(const study_values *v, study_key key, size_t count, size_t *list) {
  for (size_t i = 0; i < count; i++)
    list[i] = (size_t)value_number(v, key, i);
}

ric_status pattern_read(const study_values *v, ric_pattern **pattern, ric_error *error) {
  size_t starts = value_count(v, KEY_ORBIT_AT_START), halves = value_count(v, KEY_ORBIT_AT_HALF);
  size_t *list = malloc((starts + halves + 1) * sizeof *list);
  *pattern = NULL;
  if (!list)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu impacts", starts + halves);
  read_particles(v, KEY_ORBIT_AT_START, starts, list);
  read_particles(v, KEY_ORBIT_AT_HALF, halves, list + starts);
  ric_status status =
      ric_pattern_create(lattice_particles(study_values_of(v)), list, starts, list + starts, halves, pattern, error);
  free(list);
  return status;
}

/* --- the model --- */

/* Keys that must have their default for closed forms (linear chains without damping, with rigid floors of restitution
 * 1), and whether shooting needs the default as well. */
static const struct {
  study_key key;
  bool shooting;
} needed[] = {{KEY_MODEL_RESTITUTION, true},     {KEY_MODEL_MASS, false},       {KEY_MODEL_STIFFNESS, false},
              {KEY_MODEL_QUADRATIC, false},      {KEY_MODEL_CUBIC, false},      {KEY_MODEL_DAMPING, true},
              {KEY_MODEL_LINK_QUADRATIC, false}, {KEY_MODEL_LINK_CUBIC, false}, {KEY_MODEL_LINK_DAMPING, false},
              {KEY_MODEL_WALL, false},           {KEY_MODEL_HERTZ, true},       {KEY_MODEL_FORCE, true},
              {KEY_MODEL_FREQUENCY, false},      {KEY_MODEL_PHASE, false}};

static int check_default(const study *s, const document *d, study_key key, const char *who, message *why) {
  char label[128], shown[32] = "null";
  double value;
  const int node = check_find_other(s, d, key, label, sizeof label, &value);
  if (node < 0)
    return refuse(why, EXIT_RUN, "%s: out of memory", study_name(s));
  if (node == 0)
    return 0;
  if (value > -INFINITY)
    number_show(value, shown, sizeof shown);
  if (key == KEY_MODEL_RESTITUTION)
    return document_refuse(
        d, node, why, "%s = %s is not in this version: orbits of an undamped chain need restitution 1", label, shown);
  return document_refuse(d, node, why, "%s = %s, but %s needs %s = %s", label, shown, who, key->path, key->fallback);
}

int pattern_check_model(const study *s, const document *d, bool closed, const char *who, message *why) {
  int code = 0;
  for (size_t i = 0; i < sizeof needed / sizeof *needed && !code; i++)
    if (closed || needed[i].shooting)
      code = check_default(s, d, needed[i].key, who, why);
  return code;
}

/* --- its keys --- */

/* One impact of the pattern: an element of orbit.at_start or orbit.at_half. */
typedef struct impact {
  double particle;
  study_key key;
  size_t item;
} impact;

static int compare_impacts(const void *left, const void *right) {
  const impact *a = left, *b = right;
  if (a->particle != b->particle)
    return a->particle < b->particle ? -1 : 1;
  if (a->key != b->key)
    return a->key == KEY_ORBIT_AT_START ? -1 : 1;
  return a->item < b->item ? -1 : a->item > b->item;
}

/* Checks the elements of one list that are not swept, and appends them to the impacts. */
static int collect_impacts(const study *s, const document *d, study_key key, impact *impacts, size_t *count,
                           message *why) {
  const typed_value *list = study_value(s, key);
  for (size_t i = 0; i < list->count; i++) {
    const int node = typed_item_node(d, list, i);
    const double particle = list->numbers[i];
    const int code = lattice_check_particle(s, d, key, i, why);
    if (code)
      return code;
    if (sweep_over(s, key, (long)i))
      continue;
    if (!lattice_has_obstacle(s, (size_t)particle))
      return document_refuse(d, node, why,
                             "%s[%zu] = %.0f has no floor or wall to hit (both are null there), expected a particle "
                             "with one",
                             key->path, i, particle);
    impacts[(*count)++] = (impact){particle, key, i};
  }
  return 0;
}

static int refuse_twice(const document *d, const study *s, const impact *first, const impact *again, message *why) {
  return document_refuse(d, typed_item_node(d, study_value(s, again->key), again->item), why,
                         "%s[%zu] = %.0f is in the pattern twice (%s[%zu] too), expected each particle at most once in "
                         "at_start and at_half together",
                         again->key->path, again->item, again->particle, first->key->path, first->item);
}

static int check_impacts(const study *s, const document *d, impact *impacts, message *why) {
  size_t count = 0;
  int code = collect_impacts(s, d, KEY_ORBIT_AT_START, impacts, &count, why);
  if (!code)
    code = collect_impacts(s, d, KEY_ORBIT_AT_HALF, impacts, &count, why);
  if (code)
    return code;
  qsort(impacts, count, sizeof *impacts, compare_impacts);
  for (size_t i = 1; i < count; i++)
    if (impacts[i].particle == impacts[i - 1].particle)
      return refuse_twice(d, s, &impacts[i - 1], &impacts[i], why);
  return 0;
}

int pattern_check(const study *s, const document *d, bool may_be_empty, message *why) {
  const size_t most = study_value(s, KEY_ORBIT_AT_START)->count + study_value(s, KEY_ORBIT_AT_HALF)->count;
  if (most == 0 && !may_be_empty) {
    char place[640];
    study_place(s, KEY_ORBIT_AT_START, place, sizeof place);
    return refuse(why, EXIT_USAGE, "%s and orbit.at_half are both empty, expected at least one particle that hits",
                  place);
  }
  impact *impacts = malloc((most + 1) * sizeof *impacts);
  if (!impacts)
    return refuse(why, EXIT_RUN, "%s: out of memory", study_name(s));
  int code = check_impacts(s, d, impacts, why);
  free(impacts);
  if (!code)
    code = lattice_check_swept_particles(s, d, KEY_ORBIT_AT_START, why);
  return code ? code : lattice_check_swept_particles(s, d, KEY_ORBIT_AT_HALF, why);
}
