#include "number.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static const char *skip_sign(const char *p) {
  return *p == '+' || *p == '-' ? p + 1 : p;
}

static const char *skip_digits(const char *p) {
  while (*p >= '0' && *p <= '9')
    p++;
  return p;
}

/* End of the digits, fraction and exponent that begin at p; p itself when there is no digit. */
static const char *skip_decimal(const char *p) {
  const char *end = skip_digits(p);
  size_t digits = (size_t)(end - p);
  if (*end == '.') {
    const char *fraction = skip_digits(end + 1);
    digits += (size_t)(fraction - end - 1);
    end = fraction;
  }
  if (digits == 0)
    return p;
  if (*end == 'e' || *end == 'E') {
    const char *exponent = skip_sign(end + 1);
    const char *last = skip_digits(exponent);
    return last > exponent ? last : p;
  }
  return end;
}

number_status number_read(const char *text, size_t length, double *value) {
  const char *const end = text + length;
  const char *const start = skip_sign(text);
  const char *p = skip_decimal(start);
  const bool decimal = p > start;
  double result = decimal ? strtod(text, NULL) : *text == '-' ? -1 : 1;
  if (!decimal || p < end) {
    const char *const blank = p;
    while (*p == ' ')
      p++;
    const bool apart = decimal == (p > blank);
    if (!apart || end - p != 2 || memcmp(p, "pi", 2) != 0)
      return NUMBER_MALFORMED;
    result *= pi;
  }
  if (!isfinite(result))
    return NUMBER_TOO_LARGE;
  *value = result;
  return NUMBER_OK;
}

void number_show(double value, char *text, size_t size) {
  snprintf(text, size, "%.15g", value);
  if (strtod(text, NULL) != value)
    snprintf(text, size, "%.17g", value);
}
