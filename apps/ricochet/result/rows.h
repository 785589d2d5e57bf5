/* The rows of a result's tables, written by all ranks at the same time. */
#ifndef RICOCHET_APP_ROWS_H
#define RICOCHET_APP_ROWS_H

#include "hdf5_call.h"
#include "plan.h"

/** Writes this rank's share of all tables into `p->partial`, which space_create has laid out: the blocks `rank`,
 *  `rank + ranks`, ... of each. Needs no other rank, so that a rank that fails keeps nobody waiting. */
int rows_write(const plan *p, const place *at, int rank, int ranks);

#endif
