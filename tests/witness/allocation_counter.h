/* Every allocation of a test's process, counted, or refused.
 *
 * The functions that allocate stand in the executable, so that the shared libraries are bound to them, and hand on to
 * those of the C library. Buffers that FFTW takes inside some of its transforms are its own affair: while watching,
 * allocations called from it are not counted. Not with the allocator of a sanitizer, nor another C library. */
#ifndef RICOCHET_TESTS_ALLOCATION_COUNTER_H
#define RICOCHET_TESTS_ALLOCATION_COUNTER_H

#include <stdbool.h>
#include <stddef.h>

#include <stdlib.h> /* says whose C library it is */

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define ALLOCATIONS_ARE_COUNTED
#endif

extern size_t allocations;
extern size_t live, most_live; /* bytes */
extern size_t until_refusal;   /* the so many-th request from now on is refused; 0: none is */
extern bool watching;

#endif
