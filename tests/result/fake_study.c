#include "fake_study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct study {
  study_sweep sweeps[2];
  size_t sweep_count;
  char *text;
  double *list; /* [list_count] 0, 1, 2, ... */
  size_t list_count;
};

static const schema_entry gamma_key = {.path = "model.gamma", .units = "", .doc = "stiffness of the springs"};
static const schema_entry floor_key = {.path = "model.floor", .units = "length", .doc = "position of the obstacle"};

study *fake_study_create(size_t gammas, size_t floors, size_t text_bytes, size_t list) {
  study *s = calloc(1, sizeof *s);
  char *text = malloc(text_bytes + 1);
  double *numbers = malloc((list + 1) * sizeof *numbers);
  if (!s || !text || !numbers) {
    free(s);
    free(text);
    free(numbers);
    return NULL;
  }
  for (size_t i = 0; i < list; i++)
    numbers[i] = (double)i;
  s->list = numbers;
  s->list_count = list;
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
  free((*s)->list);
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

/* A key of every type. */
int study_each(const study *s, study_entry_call *call, void *user, message *why) {
  static const schema_entry keys[] = {{.path = "title", .type = VALUE_TEXT},
                                      {.path = "model.ends", .type = VALUE_WORD, .words = "periodic|fixed"},
                                      {.path = "orbit.states", .type = VALUE_FLAG},
                                      {.path = "orbit.mode", .type = VALUE_INTEGER},
                                      {.path = "orbit.excited", .type = VALUE_INTEGER},
                                      {.path = "orbit.sequence", .type = VALUE_INTEGER},
                                      {.path = "branch.kinds", .type = VALUE_WORD, .words = "grazing|fold|zero"},
                                      {.path = "model.force", .type = VALUE_NUMBER}};
  static const double yes[] = {1}, none[] = {-INFINITY}, excited[] = {3, 1, 2}, places[] = {2, 0}, start[] = {0};
  static const double floors[] = {-1, -INFINITY, 0.5, -1, -1};
  const study_entry entries[] = {{&keys[0], false, true, 1, NULL, study_title(s)},
                                 {&keys[1], false, false, 1, NULL, "periodic"},
                                 {&keys[2], false, true, 1, yes, NULL},
                                 {&keys[3], false, false, 1, none, NULL},
                                 {&keys[4], true, true, 3, excited, NULL},
                                 {&keys[5], true, false, 0, excited, NULL},
                                 {&keys[6], true, false, 2, places, NULL},
                                 {&keys[7], true, true, s->list_count, s->list, NULL},
                                 {&gamma_key, false, true, 1, start, NULL},
                                 {&floor_key, true, true, 5, floors, NULL}};
  int code = 0;
  for (size_t i = 0; i < sizeof entries / sizeof *entries && !code; i++)
    code = call(user, &entries[i], why);
  return code;
}
