/* Curves to be followed without trouble: a small one, and one of many unknowns. */
#ifndef RICOCHET_SCENARIO_SMOOTH_CURVE_H
#define RICOCHET_SCENARIO_SMOOTH_CURVE_H

#include <ricochet/ricochet.h>

/** u = (s, s^2, -s^3) with s = sin p, three unknowns. @param calls  counts evaluations; borrowed */
ric_curve_problem smooth_wave(size_t *calls);

/** A straight line, A u = p b, through 0 with a dense matrix of random entries and 2 on its diagonal; b_i = 1. */
typedef struct smooth_line {
  size_t unknowns;
  double *matrix; /* [unknowns][unknowns] */
} smooth_line;

/** @returns 0, non-zero when there is no memory */
int smooth_line_init(smooth_line *line, size_t unknowns);
void smooth_line_clear(smooth_line *line);
/** @param line  borrowed */
ric_curve_problem smooth_line_problem(const smooth_line *line);

#endif
