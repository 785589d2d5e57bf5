#include "reader.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "attribute.h"
#include "hdf5_call.h"
#include "result.h"

/* --- the file --- */

static int check_creator(const file_place *at, hid_t file) {
  char creator[64] = "";
  int64_t version = 0;
  int code = attribute_text_if_there(at, file, "creator", creator, sizeof creator);
  if (code)
    return code;
  if (strcmp(creator, RESULT_CREATOR) != 0)
    return refuse(at->why, EXIT_FILES, "%s: not a result of ricochet (attribute creator = \"%s\")", at->path, creator);
  code = attribute_integer(at, file, "schema_version", &version);
  if (!code && (version < 1 || version > RESULT_SCHEMA_VERSION))
    code = refuse(at->why, EXIT_FILES, "%s: schema_version = %lld, this program reads 1 to %d", at->path,
                  (long long)version, RESULT_SCHEMA_VERSION);
  return code;
}

_Static_assert(sizeof(reader_handle) == sizeof(hid_t), "handles are those of HDF5");
_Static_assert((int)READER_MAX_RANK == H5S_MAX_RANK, "every data set has a place for its shape");

int reader_close(const file_place *at, reader_handle file, int code) {
  return hdf5_close(at, file, code);
}

int reader_open(const file_place *at, const char *path, reader_handle *file) {
  int code = 0;
  struct stat about;
  htri_t known;
  *file = H5I_INVALID_HID;
  code = hdf5_start(at);
  if (code)
    return code;
  if (stat(path, &about) != 0)
    return refuse(at->why, EXIT_FILES, "%s: cannot open it: %s", at->path, strerror(errno));
  if (!S_ISREG(about.st_mode))
    return refuse(at->why, EXIT_FILES, "%s: not a regular file", at->path);
  HDF5_TRY(at, known = H5Fis_hdf5(path), "open it");
  if (!known)
    return refuse(at->why, EXIT_FILES, "%s: not an HDF5 file, or its beginning is damaged", at->path);
  HDF5_TRY(at, *file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), "open it");
  code = check_creator(at, *file);
  if (code) {
    code = hdf5_close(at, *file, code);
    *file = H5I_INVALID_HID;
  }
out:
  return code;
}

/* --- names --- */

static uint64_t file_bytes_of(hid_t object) {
  hsize_t bytes = 0;
  const hid_t file = H5Iget_file_id(object);
  if (file < 0 || H5Fget_filesize(file, &bytes) < 0)
    bytes = 0;
  (void)H5Fclose(file);
  return bytes;
}

static bool has_controls(const char *name) {
  char shown[4096];
  escape_text(name, shown, sizeof shown);
  return strcmp(shown, name) != 0;
}

static int link_name(const file_place *at, hid_t group, hsize_t i, char **name) {
  ssize_t length = H5Lget_name_by_idx(group, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, i, NULL, 0, H5P_DEFAULT);
  if (length < 0)
    return hdf5_refuse(at, "list it");
  *name = malloc((size_t)length + 1);
  if (!*name)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  int code = 0;
  if (H5Lget_name_by_idx(group, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, i, *name, (size_t)length + 1, H5P_DEFAULT) < 0)
    code = hdf5_refuse(at, "list it");
  else if (has_controls(*name))
    code = refuse(at->why, EXIT_FILES, "%s: the name of an object in it has control characters", at->path);
  else
    return 0;
  free(*name);
  return code;
}

/* Opens what a link leads to: an object of this file, which no result refers to in any other way. */
static int open_linked(const file_place *at, hid_t group, const char *name, hid_t *object) {
  H5L_info_t link;
  if (H5Lget_info(group, name, &link, H5P_DEFAULT) < 0)
    return hdf5_refuse(at, "open %s", name);
  if (link.type != H5L_TYPE_HARD)
    return refuse(at->why, EXIT_FILES, "%s: %s is a link to somewhere else, expected an object", at->path, name);
  *object = H5Oopen(group, name, H5P_DEFAULT);
  return *object < 0 ? hdf5_refuse(at, "open %s", name) : 0;
}

/* Appends the i-th link when it leads to an object of the type asked for. */
static int list_link(const file_place *at, hid_t group, hsize_t i, H5I_type_t type, reader_names *names) {
  char *name = NULL;
  hid_t object = H5I_INVALID_HID;
  int code = link_name(at, group, i, &name);
  if (code)
    return code;
  code = open_linked(at, group, name, &object);
  if (object >= 0 && H5Iget_type(object) == type)
    names->at[names->count++] = name;
  else
    free(name);
  return hdf5_close(at, object, code);
}

int reader_list(const file_place *at, reader_handle group, bool groups, reader_names *names) {
  const H5I_type_t type = groups ? H5I_GROUP : H5I_DATASET;
  H5G_info_t info;
  *names = (reader_names){0};
  if (H5Gget_info(group, &info) < 0)
    return hdf5_refuse(at, "list it");
  if (info.nlinks > file_bytes_of(group))
    return refuse(at->why, EXIT_FILES, "%s: damaged: a group claims more objects than the file can hold", at->path);
  names->at = calloc((size_t)info.nlinks + 1, sizeof *names->at);
  if (!names->at)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  int code = 0;
  for (hsize_t i = 0; !code && i < info.nlinks; i++)
    code = list_link(at, group, i, type, names);
  if (code)
    reader_names_clear(names);
  return code;
}

void reader_names_clear(reader_names *names) {
  for (size_t i = 0; i < names->count; i++)
    free(names->at[i]);
  free(names->at);
  *names = (reader_names){0};
}

/* --- data sets --- */

static int read_words(const file_place *at, reader_set *s) {
  int count = H5Tget_nmembers(s->memory);
  if (count < 0 || H5Tget_size(s->memory) != 1)
    return refuse(at->why, EXIT_FILES, "%s: %s is an enum of another size than one byte", at->path, s->name);
  for (unsigned i = 0; i < (unsigned)count; i++) {
    signed char value;
    char *word = H5Tget_member_name(s->memory, i);
    if (!word || H5Tget_member_value(s->memory, i, &value) < 0)
      return hdf5_refuse(at, "read the words of %s", s->name);
    char shown[256];
    escape_text(word, shown, sizeof shown);
    if (value >= 0 && !s->words[value])
      s->words[value] = strdup(shown);
    if (H5free_memory(word) < 0)
      return hdf5_refuse(at, "read the words of %s", s->name);
  }
  return 0;
}

/* Whether a compound is {r, i} of two doubles, side by side. */
static bool is_complex(hid_t type) {
  static const char *const names[] = {"r", "i"};
  bool so = H5Tget_nmembers(type) == 2 && H5Tget_size(type) == 2 * sizeof(double);
  for (unsigned k = 0; so && k < 2; k++) {
    char *name = H5Tget_member_name(type, k);
    hid_t member = H5Tget_member_type(type, k);
    so = name && strcmp(name, names[k]) == 0 && member >= 0 && H5Tequal(member, H5T_NATIVE_DOUBLE) > 0 &&
         H5Tget_member_offset(type, k) == k * sizeof(double);
    (void)H5Tclose(member);
    (void)H5free_memory(name);
  }
  return so;
}

static reader_type type_of(hid_t type) {
  switch (H5Tget_class(type)) {
  case H5T_FLOAT:
    return READER_NUMBER;
  case H5T_INTEGER:
    return READER_INTEGER;
  case H5T_ENUM:
    return READER_WORD;
  case H5T_STRING:
    return H5Tis_variable_str(type) == 0 ? READER_TEXT : READER_OTHER;
  case H5T_COMPOUND:
    return is_complex(type) ? READER_COMPLEX : READER_OTHER;
  default:
    return READER_OTHER;
  }
}

static int read_type(const file_place *at, reader_set *s) {
  int code = 0;
  hid_t type = H5I_INVALID_HID;
  HDF5_TRY(at, type = H5Dget_type(s->id), "read the type of %s", s->name);
  s->type = type_of(type);
  HDF5_TRY(at,
           s->memory = H5Tcopy(s->type == READER_NUMBER    ? H5T_NATIVE_DOUBLE
                               : s->type == READER_INTEGER ? H5T_NATIVE_INT64
                                                           : type),
           "read the type of %s", s->name);
  s->value_bytes = H5Tget_size(s->memory);
  if (s->type == READER_WORD)
    code = read_words(at, s);
out:
  return hdf5_close(at, type, code);
}

/* Every chunk takes some bytes of the file, if only those of its checksum: each is looked up by itself. */
static bool chunks_fit(hid_t list, int rank, const uint64_t *shape, uint64_t file_bytes) {
  hsize_t chunk[H5S_MAX_RANK];
  uint64_t chunks = 1;
  if (H5Pget_layout(list) != H5D_CHUNKED || rank < 1)
    return true;
  bool fits = H5Pget_chunk(list, rank, chunk) == rank;
  for (int i = 0; fits && i < rank; i++)
    fits = !__builtin_mul_overflow(chunks, shape[i] / chunk[i] + (shape[i] % chunk[i] != 0), &chunks);
  return fits && chunks <= file_bytes;
}

static bool values_fit(int rank, const uint64_t *shape, size_t value_bytes, uint64_t file_bytes) {
  enum { TIGHTEST = 1032 };
  uint64_t bytes = value_bytes, most;
  bool fits = !__builtin_mul_overflow(file_bytes, TIGHTEST, &most);
  for (int i = 0; i < rank; i++)
    fits = fits && (shape[i] == 0 || !__builtin_mul_overflow(bytes, shape[i], &bytes));
  return fits && bytes <= most;
}

int reader_check_storage(const file_place *at, reader_handle set, const char *name, int rank, const uint64_t *shape,
                         size_t value_bytes) {
  int code = 0;
  hid_t list = H5I_INVALID_HID;
  const uint64_t file_bytes = file_bytes_of(set);
  HDF5_TRY(at, list = H5Dget_create_plist(set), "read %s", name);
  if (H5Pget_layout(list) == H5D_VIRTUAL || H5Pget_external_count(list) > 0) /* HDF5 would open that file */
    code = refuse(at->why, EXIT_FILES, "%s: the values of %s are in another file", at->path, name);
  else if (!values_fit(rank, shape, value_bytes, file_bytes) || !chunks_fit(list, rank, shape, file_bytes))
    code = refuse(at->why, EXIT_FILES, "%s: damaged: %s claims more values than the file can hold", at->path, name);
out:
  return hdf5_close(at, list, code);
}

static int read_shape(const file_place *at, reader_set *s) {
  int code = 0;
  hid_t space = H5I_INVALID_HID;
  hsize_t shape[H5S_MAX_RANK];
  HDF5_TRY(at, space = H5Dget_space(s->id), "read the shape of %s", s->name);
  HDF5_TRY(at, s->rank = H5Sget_simple_extent_dims(space, shape, NULL), "read the shape of %s", s->name);
  for (int i = 0; i < s->rank; i++)
    s->shape[i] = shape[i];
  code = reader_check_storage(at, s->id, s->name, s->rank, s->shape, s->value_bytes);
out:
  return hdf5_close(at, space, code);
}

static int open_set(const file_place *at, hid_t group, reader_set *s) {
  s->id = H5Dopen2(group, s->name, H5P_DEFAULT);
  if (s->id < 0)
    return hdf5_refuse(at, "open %s", s->name);
  int code = read_type(at, s);
  if (!code)
    code = read_shape(at, s);
  if (!code)
    code = attribute_text_into(at, s->id, "axes", s->axes, sizeof s->axes);
  if (!code)
    code = attribute_text_into(at, s->id, "units", s->units, sizeof s->units);
  if (!code)
    code = attribute_text_into(at, s->id, "long_name", s->long_name, sizeof s->long_name);
  if (!code)
    code = attribute_text_if_there(at, s->id, "parameter", s->parameter, sizeof s->parameter);
  return code ? code : attribute_text_if_there(at, s->id, "observed", s->observed, sizeof s->observed);
}

static int open_sets(const file_place *at, hid_t group, reader_group *g) {
  reader_names names;
  int code = reader_list(at, group, false, &names);
  if (code)
    return code;
  g->sets = calloc(names.count + 1, sizeof *g->sets);
  if (!g->sets)
    code = refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  while (!code && g->count < names.count) {
    reader_set *s = &g->sets[g->count];
    s->id = s->memory = H5I_INVALID_HID;
    s->name = names.at[g->count];
    names.at[g->count++] = NULL; /* the set owns it now */
    code = open_set(at, group, s);
  }
  reader_names_clear(&names);
  return code;
}

int reader_group_open(const file_place *at, reader_handle file, const char *name, reader_group *g) {
  *g = (reader_group){.name = strdup(name)};
  if (!g->name)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  hid_t group = H5Gopen2(file, name, H5P_DEFAULT);
  if (group < 0)
    return hdf5_refuse(at, "open /%s", name);
  return hdf5_close(at, group, open_sets(at, group, g));
}

void reader_group_clear(reader_group *g) {
  message ignored; /* nothing was written through these handles */
  const file_place nowhere = {"", &ignored};
  for (size_t i = 0; i < g->count; i++) {
    reader_set *s = &g->sets[i];
    (void)hdf5_close(&nowhere, s->memory, 0);
    (void)hdf5_close(&nowhere, s->id, 0);
    for (int k = 0; k < READER_MAX_WORDS; k++)
      free(s->words[k]);
    free(s->name);
  }
  free(g->sets);
  free(g->name);
  *g = (reader_group){0};
}

bool reader_has(reader_handle file, const char *name) {
  return H5Lexists(file, name, H5P_DEFAULT) > 0;
}

const reader_set *reader_find(const reader_group *g, const char *name) {
  for (size_t i = 0; i < g->count; i++)
    if (strcmp(g->sets[i].name, name) == 0)
      return &g->sets[i];
  return NULL;
}

const char *reader_parameter(const reader_set *s) {
  return s->parameter[0] ? s->parameter : s->long_name;
}

void reader_axis(const reader_set *s, int k, char *axis) {
  const char *at = s->axes;
  for (; k > 0 && *at; k--) {
    at += strcspn(at, " ");
    at += *at == ' ';
  }
  snprintf(axis, sizeof s->axes, "%.*s", (int)strcspn(at, " "), at);
}

bool reader_is_column(const reader_set *s, const char *axis) {
  return s->rank == 1 && s->type != READER_OTHER && strcmp(s->axes, axis) == 0;
}

/* --- values --- */

/* @param first, count  [rank] */
static int read_part(const file_place *at, const reader_set *s, const hsize_t *first, const hsize_t *count,
                     unsigned char *values) {
  int code = 0;
  hid_t in_file = H5I_INVALID_HID, in_memory = H5I_INVALID_HID;
  HDF5_TRY(at, in_file = H5Dget_space(s->id), "read %s", s->name);
  HDF5_TRY(at, H5Sselect_hyperslab(in_file, H5S_SELECT_SET, first, NULL, count, NULL), "read %s", s->name);
  HDF5_TRY(at, in_memory = H5Screate_simple(s->rank, count, NULL), "read %s", s->name);
  HDF5_TRY(at, H5Dread(s->id, s->memory, in_memory, in_file, H5P_DEFAULT, values), "read %s", s->name);
out:
  code = hdf5_close(at, in_memory, code);
  return hdf5_close(at, in_file, code);
}

uint64_t reader_width(const reader_set *s, int axes) {
  uint64_t width = 1;
  for (int i = axes; i < s->rank; i++)
    if (__builtin_mul_overflow(width, s->shape[i], &width))
      return 0;
  return width;
}

int reader_rows(const file_place *at, const reader_set *s, uint64_t first, uint64_t count, unsigned char *values) {
  hsize_t from[READER_MAX_RANK] = {first}, counts[READER_MAX_RANK];
  memcpy(counts, s->shape, sizeof counts);
  counts[0] = count;
  return read_part(at, s, from, counts, values);
}

int reader_part_of_row(const file_place *at, const reader_set *s, uint64_t row, uint64_t first, uint64_t count,
                       unsigned char *values) {
  hsize_t from[READER_MAX_RANK] = {row, first}, counts[READER_MAX_RANK];
  memcpy(counts, s->shape, sizeof counts);
  counts[0] = 1;
  counts[1] = count;
  return read_part(at, s, from, counts, values);
}

static void show_number(const unsigned char *value, int digits, char *text, size_t size) {
  double number;
  memcpy(&number, value, sizeof number);
  if (isnan(number)) /* printf would show the sign of some NaNs */
    snprintf(text, size, "nan");
  else
    snprintf(text, size, "%.*g", digits, number);
}

int reader_parts(const reader_set *s) {
  return s->type == READER_COMPLEX ? 2 : 1;
}

void reader_part(const reader_set *s, const unsigned char *value, int part, int digits, char *text, size_t size) {
  int64_t integer;
  signed char word = (signed char)value[0];
  switch (s->type) {
  case READER_NUMBER:
  case READER_COMPLEX:
    show_number(value + (size_t)part * sizeof(double), digits, text, size);
    break;
  case READER_INTEGER:
    memcpy(&integer, value, sizeof integer);
    snprintf(text, size, "%lld", (long long)integer);
    break;
  case READER_WORD:
    if (word >= 0 && s->words[word])
      snprintf(text, size, "%s", s->words[word]);
    else
      snprintf(text, size, "%d", word);
    break;
  case READER_TEXT:
    snprintf(text, size, "%.*s", (int)s->value_bytes, (const char *)value);
    break;
  case READER_OTHER:
    snprintf(text, size, "?");
    break;
  }
}

void reader_value(const reader_set *s, const unsigned char *value, int digits, char *text, size_t size) {
  char imaginary[64];
  reader_part(s, value, 0, digits, text, size);
  if (s->type == READER_TEXT) {
    char whole[1024];
    snprintf(whole, sizeof whole, "%s", text);
    escape_text(whole, text, size);
  }
  if (s->type != READER_COMPLEX)
    return;
  reader_part(s, value, 1, digits, imaginary, sizeof imaginary);
  if (strcmp(text, "nan") == 0 && strcmp(imaginary, "nan") == 0)
    return; /* one is enough to say that there is no number */
  size_t used = strlen(text);
  snprintf(text + used, size - used, "%s%si", imaginary[0] == '-' ? "" : "+", imaginary);
}

int reader_cell(const file_place *at, const reader_set *s, uint64_t row, int digits, char *text, size_t size) {
  *text = '\0';
  if (!s || s->rank != 1 || row >= s->shape[0])
    return 0;
  unsigned char *value = calloc(1, s->value_bytes + 1);
  if (!value)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  const int code = reader_rows(at, s, row, 1, value);
  if (!code)
    reader_value(s, value, digits, text, size);
  free(value);
  return code;
}
