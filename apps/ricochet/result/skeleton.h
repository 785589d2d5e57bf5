/* The skeleton of a result file: everything but the rows of the tables, whose data sets have no space yet. */
#ifndef RICOCHET_APP_SKELETON_H
#define RICOCHET_APP_SKELETON_H

#include "chunks.h"
#include "hdf5_call.h"
#include "plan.h"

/** The bytes of an HDF5 file, malloc'd; zeros may follow its end. */
typedef struct skeleton_image {
  unsigned char *bytes;
  size_t size;
} skeleton_image;

/** Access properties of every writer of the file: the format of HDF5 1.10 and nothing older, so that metadata have
 *  checksums. Negative on failure. */
hid_t skeleton_access(void);

/* The result file on the disk before its rows are written: skeleton, and space for everything.
 *
 * HDF5 fails badly on a full disk: a close that cannot flush leaves a broken handle. HDF5 therefore never allocates
 * space on the disk: the skeleton is made in memory and written as plain bytes, and the file system reserves all the
 * space of the result. A full disk, a quota or a limit on the file's size appears there, in calls that fail cleanly.
 * Then HDF5 allocates all chunks, without writing them: ranks do. */

/** Creates `p->partial` on this process alone, all data sets laid out, and finds their chunks.
 *  @param places  zeroed */
int space_create(const plan *p, const file_place *at, chunk_places *places);

#endif
