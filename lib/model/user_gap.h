/* Gaps of user systems and their gradients: shared by both forms. */
#ifndef RICOCHET_USER_GAP_H
#define RICOCHET_USER_GAP_H

#include "system_model.h"

typedef struct user_gap {
  size_t coordinates;
  int (*gap)(double t, const double *q, size_t obstacle, double *h, void *user);
  int (*gradient)(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user);
  void *user;
  double *point; /* [coordinates] for differences. Borrowed */
} user_gap;

const char *user_gap_value(const user_gap *g, size_t obstacle, double t, const double *q, double *h);

/** Gradient [coordinates] in q and the derivative in t; by differences where there is no callback. */
const char *user_gap_gradient(const user_gap *g, size_t obstacle, double t, const double *q, double *gradient,
                              double *in_time);

/** Derivatives [columns] of a gap along tangent vectors. @param gradient  [coordinates] work */
const char *user_gap_derivative(const user_gap *g, size_t obstacle, double t, const double *q, const tangents *d,
                                double *gradient, double *derivative);

#endif
