#include "space.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "data_set.h"
#include "heap.h"
#include "skeleton.h"

/* --- bytes and space, without HDF5 --- */

static int write_all(int handle, const unsigned char *bytes, size_t count) {
  while (count > 0) {
    ssize_t written = write(handle, bytes, count);
    if (written < 0 && errno != EINTR)
      return errno;
    if (written > 0) {
      bytes += written;
      count -= (size_t)written;
    }
  }
  return 0;
}

static int reserve(int handle, uint64_t bytes) {
  int failed;
  do
    failed = posix_fallocate(handle, 0, (off_t)bytes);
  while (failed == EINTR);
  return failed == EINVAL || failed == EOPNOTSUPP ? 0 : failed; /* a file system that cannot reserve: hope */
}

static int write_image(const plan *p, const file_place *at, const skeleton_image *image) {
  int handle = open(p->partial, O_RDWR | O_CREAT | O_TRUNC, 0666);
  if (handle < 0)
    return refuse(at->why, EXIT_FILES, "%s: cannot create it: %s", at->path, strerror(errno));
  uint64_t total = image->size + plan_bytes(p);
  int failed = write_all(handle, image->bytes, image->size);
  if (!failed)
    failed = reserve(handle, total);
  if (close(handle) != 0 && !failed)
    failed = errno;
  if (!failed)
    return 0;
  return refuse(at->why, EXIT_FILES, "%s: cannot write its %llu bytes: %s", at->path, (unsigned long long)total,
                strerror(failed));
}

/* --- layout of the chunks --- */

/* The first write to a data set lays all its chunks out; one value is enough. */
static int touch(const file_place *at, hid_t file, const table *t, const column *c) {
  int code = 0;
  hid_t set = H5I_INVALID_HID, in_file = H5I_INVALID_HID, in_memory = H5I_INVALID_HID, type = H5I_INVALID_HID;
  char name[512];
  const hsize_t first[PLAN_MOST_AXES] = {0}, one[PLAN_MOST_AXES] = {1, 1, 1};
  unsigned char *zero = calloc(1, column_value_bytes(c));
  if (!zero)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  snprintf(name, sizeof name, "/%s/%s", t->group, c->name);
  HDF5_TRY(at, set = H5Dopen2(file, name, H5P_DEFAULT), "lay out %s", name);
  HDF5_TRY(at, type = data_set_type(c), "lay out %s", name);
  HDF5_TRY(at, in_file = H5Dget_space(set), "lay out %s", name);
  HDF5_TRY(at, H5Sselect_hyperslab(in_file, H5S_SELECT_SET, first, NULL, one, NULL), "lay out %s", name);
  HDF5_TRY(at, in_memory = H5Screate_simple(1, one, NULL), "lay out %s", name);
  HDF5_TRY(at, H5Dwrite(set, type, in_memory, in_file, H5P_DEFAULT, zero), "lay out %s", name);
out:
  code = hdf5_close(at, in_memory, code);
  code = hdf5_close(at, in_file, code);
  code = hdf5_close(at, type, code);
  code = hdf5_close(at, set, code);
  free(zero);
  return code;
}

static int touch_table(const file_place *at, hid_t file, const result_table *t) {
  int code = 0;
  for (size_t k = 0; !code && k < t->layout->column_count; k++)
    if (t->rows > 0 && column_values(&t->layout->columns[k]) > 0)
      code = touch(at, file, t->layout, &t->layout->columns[k]);
  return code;
}

static int lay_out_chunks(const plan *p, const file_place *at, const skeleton_image *image) {
  int code = 0;
  hid_t access = H5I_INVALID_HID, file = H5I_INVALID_HID;
  HDF5_TRY(at, access = skeleton_access(), "lay it out");
  HDF5_TRY(at, file = H5Fopen(p->partial, H5F_ACC_RDWR, access), "lay it out");
  for (size_t i = 0; !code && i < p->table_count; i++)
    code = touch_table(at, file, &p->tables[i]);
  if (!code)
    code = heap_put_checksums(at, file, image);
out:
  code = hdf5_close(at, file, code);
  return hdf5_close(at, access, code);
}

int space_create(const plan *p, const file_place *at) {
  skeleton_image image;
  int code = skeleton_make(p, at, &image);
  if (!code)
    code = write_image(p, at, &image);
  if (!code)
    code = lay_out_chunks(p, at, &image);
  free(image.bytes);
  return code;
}
