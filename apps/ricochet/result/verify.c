#include "verify.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../base/digest.h"
#include "attribute.h"
#include "data_set.h"
#include "reader.h"
#include "result.h"
#include "hdf5_call.h"

/* --- global heaps --- */

static const char attribute_name[] = "heap_checksums";

typedef struct heap {
  int64_t address, size, digest;
} heap;

static int64_t digest_of(const unsigned char *bytes, size_t count) {
  return (int64_t)digest_bytes(0, bytes, count);
}

/* Signature, version 1, three zero bytes, size of the whole collection. Other data with this signature do no
 * harm: the skeleton does not change any more, so their checksum stays correct as well. */
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

/* --- the values of the study --- */

static const char values_checksum[] = "study_values_checksum";

/* @param sum  [17] */
static int study_digest_text(const file_place *at, hid_t file, char *sum) {
  uint64_t digest;
  hid_t group = H5Gopen2(file, "study", H5P_DEFAULT);
  if (group < 0)
    return hdf5_refuse(at, "open /study");
  int code = attribute_digest(at, group, &digest);
  snprintf(sum, 17, "%016llx", (unsigned long long)digest);
  return hdf5_close(at, group, code);
}

int study_put_checksum(const file_place *at, hid_t file) {
  char sum[17];
  int code = study_digest_text(at, file, sum);
  return code ? code : attribute_put_text(at, file, values_checksum, sum);
}

/* Results of earlier versions have neither the group nor its checksum. */
static int check_values(const file_place *at, hid_t file) {
  char sum[17], stored[17];
  if (H5Aexists(file, values_checksum) == 0 && !reader_has(file, "study"))
    return 0;
  int code = attribute_text_into(at, file, values_checksum, stored, sizeof stored);
  if (!code)
    code = study_digest_text(at, file, sum);
  if (!code && strcmp(sum, stored) != 0)
    code = refuse(at->why, EXIT_FILES, "%s: /study is damaged: checksum %s, expected %s", at->path, sum, stored);
  return code;
}

/* --- checking --- */

/* @param end  of the file */
static int check_one(const file_place *at, FILE *from, off_t end, const heap *h) {
  bool good = false;
  const bool possible = h->address >= 0 && h->size > 0 && h->size <= end;
  unsigned char *bytes = possible ? malloc((size_t)h->size) : NULL;
  if (possible && !bytes)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
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
    return refuse_errno(at->path, "open it again", at->why);
  int code = 0;
  const off_t end = fseeko(from, 0, SEEK_END) == 0 ? ftello(from) : 0;
  for (size_t i = 0; !code && i < count; i++)
    code = check_one(at, from, end, &heaps[i]);
  fclose(from); /* only read */
  return code;
}

static int heap_check(const file_place *at, hid_t file, const char *path) {
  int code = 0;
  hid_t attribute = H5I_INVALID_HID, space = H5I_INVALID_HID;
  heap *heaps = NULL;
  hssize_t values;
  HDF5_TRY(at, attribute = H5Aopen(file, attribute_name, H5P_DEFAULT), "read %s", attribute_name);
  HDF5_TRY(at, space = H5Aget_space(attribute), "read %s", attribute_name);
  HDF5_TRY(at, values = H5Sget_simple_extent_npoints(space), "read %s", attribute_name);
  heaps = calloc((size_t)values / 3 + 1, sizeof *heaps);
  if (!heaps) {
    code = refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
    goto out;
  }
  if (values % 3 != 0) {
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

/* --- metadata --- */

/* Reads an attribute of plain values; 0 goes on, -1 fails as HDF5 iteration wants it. */
static herr_t read_values(hid_t attribute, hid_t type) {
  hsize_t bytes = H5Aget_storage_size(attribute);
  unsigned char *values = malloc(bytes > 0 ? (size_t)bytes : 1);
  herr_t status = values ? H5Aread(attribute, type, values) : -1;
  if (!values)
    hdf5_out_of_memory();
  free(values);
  return status;
}

static herr_t visit_attribute(hid_t object, const char *name, const H5A_info_t *info, void *user) {
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

static herr_t visit_object(hid_t root, const char *name, const H5O_info_t *info, void *user) {
  (void)info;
  hid_t object = H5Oopen(root, name, H5P_DEFAULT);
  if (object < 0)
    return -1;
  herr_t status = H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, visit_attribute, user);
  if (H5Oclose(object) < 0)
    status = -1;
  return status < 0 ? -1 : 0;
}

/* Visits all groups, data sets and named types and reads their attributes, so that HDF5 verifies the checksums of all
 * metadata. Attributes with references are verified by check_axes. */
static int objects_check(const file_place *at, hid_t file) {
  herr_t status = H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit_object, NULL, H5O_INFO_ALL);
  return status < 0 ? hdf5_refuse(at, "read all of it") : 0;
}

/* A verification in progress. */
typedef struct verifier {
  const file_place *at;
  hid_t file;
  ric_poll stop;
  bool with_rows; /* or only what surrounds them */
} verifier;

/* --- data --- */

/* A data set opened for reading, and how many of its rows are read at a time. */
typedef struct slabs {
  hid_t set, type, space;
  int rank;
  hsize_t shape[H5S_MAX_RANK];
  hsize_t height;   /* rows of a slab: those of a chunk */
  size_t row_bytes; /* of all values with the same first index */
} slabs;

static int read_slab(const verifier *v, const char *name, const slabs *s, hsize_t first, unsigned char *bytes) {
  int code = 0;
  hid_t memory = H5I_INVALID_HID;
  hsize_t start[H5S_MAX_RANK] = {first}, count[H5S_MAX_RANK];
  memcpy(count, s->shape, sizeof count);
  count[0] = s->shape[0] - first < s->height ? s->shape[0] - first : s->height;
  HDF5_TRY(v->at, memory = H5Screate_simple(s->rank, count, NULL), "read %s", name);
  HDF5_TRY(v->at, H5Sselect_hyperslab(s->space, H5S_SELECT_SET, start, NULL, count, NULL), "read %s", name);
  HDF5_TRY(v->at, H5Dread(s->set, s->type, memory, s->space, H5P_DEFAULT, bytes), "read %s", name);
out:
  return hdf5_close(v->at, memory, code);
}

static int read_slabs(const verifier *v, const char *name, const slabs *s) {
  int code = 0;
  if (s->row_bytes == 0 || s->shape[0] == 0)
    return 0;
  unsigned char *bytes = malloc(s->height * s->row_bytes);
  if (!bytes)
    return refuse(v->at->why, EXIT_RUN, "%s: out of memory for %llu rows of %s", v->at->path,
                  (unsigned long long)s->height, name);
  for (hsize_t first = 0; !code && first < s->shape[0]; first += s->height) {
    code = result_ask(v->stop, v->at);
    if (!code)
      code = read_slab(v, name, s, first, bytes);
  }
  free(bytes);
  return code;
}

/* --- how a data set is stored --- */

/* Requires chunks with a checksum, without which reading verifies nothing; sets the height of a slab. */
static int check_storage(const verifier *v, const char *name, slabs *s) {
  int code = 0;
  hsize_t chunk[H5S_MAX_RANK];
  hid_t list = H5I_INVALID_HID;
  unsigned flags;
  size_t values = 0;
  HDF5_TRY(v->at, list = H5Dget_create_plist(s->set), "read %s", name);
  HDF5_TRY(v->at, H5Pget_chunk(list, s->rank, chunk), "read the chunks of %s", name);
  HDF5_TRY(v->at, H5Pget_filter_by_id2(list, H5Z_FILTER_FLETCHER32, &flags, &values, NULL, 0, NULL, NULL),
           "find the checksum of %s", name);
  s->height = chunk[0] < s->shape[0] ? chunk[0] : s->shape[0];
  s->row_bytes = H5Tget_size(s->type);
  for (int i = 1; i < s->rank; i++)
    s->row_bytes *= s->shape[i]; /* cannot overflow: the extent was checked */
out:
  return hdf5_close(v->at, list, code);
}

/* Every axis is attached to the scale that the attribute `axes` names; a scale is its own axis. */
static int check_axes(const verifier *v, const char *name, const slabs *s) {
  char axes[256], *rest = axes;
  hid_t scale = H5I_INVALID_HID;
  htri_t good = 1;
  int code = attribute_text_into(v->at, s->set, "axes", axes, sizeof axes);
  for (int i = 0; !code && good && i < s->rank; i++) {
    char *axis = rest;
    rest += strcspn(rest, " ");
    if (*rest)
      *rest++ = '\0';
    HDF5_TRY(v->at, scale = H5Dopen2(v->file, axis[0] ? axis : "?", H5P_DEFAULT), "find axis %d of %s", i, name);
    if (strcmp(axis, name) == 0)
      good = H5DSis_scale(scale);
    else
      good = H5DSis_attached(s->set, scale, (unsigned)i);
    HDF5_TRY(v->at, good, "find axis %d of %s", i, name);
    code = hdf5_close(v->at, scale, 0);
    scale = H5I_INVALID_HID;
  }
  if (!code && !good)
    code = refuse(v->at->why, EXIT_FILES, "%s: an axis of %s is not attached to its scale", v->at->path, name);
out:
  return hdf5_close(v->at, scale, code);
}

static int check_set(const verifier *v, const char *name) {
  int code = 0;
  slabs s = {.set = H5I_INVALID_HID, .type = H5I_INVALID_HID, .space = H5I_INVALID_HID};
  uint64_t shape[H5S_MAX_RANK];
  HDF5_TRY(v->at, s.set = H5Dopen2(v->file, name, H5P_DEFAULT), "open %s", name);
  HDF5_TRY(v->at, s.type = H5Dget_type(s.set), "read %s", name);
  HDF5_TRY(v->at, s.space = H5Dget_space(s.set), "read %s", name);
  HDF5_TRY(v->at, s.rank = H5Sget_simple_extent_dims(s.space, s.shape, NULL), "read %s", name);
  for (int i = 0; i < s.rank; i++)
    shape[i] = s.shape[i];
  code = reader_check_storage(v->at, s.set, name, s.rank, shape, H5Tget_size(s.type));
  if (!code)
    code = check_storage(v, name, &s);
  if (!code)
    code = check_axes(v, name, &s);
  if (!code && v->with_rows)
    code = read_slabs(v, name, &s);
out:
  code = hdf5_close(v->at, s.space, code);
  code = hdf5_close(v->at, s.type, code);
  return hdf5_close(v->at, s.set, code);
}

/* --- the whole file --- */

static int check_sets(const verifier *v, const char *group_name) {
  reader_names names = {0};
  hid_t group = H5Gopen2(v->file, group_name, H5P_DEFAULT);
  if (group < 0)
    return hdf5_refuse(v->at, "open %s", group_name);
  int code = reader_list(v->at, group, false, &names);
  for (size_t i = 0; !code && i < names.count; i++) {
    char name[1024];
    bool root = strcmp(group_name, "/") == 0;
    snprintf(name, sizeof name, "%s%s%s", root ? "" : group_name, root ? "" : "/", names.at[i]);
    code = check_set(v, name);
  }
  reader_names_clear(&names);
  return hdf5_close(v->at, group, code);
}

static int check_groups(const verifier *v) {
  reader_names names;
  int code = reader_list(v->at, v->file, true, &names);
  for (size_t i = 0; !code && i < names.count; i++)
    code = check_sets(v, names.at[i]);
  reader_names_clear(&names);
  return code;
}

static int check_study(const verifier *v) {
  char *text;
  int code = attribute_checked_text(v->at, v->file, "study", &text);
  free(text);
  return code;
}

/* --- comparison with the plan --- */

static int check_shape(const verifier *v, const char *group, const char *name, int rank, const hsize_t *expected) {
  int code = 0;
  hid_t set = H5I_INVALID_HID, space = H5I_INVALID_HID;
  hsize_t shape[H5S_MAX_RANK];
  char path[512];
  snprintf(path, sizeof path, "%s/%s", group, name);
  HDF5_TRY(v->at, set = H5Dopen2(v->file, path, H5P_DEFAULT), "open %s", path);
  HDF5_TRY(v->at, space = H5Dget_space(set), "read %s", path);
  if (H5Sget_simple_extent_ndims(space) != rank || H5Sget_simple_extent_dims(space, shape, NULL) != rank ||
      memcmp(shape, expected, (size_t)rank * sizeof *shape) != 0)
    code = refuse(v->at->why, EXIT_FILES, "%s: %s was written with another shape than it has", v->at->path, path);
out:
  code = hdf5_close(v->at, space, code);
  return hdf5_close(v->at, set, code);
}

static int check_expected(const verifier *v, const plan *expected) {
  int code = 0;
  for (size_t i = 0; !code && i < expected->scale_count; i++)
    code = check_shape(v, "", expected->scales[i].name, 1, &(hsize_t){expected->scales[i].extent});
  for (size_t i = 0; i < expected->table_count; i++) {
    const result_table *t = &expected->tables[i];
    for (size_t k = 0; !code && k < t->layout->column_count; k++) {
      const column *c = &t->layout->columns[k];
      hsize_t shape[PLAN_MOST_AXES];
      const int rank = data_set_shape(c, t->rows, shape);
      code = check_shape(v, t->layout->group, c->name, rank, shape);
    }
  }
  return code;
}

int verify_file(const file_place *at, const char *path, const plan *expected, ric_poll stop) {
  verifier v = {.at = at, .stop = stop, .with_rows = !expected};
  int code = reader_open(at, path, &v.file);
  if (code)
    return code;
  code = heap_check(at, v.file, path); /* before check_axes makes HDF5 read the heaps */
  if (!code)
    code = check_study(&v);
  if (!code && expected)
    code = check_expected(&v, expected);
  if (!code)
    code = check_sets(&v, "/");
  if (!code)
    code = check_groups(&v);
  if (!code)
    code = check_values(at, v.file);
  if (!code)
    code = objects_check(at, v.file);
  return hdf5_close(at, v.file, code);
}

int result_verify(const char *path, ric_poll stop, message *why) {
  const file_place at = {path, why};
  return verify_file(&at, path, NULL, stop);
}

int result_study_digest(const char *path, uint64_t *digest, message *why) {
  const file_place at = {path, why};
  char text[32], *end;
  hid_t file;
  int code = reader_open(&at, path, &file);
  if (code)
    return code;
  code = attribute_text_into(&at, file, "study_digest", text, sizeof text);
  if (!code) {
    *digest = strtoull(text, &end, 16);
    if (end != text + 16 || *end)
      code = refuse(why, EXIT_FILES, "%s: study_digest = \"%s\", expected 16 hexadecimal digits", path, text);
  }
  return hdf5_close(&at, file, code);
}
