/* Studies of kind `branch`: what is followed, and how its keys fit together. */
#include <math.h>
#include <string.h>

#include "number.h"
#include "parameter.h"

static double first(const study *s, study_key key) {
  return s->values[key].numbers[0];
}

/* Whether a key has a value other than null. */
static bool is_set(const study *s, study_key key) {
  return s->values[key].present && first(s, key) > -INFINITY;
}

static bool motion_is(const study *s, const char *word) {
  return strcmp(s->values[KEY_ORBIT_MOTION].text, word) == 0;
}

static const char *shown(double value, char *text, size_t size) {
  number_show(value, text, size);
  return text;
}

/* --- what is followed --- */

static bool can_be_followed(study_key key) {
  return strncmp(schema_row(key)->path, "model.", 6) == 0 || key == KEY_ORBIT_PERIOD || key == KEY_ORBIT_ENERGY;
}

/* The values that the study gives for the parameter are ones that its key allows. */
static int check_values(const study *s, const document *d, message *why) {
  static const study_key keys[] = {KEY_BRANCH_FROM, KEY_BRANCH_TO, KEY_BRANCH_LOW, KEY_BRANCH_HIGH};
  int code = 0;
  for (size_t i = 0; i < sizeof keys / sizeof *keys && !code; i++) {
    char label[160];
    snprintf(label, sizeof label, "%s (%s)", schema_row(keys[i])->path, s->followed.name);
    if (is_set(s, keys[i]))
      code = typed_check(d, s->values[keys[i]].node, schema_row(s->followed.key), label, first(s, keys[i]), why);
  }
  return code;
}

int branch_read(study *s, const document *d, message *why) {
  const typed_value *name = &s->values[KEY_BRANCH_PARAMETER];
  if (!study_is_kind(s, "branch") || !name->present)
    return 0;
  const parameter_use use = {.label = "branch.parameter",
                             .noun = "branch",
                             .verb = "follow",
                             .done = "cannot be followed",
                             .example = "a number of model such as model.gamma, orbit.period or orbit.energy",
                             .node = name->node};
  study_parameter found;
  int code = parameter_find(s, d, &use, name->text, &found, why);
  if (code)
    return code;
  if (!can_be_followed(found.key))
    return document_refuse(d, use.node, why, "branch.parameter = %s cannot be followed, expected %s", found.name,
                           use.example);
  if (sweep_over(s, found.key, found.item))
    return document_refuse(d, use.node, why, "branch.parameter = %s is swept, too, expected one of the two",
                           found.name);
  s->followed = found;
  code = check_values(s, d, why);
  if (code || !s->values[KEY_BRANCH_FROM].present)
    return code;
  return parameter_supply(s, d, &use, use.node, found.key, first(s, KEY_BRANCH_FROM), why);
}

/* --- its range and its steps --- */

static int check_log(const study *s, const document *d, message *why) {
  static const study_key keys[] = {KEY_BRANCH_FROM, KEY_BRANCH_TO, KEY_BRANCH_LOW};
  char value[32];
  if (strcmp(s->values[KEY_BRANCH_SCALE].text, "log") != 0)
    return 0;
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
    if (is_set(s, keys[i]) && !(first(s, keys[i]) > 0))
      return document_refuse(d, s->values[keys[i]].node, why, "%s = %s with scale: log, expected a number > 0",
                             schema_row(keys[i])->path, shown(first(s, keys[i]), value, sizeof value));
  return 0;
}

/* The start lies within the bounds, with room on one side. */
static int check_range(const study *s, const document *d, message *why) {
  const double from = first(s, KEY_BRANCH_FROM), to = first(s, KEY_BRANCH_TO);
  const double low = is_set(s, KEY_BRANCH_LOW) ? first(s, KEY_BRANCH_LOW) : fmin(from, to);
  const double high = is_set(s, KEY_BRANCH_HIGH) ? first(s, KEY_BRANCH_HIGH) : fmax(from, to);
  char start[32], bound[32];
  shown(from, start, sizeof start);
  if (from == to)
    return document_refuse(d, s->values[KEY_BRANCH_TO].node, why,
                           "branch.to = %s is where the branch starts, expected another value", start);
  if (!(low <= from))
    return document_refuse(d, s->values[KEY_BRANCH_LOW].node, why,
                           "branch.low = %s leaves out the start, expected at most branch.from = %s",
                           shown(low, bound, sizeof bound), start);
  if (!(high >= from))
    return document_refuse(d, s->values[KEY_BRANCH_HIGH].node, why,
                           "branch.high = %s leaves out the start, expected at least branch.from = %s",
                           shown(high, bound, sizeof bound), start);
  if (!(low < high))
    return document_refuse(d, s->values[is_set(s, KEY_BRANCH_LOW) ? KEY_BRANCH_LOW : KEY_BRANCH_HIGH].node, why,
                           "branch.low and branch.high are both %s, expected low < high", start);
  return check_log(s, d, why);
}

/* Steps that are given do not contradict each other. */
static int check_steps(const study *s, const document *d, message *why) {
  static const study_key rising[] = {KEY_BRANCH_STEP_LEAST, KEY_BRANCH_STEP, KEY_BRANCH_STEP_MOST};
  char small[32], large[32];
  for (size_t i = 0; i < 2; i++)
    for (size_t j = i + 1; j < 3; j++)
      if (is_set(s, rising[i]) && is_set(s, rising[j]) && first(s, rising[i]) > first(s, rising[j]))
        return document_refuse(d, s->values[rising[i]].node, why, "%s = %s, expected at most %s = %s",
                               schema_row(rising[i])->path, shown(first(s, rising[i]), small, sizeof small),
                               schema_row(rising[j])->path, shown(first(s, rising[j]), large, sizeof large));
  return 0;
}

/* --- its motion --- */

/* Keys that have their default wherever the motion is of this kind. */
static int check_needs(const study *s, const document *d, const study_key *keys, size_t count, message *why) {
  int code = 0;
  for (size_t i = 0; i < count && !code; i++) {
    code = check_key_default(s, d, keys[i], why);
    if (!code && s->followed.key == keys[i])
      code = document_refuse(
          d, s->values[KEY_BRANCH_PARAMETER].node, why, "branch.parameter = %s, but orbit.motion: %s needs %s = %s",
          s->followed.name, s->values[KEY_ORBIT_MOTION].text, schema_row(keys[i])->path, schema_row(keys[i])->fallback);
  }
  return code;
}

static bool has_hertz(const study *s) {
  return is_set(s, KEY_MODEL_HERTZ);
}

/* What a kind of motion asks of the model: no losses, no force, a force that runs backwards as it runs forwards. */
static int check_model(const study *s, const document *d, message *why) {
  static const study_key lossless[] = {KEY_MODEL_DAMPING, KEY_MODEL_LINK_DAMPING, KEY_MODEL_RESTITUTION};
  static const study_key even[] = {KEY_MODEL_PHASE}, free_of_force[] = {KEY_MODEL_FORCE};
  int code = 0;
  if (motion_is(s, "even") || motion_is(s, "conservative"))
    code = check_needs(s, d, lossless, has_hertz(s) ? 2 : 3, why); /* Hertz contacts have no restitution */
  if (!code && motion_is(s, "even"))
    code = check_needs(s, d, even, 1, why);
  if (!code && (motion_is(s, "conservative") || motion_is(s, "autonomous")))
    code = check_needs(s, d, free_of_force, 1, why);
  return code;
}

static int refuse_key(const study *s, const document *d, study_key key, message *why, const char *but) {
  return document_refuse(d, check_node_of_key(s, key), why, "%s, but orbit.motion is %s: %s", schema_row(key)->path,
                         s->values[KEY_ORBIT_MOTION].text, but);
}

/* Which number says how long the motion takes. */
static int check_given(const study *s, const document *d, message *why) {
  const bool even = motion_is(s, "even"), conservative = motion_is(s, "conservative");
  const int followed = s->values[KEY_BRANCH_PARAMETER].node;
  const bool energy = is_set(s, KEY_ORBIT_ENERGY), multiple = is_set(s, KEY_ORBIT_FORCING_PERIODS);
  if (s->followed.key == KEY_ORBIT_PERIOD && (energy || multiple || !(even || conservative)))
    return document_refuse(d, followed, why,
                           "branch.parameter = orbit.period, but %s decides about the period, expected another one",
                           energy     ? "orbit.energy"
                           : multiple ? "orbit.forcing_periods"
                                      : s->values[KEY_ORBIT_MOTION].text);
  if (energy && !even && !conservative)
    return document_refuse(d, s->followed.key == KEY_ORBIT_ENERGY ? followed : check_node_of_key(s, KEY_ORBIT_ENERGY),
                           why, "orbit.energy, but orbit.motion is %s: it can be given of even and conservative ones",
                           s->values[KEY_ORBIT_MOTION].text);
  if (multiple && (conservative || motion_is(s, "autonomous")))
    return refuse_key(s, d, KEY_ORBIT_FORCING_PERIODS, why, "it has no force");
  if (multiple && s->values[KEY_ORBIT_PERIOD].present)
    return document_refuse(d, check_node_of_key(s, KEY_ORBIT_FORCING_PERIODS), why,
                           "orbit.forcing_periods and orbit.period both give the period, expected one of the two");
  return 0;
}

static bool has_obstacle(const study *s, study_key key, size_t particle) {
  const typed_value *at = &s->values[key];
  return at->numbers[at->list ? particle : 0] > -INFINITY;
}

static int check_sequence(const study *s, const document *d, message *why) {
  const typed_value *sequence = &s->values[KEY_ORBIT_SEQUENCE], *times = &s->values[KEY_ORBIT_TIMES];
  if (times->count != sequence->count)
    return document_refuse(d, times->node ? times->node : sequence->node, why,
                           "orbit.times has %zu elements, expected %zu, one per impact of orbit.sequence", times->count,
                           sequence->count);
  if (sequence->count > 0 && has_hertz(s))
    return document_refuse(d, sequence->node, why,
                           "orbit.sequence, but with model.hertz nothing jumps, expected no impacts");
  for (size_t i = 0; i < sequence->count; i++) {
    const int code = check_particle(s, d, KEY_ORBIT_SEQUENCE, i, why);
    const size_t particle = (size_t)sequence->numbers[i];
    if (code)
      return code;
    if (!has_obstacle(s, KEY_MODEL_FLOOR, particle) && !has_obstacle(s, KEY_MODEL_WALL, particle))
      return document_refuse(d, typed_item_node(d, sequence, i), why,
                             "orbit.sequence[%zu] = %zu has no floor or wall to hit, expected a particle with one", i,
                             particle);
    if (i > 0 && !(times->numbers[i] >= times->numbers[i - 1]) && !sweep_over(s, KEY_ORBIT_TIMES, (long)i))
      return document_refuse(d, typed_item_node(d, times, i), why,
                             "orbit.times[%zu] lies before orbit.times[%zu], expected rising times", i, i - 1);
  }
  return 0;
}

static int check_excited(const study *s, const document *d, message *why) {
  const typed_value *excited = &s->values[KEY_ORBIT_EXCITED];
  int code = 0;
  for (size_t i = 0; i < excited->count && !code; i++)
    code = check_particle(s, d, KEY_ORBIT_EXCITED, i, why);
  return code;
}

/* One guess to begin with. */
static int check_guess(const study *s, const document *d, message *why) {
  const source file = {.name = s->name};
  const int start = check_node_of_section(s, d, "start");
  const bool excited = s->values[KEY_ORBIT_EXCITED].count > 0, forced = motion_is(s, "forced");
  const bool listed = s->values[KEY_ORBIT_AT_START].count + s->values[KEY_ORBIT_AT_HALF].count > 0;
  if (!motion_is(s, "even") && listed)
    return refuse_key(s, d, s->values[KEY_ORBIT_AT_START].count > 0 ? KEY_ORBIT_AT_START : KEY_ORBIT_AT_HALF, why,
                      "expected the impacts in orbit.sequence");
  if (excited && (start || listed))
    return document_refuse(d, s->values[KEY_ORBIT_EXCITED].node, why,
                           "orbit.excited gives a first guess, and so %s, expected one of them",
                           start ? "does the section start" : "do the impacts");
  if (!start && !excited && !listed && !forced)
    return source_refuse(&file, 0, why, "kind: branch has no first guess, expected the section start, orbit.excited%s",
                         motion_is(s, "even") ? ", orbit.at_start or orbit.at_half" : "");
  return 0;
}

int branch_check(const study *s, const document *d, message *why) {
  static int (*const checks[])(const study *, const document *, message *) = {
      check_range, check_steps, check_model, check_given, check_sequence, check_excited, check_guess};
  int code = 0;
  for (size_t i = 0; i < sizeof checks / sizeof *checks && !code; i++)
    code = checks[i](s, d, why);
  return code;
}

int branch_check_restart(const study *s, const document *d, message *why) {
  const bool special = is_set(s, KEY_RESTART_SPECIAL), point = is_set(s, KEY_RESTART_POINT);
  if (special != point)
    return 0;
  return document_refuse(d, s->values[special ? KEY_RESTART_SPECIAL : KEY_RESTART_FILE].node, why,
                         "restart has %s special %s point, expected one of the two", special ? "both" : "neither",
                         special ? "and" : "nor");
}
