/* The study-file reference, printed from the schema table. */
#include "schema.h"

#include <string.h>

#include "study.h"

static void print_default(FILE *out, const schema_entry *row) {
  if (row->required)
    fprintf(out, "required");
  else if (!row->fallback || !*row->fallback)
    fprintf(out, "none");
  else
    fprintf(out, "`%s`", row->fallback);
  if (row->other_models)
    fprintf(out, "; of %s: `%s`", row->other_models, row->other_fallback);
}

static void print_rows_head(FILE *out, bool sweepable) {
  fprintf(out, "| key | allowed | default |%s meaning |\n", sweepable ? " can be swept |" : "");
  fprintf(out, "|---|---|---|%s---|\n", sweepable ? "---|" : "");
}

static void print_row(FILE *out, const schema_entry *row, const char *name) {
  char allowed[256];
  schema_allowed(row, allowed, sizeof allowed);
  fprintf(out, "| `%s` | %s | ", name, allowed);
  print_default(out, row);
  fprintf(out, " | ");
}

/* Words that are not for every type of model. */
static void print_word_models(FILE *out, const schema_entry *row) {
  const char *word = row->words;
  for (size_t i = 0; row->word_models && *word; i++, word += strcspn(word, "|"), word += *word == '|') {
    char models[64];
    if (!row->word_models[i])
      continue;
    schema_either(row->word_models[i], models, sizeof models);
    fprintf(out, " `%.*s` is for `model.type: %s`.", (int)strcspn(word, "|"), word, models);
  }
}

static void print_key(FILE *out, const schema_entry *row) {
  print_row(out, row, row->path);
  if (row->sweep)
    fprintf(out, "%s", !row->list ? "yes" : row->scalar ? "yes, or an element" : "an element");
  else
    fprintf(out, "no: %s", row->no_sweep);
  fprintf(out, " | %s", row->doc);
  if (row->kinds) {
    char kinds[64];
    schema_either(row->kinds, kinds, sizeof kinds);
    fprintf(out, " For `kind: %s`.", kinds);
  }
  if (row->models) {
    char models[64];
    schema_either(row->models, models, sizeof models);
    fprintf(out, " For `model.type: %s`.", models);
  }
  print_word_models(out, row);
  if (row->orbits_default) {
    char methods[64];
    schema_either(row->orbits_default, methods, sizeof methods);
    fprintf(out, " Orbits by `method: %s` need the default.", methods);
  }
  fprintf(out, " |\n");
}

static void print_rules(FILE *out) {
  fprintf(
      out,
      "# Study files\n\n"
      "A study is a YAML file: a model, what to compute, and the parameters that are swept. Reading is strict: what "
      "is not\ndescribed here is refused with the file, the line, the key, the value received and what is "
      "allowed, and nothing runs.\n\n"
      "- Numbers are decimal (`0.1`, `-2`, `5e-3`) or multiples of pi (`1.5 pi`, `pi`, `-0.25 pi`). Infinities, NaN, "
      "quoted\n  numbers and trailing characters are not numbers.\n"
      "- Integers may be written in any of these ways as long as the value is integral: `1e6`.\n"
      "- Flags are `true` or `false`; `yes` and `on` are not flags.\n"
      "- `null` in `model.floor` and `model.wall` means no obstacle: for all particles, or for one in a list.\n"
      "- A trajectory starts either at the state of the section `start` or on the orbit of the section `orbit`; orbits "
      "are\n  those of the linear chain without damping, and need the defaults of the keys that say so.\n"
      "- A branch is a family of periodic motions of any model, followed along one number from a first guess: the "
      "state "
      "of the\n  section `start`, the particles of `orbit.excited`, the normal mode `orbit.mode`, the motion whose "
      "impacts\n  `orbit.at_start` and `orbit.at_half` name, continued from that of the model's linear part with "
      "growing "
      "nonlinear terms,\n  a mode that touches an obstacle, or, for forced motions, rest; or from a point of an "
      "earlier "
      "result, which the section\n  `restart` names. Sweeps repeat it for other values of "
      "the other numbers.\n"
      "- `branch.trace` is a section in the section `branch`: `branch: {..., trace: {parameter: model.frequency, low: "
      "1, "
      "high: 2}}`.\n  With it, curves through special points of the branch are followed in two parameters.\n"
      "- `kind: grazing` follows the same families, of motions that are not even, until they first touch an obstacle. "
      "It "
      "takes\n  the same keys, and those of the section `grazing`; with `branch.trace`, it follows the grazing point "
      "in "
      "two parameters.\n"
      "- `kind: diagram` iterates a map, or a motion from one crossing of a section to the next, at every grid point "
      "until "
      "it is on\n  its attractor: `iterate.transient` iterates are left out, `keep` stored, exponents and impacts "
      "averaged "
      "over `measure`,\n  and a few more tell its period. With `iterate.follow`, every point of the last sweep goes on "
      "from "
      "the one before it, and\n  `back: true` in that sweep comes back: attractors that coexist show. `kind: basin` "
      "does the "
      "same from many starts, swept\n  over `iterate.start` or the section `start`, and says which come to the same "
      "attractor.\n"
      "- `model.type: grazing_map` is the map beyond grazing, z -> L z, and z -> L z + s sqrt(d - eta z) xi + (d - eta "
      "z) "
      "kappa where\n  eta z <= d: given by `L`, `eta`, `xi`, `kappa`, or by `lambda` and `omega` the example of "
      "[FN97].\n"
      "- With `grazing.beyond`, a diagram stands beyond a grazing point: the family of the sections `orbit` (`motion: "
      "forced`) and\n  `branch` is followed to where it first grazes, `branch.parameter` becomes (1 + beyond) times "
      "its "
      "value there, and the return\n  map of that grazing is iterated beside the motion. Without it, a diagram has no "
      "such "
      "sections.\n"
      "- Indices of particles and list elements count from 0.\n"
      "- Unknown keys, duplicate keys, anchors, aliases, tags, a second document, more than %d levels of nesting, and "
      "files\n  over %d MiB are refused.\n"
      "- `--set path=value` on the command line replaces or adds a value before anything is checked: "
      "`--set model.gamma=0.1`,\n  `--set 'orbit.at_start=[1, 2]'`, `--set sweep[0].points=5`.\n\n",
      STUDY_MAX_DEPTH, STUDY_MAX_BYTES >> 20);
}

static void print_sweeps(FILE *out) {
  fprintf(
      out,
      "\n## Sweeps\n\n"
      "`sweep` is one entry or a list of up to %d. Several span a grid, whose last entry varies fastest; the grid "
      "has fewer than\n2^40 points. A swept key may be left out of its section. An element of a list is swept by its "
      "index, as in\n`model.floor[3]`, and must stand in the list. An entry gives either `values`, or `from`, `to` "
      "and `points`.\n\n",
      STUDY_MAX_SWEEPS);
  print_rows_head(out, false);
  for (int key = 0; key < SWEEP_KEY_COUNT; key++) {
    const schema_entry *row = schema_sweep_row((sweep_key)key);
    print_row(out, row, row->path + sizeof "sweep." - 1);
    fprintf(out, "%s |\n", row->doc);
  }
}

static void print_later_words(FILE *out, const schema_entry *row) {
  fprintf(out, "- `%s`: ", row->path);
  for (const char *c = row->later_words; *c; c++)
    if (*c == '|')
      fprintf(out, ", ");
    else
      fputc(*c, out);
  fputc('\n', out);
}

void schema_reference(FILE *out) {
  print_rules(out);
  fprintf(out, "## Keys\n\n");
  print_rows_head(out, true);
  for (int key = 0; key < KEY_COUNT; key++)
    print_key(out, schema_row((study_key)key));
  print_sweeps(out);
  fprintf(out, "\n## Words of a later version\n\nRefused with \"not in this version\":\n\n");
  for (int key = 0; key < KEY_COUNT; key++)
    if (schema_row((study_key)key)->later_words)
      print_later_words(out, schema_row((study_key)key));
}
