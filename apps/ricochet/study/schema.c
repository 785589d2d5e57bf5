/* Lookup of keys, and the texts of messages about them: what a key allows, which names a section has. */
#include "schema.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "keys.h"
#include "study.h"

/* --- the keys of a sweep entry --- */

static const schema_entry sweep_rows[SWEEP_KEY_COUNT] = {
    [SWEEP_PARAMETER] = {.path = "sweep.parameter",
                         IS_TEXT,
                         REQUIRED,
                         DOC("The key that is swept, or an element of its list: `model.gamma`, `model.floor[3]`.")},
    [SWEEP_VALUES] = {.path = "sweep.values", IS_NUMBERS, ANY, DOC("The values, in the order of the tasks.")},
    [SWEEP_FROM] = {.path = "sweep.from", IS_NUMBER, ANY, DOC("Instead of `values`: the first value.")},
    [SWEEP_TO] = {.path = "sweep.to", IS_NUMBER, ANY, DOC("The last value, larger than `from`; it is hit exactly.")},
    [SWEEP_POINTS] = {.path = "sweep.points",
                      IS_INTEGER,
                      RANGE(1, STUDY_MAX_POINTS),
                      DOC("Number of values, both ends included; 1 only if `from` equals `to`.")},
    [SWEEP_SCALE] = {.path = "sweep.scale",
                     IS_WORD,
                     DEFAULT("linear"),
                     ONE_OF("linear|log"),
                     DOC("`linear`: equal steps; `log`: equal ratios, which needs `from` above 0.")},
    [SWEEP_BACK] = {.path = "sweep.back",
                    IS_FLAG,
                    DEFAULT("false"),
                    DOC("Whether the values follow once more in reverse order; with `iterate.follow` the diagram "
                        "then runs there and back.")},
};

study_key schema_sweep_row(sweep_key key) {
  return &sweep_rows[key];
}

/* --- lookup --- */

study_key schema_find(const schema *t, const char *path) {
  for (size_t i = 0; i < t->key_count; i++)
    if (strcmp(t->keys[i]->path, path) == 0)
      return t->keys[i];
  return NULL;
}

static bool is_in_section(const char *path, const char *name, size_t length) {
  return strncmp(path, name, length) == 0 && path[length] == '.';
}

bool schema_is_section(const schema *t, const char *name) {
  for (size_t i = 0; i < t->key_count; i++)
    if (is_in_section(t->keys[i]->path, name, strlen(name)))
      return true;
  return false;
}

/* Whether a key before number `i` is in the section of this name. */
static bool section_is_known(const schema *t, size_t i, const char *name, size_t length) {
  for (size_t earlier = 0; earlier < i; earlier++)
    if (is_in_section(t->keys[earlier]->path, name, length))
      return true;
  return false;
}

void schema_sections(const schema *t, void (*call)(const char *name, size_t length, void *user), void *user) {
  static const char sweep[] = "sweep";
  for (size_t i = 0; i < t->key_count; i++) {
    const char *path = t->keys[i]->path;
    for (const char *dot = strchr(path, '.'); dot; dot = strchr(dot + 1, '.'))
      if (!section_is_known(t, i, path, (size_t)(dot - path)))
        call(path, (size_t)(dot - path), user);
  }
  call(sweep, sizeof sweep - 1, user);
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

/* --- kinds and types of model --- */

const schema_choice *schema_choice_of(const schema_choice *const *choices, const char *name) {
  while (*choices && !(name && strcmp((*choices)->name, name) == 0))
    choices++;
  return *choices;
}

static bool takes(const schema_choice *choice, study_key key) {
  return !*key->group || schema_is_among(key->group, strlen(key->group), choice->groups);
}

static bool is_of_model(study_key key) {
  return strncmp(key->path, "model.", 6) == 0;
}

bool schema_kind_takes(const schema_choice *kind, study_key key) {
  return is_of_model(key) || takes(kind, key);
}

bool schema_model_takes(const schema_choice *model, study_key key) {
  return is_of_model(key) ? takes(model, key) : !key->needs || (key->needs & model->features) != 0;
}

/* Appends a name to "a or b". */
static void append_or(char *text, size_t size, const char *name) {
  const size_t used = strlen(text);
  snprintf(text + used, size - used, "%s%s", used ? " or " : "", name);
}

void schema_kinds_of(const schema *t, study_key key, char *text, size_t size) {
  *text = 0;
  for (const schema_choice *const *kind = t->kinds; *kind; kind++)
    if (schema_kind_takes(*kind, key))
      append_or(text, size, (*kind)->name);
}

void schema_models_of(const schema *t, study_key key, char *text, size_t size) {
  *text = 0;
  for (const schema_choice *const *model = t->models; *model; model++)
    if (schema_model_takes(*model, key))
      append_or(text, size, (*model)->name);
}

void schema_models_with(const schema *t, unsigned features, char *text, size_t size) {
  *text = 0;
  for (const schema_choice *const *model = t->models; *model; model++)
    if ((*model)->features & features)
      append_or(text, size, (*model)->name);
}

unsigned schema_word_needs(study_key key, const char *word) {
  const long place = word ? schema_find_word(word, strlen(word), key->words) : -1;
  return key->word_needs && place >= 0 ? key->word_needs[place] : 0;
}

const char *schema_fallback(study_key key, const schema_choice *model) {
  for (const schema_default *d = model ? model->defaults : NULL; d && d->path; d++)
    if (strcmp(d->path, key->path) == 0)
      return d->fallback;
  return key->fallback;
}

schema_fit schema_check(study_key key, double value) {
  if (key->type == VALUE_INTEGER && isfinite(value) && value != floor(value))
    return FIT_NOT_INTEGER;
  const bool above = key->low_open ? value > key->low : value >= key->low;
  const bool below = key->high_open ? value < key->high : value <= key->high;
  const double most = key->type == VALUE_INTEGER ? 0x1p53 : INFINITY; /* above, doubles skip integers */
  return above && below && fabs(value) < most ? FIT_OK : FIT_OUT_OF_RANGE;
}

/* --- sentences --- */

static void append(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));

static void append(char *text, size_t size, const char *format, ...) {
  const size_t used = strlen(text);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text + used, size - used, format, arguments);
  va_end(arguments);
}

static void append_range(study_key key, char *text, size_t size) {
  const bool low = isfinite(key->low), high = isfinite(key->high);
  if (low && high && !key->low_open && !key->high_open) {
    append(text, size, " from %.15g to %.15g", key->low, key->high);
    return;
  }
  if (low)
    append(text, size, key->low_open ? " > %.15g" : " >= %.15g", key->low);
  if (high)
    append(text, size, "%s%s %.15g", low ? " and" : "", key->high_open ? " <" : " <=", key->high);
}

static void append_words(study_key key, char *text, size_t size) {
  if (strchr(key->words, '|'))
    append(text, size, "one of ");
  for (const char *word = key->words; *word;) {
    const size_t length = strcspn(word, "|");
    append(text, size, "%.*s%s", (int)length, word, word[length] ? ", " : "");
    word += length + (word[length] == '|');
  }
}

void schema_allowed_item(study_key key, char *text, size_t size) {
  *text = 0;
  switch (key->type) {
  case VALUE_NUMBER:
  case VALUE_INTEGER:
    append(text, size, key->type == VALUE_NUMBER ? "a number" : "an integer");
    append_range(key, text, size);
    break;
  case VALUE_FLAG:
    append(text, size, "true or false");
    break;
  case VALUE_WORD:
    append_words(key, text, size);
    break;
  case VALUE_TEXT:
    append(text, size, "text");
    break;
  }
  if (key->null)
    append(text, size, " or null");
}

void schema_allowed(study_key key, char *text, size_t size) {
  if (key->scalar) {
    schema_allowed_item(key, text, size);
    append(text, size, "%s", key->list ? ", or a list of them" : "");
    return;
  }
  *text = 0;
  if (key->type == VALUE_WORD) {
    append(text, size, "a list of words, each ");
    append_words(key, text, size);
    return;
  }
  append(text, size, "a list of %s", key->type == VALUE_INTEGER ? "integers" : "numbers");
  append_range(key, text, size);
}

/* The names in a section, as a list in words. */
typedef struct name_list {
  const char *section;
  char *text;
  size_t size;
} name_list;

static void append_name(const char *path, size_t path_length, void *user) {
  const name_list *list = user;
  const size_t length = strlen(list->section), skip = length ? length + 1 : 0;
  const bool inside = !length || (strncmp(path, list->section, length) == 0 && path[length] == '.');
  if (inside && path_length > skip && !memchr(path + skip, '.', path_length - skip))
    append(list->text, list->size, "%s%.*s", *list->text ? ", " : "", (int)(path_length - skip), path + skip);
}

void schema_names(const schema *t, const char *section, char *text, size_t size) {
  name_list list = {section, text, size};
  *text = 0;
  for (size_t i = 0; i < t->key_count; i++)
    append_name(t->keys[i]->path, strlen(t->keys[i]->path), &list);
  for (int key = 0; key < SWEEP_KEY_COUNT; key++)
    append_name(schema_sweep_row((sweep_key)key)->path, strlen(schema_sweep_row((sweep_key)key)->path), &list);
  schema_sections(t, append_name, &list);
}
