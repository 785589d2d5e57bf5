/* Chunks that are written as plain bytes are those that HDF5 reads, whatever their shape and wherever they lie. */
#include "result/chunks.h"
#include "scenario/random_source.h"
#include "support.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FILE_NAME "chunks.h5"

static chunk_grid random_grid(random_source *source) {
  chunk_grid g = {.axes = 1 + (int)random_below(source, 3), .value_bytes = 1 + random_below(source, 9)};
  g.bytes = g.value_bytes;
  for (int i = 0; i < g.axes; i++) {
    g.shape[i] = 1 + random_below(source, i ? 7 : 40);
    g.chunk[i] = 1 + random_below(source, g.shape[i]);
    g.counts[i] = (g.shape[i] + g.chunk[i] - 1) / g.chunk[i];
    g.bytes *= g.chunk[i];
  }
  return g;
}

static size_t bytes_of(const chunk_grid *g) {
  size_t bytes = g->value_bytes;
  for (int i = 0; i < g->axes; i++)
    bytes *= g->shape[i];
  return bytes;
}

/* A data set of texts, whose chunks HDF5 allocates as they are first written. */
static hid_t create_set(hid_t file, const char *name, const chunk_grid *g) {
  hsize_t shape[PLAN_MOST_AXES], chunk[PLAN_MOST_AXES];
  for (int i = 0; i < g->axes; i++)
    shape[i] = g->shape[i], chunk[i] = g->chunk[i];
  hid_t space = H5Screate_simple(g->axes, shape, NULL), list = H5Pcreate(H5P_DATASET_CREATE), type = H5Tcopy(H5T_C_S1);
  assert_true(H5Tset_size(type, g->value_bytes) >= 0 && H5Pset_chunk(list, g->axes, chunk) >= 0);
  assert_true(H5Pset_fletcher32(list) >= 0 && H5Pset_alloc_time(list, H5D_ALLOC_TIME_INCR) >= 0);
  hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, list, H5P_DEFAULT);
  assert_true(set >= 0);
  H5Sclose(space), H5Pclose(list), H5Tclose(type);
  return set;
}

/* Writes one value into chunk number `number`, which allocates it; nothing where there is none. */
static void allocate(hid_t set, const chunk_grid *g, uint64_t number) {
  hsize_t at[PLAN_MOST_AXES];
  for (int i = g->axes - 1; i >= 0; number /= g->counts[i], i--)
    at[i] = number % g->counts[i] * g->chunk[i];
  if (number > 0)
    return;
  char value[16] = "";
  hid_t space = H5Dget_space(set), memory = H5Screate(H5S_SCALAR), type = H5Dget_type(set);
  assert_true(H5Sselect_elements(space, H5S_SELECT_SET, 1, at) >= 0);
  assert_true(H5Dwrite(set, type, memory, space, H5P_DEFAULT, value) >= 0);
  assert_true(H5Dflush(set) >= 0); /* until then the chunk is in memory only */
  H5Sclose(space), H5Sclose(memory), H5Tclose(type);
}

/* Two data sets whose chunks lie between one another in the file. */
static void lay_out(const chunk_grid *g, chunk_places *places) {
  message why;
  const file_place at = {FILE_NAME, &why};
  hid_t file = H5Fcreate(FILE_NAME, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), sets[2];
  for (int k = 0; k < 2; k++)
    sets[k] = create_set(file, k ? "b" : "a", &g[k]);
  for (uint64_t i = 0; i < 40 * 49; i++)
    for (int k = 0; k < 2; k++)
      allocate(sets[k], &g[k], i);
  for (int k = 0; k < 2; k++) {
    assert_int_equal(chunks_find(places, &at, sets[k], (uint64_t)k, &g[k]), 0);
    H5Dclose(sets[k]);
  }
  assert_true(H5Fclose(file) >= 0);
}

/* In blocks of whole chunks. */
static void write_values(const chunk_grid *g, const chunk_places *places, uint64_t set, const unsigned char *values) {
  unsigned char *buffer = malloc(g->bytes + 4);
  const int handle = open(FILE_NAME, O_WRONLY);
  const uint64_t block = 2 * g->chunk[0], row_bytes = bytes_of(g) / g->shape[0];
  const chunk_file file = {.places = places, .handle = handle, .buffer = buffer};
  assert_true(buffer && handle >= 0);
  for (uint64_t first = 0; first < g->shape[0]; first += block) {
    const uint64_t count = g->shape[0] - first < block ? g->shape[0] - first : block;
    assert_int_equal(chunks_write(&file, set, g, first, count, values + first * row_bytes), 0);
  }
  close(handle);
  free(buffer);
}

static void assert_reads(const char *name, const chunk_grid *g, const unsigned char *values) {
  unsigned char *read = malloc(bytes_of(g));
  hid_t file = H5Fopen(FILE_NAME, H5F_ACC_RDONLY, H5P_DEFAULT), set = H5Dopen2(file, name, H5P_DEFAULT);
  hid_t type = H5Dget_type(set);
  assert_true(read && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, read) >= 0); /* checksums are right */
  assert_memory_equal(read, values, bytes_of(g));
  H5Tclose(type), H5Dclose(set), H5Fclose(file);
  free(read);
}

static void what_is_written_is_what_hdf5_reads(void **state) {
  (void)state;
  random_source source = {7};
  for (int round = 0; round < 60; round++) {
    const chunk_grid g[2] = {random_grid(&source), random_grid(&source)};
    unsigned char *values[2];
    chunk_places places = {0};
    lay_out(g, &places);
    for (int k = 0; k < 2; k++) {
      values[k] = malloc(bytes_of(&g[k]));
      assert_non_null(values[k]);
      for (size_t i = 0; i < bytes_of(&g[k]); i++)
        values[k][i] = (unsigned char)random_below(&source, 256);
      write_values(&g[k], &places, (uint64_t)k, values[k]);
    }
    for (int k = 0; k < 2; k++) {
      assert_reads(k ? "b" : "a", &g[k], values[k]);
      free(values[k]);
    }
    chunks_clear(&places);
  }
}

static int remove_file(void **state) {
  (void)state;
  return unlink(FILE_NAME);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_written_is_what_hdf5_reads)};
  return cmocka_run_group_tests(tests, NULL, remove_file);
}
