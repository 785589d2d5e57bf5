#include "attribute.h"

#include "../base/digest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int put(const file_place *at, hid_t object, const char *name, hid_t file_type, hid_t memory_type, hid_t space,
               const void *value) {
  int code = 0;
  hid_t attribute = H5I_INVALID_HID;
  HDF5_TRY(at, attribute = H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT),
           "create the attribute %s", name);
  HDF5_TRY(at, H5Awrite(attribute, memory_type, value), "write the attribute %s", name);
out:
  return hdf5_close(at, attribute, code);
}

int attribute_put_scalar(const file_place *at, hid_t object, const char *name, hid_t file_type, hid_t memory_type,
                         const void *value) {
  int code = 0;
  hid_t space = H5I_INVALID_HID;
  HDF5_TRY(at, space = H5Screate(H5S_SCALAR), "describe the attribute %s", name);
  code = put(at, object, name, file_type, memory_type, space, value);
out:
  return hdf5_close(at, space, code);
}

int attribute_put_list(const file_place *at, hid_t object, const char *name, hid_t file_type, hid_t memory_type,
                       size_t count, const void *values) {
  int code = 0;
  hid_t space = H5I_INVALID_HID;
  HDF5_TRY(at, space = H5Screate_simple(1, &(hsize_t){count}, NULL), "describe the attribute %s", name);
  code = put(at, object, name, file_type, memory_type, space, values);
out:
  return hdf5_close(at, space, code);
}

hid_t attribute_text_type(size_t bytes, H5T_cset_t set) {
  hid_t type = H5Tcopy(H5T_C_S1);
  if (type < 0)
    return type;
  if (H5Tset_size(type, bytes) >= 0 && H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0 && H5Tset_cset(type, set) >= 0)
    return type;
  (void)H5Tclose(type); /* the failure before is the one to report */
  return H5I_INVALID_HID;
}

static H5T_cset_t character_set(const char *text) {
  for (; *text; text++)
    if ((unsigned char)*text > 127)
      return H5T_CSET_UTF8;
  return H5T_CSET_ASCII;
}

int attribute_put_text(const file_place *at, hid_t object, const char *name, const char *text) {
  int code = 0;
  hid_t type = H5I_INVALID_HID;
  if (!text)
    text = "";
  size_t bytes = text[0] ? strlen(text) : 1; /* HDF5 has no text of length 0: it is stored as one NUL */
  HDF5_TRY(at, type = attribute_text_type(bytes, character_set(text)), "describe the attribute %s", name);
  code = attribute_put_scalar(at, object, name, type, type, text);
out:
  return hdf5_close(at, type, code);
}

int attribute_put_texts(const file_place *at, hid_t object, const char *name, size_t count, const char *const *texts) {
  int code = 0;
  hid_t type = H5I_INVALID_HID;
  size_t bytes = 1;
  for (size_t i = 0; i < count; i++)
    if (strlen(texts[i]) > bytes)
      bytes = strlen(texts[i]);
  char *packed = calloc(count + 1, bytes);
  if (!packed)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  for (size_t i = 0; i < count; i++)
    memcpy(packed + i * bytes, texts[i], strlen(texts[i]));
  HDF5_TRY(at, type = attribute_text_type(bytes, H5T_CSET_ASCII), "describe the attribute %s", name);
  code = attribute_put_list(at, object, name, type, type, count, packed);
out:
  free(packed);
  return hdf5_close(at, type, code);
}

/* Writes into `other` the name of the attribute that holds the checksum of `name`, into `sum` that of `text`. */
static void checksum_of(const char *name, const char *text, char other[64], char sum[17]) {
  snprintf(other, 64, "%s_checksum", name);
  snprintf(sum, 17, "%016llx", (unsigned long long)digest_bytes(0, text, strlen(text)));
}

int attribute_put_checked_text(const file_place *at, hid_t object, const char *name, const char *text) {
  char other[64], sum[17];
  checksum_of(name, text, other, sum);
  int code = attribute_put_text(at, object, name, text);
  return code ? code : attribute_put_text(at, object, other, sum);
}

int attribute_put_integer(const file_place *at, hid_t object, const char *name, int64_t value) {
  return attribute_put_scalar(at, object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

int attribute_put_number(const file_place *at, hid_t object, const char *name, double value) {
  return attribute_put_scalar(at, object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

/* --- reading --- */

int attribute_text(const file_place *at, hid_t object, const char *name, char **text) {
  int code = 0;
  hid_t attribute = H5I_INVALID_HID, type = H5I_INVALID_HID, space = H5I_INVALID_HID;
  *text = NULL;
  HDF5_TRY(at, attribute = H5Aopen(object, name, H5P_DEFAULT), "read the attribute %s", name);
  HDF5_TRY(at, type = H5Aget_type(attribute), "read the attribute %s", name);
  HDF5_TRY(at, space = H5Aget_space(attribute), "read the attribute %s", name);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || H5Sget_simple_extent_npoints(space) != 1) {
    code = refuse(at->why, EXIT_FILES, "%s: attribute %s is not text of fixed length", at->path, name);
    goto out;
  }
  *text = calloc(H5Tget_size(type) + 1, 1);
  if (!*text) {
    code = refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
    goto out;
  }
  HDF5_TRY(at, H5Aread(attribute, type, *text), "read the attribute %s", name);
out:
  code = hdf5_close(at, space, code);
  code = hdf5_close(at, type, code);
  code = hdf5_close(at, attribute, code);
  if (code) {
    free(*text);
    *text = NULL;
  }
  return code;
}

int attribute_checked_text(const file_place *at, hid_t object, const char *name, char **text) {
  char other[64], sum[17], stored[17] = "";
  int code = attribute_text(at, object, name, text);
  if (code)
    return code;
  checksum_of(name, *text, other, sum);
  code = attribute_text_into(at, object, other, stored, sizeof stored);
  if (!code && strcmp(sum, stored) != 0)
    code = refuse(at->why, EXIT_FILES, "%s: attribute %s is damaged: checksum %s, expected %s", at->path, name, sum,
                  stored);
  if (code) {
    free(*text);
    *text = NULL;
  }
  return code;
}

int attribute_text_into(const file_place *at, hid_t object, const char *name, char *text, size_t size) {
  char *whole;
  int code = attribute_text(at, object, name, &whole);
  if (!code)
    escape_text(whole, text, size);
  free(whole);
  return code;
}

int attribute_text_if_there(const file_place *at, hid_t object, const char *name, char *text, size_t size) {
  const htri_t there = H5Aexists(object, name);
  if (there < 0)
    return hdf5_refuse(at, "read the attribute %s", name);
  return there ? attribute_text_into(at, object, name, text, size) : 0;
}

static int read_scalar(const file_place *at, hid_t object, const char *name, hid_t memory_type, void *value) {
  int code = 0;
  hid_t attribute = H5I_INVALID_HID, space = H5I_INVALID_HID;
  HDF5_TRY(at, attribute = H5Aopen(object, name, H5P_DEFAULT), "read the attribute %s", name);
  HDF5_TRY(at, space = H5Aget_space(attribute), "read the attribute %s", name);
  if (H5Sget_simple_extent_npoints(space) != 1) {
    code = refuse(at->why, EXIT_FILES, "%s: attribute %s is not a single value", at->path, name);
    goto out;
  }
  HDF5_TRY(at, H5Aread(attribute, memory_type, value), "read the attribute %s", name);
out:
  code = hdf5_close(at, space, code);
  return hdf5_close(at, attribute, code);
}

int attribute_integer(const file_place *at, hid_t object, const char *name, int64_t *value) {
  return read_scalar(at, object, name, H5T_NATIVE_INT64, value);
}

int attribute_number(const file_place *at, hid_t object, const char *name, double *value) {
  return read_scalar(at, object, name, H5T_NATIVE_DOUBLE, value);
}

/* --- their digest --- */

static herr_t add_values(hid_t attribute, hid_t type, size_t bytes, uint64_t *digest) {
  unsigned char *values = malloc(bytes + 1);
  herr_t status = values && bytes ? H5Aread(attribute, type, values) : values ? 0 : -1;
  if (!values)
    hdf5_out_of_memory();
  if (status >= 0)
    *digest = digest_bytes(*digest, values, bytes);
  free(values);
  return status;
}

/* Adds an attribute to the digest; 0 goes on, -1 fails as HDF5 iteration wants it. */
static herr_t add_attribute(hid_t object, const char *name, const H5A_info_t *info, void *digest) {
  char described[128];
  (void)info;
  hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  hid_t type = attribute < 0 ? attribute : H5Aget_type(attribute);
  hid_t space = attribute < 0 ? attribute : H5Aget_space(attribute);
  const hssize_t count = space < 0 ? -1 : H5Sget_simple_extent_npoints(space);
  herr_t status = type < 0 || count < 0 || H5Tget_class(type) == H5T_VLEN ? -1 : 0;
  if (status == 0) {
    snprintf(described, sizeof described, " %d %zu %d %lld", (int)H5Tget_class(type), H5Tget_size(type),
             H5Sget_simple_extent_ndims(space), (long long)count);
    *(uint64_t *)digest = digest_bytes(*(uint64_t *)digest, name, strlen(name));
    *(uint64_t *)digest = digest_bytes(*(uint64_t *)digest, described, strlen(described));
    status = add_values(attribute, type, (size_t)count * H5Tget_size(type), digest);
  }
  if ((space >= 0 && H5Sclose(space) < 0) || (type >= 0 && H5Tclose(type) < 0) ||
      (attribute >= 0 && H5Aclose(attribute) < 0))
    status = -1;
  return status < 0 ? -1 : 0;
}

int attribute_digest(const file_place *at, hid_t object, uint64_t *digest) {
  *digest = 0;
  herr_t status = H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, NULL, add_attribute, digest);
  return status < 0 ? hdf5_refuse(at, "read its attributes") : 0;
}
