/* The list of kinds, and the schema of studies. */
#include "kind.h"

#include <stdlib.h>

#include "study/keys.h"

/* A kind is a folder and a word here; its keys, if it has any of its own, a line in keys.inc. */
#define KINDS(KIND) KIND(orbits) KIND(trajectory) KIND(branch) KIND(grazing) KIND(diagram) KIND(basin)

#define DECLARE(name) extern const kind kind_##name;
KINDS(DECLARE)

#define CHOICE(name) &kind_##name.choice,
static const schema_choice *const kinds[] = {KINDS(CHOICE) NULL};

#define NAME(name) "|" #name
#define KIND_NAMES (&(KINDS(NAME))[1])

/* Why keys of the section `branch` cannot be swept. */
#define STEERS .no_sweep = "it says how the branch is followed"
#define STARTS .no_sweep = "it says where the branch starts"

#define KEY KEY_DEFINE
#include "top.inc"
#include "keys.inc"
#undef KEY

static const study_key keys[] = {
#define KEY KEY_LIST
#include "top.inc"
#include "model/models.inc"
#include "keys.inc"
#undef KEY
};

/* The table that finds the place of a key (study.c) has free slots. */
_Static_assert(sizeof keys / sizeof *keys <= STUDY_SLOTS / 2, "STUDY_SLOTS is too small for the keys");

extern const embedded_text chapters[]; /* generated from *.md here and beside the models */

const schema studies = {.keys = keys,
                        .key_count = sizeof keys / sizeof *keys,
                        .kinds = kinds,
                        .models = models,
                        .kind = KEY_KIND,
                        .model = KEY_MODEL_TYPE,
                        .chapters = chapters};

int kind_read_study(const char *path, const char *const *sets, size_t set_count, ric_poll stop, study **out,
                    message *why) {
  char *text = NULL;
  study_source from = {.schema = &studies, .name = path, .sets = sets, .set_count = set_count};
  *out = NULL;
  int code = study_read_file(path, stop, &text, &from.length, why);
  from.text = text;
  if (!code)
    code = study_parse(&from, out, why);
  if (!code && kind_of(*out)->resolve)
    code = kind_of(*out)->resolve(out, &from, why);
  free(text);
  return code;
}

result_card *kind_card(const char *name) {
  const kind *found = (const kind *)schema_choice_of(kinds, name);
  return found ? found->show : NULL;
}

const kind *kind_of(const study *s) {
  const kind *found = (const kind *)study_kind_choice(s);
  return found->variant ? found->variant(s) : found;
}

void kind_lay_out_tail(tail *to, const column_list *list, const table_axis *axes, size_t axis_count) {
  *to = (tail){.offset = list->offset, .meaning = list->meaning};
  table_add(&to->records, list, axes, axis_count);
  table_lay_out(&to->records);
}

int kind_no_extra(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                  message *why) {
  (void)s;
  (void)plan;
  (void)done;
  (void)poll;
  (void)extra;
  (void)why;
  return 0;
}
