/* Verification of a result: every byte of every data set is read through its checksum. */
#ifndef RICOCHET_APP_VERIFY_H
#define RICOCHET_APP_VERIFY_H

#include "hdf5_call.h"
#include "skeleton.h"

/** Checks a file: all metadata (data sets chunked with a checksum, every axis attached to its scale), and the data of
 * the axes and of all tables, read through their checksums.
 *  @param path  of the file to open; `at` names the one for messages
 *  @param expected  the plan that it was written by: data sets must have its shapes, and their data, which rows_check
 *         has read, are not read again; NULL if unknown
 *  @param stop  asked for each piece of data */
int verify_file(const file_place *at, const char *path, const plan *expected, ric_poll stop);

/** Stores the digest of the attributes of /study, which is complete, in the root attribute `study_values_checksum`. */
int study_put_checksum(const file_place *at, hid_t file);

/* Checksums of the global heaps, the only data of a result for which HDF5 has none.
 *
 * They hold the references from data sets to the scales of their axes. HDF5 1.10 loops forever when it reads a heap
 * with a damaged object size. The writer finds the heaps (collections of bytes that begin with "GCOL") in the
 * finished skeleton and stores, in the root attribute `heap_checksums`, int64 [heaps][3], the address, the size and
 * the FNV-1a digest of each. A reader compares these before HDF5 reads a heap. */

/** Stores the checksums of the heaps in `image` in the file that was made of it. */
int heap_put_checksums(const file_place *at, hid_t file, const skeleton_image *image);

#endif
