#include "heap.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../base/digest.h"
#include "attribute.h"

static const char attribute_name[] = "heap_checksums";

typedef struct heap {
  int64_t address, size, digest;
} heap;

static int64_t digest_of(const unsigned char *bytes, size_t count) {
  return (int64_t)digest_bytes(0, bytes, count);
}

/* Signature, version 1, three zero bytes, size of the whole collection. Data that happen to look like it do no harm:
 * nothing in the skeleton changes any more, so their checksum holds as well. */
static bool heap_at(const skeleton_image *image, size_t address, heap *found) {
  static const unsigned char lead[8] = {'G', 'C', 'O', 'L', 1, 0, 0, 0};
  const unsigned char *bytes = image->bytes + address;
  uint64_t size = 0;
  if (image->size - address < 16 || memcmp(bytes, lead, sizeof lead) != 0)
    return false;
  for (int i = 7; i >= 0; i--)
    size = size << 8 | bytes[8 + i];
  if (size < 16 || size > image->size - address)
    return false;
  *found = (heap){(int64_t)address, (int64_t)size, digest_of(bytes, size)};
  return true;
}

static size_t find_heaps(const skeleton_image *image, heap *heaps) {
  size_t count = 0;
  heap found;
  for (size_t address = 0; address < image->size; address++) {
    const unsigned char *next = memchr(image->bytes + address, 'G', image->size - address);
    if (!next)
      break;
    address = (size_t)(next - image->bytes);
    if (heap_at(image, address, &found) && heaps)
      heaps[count] = found;
    count += heap_at(image, address, &found);
  }
  return count;
}

static int put(const file_place *at, hid_t file, size_t count, const heap *heaps) {
  int code = 0;
  hid_t space = H5I_INVALID_HID, attribute = H5I_INVALID_HID;
  HDF5_TRY(at, space = H5Screate_simple(2, (const hsize_t[2]){count, 3}, NULL), "write %s", attribute_name);
  HDF5_TRY(at, attribute = H5Acreate2(file, attribute_name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT), "write %s",
           attribute_name);
  HDF5_TRY(at, H5Awrite(attribute, H5T_NATIVE_INT64, heaps), "write %s", attribute_name);
out:
  code = hdf5_close(at, attribute, code);
  return hdf5_close(at, space, code);
}

int heap_put_checksums(const file_place *at, hid_t file, const skeleton_image *image) {
  size_t count = find_heaps(image, NULL);
  heap *heaps = calloc(count + 1, sizeof *heaps);
  if (!heaps)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  find_heaps(image, heaps);
  int code = put(at, file, count, heaps);
  free(heaps);
  return code;
}

/* --- checking --- */

static int check_one(const file_place *at, FILE *from, const heap *h) {
  bool good = false;
  unsigned char *bytes = h->address >= 0 && h->size > 0 ? malloc((size_t)h->size) : NULL;
  if (bytes && fseeko(from, (off_t)h->address, SEEK_SET) == 0)
    good = fread(bytes, (size_t)h->size, 1, from) == 1 && digest_of(bytes, (size_t)h->size) == h->digest;
  free(bytes);
  return good ? 0
              : refuse(at->why, EXIT_FILES, "%s: damaged: the references to its axes (global heap at byte %lld)",
                       at->path, (long long)h->address);
}

static int check_all(const file_place *at, const char *path, const heap *heaps, size_t count) {
  FILE *from = fopen(path, "rb");
  if (!from)
    return refuse(at->why, EXIT_FILES, "%s: cannot open it again", at->path);
  int code = 0;
  for (size_t i = 0; !code && i < count; i++)
    code = check_one(at, from, &heaps[i]);
  fclose(from); /* only read */
  return code;
}

int heap_check(const file_place *at, hid_t file, const char *path) {
  int code = 0;
  hid_t attribute = H5I_INVALID_HID, space = H5I_INVALID_HID;
  heap *heaps = NULL;
  hssize_t values;
  HDF5_TRY(at, attribute = H5Aopen(file, attribute_name, H5P_DEFAULT), "read %s", attribute_name);
  HDF5_TRY(at, space = H5Aget_space(attribute), "read %s", attribute_name);
  HDF5_TRY(at, values = H5Sget_simple_extent_npoints(space), "read %s", attribute_name);
  heaps = calloc((size_t)values / 3 + 1, sizeof *heaps);
  if (!heaps || values % 3 != 0) {
    code = refuse(at->why, EXIT_FILES, "%s: %s has %lld values, expected a multiple of 3", at->path, attribute_name,
                  (long long)values);
    goto out;
  }
  HDF5_TRY(at, H5Aread(attribute, H5T_NATIVE_INT64, heaps), "read %s", attribute_name);
  code = check_all(at, path, heaps, (size_t)values / 3);
out:
  free(heaps);
  code = hdf5_close(at, space, code);
  return hdf5_close(at, attribute, code);
}
