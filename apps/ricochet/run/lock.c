/* F_OFD_SETLK (POSIX 2024, Linux since 3.15) needs _GNU_SOURCE with glibc 2.36. Locks of the older F_SETLK are lost as
 * soon as any code in the process, for example a library, closes the file. */
#define _GNU_SOURCE

#include "lock.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "stop.h"

static const double retry_seconds = 0.1;

struct lock {
  int fd;
  char folder[PATH_MAX];
  char path[PATH_MAX];
};

static int lock_allocate(const char *folder, lock **out, message *why) {
  lock *l = malloc(sizeof *l);
  if (!l)
    return refuse(why, EXIT_RUN, "%s: out of memory for the lock", folder);
  l->fd = -1;
  const int length = snprintf(l->path, sizeof l->path, "%s/lock", folder);
  if (length < 0 || (size_t)length >= sizeof l->path) {
    free(l);
    return refuse(why, EXIT_FILES, "%s: the name is too long", folder);
  }
  memcpy(l->folder, folder, strlen(folder) + 1);
  *out = l;
  return 0;
}

static void lock_close(lock *l) {
  if (l->fd >= 0)
    close(l->fd);
  l->fd = -1;
}

/* @param length  in bytes, 0 for all that follow */
static int set_lock(const lock *l, short type, off_t start, off_t length) {
  struct flock range = {.l_type = type, .l_whence = SEEK_SET, .l_start = start, .l_len = length};
  return fcntl(l->fd, F_OFD_SETLK, &range);
}

static bool is_held(int error) {
  return error == EAGAIN || error == EACCES;
}

/* False also if there is no file. */
static bool path_names_file(const lock *l) {
  struct stat locked, found;
  return fstat(l->fd, &locked) == 0 && stat(l->path, &found) == 0 && locked.st_dev == found.st_dev &&
         locked.st_ino == found.st_ino;
}

static void read_holder(const lock *l, char *text, size_t size) {
  const ssize_t length = pread(l->fd, text, size - 1, 0);
  text[length > 0 ? length : 0] = '\0';
  text[strcspn(text, "\n")] = '\0';
  if (!text[0]) /* a holder whose name is not, or could not be, written */
    snprintf(text, size, "a process that left no name");
}

static int write_holder(const lock *l, message *why) {
  char host[256] = "unknown", since[32] = "", text[400];
  gethostname(host, sizeof host - 1); /* on failure the name stays "unknown" */
  const time_t now = time(NULL);
  struct tm local;
  if (localtime_r(&now, &local))
    strftime(since, sizeof since, "%Y-%m-%d %H:%M:%S", &local);
  const int length = snprintf(text, sizeof text, "host %s, process %ld, since %s\n", host, (long)getpid(), since);
  if (ftruncate(l->fd, 0) || pwrite(l->fd, text, (size_t)length, 0) != length)
    return refuse_errno(l->path, "write", why);
  return 0;
}

typedef enum attempt { TAKEN, HELD, REPLACED, IMPOSSIBLE } attempt;

/* One attempt at the whole range; `holder` is written when HELD, `why` when IMPOSSIBLE, the file is open when TAKEN. */
static attempt try_whole(lock *l, char *holder, size_t size, message *why) {
  if (mkdir(l->folder, 0777) && errno != EEXIST) {
    refuse_errno(l->folder, "create the folder", why);
    return IMPOSSIBLE;
  }
  l->fd = open(l->path, O_CREAT | O_RDWR | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (l->fd < 0) {
    if (errno == ENOENT) /* its last holder removed the folder since the mkdir */
      return REPLACED;
    refuse_errno(l->path, "open", why);
    return IMPOSSIBLE;
  }
  attempt result = TAKEN;
  if (set_lock(l, F_WRLCK, 0, 0)) {
    result = is_held(errno) ? HELD : IMPOSSIBLE;
    if (result == HELD)
      read_holder(l, holder, size);
    else
      refuse_errno(l->path, "lock", why);
  } else if (!path_names_file(l)) {
    result = REPLACED;
  }
  if (result != TAKEN)
    lock_close(l);
  return result;
}

static int wait_for_whole(lock *l, double wait_seconds, message *why) {
  const double began = clock_seconds();
  char holder[400] = "a process that removes it";
  for (;;) {
    const attempt result = try_whole(l, holder, sizeof holder, why);
    if (result == TAKEN)
      return 0;
    if (result == IMPOSSIBLE)
      return EXIT_FILES;
    if (stop_asked() != STOP_NONE)
      return refuse(why, EXIT_STOPPED, "%s: stopped while it was held by %s", l->path, holder);
    const double waited = clock_seconds() - began;
    if (!(waited < wait_seconds))
      return refuse(why, EXIT_FILES, "%s: held by %s; waited %.1f s", l->path, holder, waited);
    nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * retry_seconds)}, NULL);
  }
}

int lock_take(const char *folder, double wait_seconds, lock **out, message *why) {
  *out = NULL;
  lock *l = NULL;
  int code = lock_allocate(folder, &l, why);
  if (code)
    return code;
  code = wait_for_whole(l, wait_seconds, why);
  if (!code)
    code = write_holder(l, why);
  if (!code && set_lock(l, F_UNLCK, 1, 0)) /* the bytes of the other ranks, which join now */
    code = refuse_errno(l->path, "unlock", why);
  if (code)
    lock_release(&l, 0);
  *out = l;
  return code;
}

static int join(lock *l, int rank, message *why) {
  l->fd = open(l->path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (l->fd < 0)
    return refuse_errno(l->path, "open", why);
  if (set_lock(l, F_WRLCK, rank, 1)) {
    if (!is_held(errno))
      return refuse_errno(l->path, "lock", why);
    char holder[400];
    read_holder(l, holder, sizeof holder);
    return refuse(why, EXIT_FILES, "%s: the place of rank %d is held by %s", l->path, rank, holder);
  }
  return lock_check(l, why);
}

int lock_join(const char *folder, int rank, lock **out, message *why) {
  *out = NULL;
  lock *l = NULL;
  int code = lock_allocate(folder, &l, why);
  if (code)
    return code;
  code = join(l, rank, why);
  if (code)
    lock_release(&l, 0);
  *out = l;
  return code;
}

int lock_check(const lock *l, message *why) {
  if (!path_names_file(l))
    return refuse(why, EXIT_FILES, "%s: the lock was removed or replaced while this run held it", l->path);
  return 0;
}

void lock_release(lock **l, int remove) {
  if (!*l)
    return;
  /* Removed before it is unlocked: a process that waits for this file then finds that the path names another one, and
   * opens that. A file or folder that remains locks nothing, so failures are ignored. */
  if (remove && (*l)->fd >= 0 && path_names_file(*l)) {
    unlink((*l)->path);
    rmdir((*l)->folder);
  }
  lock_close(*l);
  free(*l);
  *l = NULL;
}
