#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../base/file_kind.h"
#include "../run/ranks.h"
#include "result.h"
#include "hdf5_call.h"
#include "chunks.h"
#include "plan.h"
#include "rows.h"
#include "skeleton.h"
#include "verify.h"

int result_stopped(const file_place *at) {
  return refuse(at->why, EXIT_STOPPED, "%s: stopped while it was read or written", at->path);
}

int result_ask(ric_poll stop, const file_place *at) {
  return ric_poll_stops(stop) ? result_stopped(at) : 0;
}

/* The beginning of an HDF5 file, or of nothing. */
static bool is_partial(const char *path) {
  static const unsigned char signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  unsigned char lead[sizeof signature];
  const int handle = open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  const ssize_t size = handle < 0 ? -1 : pread(handle, lead, sizeof lead, 0);
  if (handle >= 0)
    close(handle);
  return size == 0 || (size > 0 && memcmp(lead, signature, (size_t)size) == 0);
}

int result_check_partial(const char *path, message *why) {
  char partial[4100];
  snprintf(partial, sizeof partial, "%s.tmp", path);
  int code = file_kind_expect(partial, FILE_REGULAR, why);
  if (!code && file_kind_of(partial) == FILE_REGULAR && !is_partial(partial))
    code = refuse(why, EXIT_USAGE,
                  "%s: is there and no part of a result, which is written under this name; rename it, or "
                  "use -o for another result",
                  partial);
  return code;
}

typedef struct writer {
  plan plan;
  file_place at;
  result_hooks hooks;
  chunk_places places;
  records written; /* digests of what this rank wrote */
  bool made;       /* the file, by rank 0 */
} writer;

/* Collective: each rank checks that it can open the file that rank 0 made. */
static int check_shared_file(const writer *w) {
  struct stat mine;
  long long size = -1;
  int handle = open(w->plan.partial, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  int failed = handle < 0 || fstat(handle, &mine) != 0 ? errno : 0;
  if (handle >= 0)
    close(handle); /* nothing was written through it */
  if (!failed)
    size = (long long)mine.st_size;
  long long first = size;
  ranks_share(&first, sizeof first);
  if (failed)
    return refuse(w->at.why, EXIT_FILES, "%s: rank %d cannot open it: %s", w->at.path, ranks_rank(), strerror(failed));
  if (size != first)
    return refuse(w->at.why, EXIT_FILES,
                  "%s: %lld bytes on rank %d, %lld on rank 0: is the folder shared by all nodes?", w->at.path, size,
                  ranks_rank(), first);
  return 0;
}

static int sync_at(const writer *w, const char *path) {
  int handle = open(path, O_RDONLY);
  if (handle < 0)
    return refuse(w->at.why, EXIT_FILES, "%s: cannot open %s: %s", w->at.path, path, strerror(errno));
  bool synced = fsync(handle) == 0 || errno == EINVAL; /* EINVAL: a file system without it, for folders */
  int failed = synced ? 0 : errno;
  if (close(handle) != 0 && synced)
    failed = errno;
  return failed ? refuse(w->at.why, EXIT_FILES, "%s: cannot sync %s: %s", w->at.path, path, strerror(failed)) : 0;
}

static int sync_folder(const writer *w) {
  const char *slash = strrchr(w->at.path, '/');
  if (!slash)
    return sync_at(w, ".");
  size_t length = slash == w->at.path ? 1 : (size_t)(slash - w->at.path);
  char *folder = strndup(w->at.path, length);
  if (!folder)
    return refuse(w->at.why, EXIT_RUN, "%s: out of memory", w->at.path);
  int code = sync_at(w, folder);
  free(folder);
  return code;
}

/* Rank 0: syncs the verified file, renames it, and syncs the folder. */
static int publish(const writer *w) {
  int code = sync_at(w, w->plan.partial);
  if (!code && w->hooks.commit)
    code = w->hooks.commit(w->hooks.user, w->at.why);
  if (!code && rename(w->plan.partial, w->at.path) != 0)
    code = refuse(w->at.why, EXIT_FILES, "%s: cannot rename %s: %s", w->at.path, w->plan.partial, strerror(errno));
  return code ? code : sync_folder(w);
}

/* Rank 0: in place of what a killed run left. */
static int make_file(writer *w) {
  int code = result_check_partial(w->at.path, w->at.why);
  if (!code && unlink(w->plan.partial) != 0 && errno != ENOENT)
    code = refuse_errno(w->plan.partial, "replace it", w->at.why);
  if (code)
    return code;
  w->made = true;
  return space_create(&w->plan, &w->at, &w->places);
}

int result_write(const char *path, const result_header *header, const result_table *tables, size_t table_count,
                 const result_hooks *hooks, message *why) {
  writer w = {.at = {path, why}};
  if (hooks)
    w.hooks = *hooks;
  const int rank = ranks_rank();
  int code = ranks_agree(hdf5_start(&w.at), why);
  if (!code)
    code = ranks_agree(plan_init(&w.plan, path, header, tables, table_count, why), why);
  w.plan.stop = w.hooks.stop;
  if (!code)
    code = ranks_agree(rank == 0 ? make_file(&w) : 0, why);
  if (!code)
    code = chunks_share(&w.places, &w.at);
  if (!code)
    code = ranks_agree(check_shared_file(&w), why);
  if (!code)
    code = ranks_agree(rows_write(&w.plan, &w.places, &w.at, &w.written), why);
  if (!code)
    code = ranks_agree(rows_check(&w.plan, &w.at, &w.written), why);
  if (!code)
    code = ranks_agree(rank == 0 ? verify_file(&w.at, w.plan.partial, &w.plan, w.plan.stop) : 0, why);
  if (!code)
    code = ranks_agree(rank == 0 ? publish(&w) : 0, why);
  if (code && w.made)
    unlink(w.plan.partial); /* absent if it could not be created */
  chunks_clear(&w.places);
  records_clear(&w.written);
  plan_clear(&w.plan);
  return code;
}
