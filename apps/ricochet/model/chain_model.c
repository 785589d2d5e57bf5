#include "chain_model.h"

#include <stdlib.h>
#include <string.h>

int chain_model_init(chain_model *m, const study_values *v) {
  size_t n = (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
  *m = (chain_model){.chain = ric_chain_default(n, 0)};
  if (value_is_list(v, KEY_MODEL_FLOOR)) {
    m->floors = calloc(n, sizeof *m->floors);
    if (!m->floors)
      return -1;
  }
  chain_model_read(m, v);
  return 0;
}

void chain_model_clear(chain_model *m) {
  free(m->floors);
  m->floors = NULL;
}

ric_ends chain_model_ends(const study_values *v) {
  const char *word = value_word(v, KEY_MODEL_ENDS);
  if (strcmp(word, "fixed") == 0)
    return RIC_ENDS_FIXED;
  return strcmp(word, "free") == 0 ? RIC_ENDS_FREE : RIC_ENDS_PERIODIC;
}

void chain_model_read(chain_model *m, const study_values *v) {
  m->chain.ends = chain_model_ends(v);
  m->chain.gamma = value_number(v, KEY_MODEL_GAMMA, 0);
  m->chain.floors = m->floors;
  if (!m->floors)
    m->chain.floor = value_number(v, KEY_MODEL_FLOOR, 0);
  for (size_t i = 0; m->floors && i < m->chain.particles; i++)
    m->floors[i] = value_number(v, KEY_MODEL_FLOOR, i);
}

static void read_particles(const study_values *v, study_key key, size_t count, size_t *list) {
  for (size_t i = 0; i < count; i++)
    list[i] = (size_t)value_number(v, key, i);
}

ric_status chain_model_pattern(const study_values *v, ric_pattern **pattern, ric_error *error) {
  size_t starts = value_count(v, KEY_ORBIT_AT_START), halves = value_count(v, KEY_ORBIT_AT_HALF);
  size_t *list = malloc((starts + halves + 1) * sizeof *list);
  *pattern = NULL;
  if (!list)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu impacts", starts + halves);
  read_particles(v, KEY_ORBIT_AT_START, starts, list);
  read_particles(v, KEY_ORBIT_AT_HALF, halves, list + starts);
  ric_status status = ric_pattern_create((size_t)value_number(v, KEY_MODEL_PARTICLES, 0), list, starts, list + starts,
                                         halves, pattern, error);
  free(list);
  return status;
}
