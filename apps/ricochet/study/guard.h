/* What a text must pass before its document tree is built.
 *
 * libyaml's tree does not show a second document, resolves aliases (a few lines can stand for gigabytes), and grows
 * slow and deep on nested brackets. One pass over the parser's events, which come as they are read, refuses all of it
 * at the first offending line: so the tree is built from harmless text only, and code may recurse over it. */
#ifndef RICOCHET_APP_GUARD_H
#define RICOCHET_APP_GUARD_H

#include <yaml.h>

#include "source.h"

/** Refuses more than STUDY_MAX_BYTES, text that is not UTF-8 or contains a NUL, that is not YAML, an empty text, a
 *  second document, anchors, aliases, tags, and nesting deeper than STUDY_MAX_DEPTH.
 *  @returns 0, EXIT_USAGE, or EXIT_RUN when out of memory. */
int guard_text(const source *from, const char *text, size_t length, message *why);

/** Starts a parser on UTF-8 text, which it borrows: left to guess, libyaml also takes UTF-16. False: out of memory. */
bool guard_start_parser(yaml_parser_t *parser, const char *text, size_t length);

#endif
