#include "fake_study.h"

#include <stdlib.h>
#include <string.h>

struct study {
  study_sweep sweeps[2];
  size_t sweep_count;
  char *text;
};

static const schema_entry gamma_key = {.path = "model.gamma", .units = "", .doc = "stiffness of the springs"};
static const schema_entry floor_key = {.path = "model.floor", .units = "length", .doc = "position of the obstacle"};

study *fake_study_create(size_t gammas, size_t floors, size_t text_bytes) {
  study *s = calloc(1, sizeof *s);
  char *text = malloc(text_bytes + 1);
  if (!s || !text) {
    free(s);
    free(text);
    return NULL;
  }
  for (size_t i = 0; i < text_bytes; i++)
    text[i] = "kind: orbits # \n"[i % 16];
  text[text_bytes] = '\0';
  s->text = text;
  if (gammas == 0 && floors == 0)
    return s;
  s->sweep_count = 2;
  s->sweeps[0] = (study_sweep){.name = "model.gamma", .key = &gamma_key, .item = -1, .points = gammas};
  s->sweeps[1] = (study_sweep){.name = "model.floor[3]", .key = &floor_key, .item = 3, .points = floors};
  return s;
}

void study_destroy(study **s) {
  if (!*s)
    return;
  free((*s)->text);
  free(*s);
  *s = NULL;
}

const char *study_text(const study *s) {
  return s->text;
}

uint64_t study_digest(const study *s) {
  return 0x0123456789abcdefu + s->sweep_count;
}

size_t study_sweeps(const study *s) {
  return s->sweep_count;
}

const study_sweep *study_sweep_at(const study *s, size_t index) {
  return &s->sweeps[index];
}

uint64_t study_tasks(const study *s) {
  return s->sweep_count ? (uint64_t)s->sweeps[0].points * s->sweeps[1].points : 1;
}

double study_sweep_value(const study *s, size_t index, uint64_t task) {
  uint64_t fast = s->sweeps[1].points;
  return index == 0 ? 0.1 * (double)(task / fast) : -1 - (double)(task % fast);
}

const char *study_title(const study *s) {
  (void)s;
  return "made up, \xc3\xa0 la carte";
}
