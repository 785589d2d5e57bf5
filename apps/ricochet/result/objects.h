/* Every object of a file and every attribute of it, read once. */
#ifndef RICOCHET_APP_OBJECTS_H
#define RICOCHET_APP_OBJECTS_H

#include "hdf5_call.h"

/** Visits all groups, data sets and named types and reads their attributes, so that HDF5 looks at the checksums of all
 *  metadata, also of parts that nobody asks for. Attributes with references are left to who checks the axes.
 *  @returns 0 or EXIT_FILES. */
int objects_check(const place *at, hid_t file);

#endif
