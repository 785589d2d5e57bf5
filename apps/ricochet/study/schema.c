#include "schema.h"

#include <math.h>
#include <string.h>

study_key schema_find(const char *path) {
  int key = 0;
  while (key < KEY_COUNT && strcmp(schema_row((study_key)key)->path, path) != 0)
    key++;
  return (study_key)key;
}

bool schema_is_section(const char *name) {
  const size_t length = strlen(name);
  for (int key = 0; key < KEY_COUNT; key++) {
    const char *path = schema_row((study_key)key)->path;
    if (strncmp(path, name, length) == 0 && path[length] == '.')
      return true;
  }
  return false;
}

/* Whether a row before `key` stands in the section of this name. */
static bool section_is_known(study_key key, const char *name, size_t length) {
  for (int earlier = 0; earlier < (int)key; earlier++) {
    const char *path = schema_row((study_key)earlier)->path;
    if (strncmp(path, name, length) == 0 && path[length] == '.')
      return true;
  }
  return false;
}

void schema_sections(void (*see)(const char *name, size_t length, void *user), void *user) {
  static const char sweep[] = "sweep";
  for (int key = 0; key < KEY_COUNT; key++) {
    const char *path = schema_row((study_key)key)->path;
    for (const char *dot = strchr(path, '.'); dot; dot = strchr(dot + 1, '.'))
      if (!section_is_known((study_key)key, path, (size_t)(dot - path)))
        see(path, (size_t)(dot - path), user);
  }
  see(sweep, sizeof sweep - 1, user);
}

long schema_find_word(const char *word, size_t length, const char *words) {
  for (long place = 0; words && *words; place++) {
    const size_t next = strcspn(words, "|");
    if (next == length && memcmp(words, word, length) == 0)
      return place;
    words += next + (words[next] == '|');
  }
  return -1;
}

bool schema_is_among(const char *word, size_t length, const char *words) {
  return schema_find_word(word, length, words) >= 0;
}

void schema_either(const char *words, char *text, size_t size) {
  size_t used = 0;
  *text = 0;
  for (const char *word = words; *word && used < size; word += strcspn(word, "|"), word += *word == '|')
    used += (size_t)snprintf(text + used, size - used, "%s%.*s", word == words ? "" : " or ", (int)strcspn(word, "|"),
                             word);
}

bool schema_concerns(const schema_entry *entry, const char *kind) {
  return !entry->kinds || schema_is_among(kind, strlen(kind), entry->kinds);
}

bool schema_concerns_model(const schema_entry *entry, const char *model) {
  return !entry->models || schema_is_among(model, strlen(model), entry->models);
}

const char *schema_word_models(const schema_entry *entry, const char *word) {
  const long place = schema_find_word(word, strlen(word), entry->words);
  return entry->word_models && place >= 0 ? entry->word_models[place] : NULL;
}

const char *schema_fallback(const schema_entry *entry, const char *model) {
  return model && schema_is_among(model, strlen(model), entry->other_models) ? entry->other_fallback : entry->fallback;
}

schema_fit schema_check(const schema_entry *entry, double value) {
  if (entry->type == VALUE_INTEGER && isfinite(value) && value != floor(value))
    return FIT_NOT_INTEGER;
  const bool above = entry->low_open ? value > entry->low : value >= entry->low;
  const bool below = entry->high_open ? value < entry->high : value <= entry->high;
  const double most = entry->type == VALUE_INTEGER ? 0x1p53 : INFINITY; /* above, doubles skip integers */
  return above && below && fabs(value) < most ? FIT_OK : FIT_OUT_OF_RANGE;
}
