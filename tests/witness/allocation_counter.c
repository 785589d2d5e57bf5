#define _GNU_SOURCE /* dladdr */

#include "allocation_counter.h"

#ifdef ALLOCATIONS_ARE_COUNTED

#include <dlfcn.h>
#include <errno.h>
#include <string.h>

#define VISIBLE __attribute__((visibility("default"))) /* to the shared libraries */

size_t allocations, live, most_live, until_refusal;
bool watching;

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *block);
void *memalign(size_t alignment, size_t size);
size_t malloc_usable_size(void *block);

static bool is_refused(void) {
  return until_refusal > 0 && --until_refusal == 0;
}

/* Whether an address lies in FFTW. */
static bool in_fftw(void *address) {
  Dl_info where;
  return dladdr(address, &where) != 0 && where.dli_fname != NULL && strstr(where.dli_fname, "libfftw3") != NULL;
}

static void *counted(void *block, void *caller) {
  if (!watching || !in_fftw(caller))
    allocations++;
  live += malloc_usable_size(block);
  most_live = live > most_live ? live : most_live;
  return block;
}

VISIBLE void *malloc(size_t size) {
  return is_refused() ? NULL : counted(__libc_malloc(size), __builtin_return_address(0));
}

VISIBLE void *calloc(size_t count, size_t size) {
  return is_refused() ? NULL : counted(__libc_calloc(count, size), __builtin_return_address(0));
}

VISIBLE void *realloc(void *block, size_t size) {
  live -= malloc_usable_size(block);
  return counted(__libc_realloc(block, size), __builtin_return_address(0));
}

VISIBLE void *memalign(size_t alignment, size_t size) {
  return counted(__libc_memalign(alignment, size), __builtin_return_address(0));
}

VISIBLE void *aligned_alloc(size_t alignment, size_t size) {
  return counted(__libc_memalign(alignment, size), __builtin_return_address(0));
}

VISIBLE int posix_memalign(void **block, size_t alignment, size_t size) {
  *block = counted(__libc_memalign(alignment, size), __builtin_return_address(0));
  return *block ? 0 : ENOMEM;
}

VISIBLE void free(void *block) {
  live -= malloc_usable_size(block);
  __libc_free(block);
}

#endif
