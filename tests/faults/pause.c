/* Preloaded into a process (LD_PRELOAD), pauses before each of its calls on files whose path contains PAUSE_NAME, and
 * on what they have opened, for PAUSE_MS milliseconds: what a run does to its files in a moment then takes long enough
 * for a kill to fall between any two of the calls. */
#define _GNU_SOURCE /* RTLD_NEXT */
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#define VISIBLE __attribute__((visibility("default")))

enum { MOST_FILES = 1024 };

static bool is_watched[MOST_FILES]; /* by file descriptor */
static const char *name;
static struct timespec length;

__attribute__((constructor)) static void begin(void) {
  const char *milliseconds = getenv("PAUSE_MS");
  name = getenv("PAUSE_NAME");
  length.tv_nsec = milliseconds ? 1000000 * strtol(milliseconds, NULL, 10) : 0;
}

static bool is_named(const char *path) {
  return name && path && strstr(path, name);
}

static void pause_at(bool watched) {
  struct timespec left = length;
  while (watched && nanosleep(&left, &left) != 0)
    ;
}

static void pause_on(int file) {
  pause_at(file >= 0 && file < MOST_FILES && is_watched[file]);
}

/* The C library's own function, past those below. */
static void *next(const char *symbol) {
  return dlsym(RTLD_NEXT, symbol);
}

static int opened(const char *path, int file) {
  if (file >= 0 && file < MOST_FILES)
    is_watched[file] = is_named(path);
  return file;
}

#define OPEN(symbol)                                                                                                   \
  VISIBLE int symbol(const char *path, int flags, ...) {                                                               \
    int (*real)(const char *, int, ...);                                                                               \
    va_list more;                                                                                                      \
    *(void **)&real = next(#symbol);                                                                                   \
    va_start(more, flags);                                                                                             \
    const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;                                                    \
    va_end(more);                                                                                                      \
    pause_at(is_named(path));                                                                                          \
    return opened(path, real(path, flags, mode));                                                                      \
  }

#define ON_PATH(symbol, parameters, arguments)                                                                         \
  VISIBLE int symbol parameters {                                                                                      \
    int(*real) parameters;                                                                                             \
    *(void **)&real = next(#symbol);                                                                                   \
    pause_at(is_named(path));                                                                                          \
    return real arguments;                                                                                             \
  }

#define ON_FILE(type, symbol, parameters, arguments)                                                                   \
  VISIBLE type symbol parameters {                                                                                     \
    type(*real) parameters;                                                                                            \
    *(void **)&real = next(#symbol);                                                                                   \
    pause_on(file);                                                                                                    \
    return real arguments;                                                                                             \
  }

#undef open
OPEN(open)
OPEN(open64)
ON_PATH(mkdir, (const char *path, mode_t mode), (path, mode))
ON_PATH(rmdir, (const char *path), (path))
ON_PATH(unlink, (const char *path), (path))
ON_PATH(rename, (const char *path, const char *to), (path, to))
ON_FILE(ssize_t, write, (int file, const void *bytes, size_t size), (file, bytes, size))
ON_FILE(ssize_t, writev, (int file, const struct iovec *pieces, int count), (file, pieces, count))
ON_FILE(ssize_t, pwrite, (int file, const void *bytes, size_t size, off_t at), (file, bytes, size, at))
ON_FILE(ssize_t, pwrite64, (int file, const void *bytes, size_t size, off64_t at), (file, bytes, size, at))
ON_FILE(int, fsync, (int file), (file))
ON_FILE(int, fdatasync, (int file), (file))
ON_FILE(int, ftruncate, (int file, off_t size), (file, size))
ON_FILE(int, ftruncate64, (int file, off64_t size), (file, size))
ON_FILE(int, posix_fallocate, (int file, off_t at, off_t size), (file, at, size))
ON_FILE(int, close, (int file), (file))
