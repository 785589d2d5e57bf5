/* Studies that iterate, of kinds `diagram` and `basin`: the state, what is observed of it, and how the keys fit. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "number.h"
#include "parts.h"

static double first(const study *s, study_key key) {
  return s->values[key].numbers[0];
}

bool study_iterates(const study *s) {
  return study_is_kind(s, "diagram") || study_is_kind(s, "basin");
}

bool study_is_map(const study *s) {
  return study_model(s) && strcmp(study_model(s), "grazing_map") == 0;
}

bool study_is_beyond(const study *s) {
  const typed_value *beyond = &s->values[KEY_GRAZING_BEYOND];
  return study_is_kind(s, "diagram") && !study_is_map(s) && beyond->present && beyond->numbers[0] > -INFINITY;
}

static bool is_at_impacts(const study *s) {
  return strcmp(s->values[KEY_ITERATE_SECTION].text, "impact") == 0;
}

/* A map is given by its lists, or is the example, of three numbers. */
static bool is_listed(const study *s) {
  return s->values[KEY_MODEL_ETA].count > 0 || s->values[KEY_MODEL_L].count > 0;
}

size_t study_state_size(const study *s) {
  if (study_is_map(s))
    return is_listed(s) ? s->values[KEY_MODEL_ETA].count : 3;
  return 2 * (size_t)first(s, KEY_MODEL_PARTICLES) + is_at_impacts(s);
}

/* --- what is observed --------------------------------------------------------------------------------------------- */

/* "q12" with the letter q: 12. @returns whether it is one, below `count` */
static bool read_name(const char *name, char letter, size_t from, size_t count, size_t *index) {
  char *end;
  if (name[0] != letter || name[1] < '0' || name[1] > '9')
    return false;
  const unsigned long number = strtoul(name + 1, &end, 10);
  *index = number - from;
  return *end == '\0' && number >= from && *index < count;
}

static size_t last_with_obstacle(const study *s) {
  const size_t particles = (size_t)first(s, KEY_MODEL_PARTICLES);
  for (size_t i = particles; i-- > 0;)
    if (check_has_obstacle(s, i))
      return i;
  return particles - 1;
}

int iterate_read(study *s, message *why) {
  typed_value *name = &s->values[KEY_ITERATE_OBSERVE];
  char text[32];
  if (!study_iterates(s) || !study_model(s) || name->node)
    return 0;
  if (!study_is_map(s) && !s->values[KEY_MODEL_PARTICLES].present) /* refused later, as missing */
    return 0;
  if (study_is_map(s))
    snprintf(text, sizeof text, "z1");
  else
    snprintf(text, sizeof text, "q%zu", last_with_obstacle(s));
  free(name->text);
  name->text = strdup(text);
  return name->text ? 0 : refuse(why, EXIT_RUN, "%s: out of memory", s->name);
}

static bool find_observed(const study *s, size_t *index) {
  const char *name = s->values[KEY_ITERATE_OBSERVE].text;
  const size_t size = study_state_size(s), particles = size / 2;
  *index = 0;
  if (study_is_map(s))
    return read_name(name, 'z', 1, size, index);
  if (strcmp(name, "time") == 0) {
    *index = size - 1;
    return is_at_impacts(s);
  }
  if (read_name(name, 'v', 0, particles, index)) {
    *index += particles;
    return true;
  }
  return read_name(name, 'q', 0, particles, index);
}

size_t study_observed(const study *s) {
  size_t index;
  find_observed(s, &index);
  return index;
}

bool study_windows(const study *s) {
  return study_is_kind(s, "diagram") && first(s, KEY_ITERATE_WINDOWS) != 0;
}

static int check_observed(const study *s, const document *d, message *why) {
  const size_t size = study_state_size(s);
  size_t index;
  if (find_observed(s, &index))
    return 0;
  const typed_value *value = &s->values[KEY_ITERATE_OBSERVE];
  if (study_is_map(s))
    return document_refuse(d, value->node, why, "iterate.observe = %.40s, expected z1 to z%zu", value->text, size);
  return document_refuse(d, value->node, why, "iterate.observe = %.40s, expected q0 to q%zu or v0 to v%zu%s",
                         value->text, size / 2 - 1, size / 2 - 1, is_at_impacts(s) ? " or time" : "");
}

/* --- the map ------------------------------------------------------------------------------------------------------ */

static int check_length(const study *s, const document *d, study_key key, size_t length, message *why) {
  const typed_value *list = &s->values[key];
  if (list->count == length)
    return 0;
  const int node = list->node                      ? list->node
                   : s->values[KEY_MODEL_ETA].node ? s->values[KEY_MODEL_ETA].node
                                                   : s->values[KEY_MODEL_L].node;
  return document_refuse(d, node, why, "%s has %zu elements, expected %zu: model.eta has %zu", schema_row(key)->path,
                         list->count, length, s->values[KEY_MODEL_ETA].count);
}

static bool is_given(const study *s, study_key key) {
  return first(s, key) > -INFINITY;
}

static int check_lists(const study *s, const document *d, message *why) {
  static const study_key alone[] = {KEY_MODEL_LAMBDA, KEY_MODEL_OMEGA};
  const size_t n = s->values[KEY_MODEL_ETA].count;
  for (size_t i = 0; i < 2; i++)
    if (is_given(s, alone[i]))
      return document_refuse(d, check_node_of_key(s, alone[i]), why,
                             "%s is of the example map, and model.L gives another one: expected one of the two",
                             schema_row(alone[i])->path);
  if (n == 0)
    return document_refuse(d, s->values[KEY_MODEL_L].node, why, "model.eta is empty, expected the vector of the map");
  int code = check_length(s, d, KEY_MODEL_L, n * n, why);
  if (!code)
    code = check_length(s, d, KEY_MODEL_XI, n, why);
  if (!code && s->values[KEY_MODEL_KAPPA].count > 0)
    code = check_length(s, d, KEY_MODEL_KAPPA, n, why);
  return code;
}

static int check_map(const study *s, const document *d, message *why) {
  const source file = {.name = s->name};
  int code = 0;
  if (is_listed(s))
    code = check_lists(s, d, why);
  else if (!is_given(s, KEY_MODEL_LAMBDA) || !is_given(s, KEY_MODEL_OMEGA))
    code = source_refuse(&file, 0, why, "missing key %s: a map is given by lambda and omega, or by L, eta and xi",
                         is_given(s, KEY_MODEL_LAMBDA) ? "model.omega" : "model.lambda");
  const typed_value *start = &s->values[KEY_ITERATE_START];
  if (!code && start->list && start->count != study_state_size(s))
    code = document_refuse(d, start->node, why, "iterate.start has %zu elements, expected %zu, or a single number",
                           start->count, study_state_size(s));
  return code;
}

/* --- the section -------------------------------------------------------------------------------------------------- */

static int check_section(const study *s, const document *d, message *why) {
  const double particle = first(s, KEY_ITERATE_PARTICLE);
  const int node = check_node_of_key(s, KEY_ITERATE_PARTICLE);
  if (particle == -INFINITY && is_at_impacts(s) && !check_has_obstacle(s, last_with_obstacle(s)))
    return document_refuse(d, s->values[KEY_ITERATE_SECTION].node, why,
                           "iterate.section = impact, and no particle has a floor or a wall to hit (all are null)");
  if (particle == -INFINITY)
    return 0;
  if (!is_at_impacts(s))
    return document_refuse(d, node, why, "iterate.particle is a key of iterate.section: impact, and this is strobe");
  if (!(particle < first(s, KEY_MODEL_PARTICLES)))
    return document_refuse(d, node, why, "iterate.particle = %.0f is out of range, expected a particle from 0 to %.0f",
                           particle, first(s, KEY_MODEL_PARTICLES) - 1);
  if (!check_has_obstacle(s, (size_t)particle))
    return document_refuse(d, node, why, "iterate.particle = %.0f has no floor or wall to hit (both are null there)",
                           particle);
  return 0;
}

/* --- what is wanted ----------------------------------------------------------------------------------------------- */

static int refuse_measure(const study *s, const document *d, int node, const char *label, double measure,
                          message *why) {
  return document_refuse(d, node, why, "%s = %.0f, expected at least iterate.keep = %.0f", label, measure,
                         first(s, KEY_ITERATE_KEEP));
}

/* Iterates that are kept are among those that are measured. */
static int check_measure(const study *s, const document *d, message *why) {
  const double keep = first(s, KEY_ITERATE_KEEP), measure = first(s, KEY_ITERATE_MEASURE);
  const sweep_entry *swept = sweep_over(s, KEY_ITERATE_MEASURE, -1);
  for (size_t i = 0; swept && i < swept->view.points; i++)
    if (swept->values[i] < keep)
      return refuse_measure(s, d, sweep_value_node(d, swept, i), "swept iterate.measure", swept->values[i], why);
  if (!swept && measure > -INFINITY && measure < keep)
    return refuse_measure(s, d, s->values[KEY_ITERATE_MEASURE].node, "iterate.measure", measure, why);
  return 0;
}

static int check_counts(const study *s, const document *d, message *why) {
  const double size = (double)(study_state_size(s) - (!study_is_map(s) && is_at_impacts(s))); /* time has none */
  const double exponents = first(s, KEY_ITERATE_EXPONENTS);
  const int code = study_is_kind(s, "diagram") ? check_measure(s, d, why) : 0; /* others keep nothing */
  if (code)
    return code;
  if (exponents > 1 && first(s, KEY_ITERATE_LYAPUNOV) == 0)
    return document_refuse(d, s->values[KEY_ITERATE_EXPONENTS].node, why,
                           "iterate.exponents = %.0f needs iterate.lyapunov: true", exponents);
  if (exponents > size)
    return document_refuse(d, check_node_of_key(s, KEY_ITERATE_EXPONENTS), why,
                           "iterate.exponents = %.0f, expected at most %.0f: a state has so many numbers", exponents,
                           size);
  return 0;
}

/* What goes along the last sweep needs one; windows lie between rising or falling values of it. */
static int check_line(const study *s, const document *d, study_key key, message *why) {
  if (first(s, key) == 0)
    return 0;
  const int node = check_node_of_key(s, key);
  if (s->sweep_count == 0)
    return document_refuse(d, node, why, "%s = true goes along the last sweep, and there is none",
                           schema_row(key)->path);
  return 0;
}

static int check_windows(const study *s, const document *d, message *why) {
  const int code = check_line(s, d, KEY_ITERATE_WINDOWS, why);
  if (code || first(s, KEY_ITERATE_WINDOWS) == 0)
    return code;
  if (!study_is_map(s) && is_at_impacts(s))
    return document_refuse(d, s->values[KEY_ITERATE_WINDOWS].node, why,
                           "iterate.windows = true needs iterate.section: strobe, and this is impact");
  const sweep_entry *last = &s->sweeps[s->sweep_count - 1];
  for (size_t i = 1; i < last->view.points; i++)
    if (!((last->values[i] - last->values[i - 1]) * (last->values[1] - last->values[0]) > 0))
      return document_refuse(d, s->values[KEY_ITERATE_WINDOWS].node, why,
                             "iterate.windows = true needs rising or falling values of the last sweep, and those of %s "
                             "are neither",
                             last->view.name);
  if (strncmp(last->view.name, "model.", 6) != 0 && last->view.key != KEY_GRAZING_BEYOND)
    return document_refuse(d, s->values[KEY_ITERATE_WINDOWS].node, why,
                           "iterate.windows = true lists windows of a number of model, or of grazing.beyond, and the "
                           "last sweep is over %s",
                           last->view.name);
  return 0;
}

int iterate_check_family(const study *s, const document *d, message *why) {
  static const char *const sections[] = {"branch", "orbit"};
  if (study_is_beyond(s)) {
    const int node = check_node_of_key(s, KEY_GRAZING_BEYOND);
    if (strcmp(s->values[KEY_ORBIT_MOTION].text, "forced") != 0)
      return document_refuse(d, node, why, "grazing.beyond needs orbit.motion: forced, and this is %s",
                             s->values[KEY_ORBIT_MOTION].text);
    if (is_at_impacts(s))
      return document_refuse(d, node, why, "grazing.beyond needs iterate.section: strobe, and this is impact");
    return 0;
  }
  for (size_t i = 0; i < 2; i++) {
    const int node = check_node_of_section(s, d, sections[i]);
    if (node)
      return document_refuse(d, node, why, "the section '%s' of kind: %s is for diagrams with grazing.beyond",
                             sections[i], study_kind(s));
  }
  return 0;
}

int iterate_check(const study *s, const document *d, message *why) {
  int code = study_is_map(s) ? check_map(s, d, why) : check_section(s, d, why);
  if (!code)
    code = check_observed(s, d, why);
  if (!code)
    code = check_counts(s, d, why);
  if (!code)
    code = check_line(s, d, KEY_ITERATE_FOLLOW, why);
  return code ? code : check_windows(s, d, why);
}
