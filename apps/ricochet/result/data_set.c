#include "data_set.h"

#include <stdio.h>
#include <string.h>

#include "attribute.h"

/* Chunks with a checksum, all of them allocated (and, as they have a filter, filled) at the first write, not before. */
static hid_t data_set_properties(int rank, const hsize_t *chunk) {
  hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  if (list < 0)
    return list;
  if (H5Pset_chunk(list, rank, chunk) >= 0 && H5Pset_fletcher32(list) >= 0 &&
      H5Pset_alloc_time(list, H5D_ALLOC_TIME_LATE) >= 0 && H5Pset_obj_track_times(list, false) >= 0 &&
      H5Pset_attr_phase_change(list, ATTRIBUTE_MOST_COMPACT, 0) >= 0)
    return list;
  (void)H5Pclose(list);
  return H5I_INVALID_HID;
}

/* --- types --- */

static hid_t enum_type(const column *c) {
  hid_t type = H5Tenum_create(H5T_STD_I8LE);
  for (size_t i = 0; type >= 0 && i < c->name_count; i++) {
    if (H5Tenum_insert(type, c->names[i], &(signed char){(signed char)i}) >= 0)
      continue;
    (void)H5Tclose(type);
    type = H5I_INVALID_HID;
  }
  return type;
}

/* As h5py writes and reads complex numbers. */
static hid_t complex_type(void) {
  hid_t type = H5Tcreate(H5T_COMPOUND, 16);
  if (type < 0 || (H5Tinsert(type, "r", 0, H5T_IEEE_F64LE) >= 0 && H5Tinsert(type, "i", 8, H5T_IEEE_F64LE) >= 0))
    return type;
  (void)H5Tclose(type);
  return H5I_INVALID_HID;
}

hid_t data_set_type(const column *c) {
  switch (c->type) {
  case COLUMN_F64:
    return H5Tcopy(H5T_IEEE_F64LE);
  case COLUMN_I64:
    return H5Tcopy(H5T_STD_I64LE);
  case COLUMN_COMPLEX:
    return complex_type();
  case COLUMN_ENUM:
    return enum_type(c);
  case COLUMN_TEXT:
    return attribute_text_type(c->text_bytes, H5T_CSET_UTF8);
  }
  return H5I_INVALID_HID;
}

/* --- axes --- */

static int put_description(const file_place *at, hid_t set, const char *units, const char *long_name,
                           const char *source, const char *axes) {
  int code = attribute_put_text(at, set, "units", units);
  if (!code)
    code = attribute_put_text(at, set, "long_name", long_name);
  if (!code)
    code = attribute_put_text(at, set, "source", source);
  if (!code)
    code = attribute_put_text(at, set, "axes", axes);
  return code;
}

int data_set_create_scale(const file_place *at, hid_t file, const plan_scale *scale) {
  int code = 0;
  hid_t space = H5I_INVALID_HID, list = H5I_INVALID_HID, set = H5I_INVALID_HID;
  char long_name[128];
  uint64_t chunk[PLAN_MOST_AXES];
  plan_chunk(&scale->layout, &scale->layout.columns[0], scale->extent, chunk);
  HDF5_TRY(at, space = H5Screate_simple(1, &(hsize_t){scale->extent}, NULL), "create /%s", scale->name);
  HDF5_TRY(at, list = data_set_properties(1, &(hsize_t){chunk[0]}), "create /%s", scale->name);
  HDF5_TRY(at, set = H5Dcreate2(file, scale->name, H5T_STD_I64LE, space, H5P_DEFAULT, list, H5P_DEFAULT), "create /%s",
           scale->name);
  HDF5_TRY(at, H5DSset_scale(set, scale->name), "create /%s", scale->name);
  snprintf(long_name, sizeof long_name, "index along the axis %s", scale->name);
  code = put_description(at, set, "1", long_name, "counts from 0", scale->name);
out:
  code = hdf5_close(at, set, code);
  code = hdf5_close(at, list, code);
  return hdf5_close(at, space, code);
}

static int attach_scale(const file_place *at, hid_t file, hid_t set, const char *name, unsigned axis) {
  int code = 0;
  hid_t scale = H5I_INVALID_HID;
  HDF5_TRY(at, scale = H5Dopen2(file, name, H5P_DEFAULT), "open /%s", name);
  HDF5_TRY(at, H5DSattach_scale(set, scale, axis), "attach /%s", name);
out:
  return hdf5_close(at, scale, code);
}

/* --- columns --- */

/* The names of an enum as attributes of the CF conventions too, for readers without enums. */
static int put_flag_meanings(const file_place *at, hid_t set, const column *c) {
  enum { MOST = 128 };
  signed char values[MOST];
  message words = {""};
  for (size_t i = 0; i < c->name_count && i < MOST; i++) {
    size_t used = strlen(words.text);
    snprintf(words.text + used, sizeof words.text - used, "%s%s", i ? " " : "", c->names[i]);
    values[i] = (signed char)i;
  }
  if (c->name_count == 0 || c->name_count > MOST || strlen(words.text) + 1 == sizeof words.text)
    return refuse(at->why, EXIT_RUN, "column %s has %zu words, expected 1 to %d of %zu letters in all", c->name,
                  c->name_count, MOST, sizeof words.text);
  int code = attribute_put_list(at, set, "flag_values", H5T_STD_I8LE, H5T_NATIVE_SCHAR, c->name_count, values);
  return code ? code : attribute_put_text(at, set, "flag_meanings", words.text);
}

static int put_attributes(const file_place *at, hid_t set, const column *c) {
  int code = 0;
  for (int i = 0; !code && i < COLUMN_MOST_ATTRIBUTES && c->attributes[i].name; i++) {
    const column_attribute *a = &c->attributes[i];
    code = a->text ? attribute_put_text(at, set, a->name, a->text) : attribute_put_number(at, set, a->name, a->value);
  }
  return code;
}

static int describe_column(const file_place *at, hid_t file, hid_t set, const table *t, const column *c) {
  char axes[256];
  snprintf(axes, sizeof axes, "%s", t->row_axis);
  for (int i = 0; i < column_axes(c); i++)
    snprintf(axes + strlen(axes), sizeof axes - strlen(axes), " %s", c->axes[i]);
  int code = put_description(at, set, c->units, c->long_name, c->source, axes);
  if (!code && c->type == COLUMN_ENUM)
    code = put_flag_meanings(at, set, c);
  if (!code)
    code = put_attributes(at, set, c);
  if (!code)
    code = attach_scale(at, file, set, t->row_axis, 0);
  for (int i = 0; !code && i < column_axes(c); i++)
    code = attach_scale(at, file, set, c->axes[i], 1 + (unsigned)i);
  return code;
}

/* hsize_t has the width of uint64_t but is another type. */
static void to_sizes(const uint64_t *values, hsize_t *sizes) {
  for (int i = 0; i < PLAN_MOST_AXES; i++)
    sizes[i] = values[i];
}

int data_set_shape(const column *c, uint64_t rows, hsize_t shape[PLAN_MOST_AXES]) {
  uint64_t extents[PLAN_MOST_AXES] = {0};
  const int rank = plan_shape(c, rows, extents);
  to_sizes(extents, shape);
  return rank;
}

static void chunk_of(const result_table *t, const column *c, hsize_t *chunk) {
  uint64_t extents[PLAN_MOST_AXES] = {0};
  plan_chunk(t->layout, c, t->rows, extents);
  to_sizes(extents, chunk);
}

int data_set_create(const file_place *at, hid_t file, hid_t group, const result_table *t, const column *c) {
  int code = 0;
  hid_t space = H5I_INVALID_HID, type = H5I_INVALID_HID, list = H5I_INVALID_HID, set = H5I_INVALID_HID;
  const char *in = t->layout->group;
  hsize_t shape[PLAN_MOST_AXES], chunk[PLAN_MOST_AXES];
  const int rank = data_set_shape(c, t->rows, shape);
  chunk_of(t, c, chunk);
  HDF5_TRY(at, space = H5Screate_simple(rank, shape, NULL), "create /%s/%s", in, c->name);
  HDF5_TRY(at, type = data_set_type(c), "create /%s/%s", in, c->name);
  HDF5_TRY(at, list = data_set_properties(rank, chunk), "create /%s/%s", in, c->name);
  HDF5_TRY(at, set = H5Dcreate2(group, c->name, type, space, H5P_DEFAULT, list, H5P_DEFAULT), "create /%s/%s", in,
           c->name);
  code = describe_column(at, file, set, t->layout, c);
out:
  code = hdf5_close(at, set, code);
  code = hdf5_close(at, list, code);
  code = hdf5_close(at, type, code);
  return hdf5_close(at, space, code);
}
