/* Numbers as studies write them: a decimal number, or a multiple of pi.
 *
 *   [sign] digits [. digits] [e [sign] digits] [blanks pi]     1.5   -.5   1e-3   1.5 pi   -0.25 pi
 *   [sign] pi                                                  pi    -pi
 *
 * strtod alone would also accept hexadecimal digits, `inf`, `nan` and trailing characters; YAML's own
 * numbers include octals, underscores and sexagesimals. All of these are refused, so that a typing error is never
 * accepted as a value. */
#ifndef RICOCHET_APP_NUMBER_H
#define RICOCHET_APP_NUMBER_H

#include <stddef.h>

typedef enum number_status {
  NUMBER_OK,
  NUMBER_MALFORMED, /* not of the form above */
  NUMBER_TOO_LARGE  /* of that form, but beyond the range of a double */
} number_status;

/** Reads the whole text as one number, correctly rounded (a multiple of pi: coefficient times the double nearest to
 *  pi). Tiny numbers may round to zero.
 *  @param text    [length], a 0 behind it
 *  @param value   written on NUMBER_OK only, finite */
number_status number_read(const char *text, size_t length, double *value);

/** Writes the shortest of 15 and 17 significant digits that reads back as the same double. */
void number_show(double value, char *text, size_t size);

#endif
