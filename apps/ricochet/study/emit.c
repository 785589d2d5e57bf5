#include "document.h"

#include <stdlib.h>
#include <string.h>

typedef struct buffer {
  char *text;
  size_t length, capacity;
} buffer;

static int append(void *user, unsigned char *bytes, size_t count) {
  buffer *b = user;
  if (b->length + count + 1 > b->capacity) {
    const size_t capacity = 2 * (b->length + count + 1);
    char *grown = realloc(b->text, capacity);
    if (!grown)
      return 0;
    b->text = grown;
    b->capacity = capacity;
  }
  memcpy(b->text + b->length, bytes, count);
  b->length += count;
  b->text[b->length] = 0;
  return 1;
}

/* Plain and double-quoted only, because both read back unchanged: an empty plain scalar may be written as an empty
 * string, and folded text can change at its ends. */
static bool emit_scalar(yaml_emitter_t *emitter, const document *d, int node) {
  const yaml_node_t *n = document_node(d, node);
  const bool null = document_is_null(d, node);
  const unsigned char *value = null ? (const unsigned char *)"null" : n->data.scalar.value;
  const size_t length = null ? 4 : n->data.scalar.length;
  const bool plain = n->data.scalar.style == YAML_PLAIN_SCALAR_STYLE && !memchr(value, '\n', length);
  yaml_event_t event;
  return yaml_scalar_event_initialize(&event, NULL, NULL, value, (int)length, 1, 1,
                                      plain ? YAML_PLAIN_SCALAR_STYLE : YAML_DOUBLE_QUOTED_SCALAR_STYLE) &&
         yaml_emitter_emit(emitter, &event);
}

static bool emit_node(yaml_emitter_t *emitter, const document *d, int node);

static bool emit_sequence(yaml_emitter_t *emitter, const document *d, const yaml_node_t *n) {
  yaml_event_t event;
  if (!yaml_sequence_start_event_initialize(&event, NULL, NULL, 1, n->data.sequence.style) ||
      !yaml_emitter_emit(emitter, &event))
    return false;
  for (const int *item = n->data.sequence.items.start; item < n->data.sequence.items.top; item++)
    if (!emit_node(emitter, d, *item))
      return false;
  return yaml_sequence_end_event_initialize(&event) && yaml_emitter_emit(emitter, &event);
}

static bool emit_mapping(yaml_emitter_t *emitter, const document *d, const yaml_node_t *n) {
  yaml_event_t event;
  if (!yaml_mapping_start_event_initialize(&event, NULL, NULL, 1, n->data.mapping.style) ||
      !yaml_emitter_emit(emitter, &event))
    return false;
  for (const yaml_node_pair_t *pair = n->data.mapping.pairs.start; pair < n->data.mapping.pairs.top; pair++)
    if (!emit_node(emitter, d, pair->key) || !emit_node(emitter, d, pair->value))
      return false;
  return yaml_mapping_end_event_initialize(&event) && yaml_emitter_emit(emitter, &event);
}

static bool emit_node(yaml_emitter_t *emitter, const document *d, int node) {
  const yaml_node_t *n = document_node(d, node);
  switch (n->type) {
  case YAML_SEQUENCE_NODE:
    return emit_sequence(emitter, d, n);
  case YAML_MAPPING_NODE:
    return emit_mapping(emitter, d, n);
  default:
    return emit_scalar(emitter, d, node);
  }
}

static bool emit_stream(yaml_emitter_t *emitter, const document *d) {
  yaml_event_t event;
  return yaml_stream_start_event_initialize(&event, YAML_UTF8_ENCODING) && yaml_emitter_emit(emitter, &event) &&
         yaml_document_start_event_initialize(&event, NULL, NULL, NULL, 1) && yaml_emitter_emit(emitter, &event) &&
         emit_node(emitter, d, DOCUMENT_ROOT) && yaml_document_end_event_initialize(&event, 1) &&
         yaml_emitter_emit(emitter, &event) && yaml_stream_end_event_initialize(&event) &&
         yaml_emitter_emit(emitter, &event) && yaml_emitter_flush(emitter);
}

int document_emit(const document *d, char **text, message *why) {
  yaml_emitter_t emitter;
  buffer b = {0};
  if (!yaml_emitter_initialize(&emitter))
    return refuse(why, EXIT_RUN, "%s: out of memory", d->from.name);
  yaml_emitter_set_output(&emitter, append, &b);
  yaml_emitter_set_unicode(&emitter, 1);
  yaml_emitter_set_width(&emitter, -1); /* no line is broken */
  const bool written = emit_stream(&emitter, d);
  yaml_emitter_delete(&emitter);
  if (!written) {
    free(b.text);
    return refuse(why, EXIT_RUN, "%s: out of memory", d->from.name);
  }
  *text = b.text;
  return 0;
}
