/* The study-file reference, printed from the schema: a chapter for every kind of study and type of model. A table of
 * keys is printed in the first chapter whose kind or model accepts them; later chapters refer to it. */
#include "schema.h"

#include <string.h>

#include "study.h"

static void print_default(FILE *out, study_key key) {
  if (key->required)
    fprintf(out, "required");
  else if (!key->fallback || !*key->fallback)
    fprintf(out, "none");
  else
    fprintf(out, "`%s`", key->fallback);
}

static void print_head(FILE *out, bool sweepable) {
  fprintf(out, "\n| key | allowed | default |%s meaning |\n", sweepable ? " can be swept |" : "");
  fprintf(out, "|---|---|---|%s---|\n", sweepable ? "---|" : "");
}

static void print_row(FILE *out, study_key key, const char *name) {
  char allowed[256];
  schema_allowed(key, allowed, sizeof allowed);
  fprintf(out, "| `%s` | %s | ", name, allowed);
  print_default(out, key);
  fprintf(out, " | ");
}

/* Words that need a feature of the model. */
static void print_word_models(FILE *out, const schema *t, study_key key) {
  const char *word = key->words;
  for (size_t i = 0; key->word_needs && *word; i++, word += strcspn(word, "|"), word += *word == '|') {
    char models[96];
    if (!key->word_needs[i])
      continue;
    schema_models_with(t, key->word_needs[i], models, sizeof models);
    fprintf(out, " `%.*s` is for `model.type: %s`.", (int)strcspn(word, "|"), word, models);
  }
}

static void print_other_defaults(FILE *out, const schema *t, study_key key) {
  for (const schema_choice *const *model = t->models; *model; model++) {
    const char *fallback = schema_fallback(key, *model);
    if (fallback != key->fallback)
      fprintf(out, " Default with `model.type: %s`: `%s`.", (*model)->name, fallback);
  }
}

static void print_key(FILE *out, const schema *t, study_key key) {
  print_row(out, key, key->path);
  if (key->sweep)
    fprintf(out, "%s", !key->list ? "yes" : key->scalar ? "yes, or an element" : "an element");
  else
    fprintf(out, "no: %s", key->no_sweep);
  fprintf(out, " | %s", key->doc);
  if (key->needs) {
    char models[96];
    schema_models_with(t, key->needs, models, sizeof models);
    fprintf(out, " For `model.type: %s`.", models);
  }
  print_word_models(out, t, key);
  print_other_defaults(out, t, key);
  fprintf(out, " |\n");
}

/* --- chapters --- */

typedef struct chapters {
  const schema *schema;
  const schema_choice *const *choices;
  bool (*takes)(const schema_choice *choice, study_key key);
  const char *key; /* "kind", "model.type" */
} chapters;

/* The first choice that accepts a key. */
static const schema_choice *first_of(const chapters *c, study_key key) {
  const schema_choice *const *choice = c->choices;
  while (*choice && !c->takes(*choice, key))
    choice++;
  return *choice;
}

static bool is_of_model(study_key key) {
  return strncmp(key->path, "model.", 6) == 0;
}

/* Keys of these chapters: not those of every study. */
static bool is_in_chapters(const chapters *c, study_key key) {
  return *key->group && is_of_model(key) == (c->choices == c->schema->models);
}

static void print_own_keys(FILE *out, const chapters *c, const schema_choice *choice) {
  bool any = false;
  for (size_t i = 0; i < c->schema->key_count; i++) {
    const study_key key = c->schema->keys[i];
    if (!is_in_chapters(c, key) || first_of(c, key) != choice)
      continue;
    if (!any)
      print_head(out, true);
    any = true;
    print_key(out, c->schema, key);
  }
}

/* The keys that a choice shares with an earlier one. */
static void print_shared_keys(FILE *out, const chapters *c, const schema_choice *choice, const schema_choice *earlier) {
  bool any = false;
  for (size_t i = 0; i < c->schema->key_count; i++) {
    const study_key key = c->schema->keys[i];
    if (!is_in_chapters(c, key) || !c->takes(choice, key) || first_of(c, key) != earlier)
      continue;
    if (any)
      fprintf(out, ", `%s`", key->path);
    else
      fprintf(out, "\nAs with `%s: %s`: `%s`", c->key, earlier->name, key->path);
    any = true;
  }
  if (any)
    fprintf(out, ".\n");
}

static void print_chapters(FILE *out, const chapters *c) {
  for (const schema_choice *const *choice = c->choices; *choice; choice++) {
    fprintf(out, "\n### `%s: %s`\n\n%s", c->key, (*choice)->name, embedded_find(c->schema->chapters, (*choice)->name));
    print_own_keys(out, c, *choice);
    for (const schema_choice *const *earlier = c->choices; earlier != choice; earlier++)
      print_shared_keys(out, c, *choice, *earlier);
  }
}

/* --- the rest --- */

static void print_common(FILE *out, const schema *t) {
  fprintf(out, "\n## Every study\n");
  print_head(out, true);
  for (size_t i = 0; i < t->key_count; i++)
    if (!*t->keys[i]->group)
      print_key(out, t, t->keys[i]);
}

static void print_sweeps(FILE *out) {
  fprintf(out,
          "\n## Sweeps\n\n"
          "`sweep` is one entry or a list of up to %d. Several span a grid, whose last entry varies fastest; the grid "
          "has fewer than\n2^40 points. A swept key may be left out of its section. An element of a list is swept by "
          "its index, as in\n`model.floor[3]`, and must exist in the list. An entry gives either `values`, or `from`, "
          "`to` and `points`.\n",
          STUDY_MAX_SWEEPS);
  print_head(out, false);
  for (int key = 0; key < SWEEP_KEY_COUNT; key++) {
    const study_key row = schema_sweep_row((sweep_key)key);
    print_row(out, row, row->path + sizeof "sweep." - 1);
    fprintf(out, "%s |\n", row->doc);
  }
}

static void print_later_words(FILE *out, const schema *t) {
  fprintf(out, "\n## Words of a later version\n\nRefused with \"not in this version\":\n\n");
  for (size_t i = 0; i < t->key_count; i++) {
    if (!t->keys[i]->later_words)
      continue;
    fprintf(out, "- `%s`: ", t->keys[i]->path);
    for (const char *c = t->keys[i]->later_words; *c; c++)
      fputs(*c == '|' ? ", " : (char[]){*c, '\0'}, out);
    fputc('\n', out);
  }
}

void schema_reference(const schema *t, FILE *out) {
  const chapters kinds = {t, t->kinds, schema_kind_takes, "kind"},
                 models = {t, t->models, schema_model_takes, "model.type"};
  fprintf(out, "%s", embedded_find(t->chapters, "introduction"));
  print_common(out, t);
  fprintf(out, "\n## Kinds of study\n");
  print_chapters(out, &kinds);
  fprintf(out, "\n## Models\n");
  print_chapters(out, &models);
  print_sweeps(out);
  print_later_words(out, t);
}
