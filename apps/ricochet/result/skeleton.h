/* The skeleton of a result file: everything but the rows of the tables, whose data sets have no space yet. */
#ifndef RICOCHET_APP_SKELETON_H
#define RICOCHET_APP_SKELETON_H

#include "hdf5_call.h"
#include "plan.h"

/** The bytes of an HDF5 file, malloc'd; zeros may follow its end. */
typedef struct skeleton_image {
  unsigned char *bytes;
  size_t size;
} skeleton_image;

/** Makes the skeleton in memory: all groups, attributes, axes and empty data sets. The caller frees `image->bytes`,
 * also after a failure. */
int skeleton_make(const plan *p, const file_place *at, skeleton_image *image);

/** Access properties of every writer of the file: the format of HDF5 1.10 and nothing older, so that metadata have
 *  checksums. Negative on failure. */
hid_t skeleton_access(void);

#endif
