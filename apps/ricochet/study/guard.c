#include "document.h"

#include <string.h>

#include "study.h"

typedef struct scan {
  const source *from;
  const char *text;
  size_t length;
  size_t depth, documents;
  size_t character, byte; /* the same position of the text: libyaml's marks count characters */
} scan;

bool guard_start_parser(yaml_parser_t *parser, const char *text, size_t length) {
  if (!yaml_parser_initialize(parser))
    return false;
  yaml_parser_set_encoding(parser, YAML_UTF8_ENCODING);
  yaml_parser_set_input_string(parser, (const unsigned char *)text, length);
  return true;
}

static size_t line_of_byte(const char *text, size_t byte) {
  size_t line = 1;
  for (size_t i = 0; i < byte; i++)
    line += text[i] == '\n';
  return line;
}

static int refuse_syntax(const scan *s, const yaml_parser_t *parser, message *why) {
  if (parser->error == YAML_MEMORY_ERROR)
    return refuse(why, EXIT_RUN, "%s: out of memory", s->from->name);
  if (parser->error == YAML_READER_ERROR)
    return source_refuse(s->from, line_of_byte(s->text, parser->problem_offset), why,
                         "not UTF-8 text: %s, expected a YAML study", parser->problem);
  const char *context = parser->context ? parser->context : "";
  return source_refuse(s->from, parser->problem_mark.line + 1, why, "not YAML: %s%s%s", parser->problem,
                       *context ? " " : "", context);
}

/* Whether a tag begins at the mark. Events do not show the tag `!`, but they begin at it. */
static bool tag_begins(scan *s, size_t character) {
  while (s->byte < s->length && s->character < character) {
    do
      s->byte++;
    while (s->byte < s->length && ((unsigned char)s->text[s->byte] & 0xC0u) == 0x80u);
    s->character++;
  }
  return s->byte < s->length && s->character == character && s->text[s->byte] == '!';
}

static int check_node(scan *s, const yaml_event_t *event, const yaml_char_t *anchor, const yaml_char_t *tag,
                      message *why) {
  const size_t line = event->start_mark.line + 1;
  if (anchor)
    return source_refuse(s->from, line, why, "anchor &%.60s: anchors are not allowed in a study", (const char *)anchor);
  if (tag)
    return source_refuse(s->from, line, why, "tag %.60s: tags are not allowed in a study", (const char *)tag);
  if (tag_begins(s, event->start_mark.index))
    return source_refuse(s->from, line, why, "tag !: tags are not allowed in a study");
  return 0;
}

static int check_collection(scan *s, const yaml_event_t *event, const yaml_char_t *anchor, const yaml_char_t *tag,
                            message *why) {
  if (++s->depth > STUDY_MAX_DEPTH)
    return source_refuse(s->from, event->start_mark.line + 1, why,
                         "nested deeper than %d levels, the limit for a study", STUDY_MAX_DEPTH);
  return check_node(s, event, anchor, tag, why);
}

static int check_event(scan *s, const yaml_event_t *event, message *why) {
  switch (event->type) {
  case YAML_DOCUMENT_START_EVENT:
    if (s->documents++ > 0)
      return source_refuse(s->from, event->start_mark.line + 1, why,
                           "a second document begins here, expected a single one");
    return 0;
  case YAML_ALIAS_EVENT:
    return source_refuse(s->from, event->start_mark.line + 1, why, "alias *%.60s: aliases are not allowed in a study",
                         (const char *)event->data.alias.anchor);
  case YAML_SCALAR_EVENT:
    return check_node(s, event, event->data.scalar.anchor, event->data.scalar.tag, why);
  case YAML_SEQUENCE_START_EVENT:
    return check_collection(s, event, event->data.sequence_start.anchor, event->data.sequence_start.tag, why);
  case YAML_MAPPING_START_EVENT:
    return check_collection(s, event, event->data.mapping_start.anchor, event->data.mapping_start.tag, why);
  case YAML_SEQUENCE_END_EVENT:
  case YAML_MAPPING_END_EVENT:
    s->depth--;
    return 0;
  default:
    return 0;
  }
}

static int check_events(scan *s, yaml_parser_t *parser, message *why) {
  for (bool more = true; more;) {
    yaml_event_t event;
    if (!yaml_parser_parse(parser, &event))
      return refuse_syntax(s, parser, why);
    more = event.type != YAML_STREAM_END_EVENT;
    const int code = check_event(s, &event, why);
    yaml_event_delete(&event);
    if (code)
      return code;
  }
  return s->documents ? 0 : source_refuse(s->from, 1, why, "empty, expected a YAML mapping with the keys of a study");
}

int guard_text(const source *from, const char *text, size_t length, message *why) {
  if (length > STUDY_MAX_BYTES)
    return source_refuse(from, 1, why, "%zu bytes, expected at most %d", length, STUDY_MAX_BYTES);
  const char *nul = memchr(text, 0, length);
  if (nul)
    return source_refuse(from, line_of_byte(text, (size_t)(nul - text)), why,
                         "a NUL byte: not text, expected a YAML study");
  scan s = {.from = from, .text = text, .length = length};
  yaml_parser_t parser;
  if (!guard_start_parser(&parser, text, length))
    return refuse(why, EXIT_RUN, "%s: out of memory", from->name);
  const int code = check_events(&s, &parser, why);
  yaml_parser_delete(&parser);
  return code;
}
