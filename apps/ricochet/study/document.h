/* The document tree of a study: libyaml's, read through the guard, with `--set` assignments applied to it, and with the
 * origin of every node known, so that each refusal can begin with its place.
 *
 * Nodes are identified by libyaml's index, from 1 (the root); 0 is "no node". An assignment adds nodes after those of
 * the file, so the index of a node determines its origin. */
#ifndef RICOCHET_APP_DOCUMENT_H
#define RICOCHET_APP_DOCUMENT_H

#include <stdarg.h>
#include <stdbool.h>
#include <yaml.h>

#include "study.h"

/* Origin of a text, with which messages begin: `FILE:LINE:`, or `--set path=value:` without a line. */

typedef struct source {
  const char *name; /* borrowed */
  bool lines;       /* messages name the line too */
} source;

/** A refusal that begins with the place. @param line  from 1. @returns EXIT_USAGE. */
int source_refuse(const source *from, size_t line, message *why, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int source_refuse_list(const source *from, size_t line, message *why, const char *format, va_list arguments)
    __attribute__((format(printf, 4, 0)));

/** Copies text for use inside a one-line message: control characters become blanks, and what does not fit into `size`
 *  bytes is cut between two characters and replaced by "...". @param size  at least 8. */
void source_quote(const char *text, size_t length, char *quoted, size_t size);

enum { DOCUMENT_ROOT = 1 };

/** The nodes that one `--set` added, and what messages about them begin with. */
typedef struct document_assignment {
  int first_node;
  char *place; /* "--set path=value", shortened when very long; owned */
} document_assignment;

typedef struct document {
  source from;
  yaml_document_t tree;
  document_assignment *assignments; /* [assignment_count], in order, so first_node ascends */
  size_t assignment_count;
} document;

/** Reads a text that passes the guard and repeats no key of a mapping; keys are single words.
 *  @param from  copied; the name in it is borrowed and must outlive the document
 *  @returns 0, EXIT_USAGE, or EXIT_RUN when out of memory. */
int document_read(source from, const char *text, size_t length, document **out, message *why);
void document_destroy(document **d);

/** The node; its pointer holds until the next assignment. Not const because libyaml's accessors are not. */
yaml_node_t *document_node(const document *d, int node);
int document_node_count(const document *d);

/** Index of the pair of a mapping with this key, -1 when there is none. */
long document_find_pair(const document *d, int mapping, const char *name, size_t length);
/** Value of that pair, 0 when there is none. */
int document_find(const document *d, int mapping, const char *name);

/** Whether the node is a scalar with exactly this text, quoted or not. */
bool document_is(const document *d, int node, const char *text);
/** Whether the node is an unquoted null: nothing at all, `~`, or `null`. */
bool document_is_null(const document *d, int node);

/** Line of the node in the file, from 1; 0 when an assignment added it. */
size_t document_line(const document *d, int node);
/** "--set path=value" of the assignment that added the node, NULL for a node of the file. */
const char *document_assigned_by(const document *d, int node);

/** What a node holds, for messages: `0.1x`, `"0.1" (a quoted string)`, `null`, `a list`, `a mapping`. */
void document_show(const document *d, int node, char *text, size_t size);

/** A refusal that begins with the place of the node. @returns EXIT_USAGE. */
int document_refuse(const document *d, int node, message *why, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The document tree written out as YAML again: the study as run, `--set` assignments included. */

/** Writes the tree as YAML text that reads back as the same values. Comments are gone, the layout is libyaml's.
 *  @param text  set to malloc'd text with a terminating 0; the caller frees
 *  @returns 0, or EXIT_RUN when out of memory. */
int document_emit(const document *d, char **text, message *why);

/* `--set path=value`: an edit of the document tree, made before anything is validated, so that the same
 * checks and messages apply to it as to a line of the file.
 *
 * The path is names joined by dots, list elements by index: `model.gamma`, `sweep[0].points`. The value is YAML, read
 * through the same guard as a file. Missing keys and sections are created; list elements must exist. */

/** @param assignment  "path=value", copied. @returns 0, EXIT_USAGE, or EXIT_RUN when out of memory. */
int document_assign(document *d, const char *assignment, message *why);

/** The same for a value that the program assigns. @param place  how messages about it begin */
int document_assign_value(document *d, const char *place, const study_assignment *value, message *why);

/* What a text must pass before its document tree is built.
 *
 * libyaml's tree hides a second document, resolves aliases (a few lines can expand to gigabytes), and becomes slow and
 * deep on nested brackets. One pass over the parser's events refuses all of this at the first offending line. The tree
 * is then built from harmless text only, and recursion over it is bounded. */

/** Refuses more than STUDY_MAX_BYTES, text that is not UTF-8 or contains a NUL, that is not YAML, an empty text, a
 *  second document, anchors, aliases, tags, and nesting deeper than STUDY_MAX_DEPTH.
 *  @returns 0, EXIT_USAGE, or EXIT_RUN when out of memory. */
int guard_text(const source *from, const char *text, size_t length, message *why);

/** Starts a parser on UTF-8 text, which it borrows: by default libyaml would accept UTF-16 as well. False: out of
 * memory. */
bool guard_start_parser(yaml_parser_t *parser, const char *text, size_t length);

#endif
