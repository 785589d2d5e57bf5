/* The sentences about the schema: what an entry allows, and which names a section knows. */
#include "schema.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "study.h"

static void append(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));

static void append(char *text, size_t size, const char *format, ...) {
  const size_t used = strlen(text);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text + used, size - used, format, arguments);
  va_end(arguments);
}

static void append_range(const schema_entry *entry, char *text, size_t size) {
  const bool low = isfinite(entry->low), high = isfinite(entry->high);
  if (low && high && !entry->low_open && !entry->high_open) {
    append(text, size, " from %.15g to %.15g", entry->low, entry->high);
    return;
  }
  if (low)
    append(text, size, entry->low_open ? " > %.15g" : " >= %.15g", entry->low);
  if (high)
    append(text, size, "%s%s %.15g", low ? " and" : "", entry->high_open ? " <" : " <=", entry->high);
}

static void append_words(const schema_entry *entry, char *text, size_t size) {
  if (strchr(entry->words, '|'))
    append(text, size, "one of ");
  for (const char *word = entry->words; *word;) {
    const size_t length = strcspn(word, "|");
    append(text, size, "%.*s%s", (int)length, word, word[length] ? ", " : "");
    word += length + (word[length] == '|');
  }
}

void schema_allowed_item(const schema_entry *entry, char *text, size_t size) {
  *text = 0;
  switch (entry->type) {
  case VALUE_NUMBER:
  case VALUE_INTEGER:
    append(text, size, entry->type == VALUE_NUMBER ? "a number" : "an integer");
    append_range(entry, text, size);
    break;
  case VALUE_FLAG:
    append(text, size, "true or false");
    break;
  case VALUE_WORD:
    append_words(entry, text, size);
    break;
  case VALUE_TEXT:
    append(text, size, "text");
    break;
  }
  if (entry->null)
    append(text, size, " or null");
}

void schema_allowed(const schema_entry *entry, char *text, size_t size) {
  if (entry->scalar) {
    schema_allowed_item(entry, text, size);
    append(text, size, "%s", entry->list ? ", or a list of them" : "");
    return;
  }
  *text = 0;
  if (entry->type == VALUE_WORD) {
    append(text, size, "a list of words, each ");
    append_words(entry, text, size);
    return;
  }
  append(text, size, "a list of %s", entry->type == VALUE_INTEGER ? "integers" : "numbers");
  append_range(entry, text, size);
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

void schema_names(const char *section, char *text, size_t size) {
  name_list list = {section, text, size};
  *text = 0;
  for (int key = 0; key < KEY_COUNT; key++)
    append_name(schema_row((study_key)key)->path, strlen(schema_row((study_key)key)->path), &list);
  for (int key = 0; key < SWEEP_KEY_COUNT; key++)
    append_name(schema_sweep_row((sweep_key)key)->path, strlen(schema_sweep_row((sweep_key)key)->path), &list);
  schema_sections(append_name, &list);
}
