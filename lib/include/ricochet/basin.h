/* Basins of attraction: which of many starts converge to one attractor.
 *
 * Runs from many starts (attractor.h) converge to the same few attractors. Two runs have reached the same attractor if
 * they found the same period and their states with the smallest observed number, `lowest`, agree: on a periodic
 * attractor that state depends neither on the start nor on the phase at which a run ended. Attractors without a period
 * have no such state; all of them count as one. */
#ifndef RICOCHET_BASIN_H
#define RICOCHET_BASIN_H

#include <stdint.h>

#include "attractor.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_basin_options {
  size_t limit; /* largest number of distinguished attractors, default 1000: every run is compared with all of them */
  double same_tol; /* 1e-4, relative to the largest number of the two states: much more than the remainder of a
                      transient, much less than the distance of two cycles */
} ric_basin_options;

RIC_API ric_basin_options ric_basin_options_default(void);

/** Labels of runs that have reached none of the distinguished attractors. */
enum {
  RIC_BASIN_NONE = -1, /* diverged or failed */
  RIC_BASIN_OTHER = -2 /* an attractor beyond the limit */
};

/** An attractor, and the number of starts that converge to it. */
typedef struct ric_basin_attractor {
  size_t period;        /* 0: all attractors without a period */
  size_t first, starts; /* the first start that converges to it, in the order of addition; their number */
  const double *lowest; /* [size] of that first one; valid until the basin is destroyed */
} ric_basin_attractor;

typedef struct ric_basin ric_basin;

/** @param size  numbers of a state
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for options out of range, with their value; RIC_ENOMEM */
RIC_API ric_status ric_basin_create(size_t size, const ric_basin_options *options, ric_basin **basin, ric_error *error);
RIC_API void ric_basin_destroy(ric_basin **basin);

/** Adds the run of a start.
 *  @param run  of which kind, period and, if it has a period, lowest [size] are read
 *  @param label  set to the index of its attractor, RIC_BASIN_NONE or RIC_BASIN_OTHER
 *  @returns RIC_EINVAL for a periodic run without `lowest`; RIC_ENOMEM */
RIC_API ric_status ric_basin_add(ric_basin *basin, const ric_attractor *run, int64_t *label, ric_error *error);

/** The label of a run that has been added: the same as then, however many were added after it. Nobody needs to store
 *  labels. */
RIC_API int64_t ric_basin_label(const ric_basin *basin, const ric_attractor *run);

/** Number of attractors, in the order in which they were found. */
RIC_API size_t ric_basin_count(const ric_basin *basin);
/** @param index  < ric_basin_count */
RIC_API ric_basin_attractor ric_basin_at(const ric_basin *basin, size_t index);

RIC_END_DECLARATIONS

#endif
