#include "skeleton.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "attribute.h"
#include "chunks.h"
#include "data_set.h"
#include "verify.h"

/* --- properties --- */

/* A group or file whose links keep the order they were made in, as `show` lists them. */
static hid_t group_properties(hid_t class) {
  hid_t list = H5Pcreate(class);
  if (list < 0)
    return list;
  if (H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0 &&
      H5Pset_attr_phase_change(list, ATTRIBUTE_MOST_COMPACT, 0) >= 0 && H5Pset_obj_track_times(list, false) >= 0)
    return list;
  (void)H5Pclose(list);
  return H5I_INVALID_HID;
}

hid_t skeleton_access(void) {
  hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  if (list < 0 || H5Pset_libver_bounds(list, H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0)
    return list;
  (void)H5Pclose(list);
  return H5I_INVALID_HID;
}

/* --- groups --- */

/* Opens a group, which an earlier table of the same group may have made. */
static int open_group(const file_place *at, hid_t file, const char *name, hid_t *group) {
  int code = 0;
  hid_t list = H5I_INVALID_HID;
  htri_t exists;
  HDF5_TRY(at, exists = H5Lexists(file, name, H5P_DEFAULT), "create /%s", name);
  if (exists) {
    HDF5_TRY(at, *group = H5Gopen2(file, name, H5P_DEFAULT), "open /%s", name);
    return 0;
  }
  HDF5_TRY(at, list = group_properties(H5P_GROUP_CREATE), "create /%s", name);
  HDF5_TRY(at, *group = H5Gcreate2(file, name, H5P_DEFAULT, list, H5P_DEFAULT), "create /%s", name);
out:
  return hdf5_close(at, list, code);
}

static int create_table(const file_place *at, hid_t file, const result_table *t) {
  hid_t group = H5I_INVALID_HID;
  int code = open_group(at, file, t->layout->group, &group);
  for (size_t k = 0; !code && k < t->layout->column_count; k++)
    code = data_set_create(at, file, group, t, &t->layout->columns[k]);
  return hdf5_close(at, group, code);
}

/* The grid of the sweeps: their names, and the number of points of each in order. */
static int put_grid(const file_place *at, hid_t file, const study *s) {
  hid_t group = H5I_INVALID_HID;
  int64_t grid[STUDY_MAX_SWEEPS];
  char names[STUDY_MAX_SWEEPS * (sizeof(study_sweep) + 1)] = "";
  size_t sweeps = study_sweeps(s);
  for (size_t k = 0; k < sweeps; k++) {
    const study_sweep *sweep = study_sweep_at(s, k);
    grid[k] = (int64_t)sweep->points;
    strcat(strcat(names, k ? " " : ""), sweep->name);
  }
  int code = open_group(at, file, "sweep", &group);
  if (!code)
    code = attribute_put_text(at, group, "parameters", names);
  if (!code && sweeps > 0)
    code = attribute_put_list(at, group, "grid", H5T_STD_I64LE, H5T_NATIVE_INT64, sweeps, grid);
  return hdf5_close(at, group, code);
}

/* --- the values of the study --- */

typedef struct study_writer {
  const file_place *at;
  hid_t group;
  records given; /* paths of keys, `const char *` */
} study_writer;

static int put_values(const study_writer *w, const study_entry *e, hid_t file_type, hid_t memory_type,
                      const void *values) {
  const char *path = e->key->path;
  return e->list ? attribute_put_list(w->at, w->group, path, file_type, memory_type, e->count, values)
                 : attribute_put_scalar(w->at, w->group, path, file_type, memory_type, values);
}

/* Null is NaN, which makes numbers of integers. */
static int put_numbers(const study_writer *w, const study_entry *e) {
  double *values = calloc(e->count + 1, sizeof *values);
  bool whole = e->key->type == VALUE_INTEGER;
  if (!values)
    return refuse(w->at->why, EXIT_RUN, "%s: out of memory", w->at->path);
  for (size_t i = 0; i < e->count; i++) {
    values[i] = isinf(e->numbers[i]) ? NAN : e->numbers[i];
    whole = whole && !isnan(values[i]);
  }
  int code = put_values(w, e, whole ? H5T_STD_I64LE : H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values);
  free(values);
  return code;
}

/* A flag as h5py writes and reads it. */
static int put_flag(const study_writer *w, const study_entry *e) {
  int code = 0;
  const signed char no = 0, yes = 1;
  hid_t type = H5I_INVALID_HID;
  HDF5_TRY(w->at, type = H5Tenum_create(H5T_STD_I8LE), "describe /study/%s", e->key->path);
  HDF5_TRY(w->at, H5Tenum_insert(type, "FALSE", &no), "describe /study/%s", e->key->path);
  HDF5_TRY(w->at, H5Tenum_insert(type, "TRUE", &yes), "describe /study/%s", e->key->path);
  code = attribute_put_scalar(w->at, w->group, e->key->path, type, type, e->numbers[0] != 0 ? &yes : &no);
out:
  return hdf5_close(w->at, type, code);
}

/* Words of a list are places among those of the key, "fold|grazing". */
static int put_words(const study_writer *w, const study_entry *e) {
  char *words = strdup(e->key->words);
  const char **texts = calloc(e->count + 1, sizeof *texts);
  int code = words && texts ? 0 : refuse(w->at->why, EXIT_RUN, "%s: out of memory", w->at->path);
  double place = 0;
  for (char *word = code ? NULL : strtok(words, "|"); word; word = strtok(NULL, "|"), place++)
    for (size_t i = 0; i < e->count; i++)
      if (e->numbers[i] == place)
        texts[i] = word;
  if (!code)
    code = attribute_put_texts(w->at, w->group, e->key->path, e->count, texts);
  free(texts);
  free(words);
  return code;
}

static int put_value(const study_writer *w, const study_entry *e) {
  if (e->text)
    return attribute_put_text(w->at, w->group, e->key->path, e->text);
  if (e->key->type == VALUE_WORD)
    return put_words(w, e);
  return e->key->type == VALUE_FLAG ? put_flag(w, e) : put_numbers(w, e);
}

static int put_entry(void *user, const study_entry *e, message *why) {
  study_writer *w = user;
  const char *units = e->key->units;
  int code = put_value(w, e);
  if (!code && units && *units && strcmp(units, "1") != 0) {
    char name[128];
    snprintf(name, sizeof name, "%s:units", e->key->path);
    code = attribute_put_text(w->at, w->group, name, units);
  }
  if (code || !e->given)
    return code;
  unsigned char *added = records_add(&w->given);
  if (!added)
    return refuse(why, EXIT_RUN, "%s: out of memory", w->at->path);
  memcpy(added, &e->key->path, sizeof e->key->path);
  return 0;
}

/* Every parameter of the study with its type, so that no reader needs the YAML text or the defaults. */
static int put_study(const file_place *at, hid_t file, const study *s) {
  study_writer w = {.at = at, .group = H5I_INVALID_HID, .given = {.record_bytes = sizeof(const char *)}};
  const char *swept[STUDY_MAX_SWEEPS];
  size_t sweeps = study_sweeps(s);
  for (size_t k = 0; k < sweeps; k++)
    swept[k] = study_sweep_at(s, k)->name;
  int code = open_group(at, file, "study", &w.group);
  if (!code)
    code = study_each(s, put_entry, &w, at->why);
  if (!code)
    code = attribute_put_texts(at, w.group, "swept", sweeps, swept);
  if (!code)
    code = attribute_put_texts(at, w.group, "given", w.given.count, (const char *const *)(void *)w.given.bytes);
  records_clear(&w.given);
  code = hdf5_close(at, w.group, code);
  return code ? code : study_put_checksum(at, file);
}

/* --- the file's own attributes --- */

/* ISO 8601. */
static void utc_text(time_t at, char *text, size_t size) {
  struct tm utc;
  if (!gmtime_r(&at, &utc) || strftime(text, size, "%Y-%m-%dT%H:%M:%SZ", &utc) == 0)
    snprintf(text, size, "unknown");
}

static int put_root(const file_place *at, hid_t file, const result_header *header) {
  char digest[17], now[32];
  snprintf(digest, sizeof digest, "%016llx", (unsigned long long)study_digest(header->study));
  utc_text(time(NULL), now, sizeof now);
  const char *const texts[][2] = {
      {"creator", RESULT_CREATOR},    {"creator_version", header->version},
      {"study_digest", digest},       {"command", header->command},
      {"git_sha", header->git_sha},   {"libraries", header->libraries},
      {"compiler", header->compiler}, {"file_time", now},
  };
  int code = attribute_put_integer(at, file, "schema_version", RESULT_SCHEMA_VERSION);
  for (size_t i = 0; !code && i < sizeof texts / sizeof texts[0]; i++)
    code = attribute_put_text(at, file, texts[i][0], texts[i][1]);
  if (!code)
    code = attribute_put_text(at, file, "title", study_title(header->study));
  if (!code)
    code = attribute_put_checked_text(at, file, "study", study_text(header->study));
  return code;
}

/* Everything that differs between two runs of one study is here, except the attributes file_time and command. */
static int put_run(const file_place *at, hid_t file, const result_header *header) {
  char host[256] = "unknown", started[32], arithmetic[17] = "mixed";
  hid_t group = H5I_INVALID_HID;
  if (gethostname(host, sizeof host - 1) != 0)
    strcpy(host, "unknown");
  utc_text(time(NULL) - (time_t)header->total_seconds, started, sizeof started);
  if (!header->mixed)
    snprintf(arithmetic, sizeof arithmetic, "%016llx", (unsigned long long)header->arithmetic);
  int code = open_group(at, file, "run", &group);
  if (!code)
    code = attribute_put_text(at, group, "host", host);
  if (!code)
    code = attribute_put_text(at, group, "started", started);
  if (!code)
    code = attribute_put_text(at, group, "arithmetic", arithmetic);
  if (!code)
    code = attribute_put_integer(at, group, "ranks", header->ranks);
  if (!code)
    code = attribute_put_integer(at, group, "tasks_computed", (int64_t)header->tasks_computed);
  if (!code)
    code = attribute_put_integer(at, group, "tasks_resumed", (int64_t)header->tasks_resumed);
  if (!code)
    code = attribute_put_number(at, group, "compute_seconds", header->compute_seconds);
  if (!code)
    code = attribute_put_number(at, group, "total_seconds", header->total_seconds);
  return hdf5_close(at, group, code);
}

/* --- the file --- */

static int fill(const file_place *at, hid_t file, const plan *p) {
  int code = put_root(at, file, p->header);
  for (size_t i = 0; !code && i < p->scale_count; i++)
    code = data_set_create_scale(at, file, &p->scales[i]);
  for (size_t i = 0; !code && i < p->table_count; i++)
    code = create_table(at, file, &p->tables[i]);
  if (!code)
    code = put_grid(at, file, p->header->study);
  if (!code)
    code = put_study(at, file, p->header->study);
  return code ? code : put_run(at, file, p->header);
}

/* The file in memory: HDF5's memory driver allocates by these callbacks, so that the bytes remain after the file is
 * closed. (H5Fget_file_image, of a file still open, gives a superblock whose checksum is wrong.) */

static void *image_resize(void *bytes, size_t size, H5FD_file_image_op_t op, void *user) {
  skeleton_image *image = user;
  (void)op;
  void *resized = realloc(bytes, size);
  if (resized)
    *image = (skeleton_image){resized, size};
  return resized;
}

static void *image_malloc(size_t size, H5FD_file_image_op_t op, void *user) {
  return image_resize(NULL, size, op, user);
}

static void *image_copy(void *to, const void *from, size_t size, H5FD_file_image_op_t op, void *user) {
  (void)op;
  (void)user;
  return memcpy(to, from, size);
}

static herr_t image_keep(void *bytes, H5FD_file_image_op_t op, void *user) {
  (void)bytes;
  (void)op;
  (void)user;
  return 0;
}

static void *user_share(void *user) {
  return user;
}

static herr_t user_keep(void *user) {
  (void)user;
  return 0;
}

/* HDF5 opens a file of the given name, if there is one, and the memory driver reads it whole. */
static const char no_file[] = "/dev/null/image";

static int create_in_memory(const file_place *at, skeleton_image *image, hid_t *file) {
  int code = 0;
  hid_t access = H5I_INVALID_HID, list = H5I_INVALID_HID;
  enum { GROWTH = 1 << 16 }; /* bytes by which the file grows */
  H5FD_file_image_callbacks_t callbacks = {image_malloc, image_copy, image_resize, image_keep,
                                           user_share,   user_keep,  image};
  HDF5_TRY(at, access = skeleton_access(), "make its image");
  HDF5_TRY(at, H5Pset_fapl_core(access, GROWTH, false), "make its image");
  HDF5_TRY(at, H5Pset_file_image_callbacks(access, &callbacks), "make its image");
  HDF5_TRY(at, list = group_properties(H5P_FILE_CREATE), "make its image");
  HDF5_TRY(at, *file = H5Fcreate(no_file, H5F_ACC_TRUNC, list, access), "make its image");
out:
  code = hdf5_close(at, list, code);
  return hdf5_close(at, access, code);
}

/* Makes the skeleton in memory: all groups, attributes, axes and empty data sets. The caller frees `image->bytes`,
 * also after a failure. */
static int skeleton_make(const plan *p, const file_place *at, skeleton_image *image) {
  hid_t file = H5I_INVALID_HID;
  *image = (skeleton_image){NULL, 0};
  int code = create_in_memory(at, image, &file);
  if (!code)
    code = fill(at, file, p);
  return hdf5_close(at, file, code);
}

/* --- bytes and space, without HDF5 --- */

enum { PIECE_BYTES = 16 << 20, RESERVED_BYTES = 256 << 20 /* at a time */ };

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

/* Piece by piece: a file system without reservation of its own writes to every block. */
static int reserve(int handle, uint64_t bytes, ric_poll stop) {
  int failed = 0;
  for (uint64_t done = 0; (!failed || failed == EINTR) && done < bytes;) {
    const uint64_t left = bytes - done, step = left < RESERVED_BYTES ? left : RESERVED_BYTES;
    failed = ric_poll_stops(stop) ? ECANCELED : posix_fallocate(handle, (off_t)done, (off_t)step);
    done += failed ? 0 : step;
  }
  return failed == EINVAL || failed == EOPNOTSUPP
             ? 0
             : failed; /* a file system without reservation: the write may fail later */
}

/* The image, a piece at a time. @returns 0, an error of the system, or ECANCELED to stop */
static int write_pieces(int handle, const skeleton_image *image, ric_poll stop) {
  int failed = 0;
  for (size_t done = 0; !failed && done < image->size; done += PIECE_BYTES) {
    const size_t left = image->size - done;
    failed = ric_poll_stops(stop) ? ECANCELED
                                  : write_all(handle, image->bytes + done, left < PIECE_BYTES ? left : PIECE_BYTES);
  }
  return failed;
}

static int write_image(const plan *p, const file_place *at, const skeleton_image *image) {
  int handle = open(p->partial, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (handle < 0)
    return refuse(at->why, EXIT_FILES, "%s: cannot create it: %s", at->path, strerror(errno));
  uint64_t total = image->size + plan_bytes(p);
  int failed = write_pieces(handle, image, p->stop);
  if (!failed)
    failed = reserve(handle, total, p->stop);
  if (close(handle) != 0 && !failed)
    failed = errno;
  if (!failed || failed == ECANCELED)
    return failed ? result_stopped(at) : 0;
  return refuse(at->why, EXIT_FILES, "%s: cannot write its %llu bytes: %s", at->path, (unsigned long long)total,
                strerror(failed));
}

/* --- layout of the chunks --- */

/* HDF5 writes zeros to every chunk that it allocates. Ranks overwrite all of them, and until then the reserved space
 * reads as zeros, whose checksum is zero: those writes are left out. They would take as long as all rows. */
static herr_t write_metadata(H5FD_t *file, H5FD_mem_t type, hid_t transfer, haddr_t address, size_t size,
                             const void *bytes) {
  void *handle;
  (void)transfer;
  if (type == H5FD_MEM_DRAW)
    return 0;
  if (file->cls->get_handle(file, H5P_DEFAULT, &handle) < 0)
    return -1;
  const int failed = chunks_write_at(*(int *)handle, bytes, size, address);
  if (failed)
    (void)H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_IO, H5E_WRITEERROR, "%s",
                   strerror(failed));
  return failed ? -1 : 0;
}

/* HDF5's driver of plain files, but with the function above. Negative on failure. */
static hid_t layout_driver(const char *path, hid_t access) {
  H5FD_t *plain = H5FDopen(path, H5F_ACC_RDONLY, access, HADDR_UNDEF);
  if (!plain)
    return H5I_INVALID_HID;
  H5FD_class_t class = *plain->cls;
  class.name = "ricochet_layout";
  class.write = write_metadata;
  return H5FDclose(plain) < 0 ? H5I_INVALID_HID : H5FDregister(&class);
}

/* The first write to a data set allocates all its chunks; one value is enough. */
static int touch(const file_place *at, hid_t set, const char *name, const column *c) {
  int code = 0;
  hid_t in_file = H5I_INVALID_HID, in_memory = H5I_INVALID_HID, type = H5I_INVALID_HID;
  const hsize_t first[PLAN_MOST_AXES] = {0}, one[PLAN_MOST_AXES] = {1, 1, 1};
  unsigned char *zero = calloc(1, column_value_bytes(c));
  if (!zero)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  HDF5_TRY(at, type = data_set_type(c), "lay out %s", name);
  HDF5_TRY(at, in_file = H5Dget_space(set), "lay out %s", name);
  HDF5_TRY(at, H5Sselect_hyperslab(in_file, H5S_SELECT_SET, first, NULL, one, NULL), "lay out %s", name);
  HDF5_TRY(at, in_memory = H5Screate_simple(1, one, NULL), "lay out %s", name);
  HDF5_TRY(at, H5Dwrite(set, type, in_memory, in_file, H5P_DEFAULT, zero), "lay out %s", name);
  HDF5_TRY(at, H5Dflush(set), "lay out %s", name);
out:
  code = hdf5_close(at, in_memory, code);
  code = hdf5_close(at, in_file, code);
  code = hdf5_close(at, type, code);
  free(zero);
  return code;
}

/* Allocates the chunks of data set number `set`, and finds them. */
static int lay_out_set(const file_place *at, hid_t file, const result_table *t, const column *c, uint64_t set,
                       chunk_places *places) {
  int code = 0;
  hid_t data_set = H5I_INVALID_HID;
  const chunk_grid g = chunk_grid_of(t, c);
  char name[512];
  snprintf(name, sizeof name, "/%s/%s", t->layout->group, c->name);
  HDF5_TRY(at, data_set = H5Dopen2(file, name, H5P_DEFAULT), "lay out %s", name);
  code = touch(at, data_set, name, c);
  if (!code)
    code = chunks_find(places, at, data_set, set, &g);
out:
  return hdf5_close(at, data_set, code);
}

static int lay_out_chunks(const plan *p, const file_place *at, const skeleton_image *image, chunk_places *places) {
  int code = 0;
  uint64_t set = 0;
  hid_t access = H5I_INVALID_HID, driver = H5I_INVALID_HID, file = H5I_INVALID_HID;
  HDF5_TRY(at, access = skeleton_access(), "lay it out");
  HDF5_TRY(at, driver = layout_driver(p->partial, access), "lay it out");
  HDF5_TRY(at, H5Pset_driver(access, driver, NULL), "lay it out");
  HDF5_TRY(at, file = H5Fopen(p->partial, H5F_ACC_RDWR, access), "lay it out");
  for (size_t i = 0; i < p->stored_count; i++)
    for (size_t k = 0; !code && k < p->tables[i].layout->column_count; k++, set++)
      if (p->tables[i].rows > 0 && column_values(&p->tables[i].layout->columns[k]) > 0) {
        code = result_ask(p->stop, at);
        if (!code)
          code = lay_out_set(at, file, &p->tables[i], &p->tables[i].layout->columns[k], set, places);
      }
  if (!code)
    code = heap_put_checksums(at, file, image);
out:
  code = hdf5_close(at, file, code);
  code = hdf5_close(at, access, code);
  return hdf5_close(at, driver, code);
}

int space_create(const plan *p, const file_place *at, chunk_places *places) {
  skeleton_image image;
  int code = skeleton_make(p, at, &image);
  if (!code)
    code = write_image(p, at, &image);
  if (!code)
    code = lay_out_chunks(p, at, &image, places);
  free(image.bytes);
  return code;
}
