/* Checksums for the one part of a result to which HDF5 gives none: its global heaps.
 *
 * They hold the references from data sets to the scales of their axes, and HDF5 1.10 loops for ever when it reads a
 * heap with a damaged object size. The writer finds the heaps (collections of bytes that begin with "GCOL") in the
 * finished skeleton and stores where they are, with a digest of each, in the root attribute `heap_checksums`, int64
 * [heaps][3]: address, size, FNV-1a of the bytes. A reader compares them before it asks HDF5 for anything in there. */
#ifndef RICOCHET_APP_HEAP_H
#define RICOCHET_APP_HEAP_H

#include "hdf5_call.h"
#include "skeleton.h"

/** Stores the checksums of the heaps in `image` in the file that was made of it. */
int heap_put_checksums(const file_place *at, hid_t file, const skeleton_image *image);

/** Compares the heaps of the file at `path`, open as `file`, with their checksums. */
int heap_check(const file_place *at, hid_t file, const char *path);

#endif
