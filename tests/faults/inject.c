/* Preloaded into a process (LD_PRELOAD), makes one of its calls fail, or that one and all later ones of its family.
 *
 *   FAULT_CALLS   memory: malloc and its kin, in the program and in every library
 *                 files: calls on files whose path contains FAULT_NAME, and on what they have opened
 *   FAULT_ONLY    if set, of these only the calls of one function: close
 *   FAULT_AT      the so many-th call fails, counted from 1 on from the beginning of main, with those of child
 * processes; 0: none FAULT_ON      if set, all later calls fail as well FAULT_ERROR   the errno of files, a number;
 * memory has ENOMEM FAULT_PLACES  if set, the log gets a line for every call whose innermost callers differ from all
 * before, with the innermost FAULT_LOG     a file that gets a line for the fault, with the stack that leads to it; one
 * for a deadly signal, with its stack; and the number of calls at the end
 *
 * A close that fails has closed. A stack is `library(function)` or `library+offset`, the innermost frame first. */
#define _GNU_SOURCE /* RTLD_NEXT, dladdr, _dl_find_object */
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#define VISIBLE __attribute__((visibility("default")))

enum { MOST_FILES = 1024, MOST_FRAMES = 40, MOST_TEXT = 8192, MOST_CALLERS = 12, MOST_PLACES = 1 << 16 };

static bool in_memory, in_files, goes_on, lists_places, counting;
static unsigned long *calls, at; /* calls: in memory that child processes share */
static int error_number, log_file = -1;
static const char *name = "", *only = "";
static bool is_watched[MOST_FILES]; /* by file descriptor */

/* --- the log -------------------------------------------------------------------------------------------------------
 */

/* The C library's own functions are reached past those below. */
static void *next(const char *symbol) {
  return dlsym(RTLD_NEXT, symbol);
}

static void log_text(const char *text) {
  static ssize_t (*real)(int, const void *, size_t);
  if (!real)
    *(void **)&real = next("write");
  if (log_file >= 0 && real(log_file, text, strlen(text)) < 0)
    log_file = -1;
}

static size_t put_frame(void *address, char *text, size_t size) {
  Dl_info where;
  if (!dladdr(address, &where) || !where.dli_fname)
    return (size_t)snprintf(text, size, " ?");
  const char *slash = strrchr(where.dli_fname, '/'), *library = slash ? slash + 1 : where.dli_fname;
  if (where.dli_sname)
    return (size_t)snprintf(text, size, " %s(%s)", library, where.dli_sname);
  return (size_t)snprintf(text, size, " %s+%#zx", library, (size_t)((char *)address - (char *)where.dli_fbase));
}

static void *base_of(void *address) {
  struct dl_find_object where;
  return _dl_find_object(address, &where) == 0 ? (void *)where.dlfo_link_map : NULL;
}

/* The stack without our own innermost frames. @param frames  [most] @param skipped  set @returns the number of all */
static int callers(void **frames, int most, int *skipped) {
  const int count = backtrace(frames, most);
  for (*skipped = 0; *skipped < count && base_of(frames[*skipped]) == base_of(frames[0]); ++*skipped)
    continue;
  return count;
}

static void log_stack(const char *what) {
  void *frames[MOST_FRAMES];
  char text[MOST_TEXT];
  int i;
  const int count = callers(frames, MOST_FRAMES, &i);
  size_t used = (size_t)snprintf(text, sizeof text, "%s:", what);
  for (; i < count && used + 200 < sizeof text; i++)
    used += put_frame(frames[i], text + used, 200);
  text[used] = '\n';
  text[used + 1] = '\0';
  log_text(text);
}

static char signal_stack[1 << 16]; /* for recursions without an end */

static void log_signal(int number) {
  char what[32];
  counting = false;
  snprintf(what, sizeof what, "signal %d", number);
  log_stack(what);
  raise(number); /* deadly now: SA_RESETHAND */
}

/* --- places --------------------------------------------------------------------------------------------------------
 */

static uint64_t places[MOST_PLACES]; /* digests of stacks, at home modulo the size; 0: none */

/* Of a stack, wherever the libraries are loaded. */
static uint64_t digest_of(void *const *frames, int count) {
  uint64_t digest = 14695981039346656037u;
  for (int i = 0; i < count; i++) {
    struct dl_find_object where;
    const bool known = _dl_find_object(frames[i], &where) == 0;
    const uint64_t offset = known ? (uint64_t)((uintptr_t)frames[i] - where.dlfo_link_map->l_addr) : 0;
    digest = (digest ^ offset) * 1099511628211u;
  }
  return digest ? digest : 1;
}

static void list_place(void) {
  void *frames[MOST_CALLERS];
  char text[256];
  int ours;
  const int count = callers(frames, MOST_CALLERS, &ours);
  const uint64_t digest = digest_of(frames, count);
  size_t home = digest % MOST_PLACES;
  while (places[home] && places[home] != digest)
    home = (home + 1) % MOST_PLACES;
  if (places[home])
    return;
  places[home] = digest;
  size_t used = (size_t)snprintf(text, sizeof text, "place: %lu %016llx", *calls, (unsigned long long)digest);
  used += put_frame(frames[ours], text + used, sizeof text - used - 2);
  snprintf(text + used, sizeof text - used, "\n");
  log_text(text);
}

/* --- counting ------------------------------------------------------------------------------------------------------
 */

/* Whether this call fails. */
static bool fails(bool is_counted, const char *what) {
  if (!counting || !is_counted || (*only && strcmp(only, what) != 0))
    return false;
  const unsigned long call = __atomic_add_fetch(calls, 1, __ATOMIC_RELAXED);
  if (lists_places) {
    counting = false;
    list_place();
    counting = true;
  }
  if (at == 0 || call < at || (call > at && !goes_on))
    return false;
  counting = false; /* what the log needs is no call of the program */
  if (call == at)
    log_stack(what);
  counting = true;
  return true;
}

static bool memory_fails(const char *what) {
  if (!fails(in_memory, what))
    return false;
  errno = ENOMEM;
  return true;
}

static bool file_fails(bool is_ours, const char *what) {
  if (!fails(in_files && is_ours, what))
    return false;
  errno = error_number;
  return true;
}

/* --- the beginning and the end -------------------------------------------------------------------------------------
 */

static const char *setting(const char *variable) {
  const char *text = getenv(variable);
  return text ? text : "";
}

__attribute__((constructor)) static void read_settings(void) {
  static const int deadly[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  void *frame;
  calls = mmap(NULL, sizeof *calls, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (calls == MAP_FAILED)
    abort();
  (void)backtrace(&frame, 1); /* the first call allocates */
  in_memory = strcmp(setting("FAULT_CALLS"), "memory") == 0;
  in_files = strcmp(setting("FAULT_CALLS"), "files") == 0;
  at = strtoul(setting("FAULT_AT"), NULL, 10);
  goes_on = *setting("FAULT_ON");
  lists_places = *setting("FAULT_PLACES");
  error_number = (int)strtol(setting("FAULT_ERROR"), NULL, 10);
  name = setting("FAULT_NAME");
  only = setting("FAULT_ONLY");
  sigaltstack(&(stack_t){.ss_sp = signal_stack, .ss_size = sizeof signal_stack}, NULL);
  log_file = open(setting("FAULT_LOG"), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++)
    sigaction(deadly[i],
              &(struct sigaction){.sa_handler = log_signal, .sa_flags = (int)SA_RESETHAND | SA_NODEFER | SA_ONSTACK},
              NULL);
}

static int (*program_main)(int, char **, char **);

static int counted_main(int count, char **words, char **environment) {
  char text[64];
  counting = true;
  const int code = program_main(count, words, environment);
  counting = false;
  snprintf(text, sizeof text, "calls: %lu\n", *calls);
  log_text(text);
  return code;
}

int __libc_start_main(int (*main)(int, char **, char **), int count, char **words, void (*init)(void),
                      void (*fini)(void), void (*loader_fini)(void), void *stack_end);

VISIBLE int __libc_start_main(int (*main)(int, char **, char **), int count, char **words, void (*init)(void),
                              void (*fini)(void), void (*loader_fini)(void), void *stack_end) {
  int (*real)(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void), void *);
  *(void **)&real = next("__libc_start_main");
  program_main = main;
  return real(counted_main, count, words, init, fini, loader_fini, stack_end);
}

/* --- memory --------------------------------------------------------------------------------------------------------
 */

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void *memalign(size_t alignment, size_t size);

VISIBLE void *malloc(size_t size) {
  return memory_fails("malloc") ? NULL : __libc_malloc(size);
}

VISIBLE void *calloc(size_t count, size_t size) {
  return memory_fails("calloc") ? NULL : __libc_calloc(count, size);
}

VISIBLE void *realloc(void *block, size_t size) {
  return memory_fails("realloc") ? NULL : __libc_realloc(block, size);
}

VISIBLE void *memalign(size_t alignment, size_t size) {
  return memory_fails("memalign") ? NULL : __libc_memalign(alignment, size);
}

VISIBLE void *aligned_alloc(size_t alignment, size_t size) {
  return memory_fails("aligned_alloc") ? NULL : __libc_memalign(alignment, size);
}

VISIBLE int posix_memalign(void **block, size_t alignment, size_t size) {
  if (memory_fails("posix_memalign"))
    return ENOMEM;
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}

/* --- files ---------------------------------------------------------------------------------------------------------
 */

static bool is_ours(const char *path) {
  return strstr(path, name) != NULL;
}

static bool is_open(int file) {
  return file >= 0 && file < MOST_FILES && is_watched[file];
}

static int opened(int file, bool ours) {
  if (file >= 0 && file < MOST_FILES)
    is_watched[file] = ours;
  return file;
}

VISIBLE int openat(int folder, const char *path, int flags, ...) {
  static int (*real)(int, const char *, int, ...);
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & (O_CREAT | __O_TMPFILE) ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  if (!real)
    *(void **)&real = next("openat");
  const bool ours = is_ours(path) || is_open(folder);
  return file_fails(ours, "open") ? -1 : opened(real(folder, path, flags, mode), ours);
}

VISIBLE int open(const char *path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & (O_CREAT | __O_TMPFILE) ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return openat(AT_FDCWD, path, flags, mode);
}

/* A function of the C library that fails with -1 if `ours`, and is otherwise the real one. */
#define FILE_CALL(type, function, parameters, arguments, ours)                                                         \
  VISIBLE type function parameters {                                                                                   \
    static type(*real) parameters;                                                                                     \
    if (!real)                                                                                                         \
      *(void **)&real = next(#function);                                                                               \
    return file_fails(ours, #function) ? -1 : real arguments;                                                          \
  }

FILE_CALL(ssize_t, read, (int file, void *bytes, size_t size), (file, bytes, size), is_open(file))
FILE_CALL(ssize_t, pread, (int file, void *bytes, size_t size, off_t where), (file, bytes, size, where), is_open(file))
FILE_CALL(ssize_t, write, (int file, const void *bytes, size_t size), (file, bytes, size), is_open(file))
FILE_CALL(ssize_t, pwrite, (int file, const void *bytes, size_t size, off_t where), (file, bytes, size, where),
          is_open(file))
FILE_CALL(ssize_t, writev, (int file, const struct iovec *parts, int count), (file, parts, count), is_open(file))
FILE_CALL(ssize_t, pwritev, (int file, const struct iovec *parts, int count, off_t where), (file, parts, count, where),
          is_open(file))
FILE_CALL(int, fsync, (int file), (file), is_open(file))
FILE_CALL(int, fdatasync, (int file), (file), is_open(file))
FILE_CALL(int, ftruncate, (int file, off_t size), (file, size), is_open(file))
FILE_CALL(int, fallocate, (int file, int mode, off_t from, off_t size), (file, mode, from, size), is_open(file))
FILE_CALL(int, flock, (int file, int operation), (file, operation), is_open(file))
FILE_CALL(int, fchmod, (int file, mode_t mode), (file, mode), is_open(file))
FILE_CALL(int, rename, (const char *from, const char *to), (from, to), is_ours(from) || is_ours(to))
FILE_CALL(int, unlink, (const char *path), (path), is_ours(path))
FILE_CALL(int, mkdir, (const char *path, mode_t mode), (path, mode), is_ours(path))
FILE_CALL(int, rmdir, (const char *path), (path), is_ours(path))
FILE_CALL(int, unlinkat, (int folder, const char *path, int flags), (folder, path, flags),
          is_ours(path) || is_open(folder))

VISIBLE int posix_fallocate(int file, off_t from, off_t size) {
  static int (*real)(int, off_t, off_t);
  if (!real)
    *(void **)&real = next("posix_fallocate");
  return file_fails(is_open(file), "posix_fallocate") ? error_number : real(file, from, size);
}

VISIBLE int fcntl(int file, int command, ...) {
  static int (*real)(int, int, ...);
  va_list arguments;
  va_start(arguments, command);
  void *argument = va_arg(arguments, void *);
  va_end(arguments);
  if (!real)
    *(void **)&real = next("fcntl");
  return file_fails(is_open(file), "fcntl") ? -1 : real(file, command, argument);
}

VISIBLE int close(int file) {
  static int (*real)(int);
  if (!real)
    *(void **)&real = next("close");
  const bool bad = file_fails(is_open(file), "close");
  const int saved = errno, result = real(file);
  opened(file, false);
  if (bad)
    errno = saved;
  return bad ? -1 : result;
}
