/* The monodromy matrix of an orbit from the exponential of the 2n x 2n matrix and explicit saltation matrices: O(n^3),
 * and nothing of it shared with the library but the forces of the chain. */
#ifndef RICOCHET_TESTS_DENSE_MONODROMY_H
#define RICOCHET_TESTS_DENSE_MONODROMY_H

#include <ricochet/ricochet.h>

/** M [2n][2n], row-major, over one period from t = 0-; the caller frees it. */
double *dense_monodromy(const ric_chain *chain, const ric_pattern *pattern, const ric_orbit *orbit);

#endif
