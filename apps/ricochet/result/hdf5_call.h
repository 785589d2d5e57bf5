/* Calls to HDF5 whose failures become a message for the user instead of HDF5's error stack.
 *
 * HDF5 keeps the description of a failure only until its next call, closing a handle included. What it said first is
 * therefore kept here until the failure is turned into a message. Functions that own handles use HDF5_TRY, which jumps
 * to `out` on failure. There every handle is closed, and a failing close is an error as well. */
#ifndef RICOCHET_APP_HDF5_CALL_H
#define RICOCHET_APP_HDF5_CALL_H

#include <hdf5.h>
#include <hdf5_hl.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h> /* file drivers */
#endif

#include "../base/message.h"

/** Keeps HDF5 from printing its error stack, and from acting at exit. Called by every entry point of this room before
 * all other calls of HDF5. @returns 0; EXIT_RUN if HDF5 has no memory to start */
int hdf5_start(const file_place *at);

/** Said by a callback of HDF5's iterations that has no memory, before it fails. */
void hdf5_out_of_memory(void);

/** Formats "PATH: cannot WHAT: REASON", the reason being HDF5's innermost description of its first failure since the
 * last one that was refused.
 *  @returns EXIT_FILES; EXIT_RUN with "out of memory" if HDF5 had too little */
int hdf5_refuse(const file_place *at, const char *what, ...) __attribute__((format(printf, 2, 3)));

/** Closes a handle of any kind; a negative one is none.
 *  @param code  of the work done with it: a failure there keeps its message, a failing close becomes one otherwise
 *  @returns `code`, or as hdf5_refuse when only the close failed. If HDF5 has had too little memory since its start,
 *           EXIT_RUN also in place of 0 and of EXIT_FILES: what was read then may be wrong, and no damage was proved */
int hdf5_close(const file_place *at, hid_t handle, int code);

/** Makes `call`; a negative result sets `code` and jumps to `out` (both the calling function's own). */
#define HDF5_TRY(at, call, ...)                                                                                        \
  do {                                                                                                                 \
    if ((call) < 0) {                                                                                                  \
      code = hdf5_refuse((at), __VA_ARGS__);                                                                           \
      goto out;                                                                                                        \
    }                                                                                                                  \
  } while (0)

#endif
