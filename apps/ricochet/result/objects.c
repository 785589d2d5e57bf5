#include "objects.h"

#include <stdlib.h>

/* Reads an attribute of plain values; 0 goes on, -1 fails as HDF5 iteration wants it. */
static herr_t read_values(hid_t attribute, hid_t type) {
  hsize_t bytes = H5Aget_storage_size(attribute);
  unsigned char *values = malloc(bytes > 0 ? (size_t)bytes : 1);
  herr_t status = values ? H5Aread(attribute, type, values) : -1;
  free(values);
  return status;
}

static herr_t look_at_attribute(hid_t object, const char *name, const H5A_info_t *info, void *user) {
  (void)info;
  (void)user;
  hid_t attribute = H5Aopen(object, name, H5P_DEFAULT), type = attribute < 0 ? -1 : H5Aget_type(attribute);
  H5T_class_t class = type < 0 ? H5T_NO_CLASS : H5Tget_class(type);
  herr_t status = class == H5T_NO_CLASS ? -1 : 0;
  if (status == 0 && class != H5T_VLEN && class != H5T_COMPOUND)
    status = read_values(attribute, type);
  if (type >= 0 && H5Tclose(type) < 0)
    status = -1;
  if (attribute >= 0 && H5Aclose(attribute) < 0)
    status = -1;
  return status < 0 ? -1 : 0;
}

static herr_t look_at_object(hid_t root, const char *name, const H5O_info_t *info, void *user) {
  (void)info;
  hid_t object = H5Oopen(root, name, H5P_DEFAULT);
  if (object < 0)
    return -1;
  herr_t status = H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, look_at_attribute, user);
  if (H5Oclose(object) < 0)
    status = -1;
  return status < 0 ? -1 : 0;
}

int objects_check(const place *at, hid_t file) {
  herr_t status = H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, look_at_object, NULL, H5O_INFO_ALL);
  return status < 0 ? hdf5_refuse(at, "read all of it") : 0;
}
