/* Verification of a result: every byte of every data set is read through its checksum. */
#ifndef RICOCHET_APP_VERIFY_H
#define RICOCHET_APP_VERIFY_H

#include "hdf5_call.h"
#include "plan.h"

/** Part of the verification of a file, so that several processes can share the reading: process `part` of `parts`
 *  checks all metadata (data sets chunked with a checksum, every axis attached to its scale) and reads every
 *  `parts`-th slab of data.
 *  @param path  of the file to open; `at` names the one for messages
 *  @param expected  what the file must hold at least, by name and shape; NULL when nothing is known about it */
int verify_part(const file_place *at, const char *path, const plan *expected, int part, int parts);

#endif
