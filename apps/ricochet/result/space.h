/* The result file on the disk before its rows are written: skeleton, and space for everything.
 *
 * HDF5 does not survive a disk that fills up under it: a close that cannot flush leaves a broken handle behind, which
 * crashes the process when MPI_Finalize shuts HDF5 down, and in parallel the other ranks wait for ever. So HDF5 never
 * meets that disk: the skeleton is made in memory and written like any bytes, and the file system is asked to reserve
 * all the space there will ever be. A full disk, a quota or a limit on the file's size shows there, in calls that fail
 * cleanly. Then HDF5 lays all chunks out, so that ranks writing rows only overwrite bytes and change no metadata. */
#ifndef RICOCHET_APP_SPACE_H
#define RICOCHET_APP_SPACE_H

#include "hdf5_call.h"
#include "plan.h"

/** Creates `p->partial` on this process alone, all data sets laid out and filled with zeros. */
int space_create(const plan *p, const file_place *at);

#endif
