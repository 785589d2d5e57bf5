#include <string.h>

#include "../base/digest.h"
#include "parts.h"

/* Least byte first, so that the digest is the same on every machine. */
static void add_integer(uint64_t *digest, uint64_t value) {
  unsigned char bytes[8];
  for (int i = 0; i < 8; i++)
    bytes[i] = (unsigned char)(value >> (8 * i));
  *digest = digest_bytes(*digest, bytes, sizeof bytes);
}

/* Lengths come first: no two different texts or lists run together to the same bytes. */
static void add_text(uint64_t *digest, const char *text) {
  add_integer(digest, strlen(text));
  *digest = digest_bytes(*digest, text, strlen(text));
}

static void add_numbers(uint64_t *digest, const double *numbers, size_t count) {
  add_integer(digest, count);
  for (size_t i = 0; i < count; i++) {
    uint64_t bits;
    memcpy(&bits, &numbers[i], sizeof bits);
    add_integer(digest, bits);
  }
}

static void add_value(uint64_t *digest, const typed_value *value) {
  const char *tag = !value->present ? "absent" : value->text ? "text" : value->list ? "list" : "number";
  add_text(digest, tag);
  if (value->text)
    add_text(digest, value->text);
  else
    add_numbers(digest, value->numbers, value->count);
}

uint64_t study_compute_digest(const study *s) {
  uint64_t digest = 0;
  for (int key = 0; key < KEY_COUNT; key++) {
    add_text(&digest, schema_row((study_key)key)->path);
    add_value(&digest, &s->values[key]);
  }
  for (size_t i = 0; i < s->sweep_count; i++) {
    add_text(&digest, s->sweeps[i].view.name);
    add_numbers(&digest, s->sweeps[i].values, s->sweeps[i].view.points);
  }
  return digest;
}
