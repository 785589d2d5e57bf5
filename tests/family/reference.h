/* Rows of the tables in data/reference, for tests. */
#ifndef RICOCHET_TESTS_REFERENCE_H
#define RICOCHET_TESTS_REFERENCE_H

#include <stddef.h>

enum { REFERENCE_FIELDS = 64 };

/** A row: its first field as text where it is a word, and all fields as numbers (NaN for words). */
typedef struct reference_row {
  char word[32];
  double value[REFERENCE_FIELDS];
  size_t count;
} reference_row;

typedef struct reference {
  reference_row *rows;
  size_t count;
} reference;

/** Reads data/reference/<name>.csv; fails the test unless it is there. Comments and empty lines are left out. */
reference reference_read(const char *name);
void reference_clear(reference *table);

#endif
