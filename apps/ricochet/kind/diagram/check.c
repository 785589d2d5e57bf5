/* The keys of studies that iterate a map, or motions on a section: the state, what is observed of it, and how they fit.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "diagram.h"
#include "kind/family/family_check.h"
#include "model/grazing_map.h"
#include "model/lattice_model.h"
#include "study/number.h"

bool diagram_is_beyond(const study *s) {
  return study_is_kind(s, "diagram") && !model_has(s, MODEL_MAP) && study_has(s, KEY_GRAZING_BEYOND);
}

static bool is_at_impacts(const study *s) {
  return strcmp(study_word(s, KEY_ITERATE_SECTION), "impact") == 0;
}

size_t diagram_state_size(const study *s) {
  return model_has(s, MODEL_MAP) ? grazing_map_size(s) : 2 * lattice_particles(s) + is_at_impacts(s);
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
  const size_t particles = lattice_particles(s);
  for (size_t i = particles; i-- > 0;)
    if (lattice_has_obstacle(s, i))
      return i;
  return particles - 1;
}

/* The last particle that hits an obstacle is observed, or the first number of a map, unless the study says another. */
static int name_observed(study *s, message *why) {
  char text[32];
  if (study_value(s, KEY_ITERATE_OBSERVE)->node)
    return 0;
  if (model_has(s, MODEL_MAP))
    return study_fill_word(s, KEY_ITERATE_OBSERVE, "z1", why);
  if (!study_value(s, KEY_MODEL_PARTICLES)->present) /* refused later, as missing */
    return 0;
  snprintf(text, sizeof text, "q%zu", last_with_obstacle(s));
  return study_fill_word(s, KEY_ITERATE_OBSERVE, text, why);
}

int diagram_complete(study *s, const document *d, message *why) {
  const int code = diagram_is_beyond(s) ? family_complete_study(s, d, why) : 0;
  return code ? code : name_observed(s, why);
}

static bool find_observed(const study *s, size_t *index) {
  const char *name = study_word(s, KEY_ITERATE_OBSERVE);
  const size_t size = diagram_state_size(s), particles = size / 2;
  *index = 0;
  if (model_has(s, MODEL_MAP))
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

size_t diagram_observed(const study *s) {
  size_t index;
  find_observed(s, &index);
  return index;
}

bool diagram_has_windows(const study *s) {
  return study_is_kind(s, "diagram") && study_number(s, KEY_ITERATE_WINDOWS) != 0;
}

static int check_observed(const study *s, const document *d, message *why) {
  const size_t size = diagram_state_size(s);
  size_t index;
  if (find_observed(s, &index))
    return 0;
  const typed_value *value = study_value(s, KEY_ITERATE_OBSERVE);
  if (model_has(s, MODEL_MAP))
    return document_refuse(d, value->node, why, "iterate.observe = %.40s, expected z1 to z%zu", value->text, size);
  return document_refuse(d, value->node, why, "iterate.observe = %.40s, expected q0 to q%zu or v0 to v%zu%s",
                         value->text, size / 2 - 1, size / 2 - 1, is_at_impacts(s) ? " or time" : "");
}

/* --- where it starts --- */

static int check_start(const study *s, const document *d, message *why) {
  const typed_value *start = study_value(s, KEY_ITERATE_START);
  const size_t size = diagram_state_size(s);
  if (!start->list || start->count == size)
    return 0;
  return document_refuse(d, start->node, why, "iterate.start has %zu elements, expected %zu, or a single number",
                         start->count, size);
}

/* --- the section -------------------------------------------------------------------------------------------------- */

static int check_section(const study *s, const document *d, message *why) {
  const double particle = study_number(s, KEY_ITERATE_PARTICLE);
  const int node = check_node_of_key(s, KEY_ITERATE_PARTICLE);
  if (particle == -INFINITY && is_at_impacts(s) && !lattice_has_obstacle(s, last_with_obstacle(s)))
    return document_refuse(d, study_value(s, KEY_ITERATE_SECTION)->node, why,
                           "iterate.section = impact, and no particle has a floor or a wall to hit (all are null)");
  if (particle == -INFINITY)
    return 0;
  if (!is_at_impacts(s))
    return document_refuse(d, node, why, "iterate.particle is a key of iterate.section: impact, and this is strobe");
  if (!(particle < study_number(s, KEY_MODEL_PARTICLES)))
    return document_refuse(d, node, why, "iterate.particle = %.0f is out of range, expected a particle from 0 to %.0f",
                           particle, study_number(s, KEY_MODEL_PARTICLES) - 1);
  if (!lattice_has_obstacle(s, (size_t)particle))
    return document_refuse(d, node, why, "iterate.particle = %.0f has no floor or wall to hit (both are null there)",
                           particle);
  return 0;
}

/* --- what is stored ----------------------------------------------------------------------------------------------- */

static int refuse_measure(const study *s, const document *d, int node, const char *label, double measure,
                          message *why) {
  return document_refuse(d, node, why, "%s = %.0f, expected at least iterate.keep = %.0f", label, measure,
                         study_number(s, KEY_ITERATE_KEEP));
}

/* Kept iterates are among the measured ones. */
static int check_measure(const study *s, const document *d, message *why) {
  const double keep = study_number(s, KEY_ITERATE_KEEP), measure = study_number(s, KEY_ITERATE_MEASURE);
  const sweep_entry *swept = sweep_over(s, KEY_ITERATE_MEASURE, -1);
  for (size_t i = 0; swept && i < swept->view.points; i++)
    if (swept->values[i] < keep)
      return refuse_measure(s, d, sweep_value_node(d, swept, i), "swept iterate.measure", swept->values[i], why);
  if (!swept && measure > -INFINITY && measure < keep)
    return refuse_measure(s, d, study_value(s, KEY_ITERATE_MEASURE)->node, "iterate.measure", measure, why);
  return 0;
}

static int check_counts(const study *s, const document *d, message *why) {
  const double size =
      (double)(diagram_state_size(s) - (!model_has(s, MODEL_MAP) && is_at_impacts(s))); /* time has none */
  const double exponents = study_number(s, KEY_ITERATE_EXPONENTS);
  const int code = check_measure(s, d, why);
  if (code)
    return code;
  if (exponents > 1 && study_number(s, KEY_ITERATE_LYAPUNOV) == 0)
    return document_refuse(d, study_value(s, KEY_ITERATE_EXPONENTS)->node, why,
                           "iterate.exponents = %.0f needs iterate.lyapunov: true", exponents);
  if (exponents > size)
    return document_refuse(d, check_node_of_key(s, KEY_ITERATE_EXPONENTS), why,
                           "iterate.exponents = %.0f, expected at most %.0f: a state has so many numbers", exponents,
                           size);
  return 0;
}

/* Keys that refer to the last sweep need one; windows need its values to be monotonic. */
static int check_line(const study *s, const document *d, study_key key, message *why) {
  if (study_number(s, key) == 0)
    return 0;
  const int node = check_node_of_key(s, key);
  if (s->sweep_count == 0)
    return document_refuse(d, node, why, "%s = true refers to the last sweep, but the study has none", key->path);
  return 0;
}

static int check_windows(const study *s, const document *d, message *why) {
  const int code = check_line(s, d, KEY_ITERATE_WINDOWS, why);
  if (code || study_number(s, KEY_ITERATE_WINDOWS) == 0)
    return code;
  if (!model_has(s, MODEL_MAP) && is_at_impacts(s))
    return document_refuse(d, study_value(s, KEY_ITERATE_WINDOWS)->node, why,
                           "iterate.windows = true needs iterate.section: strobe, and this is impact");
  const sweep_entry *last = &s->sweeps[s->sweep_count - 1];
  for (size_t i = 1; i < last->view.points; i++)
    if (!((last->values[i] - last->values[i - 1]) * (last->values[1] - last->values[0]) > 0))
      return document_refuse(d, study_value(s, KEY_ITERATE_WINDOWS)->node, why,
                             "iterate.windows = true needs rising or falling values of the last sweep, and those of %s "
                             "are neither",
                             last->view.name);
  if (strncmp(last->view.name, "model.", 6) != 0 && last->view.key != KEY_GRAZING_BEYOND)
    return document_refuse(d, study_value(s, KEY_ITERATE_WINDOWS)->node, why,
                           "iterate.windows = true lists windows of a number of model, or of grazing.beyond, and the "
                           "last sweep is over %s",
                           last->view.name);
  return 0;
}

/* --- beyond grazing --- */

static int check_beyond(const study *s, const document *d, message *why) {
  const int node = check_node_of_key(s, KEY_GRAZING_BEYOND);
  if (strcmp(study_word(s, KEY_ORBIT_MOTION), "forced") != 0)
    return document_refuse(d, node, why, "grazing.beyond needs orbit.motion: forced, and this is %s",
                           study_word(s, KEY_ORBIT_MOTION));
  if (is_at_impacts(s))
    return document_refuse(d, node, why, "grazing.beyond needs iterate.section: strobe, and this is impact");
  return family_check(s, d, why);
}

/* Sections of a family are for diagrams with grazing.beyond only. */
static int check_family(const study *s, const document *d, message *why) {
  static const char *const sections[] = {"branch", "orbit"};
  if (diagram_is_beyond(s))
    return check_beyond(s, d, why);
  for (size_t i = 0; i < 2; i++) {
    const int node = check_node_of_section(s, d, sections[i]);
    if (node)
      return document_refuse(d, node, why, "the section '%s' of kind: diagram is for diagrams with grazing.beyond",
                             sections[i]);
  }
  return 0;
}

/* Its motions are forced: their period is that of the force. */
bool diagram_wants(const study *s, const document *d, study_key key) {
  if (strncmp(key->path, "branch.", 7) == 0)
    return diagram_is_beyond(s) && family_wants(s, d, key);
  return key != KEY_ORBIT_PERIOD;
}

/* Checks of both diagrams and basins. */
static int check_iterates(const study *s, const document *d, message *why) {
  const int code = model_has(s, MODEL_MAP) ? check_start(s, d, why) : check_section(s, d, why);
  return code ? code : check_observed(s, d, why);
}

int basin_check(const study *s, const document *d, message *why) {
  return check_iterates(s, d, why);
}

int diagram_check(const study *s, const document *d, message *why) {
  int code = check_family(s, d, why);
  if (!code)
    code = check_iterates(s, d, why);
  if (!code)
    code = check_counts(s, d, why);
  if (!code)
    code = check_line(s, d, KEY_ITERATE_FOLLOW, why);
  return code ? code : check_windows(s, d, why);
}
