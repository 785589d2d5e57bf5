/* Lookup of numbers by their names, and the sweeps over them. */
#include <math.h>
#include <ricochet/elementary.h>
#include <stdlib.h>
#include <string.h>

#include "number.h"
#include "check.h"

/* --- parameters --- */

/* A lookup in progress. */
typedef struct lookup {
  const study *s;
  const document *d;
  const parameter_use *use;
  message *why;
} lookup;

/* Splits "model.floor[3]" into path and index. @returns -1 without an index, -2 for a malformed or huge one */
static long split_name(const char *text, char *path, size_t size) {
  const size_t length = strcspn(text, "[");
  snprintf(path, size, "%.*s", (int)(length < size ? length : size - 1), text);
  if (!text[length])
    return -1;
  const char *digits = text + length + 1;
  const size_t count = strspn(digits, "0123456789");
  if (count == 0 || count > 9 || strcmp(digits + count, "]") != 0)
    return -2;
  return strtol(digits, NULL, 10);
}

static int refuse_unknown(const lookup *l, const char *name, const char *path) {
  char near[64], shown[80];
  const parameter_use *u = l->use;
  source_quote(name, strlen(name), shown, sizeof shown);
  schema_nearest_parameter(l->s->schema, path, near, sizeof near);
  if (*near)
    return document_refuse(l->d, u->node, l->why, "unknown %s parameter '%s'; did you mean '%s'?", u->noun, shown,
                           near);
  return document_refuse(l->d, u->node, l->why, "unknown %s parameter '%s', expected %s", u->noun, shown, u->example);
}

static int refuse_model(const lookup *l, study_key key) {
  char models[64];
  schema_models_of(l->s->schema, key, models, sizeof models);
  return document_refuse(l->d, l->use->node, l->why, "%s = %s is a key of model.type: %s, and this is model.type: %s",
                         l->use->label, key->path, models, l->s->model->name);
}

/* A parameter must name one number: a scalar by its key, an element of a list by its index. */
static int check_item(const lookup *l, const study_parameter *p) {
  const typed_value *value = study_value(l->s, p->key);
  const int node = l->use->node;
  const char *path = p->key->path, *label = l->use->label;
  if (!value->list)
    return p->item == -1
               ? 0
               : document_refuse(l->d, node, l->why,
                                 "%s = %s, but %s is a single number here: %s %s without an index, or give a list",
                                 label, p->name, path, l->use->verb, path);
  if (value->count == 0)
    return document_refuse(l->d, node, l->why, "%s = %s, but %s is an empty list: give the elements to %s", label,
                           p->name, path, l->use->verb);
  if (p->item == -1)
    return document_refuse(l->d, node, l->why, "%s = %s, but %s is a list: %s one element by its index, such as %s[0]",
                           label, path, path, l->use->verb, path);
  if (!(p->item >= 0 && (size_t)p->item < value->count))
    return document_refuse(l->d, node, l->why, "%s = %s, but %s has %zu elements: expected an index from 0 to %zu",
                           label, p->name, path, value->count, value->count - 1);
  return 0;
}

int parameter_find(const study *s, const document *d, const parameter_use *use, const char *name,
                   study_parameter *parameter, message *why) {
  char path[64];
  const lookup l = {.s = s, .d = d, .use = use, .why = why};
  const long item = split_name(name, path, sizeof path);
  const study_key key = schema_find(s->schema, path);
  if (!key)
    return refuse_unknown(&l, name, path);
  if (!key->sweep)
    return document_refuse(d, use->node, why, "%s = %s %s: %s", use->label, path, use->done, key->no_sweep);
  if (s->model && !schema_model_takes(s->model, key))
    return refuse_model(&l, key);
  *parameter = (study_parameter){.key = key, .item = item};
  if (item >= 0)
    snprintf(parameter->name, sizeof parameter->name, "%s[%ld]", path, item);
  else
    snprintf(parameter->name, sizeof parameter->name, "%s", name);
  return check_item(&l, parameter);
}

int parameter_supply(study *s, const document *d, const parameter_use *use, int key_node, study_key key, double value,
                     message *why) {
  typed_value *to = &s->values[study_place_of(s, key)];
  if (to->node)
    return 0;
  const char *assigned = document_assigned_by(d, use->node);
  typed_clear(to);
  *to = (typed_value){.present = true, .count = 1, .line = document_line(d, key_node)};
  to->numbers = calloc(1, sizeof *to->numbers);
  to->assigned = assigned ? strdup(assigned) : NULL;
  if (!to->numbers || (assigned && !to->assigned))
    return refuse(why, EXIT_RUN, "%s: out of memory", s->name);
  to->numbers[0] = value;
  return 0;
}

/* --- sweeps --- */

static const uint64_t too_many_tasks = (uint64_t)1 << 40;

/* The entry of `sweep` that is read. */
typedef struct reading {
  study *s;
  const document *d;
  int node;                  /* the entry's mapping */
  char label[24];            /* "sweep[1]", or "sweep" when it is no list */
  int keys[SWEEP_KEY_COUNT]; /* nodes of the keys themselves */
  sweep_entry *e;
  message *why;
} reading;

static bool given(const reading *r, sweep_key key) {
  return r->e->nodes[key] != 0;
}

static int no_memory(const reading *r) {
  return refuse(r->why, EXIT_RUN, "%s: out of memory", r->s->name);
}

static const char *short_name(sweep_key key) {
  return schema_sweep_row(key)->path + sizeof "sweep." - 1;
}

static int find_keys(reading *r) {
  const yaml_node_t *n = document_node(r->d, r->node);
  if (n->type != YAML_MAPPING_NODE) {
    char held[128];
    document_show(r->d, r->node, held, sizeof held);
    return document_refuse(r->d, r->node, r->why, "%s = %s, expected a mapping with the keys of a sweep", r->label,
                           held);
  }
  for (const yaml_node_pair_t *pair = n->data.mapping.pairs.start; pair < n->data.mapping.pairs.top; pair++) {
    int key = 0;
    while (key < SWEEP_KEY_COUNT && !document_is(r->d, pair->key, short_name((sweep_key)key)))
      key++;
    if (key == SWEEP_KEY_COUNT)
      return refuse_unknown_key(r->s, r->d, pair->key, "sweep", r->why);
    r->e->nodes[key] = pair->value;
    r->keys[key] = pair->key;
  }
  return 0;
}

static int read_key(const reading *r, sweep_key key, typed_value *value) {
  char label[64];
  snprintf(label, sizeof label, "%s.%s", r->label, short_name(key));
  return typed_read(r->d, r->keys[key], r->e->nodes[key], schema_sweep_row(key), label, value, r->why);
}

static int read_number(const reading *r, sweep_key key, double *number) {
  typed_value value = {0};
  const int code = read_key(r, key, &value);
  if (!code)
    *number = value.numbers[0];
  typed_clear(&value);
  return code;
}

static parameter_use use_of(const reading *r, char *label, size_t size) {
  snprintf(label, size, "%s.parameter", r->label);
  return (parameter_use){.label = label,
                         .noun = "sweep",
                         .verb = "sweep",
                         .done = "cannot be swept",
                         .example = "a number of model, orbit, start or time such as model.gamma",
                         .node = r->e->nodes[SWEEP_PARAMETER]};
}

static int find_parameter(const reading *r, const char *name) {
  char label[64];
  study_parameter found;
  const parameter_use use = use_of(r, label, sizeof label);
  const int code = parameter_find(r->s, r->d, &use, name, &found, r->why);
  if (code)
    return code;
  snprintf(r->e->view.name, sizeof r->e->view.name, "%s", found.name);
  r->e->view.key = found.key;
  r->e->view.item = found.item;
  if (sweep_over(r->s, found.key, found.item))
    return document_refuse(r->d, use.node, r->why, "%s = %s is swept twice, expected once", label, name);
  return 0;
}

static int read_parameter(const reading *r) {
  if (!given(r, SWEEP_PARAMETER))
    return document_refuse(r->d, r->node, r->why, "missing key %s.parameter (the key to sweep, such as model.gamma)",
                           r->label);
  typed_value value = {0};
  int code = read_key(r, SWEEP_PARAMETER, &value);
  if (!code)
    code = find_parameter(r, value.text);
  typed_clear(&value);
  return code;
}

static int read_list(const reading *r) {
  for (sweep_key key = SWEEP_FROM; key < SWEEP_KEY_COUNT; key++)
    if (given(r, key) && key != SWEEP_BACK)
      return document_refuse(r->d, r->keys[key], r->why,
                             "%s has both values and %s, expected either values, or from, to and points", r->label,
                             short_name(key));
  typed_value value = {0};
  int code = read_key(r, SWEEP_VALUES, &value);
  if (!code && value.count == 0)
    code = document_refuse(r->d, value.node, r->why, "%s.values is empty, expected a list of one number or more",
                           r->label);
  if (!code) {
    r->e->view.points = value.count;
    r->e->values = value.numbers;
    value.numbers = NULL;
  }
  typed_clear(&value);
  return code;
}

typedef struct range {
  double from, to;
  size_t points;
  bool log;
} range;

/* Both ends are exact, without rounding. */
static double range_value(const range *g, size_t i) {
  if (i == 0 || g->points == 1)
    return g->from;
  if (i == g->points - 1)
    return g->to;
  const double steps = (double)(g->points - 1);
  if (g->log)
    return ric_exp(ric_log(g->from) + (double)i * (ric_log(g->to) - ric_log(g->from)) / steps);
  return g->from + (double)i * (g->to - g->from) / steps;
}

static int check_range(const reading *r, const range *g) {
  char from[32], to[32];
  number_show(g->from, from, sizeof from);
  number_show(g->to, to, sizeof to);
  if (!(g->from <= g->to))
    return document_refuse(r->d, r->keys[SWEEP_FROM], r->why, "%s: reversed range from %s to %s, expected from <= to",
                           r->label, from, to);
  if (g->from == g->to && g->points != 1)
    return document_refuse(r->d, r->keys[SWEEP_POINTS], r->why,
                           "%s: empty range from %s to %s with %zu points, expected from < to, or points: 1", r->label,
                           from, to, g->points);
  if (g->from < g->to && g->points == 1)
    return document_refuse(r->d, r->keys[SWEEP_POINTS], r->why,
                           "%s: 1 point cannot span the range from %s to %s, expected points >= 2, or from equal to to",
                           r->label, from, to);
  if (g->log && !(g->from > 0))
    return document_refuse(r->d, r->keys[SWEEP_FROM], r->why, "%s.from = %s with scale: log, expected a number > 0",
                           r->label, from);
  return 0;
}

static int read_range_keys(const reading *r, range *g) {
  for (sweep_key key = SWEEP_FROM; key <= SWEEP_POINTS; key++) {
    char allowed[128];
    schema_allowed(schema_sweep_row(key), allowed, sizeof allowed);
    if (!given(r, key))
      return document_refuse(r->d, r->node, r->why,
                             "missing key %s.%s (%s): expected either values, or from, to and points", r->label,
                             short_name(key), allowed);
  }
  double points = 0;
  int code = read_number(r, SWEEP_FROM, &g->from);
  if (!code)
    code = read_number(r, SWEEP_TO, &g->to);
  if (!code)
    code = read_number(r, SWEEP_POINTS, &points);
  if (!code && given(r, SWEEP_SCALE)) {
    typed_value scale = {0};
    code = read_key(r, SWEEP_SCALE, &scale);
    g->log = !code && strcmp(scale.text, "log") == 0;
    typed_clear(&scale);
  }
  g->points = (size_t)points;
  return code;
}

static int read_range(const reading *r) {
  range g = {0};
  int code = read_range_keys(r, &g);
  if (!code)
    code = check_range(r, &g);
  if (code)
    return code;
  r->e->values = malloc(g.points * sizeof *r->e->values);
  if (!r->e->values)
    return no_memory(r);
  r->e->view.points = g.points;
  for (size_t i = 0; i < g.points; i++)
    r->e->values[i] = range_value(&g, i);
  return 0;
}

/* Appends the values in reverse order if `back` is true. */
static int append_reversed(const reading *r) {
  study_sweep *view = &r->e->view;
  double wanted = 0;
  const int code = read_number(r, SWEEP_BACK, &wanted);
  if (code || wanted == 0)
    return code;
  double *both = realloc(r->e->values, 2 * view->points * sizeof *both);
  if (!both)
    return no_memory(r);
  for (size_t i = 0; i < view->points; i++)
    both[2 * view->points - 1 - i] = both[i];
  view->values = r->e->values = both;
  view->points *= 2;
  return 0;
}

static int read_entry(reading *r) {
  int code = find_keys(r);
  if (!code)
    code = read_parameter(r);
  if (!code)
    code = given(r, SWEEP_VALUES) ? read_list(r) : read_range(r);
  if (code)
    return code;
  r->e->view.values = r->e->values;
  code = given(r, SWEEP_BACK) ? append_reversed(r) : 0;
  if (code)
    return code;
  char label[128];
  snprintf(label, sizeof label, "swept %s", r->e->view.name);
  for (size_t i = 0; i < r->e->view.points && !code; i++)
    code = typed_check(r->d, sweep_value_node(r->d, r->e, i), r->e->view.key, label, r->e->values[i], r->why);
  char used[64];
  const parameter_use use = use_of(r, used, sizeof used);
  return code ? code
              : parameter_supply(r->s, r->d, &use, r->keys[SWEEP_PARAMETER], r->e->view.key, r->e->values[0], r->why);
}

static int count_tasks(study *s, const document *d, int node, message *why) {
  s->tasks = 1;
  for (size_t i = s->sweep_count; i-- > 0;) {
    s->sweeps[i].stride = s->tasks;
    if (s->sweeps[i].view.points > (too_many_tasks - 1) / s->tasks)
      return document_refuse(d, node, why, "the sweeps span %.3g grid points or more, expected fewer than 2^40",
                             (double)s->sweeps[i].view.points * (double)s->tasks);
    s->tasks *= s->sweeps[i].view.points;
  }
  return 0;
}

static int read_entries(study *s, const document *d, int node, message *why) {
  const yaml_node_t *n = document_node(d, node);
  const bool list = n->type == YAML_SEQUENCE_NODE;
  const size_t count = list ? (size_t)(n->data.sequence.items.top - n->data.sequence.items.start) : 1;
  if (count < 1 || count > STUDY_MAX_SWEEPS)
    return document_refuse(d, node, why, "sweep has %zu entries, expected from 1 to %d", count, STUDY_MAX_SWEEPS);
  for (size_t i = 0; i < count; i++) {
    reading r = {.s = s, .d = d, .node = list ? n->data.sequence.items.start[i] : node, .e = &s->sweeps[i], .why = why};
    if (list)
      snprintf(r.label, sizeof r.label, "sweep[%zu]", i);
    else
      snprintf(r.label, sizeof r.label, "sweep");
    const int code = read_entry(&r);
    if (code)
      return code;
    s->sweep_count = i + 1;
  }
  return 0;
}

int sweep_read(study *s, const document *d, int node, message *why) {
  const int code = node ? read_entries(s, d, node, why) : 0;
  return code ? code : count_tasks(s, d, node, why);
}

const sweep_entry *sweep_over(const study *s, study_key key, long item) {
  for (size_t i = 0; i < s->sweep_count; i++)
    if (s->sweeps[i].view.key == key && s->sweeps[i].view.item == item)
      return &s->sweeps[i];
  return NULL;
}

int sweep_value_node(const document *d, const sweep_entry *e, size_t i) {
  if (e->nodes[SWEEP_VALUES]) {
    const yaml_node_t *list = document_node(d, e->nodes[SWEEP_VALUES]);
    const size_t count = (size_t)(list->data.sequence.items.top - list->data.sequence.items.start);
    return list->data.sequence.items.start[i < count ? i : 2 * count - 1 - i]; /* from `count` on: in reverse */
  }
  return i == 0 ? e->nodes[SWEEP_FROM] : i == e->view.points - 1 ? e->nodes[SWEEP_TO] : e->nodes[SWEEP_POINTS];
}
