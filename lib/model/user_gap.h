/* Callbacks of a user, and the gaps that they define. Internal to the library. */
#ifndef RICOCHET_USER_GAP_H
#define RICOCHET_USER_GAP_H

#include <stdbool.h>
#include <stddef.h>

#include "system_model.h"

/* Callbacks of user systems: checks of their return codes and values. */

/** Returns the failure (a static text) to the caller. */
#define TRY_TEXT(call)                                                                                                 \
  do {                                                                                                                 \
    const char *try_text = (call);                                                                                     \
    if (try_text)                                                                                                      \
      return try_text;                                                                                                 \
  } while (0)

/** The texts of a callback that returned non-zero, and of one whose values are not finite. */
#define CALLBACK_TEXTS(name) "the " name " callback failed", "the " name " callback gave a value that is not finite"

/** NULL, or the text that applies to a callback that returned `code` and filled x [count]. */
const char *callback_check(int code, const double *x, size_t count, const char *failed, const char *not_finite);

bool all_finite(const double *x, size_t count);

/* Gaps of user systems and their gradients: shared by both forms. */

typedef struct user_gap {
  size_t coordinates;
  int (*gap)(double t, const double *q, size_t obstacle, double *h, void *user);
  int (*gradient)(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user);
  void *user;
  double *point; /* [coordinates] for differences. Borrowed */
} user_gap;

const char *user_gap_value(const user_gap *g, size_t obstacle, double t, const double *q, double *h);

/** Gradient [coordinates] in q and the derivative in t; by differences if there is no callback. */
const char *user_gap_gradient(const user_gap *g, size_t obstacle, double t, const double *q, double *gradient,
                              double *in_time);

/** Derivatives [columns] of a gap along tangent vectors. @param gradient  [coordinates] work */
const char *user_gap_derivative(const user_gap *g, size_t obstacle, double t, const double *q, const tangents *d,
                                double *gradient, double *derivative);

#endif
