/* The keys of studies that continue a family of periodic motions: its parameters, and checks that keys fit together. */
#include "family_check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "kind/keys.h"
#include "kind/pattern.h"
#include "model/lattice_model.h"
#include "study/number.h"

/* Whether the first guess is a normal mode. */
static bool from_mode(const study *s) {
  return study_has(s, KEY_ORBIT_MODE);
}

static bool motion_is(const study *s, const char *word) {
  return strcmp(study_word(s, KEY_ORBIT_MOTION), word) == 0;
}

static const char *shown(double value, char *text, size_t size) {
  number_show(value, text, size);
  return text;
}

/* --- parameters --- */

static bool can_be_followed(study_key key) {
  return strncmp(key->path, "model.", 6) == 0 || key == KEY_ORBIT_PERIOD || key == KEY_ORBIT_ENERGY;
}

static parameter_use use_of(const study *s, study_key key) {
  return (parameter_use){.label = key->path,
                         .noun = key == KEY_BRANCH_PARAMETER ? "branch" : "trace",
                         .verb = "follow",
                         .done = "cannot be followed",
                         .example = "a number of model such as model.gamma, orbit.period or orbit.energy",
                         .node = study_value(s, key)->node};
}

/* Finds the number that a key names; refuses one that cannot vary along a branch, or is swept. */
static int find_parameter(const study *s, const document *d, study_key key, study_parameter *found, message *why) {
  const parameter_use use = use_of(s, key);
  const int code = parameter_find(s, d, &use, study_word(s, key), found, why);
  if (code)
    return code;
  if (!can_be_followed(found->key))
    return document_refuse(d, use.node, why, "%s = %s cannot be followed, expected %s", use.label, found->name,
                           use.example);
  if (sweep_over(s, found->key, found->item))
    return document_refuse(d, use.node, why, "%s = %s is also swept, expected one of the two", use.label, found->name);
  return 0;
}

/* Refuses values for a parameter that its key does not allow. */
static int check_values(const study *s, const document *d, const study_parameter *p, const study_key *keys,
                        size_t count, message *why) {
  int code = 0;
  for (size_t i = 0; i < count && !code; i++) {
    char label[160];
    snprintf(label, sizeof label, "%s (%s)", keys[i]->path, p->name);
    if (study_has(s, keys[i]))
      code = typed_check(d, study_value(s, keys[i])->node, p->key, label, study_number(s, keys[i]), why);
  }
  return code;
}

static double own_value(const study *s, const study_parameter *p) {
  const typed_value *value = study_value(s, p->key);
  return value->present ? value->numbers[p->item < 0 ? 0 : p->item] : -INFINITY;
}

/* branch.from sets an omitted parameter; an omitted branch.from is the parameter's own value. */
static int supply_start(study *s, const document *d, const study_parameter *p, message *why) {
  const parameter_use use = use_of(s, KEY_BRANCH_PARAMETER);
  if (study_has(s, KEY_BRANCH_FROM))
    return parameter_supply(s, d, &use, use.node, p->key, study_number(s, KEY_BRANCH_FROM), why);
  study_fill_number(s, KEY_BRANCH_FROM, own_value(s, p));
  return 0;
}

static int read_followed(study *s, const document *d, message *why) {
  static const study_key keys[] = {KEY_BRANCH_FROM, KEY_BRANCH_TO, KEY_BRANCH_LOW, KEY_BRANCH_HIGH};
  study_parameter found;
  if (!study_value(s, KEY_BRANCH_PARAMETER)->present)
    return 0;
  int code = find_parameter(s, d, KEY_BRANCH_PARAMETER, &found, why);
  if (code)
    return code;
  code = check_values(s, d, &found, keys, sizeof keys / sizeof *keys, why);
  if (!code)
    code = supply_start(s, d, &found, why);
  const double start = study_number(s, KEY_BRANCH_FROM);
  study_move(s, KEY_BRANCH_FROM, &(study_parameter){.name = "branch.from", .key = KEY_BRANCH_FROM, .item = -1}, start);
  study_move(s, KEY_BRANCH_PARAMETER, &found, start);
  return code;
}

static int read_traced(study *s, const document *d, message *why) {
  static const study_key keys[] = {KEY_BRANCH_TRACE_LOW, KEY_BRANCH_TRACE_HIGH};
  static const study_key firsts[] = {KEY_BRANCH_TRACE_FIRST_LOW, KEY_BRANCH_TRACE_FIRST_HIGH};
  const typed_value *name = study_value(s, KEY_BRANCH_TRACE_PARAMETER);
  const study_parameter *followed = family_followed(s);
  study_parameter found;
  if (!name->present)
    return 0;
  int code = find_parameter(s, d, KEY_BRANCH_TRACE_PARAMETER, &found, why);
  if (code)
    return code;
  if (followed && found.key == followed->key && found.item == followed->item)
    return document_refuse(d, name->node, why,
                           "branch.trace.parameter = %s is already branch.parameter, expected another one", found.name);
  study_move(s, KEY_BRANCH_TRACE_PARAMETER, &found, own_value(s, &found));
  code = check_values(s, d, &found, keys, sizeof keys / sizeof *keys, why);
  if (code || !followed)
    return code;
  return check_values(s, d, followed, firsts, sizeof firsts / sizeof *firsts, why);
}

int family_complete_study(study *s, const document *d, message *why) {
  const int code = read_followed(s, d, why);
  return code ? code : read_traced(s, d, why);
}

const study_parameter *family_followed(const study *s) {
  return study_moved(s, KEY_BRANCH_PARAMETER);
}

const study_parameter *family_traced(const study *s) {
  return study_moved(s, KEY_BRANCH_TRACE_PARAMETER);
}

static bool follows_key(const study *s, study_key key) {
  return family_followed(s) && family_followed(s)->key == key;
}

static bool is_of_trace(study_key key) {
  return strncmp(key->path, "branch.trace.", 13) == 0;
}

/* Whether the study asks for curves through special points. */
static bool traces(const study *s) {
  for (size_t i = 0; i < s->schema->key_count; i++)
    if (is_of_trace(s->schema->keys[i]) && s->values[i].node)
      return true;
  return false;
}

/* The period is not required if the force or a normal mode gives it. */
bool family_wants(const study *s, const document *d, study_key key) {
  (void)d;
  if (key == KEY_ORBIT_PERIOD)
    return !motion_is(s, "forced") && !from_mode(s) && !study_has(s, KEY_ORBIT_FORCING_PERIODS);
  return !is_of_trace(key) || traces(s);
}

/* --- its range and its steps --- */

/* Node of a bound; of an omitted start that of branch.parameter. */
static int node_of_bound(const study *s, study_key key) {
  return study_value(s, key)->node ? study_value(s, key)->node : study_value(s, KEY_BRANCH_PARAMETER)->node;
}

static int check_log(const study *s, const document *d, message *why) {
  static const study_key keys[] = {KEY_BRANCH_FROM, KEY_BRANCH_TO, KEY_BRANCH_LOW};
  char value[32];
  if (strcmp(study_word(s, KEY_BRANCH_SCALE), "log") != 0)
    return 0;
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
    if (study_has(s, keys[i]) && !(study_number(s, keys[i]) > 0))
      return document_refuse(d, node_of_bound(s, keys[i]), why, "%s = %s with scale: log, expected a number > 0",
                             keys[i]->path, shown(study_number(s, keys[i]), value, sizeof value));
  return 0;
}

/* Whether the branch starts at the energy of the motion with the given period. */
static bool starts_at_period(const study *s) {
  return follows_key(s, KEY_ORBIT_ENERGY) && !study_has(s, KEY_BRANCH_FROM);
}

/* Whether it starts at the energy at which a mode grazes the obstacle of the particle in orbit.at_start. */
static bool starts_at_grazing_mode(const study *s) {
  return from_mode(s) && starts_at_period(s) && motion_is(s, "even") &&
         study_value(s, KEY_ORBIT_AT_START)->count == 1 && study_value(s, KEY_ORBIT_AT_HALF)->count == 0 &&
         study_value(s, KEY_ORBIT_SEQUENCE)->count == 0;
}

static int check_from(const study *s, const document *d, message *why) {
  if (study_has(s, KEY_BRANCH_FROM))
    return 0;
  if (!starts_at_period(s))
    return document_refuse(d, study_value(s, KEY_BRANCH_PARAMETER)->node, why,
                           "missing key branch.from (a number): %s has no value of its own", family_followed(s)->name);
  if (from_mode(s) && !starts_at_grazing_mode(s))
    return document_refuse(d, study_value(s, KEY_BRANCH_PARAMETER)->node, why,
                           "missing key branch.from (a number), the energy at the start: orbit.mode does not give "
                           "it");
  return 0;
}

/* Refuses two bounds that are both given and not ascending. */
static int check_bounds(const study *s, const document *d, study_key low, study_key high, message *why) {
  char small[32], large[32];
  if (!study_has(s, low) || !study_has(s, high) || study_number(s, low) < study_number(s, high))
    return 0;
  return document_refuse(d, study_value(s, low)->node, why, "%s = %s, expected less than %s = %s", low->path,
                         shown(study_number(s, low), small, sizeof small), high->path,
                         shown(study_number(s, high), large, sizeof large));
}

/* The start must be within the bounds, and not equal to both. */
static int check_range(const study *s, const document *d, message *why) {
  const double to = study_number(s, KEY_BRANCH_TO), from = study_number(s, KEY_BRANCH_FROM);
  const double low = study_has(s, KEY_BRANCH_LOW) ? study_number(s, KEY_BRANCH_LOW) : fmin(from, to);
  const double high = study_has(s, KEY_BRANCH_HIGH) ? study_number(s, KEY_BRANCH_HIGH) : fmax(from, to);
  char start[32], bound[32];
  shown(from, start, sizeof start);
  if (starts_at_period(s)) { /* the run finds the start */
    const int code = check_bounds(s, d, KEY_BRANCH_LOW, KEY_BRANCH_HIGH, why);
    return code ? code : check_log(s, d, why);
  }
  if (from == to)
    return document_refuse(d, study_value(s, KEY_BRANCH_TO)->node, why,
                           "branch.to = %s is the start of the branch, expected another value", start);
  if (!(low <= from))
    return document_refuse(d, study_value(s, KEY_BRANCH_LOW)->node, why,
                           "branch.low = %s is above the start, expected at most branch.from = %s",
                           shown(low, bound, sizeof bound), start);
  if (!(high >= from))
    return document_refuse(d, study_value(s, KEY_BRANCH_HIGH)->node, why,
                           "branch.high = %s is below the start, expected at least branch.from = %s",
                           shown(high, bound, sizeof bound), start);
  if (!(low < high))
    return document_refuse(d, study_value(s, study_has(s, KEY_BRANCH_LOW) ? KEY_BRANCH_LOW : KEY_BRANCH_HIGH)->node,
                           why, "branch.low and branch.high are both %s, expected low < high", start);
  return check_log(s, d, why);
}

/* Given steps must not decrease. */
static int check_rising(const study *s, const document *d, const study_key *rising, size_t count, message *why) {
  char small[32], large[32];
  for (size_t i = 0; i < count; i++)
    for (size_t j = i + 1; j < count; j++)
      if (study_has(s, rising[i]) && study_has(s, rising[j]) && study_number(s, rising[i]) > study_number(s, rising[j]))
        return document_refuse(d, study_value(s, rising[i])->node, why, "%s = %s, expected at most %s = %s",
                               rising[i]->path, shown(study_number(s, rising[i]), small, sizeof small), rising[j]->path,
                               shown(study_number(s, rising[j]), large, sizeof large));
  return 0;
}

static int check_steps(const study *s, const document *d, message *why) {
  static const study_key steps[] = {KEY_BRANCH_STEP_LEAST, KEY_BRANCH_STEP, KEY_BRANCH_STEP_MOST};
  return check_rising(s, d, steps, sizeof steps / sizeof *steps, why);
}

/* --- curves in two parameters --- */

static int check_trace_range(const study *s, const document *d, message *why) {
  const double low = study_number(s, KEY_BRANCH_TRACE_LOW), high = study_number(s, KEY_BRANCH_TRACE_HIGH);
  const study_parameter *p = family_traced(s);
  const double start = own_value(s, p);
  char bound[32], own[32];
  shown(start, own, sizeof own);
  if (!(start > -INFINITY))
    return document_refuse(d, study_value(s, KEY_BRANCH_TRACE_PARAMETER)->node, why,
                           "branch.trace.parameter = %s is null in the study, expected a number: curves start there",
                           p->name);
  const int code = check_bounds(s, d, KEY_BRANCH_TRACE_LOW, KEY_BRANCH_TRACE_HIGH, why);
  if (code)
    return code;
  if (!(low <= start))
    return document_refuse(d, study_value(s, KEY_BRANCH_TRACE_LOW)->node, why,
                           "branch.trace.low = %s is above the start of curves, expected at most %s = %s",
                           shown(low, bound, sizeof bound), p->name, own);
  if (!(high >= start))
    return document_refuse(d, study_value(s, KEY_BRANCH_TRACE_HIGH)->node, why,
                           "branch.trace.high = %s is below the start of curves, expected at least %s = %s",
                           shown(high, bound, sizeof bound), p->name, own);
  return 0;
}

static int check_trace(const study *s, const document *d, message *why) {
  static const study_key steps[] = {KEY_BRANCH_TRACE_STEP, KEY_BRANCH_TRACE_STEP_MOST};
  const typed_value *kinds = study_value(s, KEY_BRANCH_TRACE_KINDS);
  if (!traces(s))
    return 0;
  if (kinds->count == 0)
    return document_refuse(d, kinds->node, why, "branch.trace.kinds is empty, expected at least one kind");
  int code = check_trace_range(s, d, why);
  if (!code)
    code = check_bounds(s, d, KEY_BRANCH_TRACE_FIRST_LOW, KEY_BRANCH_TRACE_FIRST_HIGH, why);
  return code ? code : check_rising(s, d, steps, sizeof steps / sizeof *steps, why);
}

/* --- its motion --- */

/* The key that names this one as a continuation parameter; NULL for none. */
static study_key naming_key_of(const study *s, study_key key) {
  if (follows_key(s, key))
    return KEY_BRANCH_PARAMETER;
  return family_traced(s) && family_traced(s)->key == key ? KEY_BRANCH_TRACE_PARAMETER : NULL;
}

/* Refuses a key, given, swept or continued, whose default this kind of motion needs. */
static int check_need(const study *s, const document *d, study_key key, message *why) {
  const study_key naming = naming_key_of(s, key);
  char label[128], value[32] = "null";
  double other;
  const int node = check_find_other(s, d, key, label, sizeof label, &other);
  if (node < 0)
    return refuse(why, EXIT_RUN, "%s: out of memory", study_name(s));
  if (node && other > -INFINITY)
    number_show(other, value, sizeof value);
  if (node)
    return document_refuse(d, node, why, "%s = %s, but orbit.motion: %s needs %s = %s", label, value,
                           study_word(s, KEY_ORBIT_MOTION), key->path, key->fallback);
  if (naming)
    return document_refuse(d, study_value(s, naming)->node, why, "%s = %s, but orbit.motion: %s needs %s = %s",
                           naming->path, study_word(s, naming), study_word(s, KEY_ORBIT_MOTION), key->path,
                           key->fallback);
  return 0;
}

static int check_needs(const study *s, const document *d, const study_key *keys, size_t count, message *why) {
  int code = 0;
  for (size_t i = 0; i < count && !code; i++)
    code = check_need(s, d, keys[i], why);
  return code;
}

static bool has_hertz(const study *s) {
  return study_has(s, KEY_MODEL_HERTZ);
}

/* What a kind of motion needs of the model: no losses, no force, or a force that is even in time. */
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
  return document_refuse(d, check_node_of_key(s, key), why, "%s, but orbit.motion is %s: %s", key->path,
                         study_word(s, KEY_ORBIT_MOTION), but);
}

static bool gives_energy(const study *s) {
  return study_has(s, KEY_ORBIT_ENERGY) || naming_key_of(s, KEY_ORBIT_ENERGY);
}

/* Exactly one key must determine the period: orbit.period, orbit.energy or orbit.forcing_periods. */
static int check_given(const study *s, const document *d, message *why) {
  const bool even = motion_is(s, "even"), conservative = motion_is(s, "conservative");
  const study_key naming = naming_key_of(s, KEY_ORBIT_PERIOD);
  const bool energy = gives_energy(s), multiple = study_has(s, KEY_ORBIT_FORCING_PERIODS);
  if (naming && (energy || multiple || !(even || conservative)))
    return document_refuse(d, study_value(s, naming)->node, why,
                           "%s = orbit.period, but %s determines the period, expected another one", naming->path,
                           energy     ? "orbit.energy"
                           : multiple ? "orbit.forcing_periods"
                                      : study_word(s, KEY_ORBIT_MOTION));
  if (energy && !even && !conservative)
    return document_refuse(d,
                           follows_key(s, KEY_ORBIT_ENERGY) ? study_value(s, KEY_BRANCH_PARAMETER)->node
                                                            : check_node_of_key(s, KEY_ORBIT_ENERGY),
                           why, "orbit.energy, but orbit.motion is %s: expected even or conservative",
                           study_word(s, KEY_ORBIT_MOTION));
  if (multiple && (conservative || motion_is(s, "autonomous")))
    return refuse_key(s, d, KEY_ORBIT_FORCING_PERIODS, why, "expected even or forced");
  if (multiple && study_value(s, KEY_ORBIT_PERIOD)->present)
    return document_refuse(d, check_node_of_key(s, KEY_ORBIT_FORCING_PERIODS), why,
                           "orbit.forcing_periods and orbit.period both give the period, expected one of the two");
  return 0;
}

static int check_sequence(const study *s, const document *d, message *why) {
  const int swept = lattice_check_swept_particles(s, d, KEY_ORBIT_SEQUENCE, why);
  const typed_value *sequence = study_value(s, KEY_ORBIT_SEQUENCE), *times = study_value(s, KEY_ORBIT_TIMES);
  if (swept)
    return swept;
  if (times->count != sequence->count)
    return document_refuse(d, times->node ? times->node : sequence->node, why,
                           "orbit.times has %zu elements, expected %zu, one per impact of orbit.sequence", times->count,
                           sequence->count);
  if (sequence->count > 0 && has_hertz(s))
    return document_refuse(d, sequence->node, why,
                           "orbit.sequence, but contacts with model.hertz are not impacts, expected an empty list");
  for (size_t i = 0; i < sequence->count; i++) {
    const int code = lattice_check_particle(s, d, KEY_ORBIT_SEQUENCE, i, why);
    const size_t particle = (size_t)sequence->numbers[i];
    if (code)
      return code;
    if (!lattice_has_obstacle(s, particle))
      return document_refuse(d, typed_item_node(d, sequence, i), why,
                             "orbit.sequence[%zu] = %zu has no floor or wall to hit, expected a particle with one", i,
                             particle);
    if (i > 0 && !(times->numbers[i] >= times->numbers[i - 1]) && !sweep_over(s, KEY_ORBIT_TIMES, (long)i))
      return document_refuse(d, typed_item_node(d, times, i), why,
                             "orbit.times[%zu] is smaller than orbit.times[%zu], expected ascending times", i, i - 1);
  }
  return 0;
}

static int check_excited(const study *s, const document *d, message *why) {
  const typed_value *excited = study_value(s, KEY_ORBIT_EXCITED);
  int code = 0;
  for (size_t i = 0; i < excited->count && !code; i++)
    code = lattice_check_particle(s, d, KEY_ORBIT_EXCITED, i, why);
  return code ? code : lattice_check_swept_particles(s, d, KEY_ORBIT_EXCITED, why);
}

/* A value of orbit.mode. @param label  "orbit.mode" or "swept orbit.mode" */
static int check_one_mode(const study *s, const document *d, int node, const char *label, double mode, message *why) {
  const double particles = study_number(s, KEY_MODEL_PARTICLES);
  if (mode < particles)
    return 0;
  return document_refuse(d, node, why, "%s = %.0f is out of range, expected a mode from 0 to %.0f", label, mode,
                         particles - 1);
}

static int check_mode(const study *s, const document *d, message *why) {
  const sweep_entry *e = sweep_over(s, KEY_ORBIT_MODE, -1);
  const int node = check_node_of_key(s, KEY_ORBIT_MODE);
  if (!from_mode(s))
    return 0;
  if (!gives_energy(s))
    return document_refuse(d, node, why,
                           "orbit.mode needs an energy for its amplitude, expected orbit.energy, or a branch along "
                           "it");
  int code = check_one_mode(s, d, node, "orbit.mode", study_number(s, KEY_ORBIT_MODE), why);
  for (size_t i = 0; e && i < e->view.points && !code; i++)
    code = check_one_mode(s, d, sweep_value_node(d, e, i), "swept orbit.mode", e->values[i], why);
  return code;
}

static int check_swings(const study *s, const document *d, message *why) {
  if (!study_value(s, KEY_ORBIT_SWINGS)->node || starts_at_grazing_mode(s))
    return 0;
  return document_refuse(
      d, study_value(s, KEY_ORBIT_SWINGS)->node, why,
      "orbit.swings counts periods of orbit.mode between impacts: expected orbit.mode, one particle in "
      "orbit.at_start, and a branch along orbit.energy without branch.from");
}

static int refuse_two_guesses(const study *s, const document *d, study_key key, bool start, message *why) {
  return document_refuse(d, check_node_of_key(s, key), why, "%s gives a first guess, and so %s, expected one of them",
                         key->path, start ? "does the section start" : "do the impacts");
}

/* Exactly one first guess. */
static int check_guess(const study *s, const document *d, message *why) {
  const int start = check_node_of_section(s, d, "start");
  const bool excited = study_value(s, KEY_ORBIT_EXCITED)->count > 0, forced = motion_is(s, "forced");
  const bool mode = from_mode(s);
  const bool listed = study_value(s, KEY_ORBIT_AT_START)->count + study_value(s, KEY_ORBIT_AT_HALF)->count > 0;
  if (!motion_is(s, "even") && listed)
    return refuse_key(s, d, study_value(s, KEY_ORBIT_AT_START)->count > 0 ? KEY_ORBIT_AT_START : KEY_ORBIT_AT_HALF, why,
                      "expected the impacts in orbit.sequence");
  if (mode && study_value(s, KEY_ORBIT_PERIOD)->present)
    return document_refuse(d, check_node_of_key(s, KEY_ORBIT_PERIOD), why,
                           "orbit.period and orbit.mode both give a period, expected one of them");
  if (mode && excited)
    return document_refuse(d, check_node_of_key(s, KEY_ORBIT_MODE), why,
                           "orbit.mode gives a first guess, and so does orbit.excited, expected one of them");
  if (starts_at_grazing_mode(s) && !start)
    return has_hertz(s) ? document_refuse(d, check_node_of_key(s, KEY_ORBIT_MODE), why,
                                          "orbit.mode with orbit.at_start: the mode grazes a rigid obstacle, "
                                          "expected model.hertz = null")
                        : 0;
  if ((excited || mode) && (start || listed))
    return refuse_two_guesses(s, d, mode ? KEY_ORBIT_MODE : KEY_ORBIT_EXCITED, start, why);
  if (!start && !excited && !mode && !listed && !forced)
    return check_refuse(s, why, "kind: %s has no first guess, expected the section start, orbit.excited, orbit.mode%s",
                        study_kind(s), motion_is(s, "even") ? ", orbit.at_start or orbit.at_half" : "");
  return 0;
}

int family_check(const study *s, const document *d, message *why) {
  static int (*const checks[])(const study *, const document *, message *) = {
      check_from,     check_range,   check_steps, check_model,  check_given, check_trace,
      check_sequence, check_excited, check_mode,  check_swings, check_guess};
  int code = pattern_check(s, d, true, why);
  for (size_t i = 0; i < sizeof checks / sizeof *checks && !code; i++)
    code = checks[i](s, d, why);
  return code;
}
