#include "document.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

yaml_node_t *document_node(const document *d, int node) {
  return d->tree.nodes.start + (node - 1);
}

int document_node_count(const document *d) {
  return (int)(d->tree.nodes.top - d->tree.nodes.start);
}

static bool text_is(const yaml_node_t *node, const char *text, size_t length) {
  return node->type == YAML_SCALAR_NODE && node->data.scalar.length == length &&
         memcmp(node->data.scalar.value, text, length) == 0;
}

bool document_is(const document *d, int node, const char *text) {
  return text_is(document_node(d, node), text, strlen(text));
}

bool document_is_null(const document *d, int node) {
  static const char *const nulls[] = {"", "~", "null", "Null", "NULL"};
  const yaml_node_t *n = document_node(d, node);
  if (n->type != YAML_SCALAR_NODE || n->data.scalar.style != YAML_PLAIN_SCALAR_STYLE)
    return false;
  for (size_t i = 0; i < sizeof nulls / sizeof *nulls; i++)
    if (document_is(d, node, nulls[i]))
      return true;
  return false;
}

long document_find_pair(const document *d, int mapping, const char *name, size_t length) {
  const yaml_node_t *n = document_node(d, mapping);
  for (const yaml_node_pair_t *pair = n->data.mapping.pairs.start; pair < n->data.mapping.pairs.top; pair++)
    if (text_is(document_node(d, pair->key), name, length))
      return pair - n->data.mapping.pairs.start;
  return -1;
}

int document_find(const document *d, int mapping, const char *name) {
  const long pair = document_find_pair(d, mapping, name, strlen(name));
  return pair < 0 ? 0 : document_node(d, mapping)->data.mapping.pairs.start[pair].value;
}

const char *document_assigned_by(const document *d, int node) {
  const char *place = NULL;
  for (size_t i = 0; i < d->assignment_count && d->assignments[i].first_node <= node; i++)
    place = d->assignments[i].place;
  return place;
}

size_t document_line(const document *d, int node) {
  return document_assigned_by(d, node) ? 0 : document_node(d, node)->start_mark.line + 1;
}

void document_show(const document *d, int node, char *text, size_t size) {
  const yaml_node_t *n = document_node(d, node);
  if (n->type != YAML_SCALAR_NODE) {
    snprintf(text, size, "%s", n->type == YAML_SEQUENCE_NODE ? "a list" : "a mapping");
    return;
  }
  if (document_is_null(d, node)) {
    snprintf(text, size, "null");
    return;
  }
  char value[80];
  source_quote((const char *)n->data.scalar.value, n->data.scalar.length, value, sizeof value);
  const bool plain = n->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
  snprintf(text, size, plain ? "%s" : "\"%s\" (a quoted string)", value);
}

int document_refuse(const document *d, int node, message *why, const char *format, ...) {
  const char *assigned = document_assigned_by(d, node);
  const source from = assigned ? (source){.name = assigned} : d->from;
  va_list arguments;
  va_start(arguments, format);
  const int code = source_refuse_list(&from, document_line(d, node), why, format, arguments);
  va_end(arguments);
  return code;
}

typedef struct key_text {
  const char *text;
  size_t length;
  int node;
} key_text;

static int compare_keys(const void *left, const void *right) {
  const key_text *a = left, *b = right;
  const int order = memcmp(a->text, b->text, a->length < b->length ? a->length : b->length);
  if (order != 0)
    return order;
  if (a->length != b->length)
    return a->length < b->length ? -1 : 1;
  return a->node < b->node ? -1 : a->node > b->node;
}

/* Sorting makes equal keys neighbours: a mapping of a million keys is checked in the time of reading it.
 * @param keys  [pairs of the mapping], scratch */
static int check_keys(const document *d, int mapping, key_text *keys, message *why) {
  const yaml_node_t *n = document_node(d, mapping);
  const size_t count = (size_t)(n->data.mapping.pairs.top - n->data.mapping.pairs.start);
  for (size_t i = 0; i < count; i++) {
    const int key = n->data.mapping.pairs.start[i].key;
    const yaml_node_t *k = document_node(d, key);
    if (k->type != YAML_SCALAR_NODE)
      return document_refuse(d, key, why, "%s where a key is expected, which is a single word",
                             k->type == YAML_SEQUENCE_NODE ? "a list" : "a mapping");
    keys[i] = (key_text){(const char *)k->data.scalar.value, k->data.scalar.length, key};
  }
  qsort(keys, count, sizeof *keys, compare_keys);
  for (size_t i = 1; i < count; i++) {
    if (keys[i].length != keys[i - 1].length || memcmp(keys[i].text, keys[i - 1].text, keys[i].length) != 0)
      continue;
    char name[64];
    source_quote(keys[i].text, keys[i].length, name, sizeof name);
    return document_refuse(d, keys[i].node, why,
                           "duplicate key '%s', first on line %zu: expected each key once in a mapping", name,
                           document_node(d, keys[i - 1].node)->start_mark.line + 1);
  }
  return 0;
}

static int check_mappings(const document *d, message *why) {
  size_t most = 1;
  for (const yaml_node_t *n = d->tree.nodes.start; n < d->tree.nodes.top; n++) {
    const size_t pairs =
        n->type == YAML_MAPPING_NODE ? (size_t)(n->data.mapping.pairs.top - n->data.mapping.pairs.start) : 0;
    most = pairs > most ? pairs : most;
  }
  key_text *keys = malloc(most * sizeof *keys);
  if (!keys)
    return refuse(why, EXIT_RUN, "%s: out of memory", d->from.name);
  int code = 0;
  for (int node = 1; node <= document_node_count(d) && !code; node++)
    if (document_node(d, node)->type == YAML_MAPPING_NODE)
      code = check_keys(d, node, keys, why);
  free(keys);
  return code;
}

int document_read(source from, const char *text, size_t length, document **out, message *why) {
  static const char byte_order_mark[] = {'\xef', '\xbb', '\xbf'}; /* some editors begin UTF-8 files with it */
  if (length >= sizeof byte_order_mark && memcmp(text, byte_order_mark, sizeof byte_order_mark) == 0) {
    text += sizeof byte_order_mark;
    length -= sizeof byte_order_mark;
  }
  int code = guard_text(&from, text, length, why);
  if (code)
    return code;
  document *d = calloc(1, sizeof *d);
  yaml_parser_t parser;
  if (!d || !guard_start_parser(&parser, text, length)) {
    free(d);
    return refuse(why, EXIT_RUN, "%s: out of memory", from.name);
  }
  d->from = from;
  const bool loaded = yaml_parser_load(&parser, &d->tree);
  yaml_parser_delete(&parser);
  if (!loaded) { /* the guard has parsed the same text, so only memory can be missing */
    free(d);
    return refuse(why, EXIT_RUN, "%s: out of memory", from.name);
  }
  code = check_mappings(d, why);
  if (code)
    document_destroy(&d);
  else
    *out = d;
  return code;
}

void document_destroy(document **d) {
  if (!*d)
    return;
  yaml_document_delete(&(*d)->tree);
  for (size_t i = 0; i < (*d)->assignment_count; i++)
    free((*d)->assignments[i].place);
  free((*d)->assignments);
  free(*d);
  *d = NULL;
}

/* --- origins of texts --- */

/* Waits for the next bytes of a file, which a pipe may never have. @returns 0, -1 with errno, or 1 to stop */
static int wait_for_bytes(int handle, ric_poll stop) {
  enum { MILLISECONDS = 100 };
  struct pollfd wanted = {.fd = handle, .events = POLLIN};
  for (;;) {
    const int ready = poll(&wanted, 1, MILLISECONDS); /* a signal ends it */
    if (ready > 0)
      return 0;
    if (ready < 0 && errno != EINTR)
      return -1;
    if (ric_poll_stops(stop))
      return 1;
  }
}

/* Reads up to the end of the file, or until there is no room. @returns as wait_for_bytes */
static int read_bytes(int handle, ric_poll stop, char *bytes, size_t room, size_t *length) {
  ssize_t got = 1;
  *length = 0;
  while (got != 0 && *length < room) {
    const int waited = wait_for_bytes(handle, stop);
    if (waited != 0)
      return waited;
    got = read(handle, bytes + *length, room - *length);
    if (got < 0 && errno != EAGAIN && errno != EINTR)
      return -1;
    *length += got > 0 ? (size_t)got : 0;
  }
  return 0;
}

/* Reads at most one byte more than the limit, which detects files that are too large. The size cannot be asked for
 * beforehand: a study may come through a pipe. */
static int read_text(const char *path, int handle, ric_poll stop, char **text, size_t *length, message *why) {
  char *bytes = malloc(STUDY_MAX_BYTES + 1);
  if (!bytes)
    return refuse(why, EXIT_RUN, "%s: out of memory", path);
  const int status = read_bytes(handle, stop, bytes, STUDY_MAX_BYTES + 1, length);
  int code = 0;
  if (status < 0)
    code = refuse_errno(path, "be read", why);
  else if (status > 0)
    code = refuse(why, EXIT_STOPPED, "%s: stopped before it was read", path);
  else if (*length > STUDY_MAX_BYTES)
    code = refuse(why, EXIT_USAGE, "%s: larger than %d MiB, the limit for a study", path, STUDY_MAX_BYTES >> 20);
  if (code) {
    free(bytes);
    return code;
  }
  bytes[*length] = 0;
  char *shrunk = realloc(bytes, *length + 1);
  *text = shrunk ? shrunk : bytes;
  return 0;
}

int study_read_file(const char *path, ric_poll stop, char **text, size_t *length, message *why) {
  const int handle = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* a named pipe without a writer opens, too */
  if (handle < 0)
    return refuse_errno(path, "be opened", why);
  const int code = read_text(path, handle, stop, text, length, why);
  close(handle); /* only read */
  return code;
}

int source_refuse_list(const source *from, size_t line, message *why, const char *format, va_list arguments) {
  if (from->lines)
    snprintf(why->text, sizeof why->text, "%s:%zu: ", from->name, line);
  else
    snprintf(why->text, sizeof why->text, "%s: ", from->name);
  const size_t used = strlen(why->text);
  vsnprintf(why->text + used, sizeof why->text - used, format, arguments);
  return EXIT_USAGE;
}

int source_refuse(const source *from, size_t line, message *why, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int code = source_refuse_list(from, line, why, format, arguments);
  va_end(arguments);
  return code;
}

void source_quote(const char *text, size_t length, char *quoted, size_t size) {
  const bool cut = length > size - 1;
  size_t kept = cut ? size - 4 : length;
  /* 10xxxxxx continues a UTF-8 character: a cut in front of one would split it. */
  while (cut && kept > 0 && ((unsigned char)text[kept] & 0xC0u) == 0x80u)
    kept--;
  for (size_t i = 0; i < kept; i++)
    quoted[i] = (unsigned char)text[i] < 0x20 || text[i] == 0x7f ? ' ' : text[i];
  memcpy(quoted + kept, cut ? "..." : "", cut ? 4 : 1);
}
