#include "checkpoint.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include "checkpoint_files.h"
#include "stop.h"

enum {
  WRITE_BYTES = 16 << 20,     /* at a time */
  FINISHED_BYTES = 256 << 20, /* of a record that is written in spite of a stop; a larger one may take too long */
  MOST_PIECES = 4 + CHECKPOINT_MOST_TAILS,
};

uint64_t part_header_check(const part_header *header) {
  return digest_bytes(0, header, offsetof(part_header, check));
}

uint64_t record_header_check(const record_header *header) {
  return digest_bytes(0, header, offsetof(record_header, check));
}

static void part_name(unsigned generation, unsigned rank, char name[PART_NAME_BYTES]) {
  snprintf(name, PART_NAME_BYTES, "part-%04u-%05u", generation, rank);
}

void part_path(const char *folder, unsigned generation, unsigned rank, char *path) {
  char name[PART_NAME_BYTES];
  part_name(generation, rank, name);
  snprintf(path, PATH_MAX, "%s/%s", folder, name);
}

bool part_name_parse(const char *name, unsigned *generation, unsigned *rank) {
  char same[PART_NAME_BYTES];
  if (sscanf(name, "part-%9u-%9u", generation, rank) != 2)
    return false;
  part_name(*generation, *rank, same);
  return strcmp(name, same) == 0;
}

static int set_identity(checkpoint *c, const char *folder, const checkpoint_identity *identity, message *why) {
  uint64_t smallest = identity->row_bytes; /* bytes of a task without entries */
  while (c->tails < CHECKPOINT_MOST_TAILS && identity->entry_bytes[c->tails] > 0)
    c->tails++;
  smallest += c->tails * sizeof(uint64_t);
  if (!(identity->row_bytes >= 1) || identity->tasks > (UINT64_MAX - sizeof(uint64_t)) / smallest)
    return refuse(why, EXIT_RUN, "%s: %llu tasks with rows of %llu bytes exceed the size of a checkpoint", folder,
                  (unsigned long long)identity->tasks, (unsigned long long)identity->row_bytes);
  const int length = snprintf(c->folder, sizeof c->folder, "%s", folder);
  if (length < 0 || (size_t)length >= sizeof c->folder)
    return refuse(why, EXIT_FILES, "%s: the name is too long", folder);
  c->identity.digest = identity->digest;
  c->identity.tasks = identity->tasks;
  c->identity.row_bytes = identity->row_bytes;
  c->identity.arithmetic = identity->arithmetic;
  for (size_t i = 0; i < c->tails; i++)
    c->identity.entry_bytes[i] = identity->entry_bytes[i];
  /* Copied as a string: bytes after its end must not make a difference. */
  snprintf(c->identity.version, sizeof c->identity.version, "%.63s", identity->version);
  return 0;
}

int checkpoint_open(const char *folder, const checkpoint_identity *identity, checkpoint **out, message *why) {
  *out = NULL;
  checkpoint *c = calloc(1, sizeof *c);
  if (!c || !(c->buffer = malloc(PART_BUFFER_BYTES))) {
    free(c);
    return refuse(why, EXIT_RUN, "%s: out of memory for the checkpoint", folder);
  }
  c->own_fd = c->read_fd = -1;
  int code = set_identity(c, folder, identity, why);
  if (!code)
    code = checkpoint_scan(c, true, why);
  if (code) {
    checkpoint_close(&c);
    return code;
  }
  c->generation = 1;
  for (size_t i = 0; i < c->part_count; i++)
    if (c->parts[i].generation >= c->generation)
      c->generation = c->parts[i].generation + 1;
  *out = c;
  return 0;
}

void checkpoint_close(checkpoint **c) {
  if (!*c)
    return;
  if ((*c)->own_fd >= 0)
    close((*c)->own_fd);
  if ((*c)->read_fd >= 0)
    close((*c)->read_fd);
  index_clear(&(*c)->index);
  free((*c)->before);
  free((*c)->counts);
  free((*c)->parts);
  free((*c)->buffer);
  free(*c);
  *c = NULL;
}

int checkpoint_rescan(checkpoint *c, message *why) {
  return checkpoint_scan(c, false, why);
}

bool checkpoint_mixed(const checkpoint *c) {
  return c->mixed;
}

uint64_t checkpoint_done(const checkpoint *c) {
  return c->index.done;
}

uint64_t checkpoint_missing(const checkpoint *c, uint64_t n, uint64_t *task) {
  const index_gap *gap = index_find_gap(&c->index, n);
  if (!gap)
    return 0;
  const uint64_t skipped = n - gap->before;
  *task = gap->first + skipped;
  return gap->count - skipped;
}

/* Advances the pieces past the bytes already written. */
static void advance(struct iovec *pieces, int count, size_t written) {
  for (int i = 0; i < count; i++) {
    const size_t step = written < pieces[i].iov_len ? written : pieces[i].iov_len;
    pieces[i].iov_base = (char *)pieces[i].iov_base + step;
    pieces[i].iov_len -= step;
    written -= step;
  }
}

/* Whether to give a record up, of which so many bytes are done. */
static bool is_given_up(uint64_t done) {
  return done > FINISHED_BYTES && stop_asked() != STOP_NONE;
}

static int refuse_stopped(const checkpoint *c, message *why) {
  return refuse(why, EXIT_STOPPED, "%s: stopped while a large record was written", c->own_path);
}

/* Writes some bytes of the pieces. @returns as writev */
static ssize_t write_some(int fd, const struct iovec *pieces, int count) {
  struct iovec now[MOST_PIECES];
  size_t left = WRITE_BYTES;
  for (int i = 0; i < count; i++) {
    now[i] = pieces[i];
    now[i].iov_len = now[i].iov_len < left ? now[i].iov_len : left;
    left -= now[i].iov_len;
  }
  return writev(fd, now, count);
}

/* @returns 0, EXIT_FILES or EXIT_STOPPED; then some of them may have been written */
static int write_pieces(const checkpoint *c, struct iovec *pieces, int count, size_t size, message *why) {
  for (size_t done = 0; done < size;) {
    const ssize_t written = write_some(c->own_fd, pieces, count);
    if (written < 0 && errno == EINTR)
      continue;
    if (written == 0)
      errno = ENOSPC;
    if (written <= 0)
      return refuse_errno(c->own_path, "write", why);
    advance(pieces, count, (size_t)written);
    done += (size_t)written;
    if (is_given_up(done))
      return refuse_stopped(c, why);
  }
  return 0;
}

/* Appends all pieces to this rank's file, or none: after a failure the file is truncated to its last good record. If
 * that fails too, the file is closed, because records after an incomplete one are never read. */
static int append_pieces(checkpoint *c, struct iovec *pieces, int count, message *why) {
  size_t size = 0;
  for (int i = 0; i < count; i++)
    size += pieces[i].iov_len;
  const int code = write_pieces(c, pieces, count, size, why);
  if (code && ftruncate(c->own_fd, (off_t)c->own_size)) {
    close(c->own_fd);
    c->own_fd = -1;
  }
  c->own_size += code ? 0 : size;
  return code;
}

int checkpoint_begin(checkpoint *c, int rank, message *why) {
  part_path(c->folder, c->generation, (unsigned)rank, c->own_path);
  /* O_EXCL: a file of this name would belong to another run, which the lock excludes. */
  c->own_fd = open(c->own_path, O_CREAT | O_EXCL | O_NOFOLLOW | O_WRONLY | O_APPEND | O_CLOEXEC, 0666);
  if (c->own_fd < 0)
    return refuse_errno(c->own_path, "create", why);
  part_header header = {.magic = PART_MAGIC, .format = PART_FORMAT, .identity = c->identity};
  header.check = part_header_check(&header);
  const int code = append_pieces(c, &(struct iovec){.iov_base = &header, .iov_len = sizeof header}, 1, why);
  if (code && c->own_fd >= 0) { /* records without a header before them would never be read */
    close(c->own_fd);
    c->own_fd = -1;
  }
  return code;
}

uint64_t counts_bytes(const checkpoint *c, uint64_t count) {
  return c->tails ? (count * c->tails + 1) * sizeof(uint64_t) : 0;
}

static struct iovec piece_of(const void *bytes, uint64_t size) {
  return (struct iovec){.iov_base = (void *)(uintptr_t)(bytes ? bytes : ""), .iov_len = size};
}

/* The counts with their digest, and the entries. @returns number of pieces */
static int tail_pieces(const checkpoint *c, uint64_t count, const checkpoint_tails *tails, uint64_t *digest,
                       struct iovec *before, struct iovec *behind) {
  if (!c->tails)
    return 0;
  uint64_t totals[CHECKPOINT_MOST_TAILS] = {0};
  for (uint64_t i = 0; i < count * c->tails; i++)
    totals[i % c->tails] += tails->counts[i];
  *digest = digest_bytes(0, tails->counts, count * c->tails * sizeof(uint64_t));
  before[0] = piece_of(tails->counts, count * c->tails * sizeof(uint64_t));
  before[1] = piece_of(digest, sizeof *digest);
  for (size_t i = 0; i < c->tails; i++)
    behind[i] = piece_of(tails->entries[i], totals[i] * c->identity.entry_bytes[i]);
  return 2 + (int)c->tails;
}

/* Bytes and digest of what follows the header. @returns false to give it up */
static bool digest_pieces(const struct iovec *pieces, int count, record_header *header) {
  for (int i = 0; i < count; i++)
    for (size_t done = 0; done < pieces[i].iov_len;) {
      const size_t left = pieces[i].iov_len - done, step = left < WRITE_BYTES ? left : WRITE_BYTES;
      header->rows = digest_bytes(header->rows, (const char *)pieces[i].iov_base + done, step);
      header->bytes += step;
      done += step;
      if (is_given_up(header->bytes))
        return false;
    }
  return true;
}

int checkpoint_append(checkpoint *c, uint64_t first, uint64_t count, const void *rows, const checkpoint_tails *tails,
                      message *why) {
  const uint64_t tasks = c->identity.tasks;
  if (!(count >= 1 && first < tasks && count <= tasks - first))
    return refuse(why, EXIT_FILES, "%s: tasks %llu to %llu are not among the %llu of the study", c->own_path,
                  (unsigned long long)first, (unsigned long long)(first + count - 1), (unsigned long long)tasks);
  if (c->own_fd < 0)
    return refuse(why, EXIT_FILES, "%s: not open for writing", c->folder);
  record_header header = {.magic = RECORD_MAGIC, .first = first, .count = count};
  struct iovec pieces[MOST_PIECES];
  uint64_t digest;
  pieces[0] = piece_of(&header, sizeof header);
  const int rows_at = c->tails ? 3 : 1;
  const int piece_count = 2 + tail_pieces(c, count, tails, &digest, pieces + 1, pieces + 4);
  pieces[rows_at] = piece_of(rows, count * c->identity.row_bytes);
  if (!digest_pieces(pieces + 1, piece_count - 1, &header))
    return refuse_stopped(c, why);
  header.check = record_header_check(&header);
  return append_pieces(c, pieces, piece_count, why);
}

/* Some file systems cannot sync folders (EINVAL), and a parent may be closed to reading (EACCES): in both
 * cases the system writes the folder later, and the run goes on. */
static int sync_folder(const char *path, message *why) {
  const int fd = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  int code = 0;
  if ((fd < 0 || fsync(fd)) && errno != EINVAL && errno != EACCES)
    code = refuse_errno(path, "sync the folder", why);
  if (fd >= 0)
    close(fd);
  return code;
}

int checkpoint_sync(checkpoint *c, message *why) {
  if (c->own_fd < 0)
    return 0;
  if (fdatasync(c->own_fd))
    return refuse_errno(c->own_path, "sync", why);
  if (c->folder_synced)
    return 0;
  char parent[PATH_MAX];
  snprintf(parent, sizeof parent, "%s/..", c->folder);
  int code = sync_folder(c->folder, why);
  if (!code)
    code = sync_folder(parent, why);
  c->folder_synced = !code;
  return code;
}

static int remove_parts(const char *folder, DIR *entries, message *why) {
  const struct dirent *entry;
  unsigned generation, rank;
  while ((entry = readdir(entries))) {
    char path[PATH_MAX];
    if (!part_name_parse(entry->d_name, &generation, &rank))
      continue;
    part_path(folder, generation, rank, path);
    if (unlink(path) && errno != ENOENT)
      return refuse_errno(path, "remove", why);
  }
  return 0;
}

int checkpoint_remove(const char *folder, message *why) {
  DIR *entries = opendir(folder);
  if (!entries)
    return errno == ENOENT ? 0 : refuse_errno(folder, "read the folder", why);
  const int code = remove_parts(folder, entries, why);
  closedir(entries);
  if (code)
    return code;
  if (rmdir(folder) && errno != ENOTEMPTY && errno != EEXIST && errno != ENOENT)
    return refuse_errno(folder, "remove the folder", why);
  return 0;
}
