/* What every test file includes: cmocka with its prerequisites, and the one floating-point assertion. */
#ifndef RICOCHET_TESTS_SUPPORT_H
#define RICOCHET_TESTS_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/** Fails unless |a - b| <= tolerance; NaN fails. cmocka 1.1.5 has no such assertion. */
#define assert_close(a, b, tolerance) assert_close_at((a), (b), (tolerance), #a, __FILE__, __LINE__)

static inline void assert_close_at(double a, double b, double tolerance, const char *what, const char *file, int line) {
  if (fabs(a - b) <= tolerance)
    return;
  print_error("%s = %.17g, expected %.17g within %.3g (off by %.3g)\n", what, a, b, tolerance, fabs(a - b));
  _fail(file, line);
}

#endif
