/* What the schema's rows cannot say: how the values of several keys fit together. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "number.h"
#include "parts.h"

/* A sweep over a key or an element of its list, NULL when there is none. */
static const sweep_entry *any_sweep_over(const study *s, study_key key) {
  for (size_t i = 0; i < s->sweep_count; i++)
    if (s->sweeps[i].view.key == key)
      return &s->sweeps[i];
  return NULL;
}

int check_node_of_key(const study *s, study_key key) {
  const sweep_entry *e = any_sweep_over(s, key);
  return s->values[key].node ? s->values[key].node : e ? e->nodes[SWEEP_PARAMETER] : 0;
}

int check_node_of_section(const study *s, const document *d, const char *section) {
  const size_t length = strlen(section);
  int node = document_find(d, DOCUMENT_ROOT, section);
  for (int key = 0; key < KEY_COUNT && !node; key++) {
    const char *path = schema_row((study_key)key)->path;
    if (strncmp(path, section, length) == 0 && path[length] == '.')
      node = check_node_of_key(s, (study_key)key);
  }
  return node;
}

/* Whether the study has a periodic orbit to compute: its kind is `orbits`, or it starts on one. */
static bool has_orbit(const study *s, const document *d) {
  return study_is_kind(s, "orbits") || (!study_iterates(s) && check_node_of_section(s, d, "orbit"));
}

/* A branch whose period follows from its force, or whose guess is a normal mode, needs none. */
static bool needs_period(const study *s, const document *d) {
  if (!study_follows(s) || study_iterates(s)) /* beyond grazing, motions are forced */
    return has_orbit(s, d);
  const bool forced = s->values[KEY_ORBIT_MOTION].text && strcmp(s->values[KEY_ORBIT_MOTION].text, "forced") == 0;
  return !forced && !branch_from_mode(s) && s->values[KEY_ORBIT_FORCING_PERIODS].numbers[0] == -INFINITY;
}

static bool is_needed(const study *s, const document *d, const schema_entry *row) {
  if (study_restarts(s) && row == schema_row(KEY_ORBIT_PERIOD))
    return false;
  if (!branch_traces(s) && strncmp(row->path, "branch.trace.", 13) == 0)
    return false;
  if (!study_follows(s) && strncmp(row->path, "branch.", 7) == 0)
    return false;
  if (!row->required || (row == schema_row(KEY_ORBIT_PERIOD) && !needs_period(s, d)))
    return false;
  if (row->models && !schema_concerns_model(row, study_model(s)))
    return false;
  return row == schema_row(KEY_KIND) || schema_concerns(row, s->values[KEY_KIND].text);
}

static int check_missing(const study *s, const document *d, message *why) {
  const source file = {.name = s->name};
  for (int key = 0; key < KEY_COUNT; key++) {
    const schema_entry *row = schema_row((study_key)key);
    if (s->values[key].present || !is_needed(s, d, row))
      continue;
    char allowed[256];
    schema_allowed(row, allowed, sizeof allowed);
    return source_refuse(&file, 0, why, "missing key %s (%s)", row->path, allowed);
  }
  return 0;
}

static int check_kind(const study *s, const document *d, message *why) {
  const char *kind = s->values[KEY_KIND].text;
  for (int key = 0; kind && key < KEY_COUNT; key++) {
    const schema_entry *row = schema_row((study_key)key);
    const int node = check_node_of_key(s, (study_key)key);
    if (!node || schema_concerns(row, kind))
      continue;
    char kinds[64];
    schema_either(row->kinds, kinds, sizeof kinds);
    return document_refuse(d, node, why, "%s is a key of kind: %s, and this is kind: %s", row->path, kinds, kind);
  }
  return 0;
}

/* The keys are of the model's type, and so are the words among their values. */
static int check_model(const study *s, const document *d, message *why) {
  const char *model = study_model(s);
  for (int key = 0; key < KEY_COUNT; key++) {
    const schema_entry *row = schema_row((study_key)key);
    const int node = check_node_of_key(s, (study_key)key);
    char models[64];
    if (node && !schema_concerns_model(row, model)) {
      schema_either(row->models, models, sizeof models);
      return document_refuse(d, node, why, "%s is a key of model.type: %s, and this is model.type: %s", row->path,
                             models, model);
    }
    const char *taken = node && row->word_models ? schema_word_models(row, s->values[key].text) : NULL;
    if (taken && !schema_is_among(model, strlen(model), taken)) {
      schema_either(taken, models, sizeof models);
      return document_refuse(d, node, why, "%s = %s is for model.type: %s, and this is model.type: %s", row->path,
                             s->values[key].text, models, model);
    }
  }
  return 0;
}

static int check_start(const study *s, const document *d, message *why) {
  const source file = {.name = s->name};
  const int start = check_node_of_section(s, d, "start"), orbit = check_node_of_section(s, d, "orbit");
  if (!study_is_kind(s, "trajectory") || !start != !orbit)
    return 0;
  if (!start)
    return source_refuse(&file, 0, why,
                         "kind: trajectory has neither start nor orbit, expected exactly one of the two sections");
  return document_refuse(d, start, why,
                         "kind: trajectory has both start and orbit, expected exactly one of the two sections");
}

static int check_lengths(const study *s, const document *d, message *why) {
  if (study_is_map(s))
    return 0;
  const double particles = s->values[KEY_MODEL_PARTICLES].numbers[0];
  for (int key = 0; key < KEY_COUNT; key++) {
    const typed_value *value = &s->values[key];
    const schema_entry *row = schema_row((study_key)key);
    if (row->per_particle && value->list && (double)value->count != particles)
      return document_refuse(d, value->node, why,
                             "%s has %zu elements, expected %.0f, one per particle, or a single number", row->path,
                             value->count, particles);
  }
  return 0;
}

static int refuse_for_orbits(const study *s, const document *d, int node, study_key key, const char *label,
                             double value, message *why) {
  const char *path = schema_row(key)->path, *fallback = schema_row(key)->fallback;
  char shown[32] = "null";
  if (value > -INFINITY)
    number_show(value, shown, sizeof shown);
  if (study_follows(s))
    return document_refuse(d, node, why, "%s = %s, but orbit.motion: %s needs %s = %s", label, shown,
                           s->values[KEY_ORBIT_MOTION].text, path, fallback);
  if (key == KEY_MODEL_RESTITUTION)
    return document_refuse(
        d, node, why, "%s = %s is not in this version: orbits of an undamped chain need restitution 1", label, shown);
  if (study_is_kind(s, "orbits"))
    return document_refuse(d, node, why, "%s = %s, but kind: orbits needs %s = %s", label, shown, path, fallback);
  return document_refuse(d, node, why, "%s = %s, but a start on an orbit needs %s = %s", label, shown, path, fallback);
}

/* Every value of a key, also the swept ones, is the default. */
static int check_default(const study *s, const document *d, study_key key, double fallback, message *why) {
  const typed_value *value = &s->values[key];
  char label[128];
  for (size_t i = 0; value->node && i < value->count; i++) {
    if (value->numbers[i] == fallback)
      continue;
    snprintf(label, sizeof label, value->list ? "%s[%zu]" : "%s", schema_row(key)->path, i);
    return refuse_for_orbits(s, d, typed_item_node(d, value, i), key, label, value->numbers[i], why);
  }
  for (size_t k = 0; k < s->sweep_count; k++) {
    const sweep_entry *e = &s->sweeps[k];
    for (size_t i = 0; e->view.key == key && i < e->view.points; i++) {
      if (e->values[i] == fallback)
        continue;
      snprintf(label, sizeof label, "swept %s", e->view.name);
      return refuse_for_orbits(s, d, sweep_value_node(d, e, i), key, label, e->values[i], why);
    }
  }
  return 0;
}

int check_key_default(const study *s, const document *d, study_key key, message *why) {
  typed_value fallback;
  if (!typed_default(schema_row(key), study_model(s), &fallback))
    return refuse(why, EXIT_RUN, "%s: out of memory", s->name);
  const double number = fallback.numbers[0];
  typed_clear(&fallback);
  return check_default(s, d, key, number, why);
}

/* Periodic orbits are those of conservative models with rigid obstacles, by impulse responses of linear chains. */
static int check_defaults(const study *s, const document *d, message *why) {
  int code = 0;
  const char *method = study_method(s);
  if (!study_is_kind(s, "orbits") && strcmp(study_model(s), "chain") != 0)
    return document_refuse(d, s->values[KEY_MODEL_TYPE].node, why,
                           "model.type = %s, but a start on an orbit needs model.type = chain", study_model(s));
  for (int key = 0; key < KEY_COUNT && !code; key++)
    if (schema_is_among(method, strlen(method), schema_row((study_key)key)->orbits_default))
      code = check_key_default(s, d, (study_key)key, why);
  return code;
}

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
    return a->key < b->key ? -1 : 1;
  return a->item < b->item ? -1 : a->item > b->item;
}

bool check_has_obstacle(const study *s, size_t particle) {
  static const study_key sides[] = {KEY_MODEL_FLOOR, KEY_MODEL_WALL};
  bool has = false;
  for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
    const typed_value *at = &s->values[sides[i]];
    const long item = study_item(s, sides[i], particle);
    has = has || (item >= 0 && (at->numbers[item] > -INFINITY || sweep_over(s, sides[i], at->list ? item : -1)));
  }
  return has;
}

static int refuse_particle(const study *s, const document *d, int node, const char *label, double particle,
                           message *why) {
  return document_refuse(d, node, why, "%s = %.0f is out of range, expected a particle from 0 to %.0f", label, particle,
                         s->values[KEY_MODEL_PARTICLES].numbers[0] - 1);
}

int check_particle(const study *s, const document *d, study_key key, size_t i, message *why) {
  char label[64];
  const double particle = s->values[key].numbers[i];
  snprintf(label, sizeof label, "%s[%zu]", schema_row(key)->path, i);
  if (particle < s->values[KEY_MODEL_PARTICLES].numbers[0])
    return 0;
  return refuse_particle(s, d, typed_item_node(d, &s->values[key], i), label, particle, why);
}

/* Checks the elements of one list that no sweep moves, and appends them to the impacts. */
static int collect_impacts(const study *s, const document *d, study_key key, impact *impacts, size_t *count,
                           message *why) {
  const typed_value *list = &s->values[key];
  for (size_t i = 0; i < list->count; i++) {
    const int node = typed_item_node(d, list, i);
    const double particle = list->numbers[i];
    const int code = check_particle(s, d, key, i, why);
    if (code)
      return code;
    if (sweep_over(s, key, (long)i))
      continue;
    if (!check_has_obstacle(s, (size_t)particle))
      return document_refuse(d, node, why,
                             "%s[%zu] = %.0f has no floor or wall to hit (both are null there), expected a particle "
                             "with one",
                             schema_row(key)->path, i, particle);
    impacts[(*count)++] = (impact){particle, key, i};
  }
  return 0;
}

static int refuse_twice(const document *d, const study *s, const impact *first, const impact *again, message *why) {
  return document_refuse(d, typed_item_node(d, &s->values[again->key], again->item), why,
                         "%s[%zu] = %.0f is in the pattern twice (%s[%zu] too), expected each particle at most once in "
                         "at_start and at_half together",
                         schema_row(again->key)->path, again->item, again->particle, schema_row(first->key)->path,
                         first->item);
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

static bool names_particles(study_key key) {
  return key == KEY_ORBIT_AT_START || key == KEY_ORBIT_AT_HALF || key == KEY_ORBIT_SEQUENCE || key == KEY_ORBIT_EXCITED;
}

/* Swept indices stay in the chain; where they meet another impact, or a particle without a floor, is an outcome of
 * that grid point. */
static int check_swept_impacts(const study *s, const document *d, message *why) {
  for (size_t i = 0; i < s->sweep_count; i++) {
    const sweep_entry *e = &s->sweeps[i];
    if (!names_particles(e->view.key))
      continue;
    char label[128];
    snprintf(label, sizeof label, "swept %s", e->view.name);
    for (size_t j = 0; j < e->view.points; j++)
      if (!(e->values[j] < s->values[KEY_MODEL_PARTICLES].numbers[0]))
        return refuse_particle(s, d, sweep_value_node(d, e, j), label, e->values[j], why);
  }
  return 0;
}

static int check_pattern(const study *s, const document *d, message *why) {
  const size_t most = s->values[KEY_ORBIT_AT_START].count + s->values[KEY_ORBIT_AT_HALF].count;
  if (most == 0 && !study_follows(s)) {
    char place[640];
    study_place(s, KEY_ORBIT_AT_START, place, sizeof place);
    return refuse(why, EXIT_USAGE, "%s and orbit.at_half are both empty, expected at least one particle that hits",
                  place);
  }
  impact *impacts = malloc((most + 1) * sizeof *impacts);
  if (!impacts)
    return refuse(why, EXIT_RUN, "%s: out of memory", s->name);
  const int code = check_impacts(s, d, impacts, why);
  free(impacts);
  return code ? code : check_swept_impacts(s, d, why);
}

static int check_special_points(const study *s, const document *d, message *why) {
  const typed_value *flag = &s->values[KEY_ORBIT_SPECIAL_POINTS];
  const study_key over = s->sweep_count == 1 ? s->sweeps[0].view.key : KEY_COUNT;
  if (flag->numbers[0] == 0 || over == KEY_MODEL_GAMMA || over == KEY_ORBIT_PERIOD)
    return 0;
  return document_refuse(d, flag->node, why,
                         "orbit.special_points = true lists resonances and singular points along the swept parameter: "
                         "it requires exactly one sweep entry, over model.gamma or orbit.period");
}

/* What an orbit needs, of a study that has one. */
static int check_orbit(const study *s, const document *d, message *why) {
  const int misplaced = study_iterates(s) ? iterate_check_family(s, d, why) : 0;
  if (misplaced || (study_iterates(s) && !study_follows(s)))
    return misplaced;
  if (study_restarts(s))
    return branch_check_restart(s, d, why);
  if (study_follows(s)) {
    const int code = check_pattern(s, d, why);
    return code ? code : branch_check(s, d, why);
  }
  if (!has_orbit(s, d))
    return 0;
  int code = check_defaults(s, d, why);
  if (!code)
    code = check_pattern(s, d, why);
  return code ? code : check_special_points(s, d, why);
}

int study_check(const study *s, const document *d, message *why) {
  int code = check_missing(s, d, why);
  if (!code)
    code = check_kind(s, d, why);
  if (!code)
    code = check_model(s, d, why);
  if (!code)
    code = check_start(s, d, why);
  if (!code)
    code = check_lengths(s, d, why);
  if (!code)
    code = check_orbit(s, d, why);
  return code || !study_iterates(s) ? code : iterate_check(s, d, why);
}
