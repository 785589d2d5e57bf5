/* Data sets of a result as they are created: type, shape, chunks with a checksum, attributes, and their axes. */
#ifndef RICOCHET_APP_DATA_SET_H
#define RICOCHET_APP_DATA_SET_H

#include "hdf5_call.h"
#include "plan.h"

/** Type of a column's values, the same in memory and in the file; the caller closes it. Negative on failure. */
hid_t data_set_type(const column *c);

/** Number of axes of a column's data set, and its shape. */
int data_set_shape(const column *c, uint64_t rows, hsize_t shape[PLAN_MOST_AXES]);

/** Creates the axis `/name`; its values are written with the rows of the tables. */
int data_set_create_scale(const file_place *at, hid_t file, const plan_scale *scale);

/** Creates the data set of a column in its table's group, attached to its axes, which exist. */
int data_set_create(const file_place *at, hid_t file, hid_t group, const result_table *t, const column *c);

#endif
