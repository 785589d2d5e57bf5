#include "checkpoint_files.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stop.h"

enum {
  READ_BYTES = 16 << 20,  /* at a time */
  OPENING_BYTES = 1 << 20 /* what is read in the time that the opening of a file takes on a slow network */
};

static void path_of(const checkpoint *c, size_t number, char *path) {
  part_path(c->folder, c->parts[number].generation, c->parts[number].rank, path);
}

static int refuse_number(const checkpoint *c, size_t number, const char *what, message *why) {
  char path[PATH_MAX];
  path_of(c, number, path);
  return refuse_errno(path, what, why);
}

int open_part(checkpoint *c, size_t number, message *why) {
  if (c->read_fd >= 0 && c->read_part == number)
    return 0;
  if (c->read_fd >= 0)
    close(c->read_fd);
  char path[PATH_MAX];
  path_of(c, number, path);
  c->read_fd = open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  c->read_part = number;
  return c->read_fd >= 0 ? 0 : refuse_errno(path, "open", why);
}

/* @returns bytes read, fewer than `size` at the end of the file, or -1 with errno. */
static int64_t read_at(int fd, void *bytes, size_t size, uint64_t offset) {
  size_t done = 0;
  while (done < size) {
    const ssize_t step = pread(fd, (char *)bytes + done, size - done, (off_t)(offset + done));
    if (step < 0 && errno == EINTR)
      continue;
    if (step < 0)
      return -1;
    if (step == 0)
      break;
    done += (size_t)step;
  }
  return (int64_t)done;
}

static finding read_piece(const checkpoint *c, void *bytes, size_t size, uint64_t offset, message *why) {
  const int64_t got = read_at(c->read_fd, bytes, size, offset);
  if (got < 0) {
    refuse_number(c, c->read_part, "read", why);
    return UNREADABLE;
  }
  return (uint64_t)got == size ? GOOD : BAD;
}

static int refuse_stopped(const checkpoint *c, message *why) {
  return refuse(why, EXIT_STOPPED, "%s: stopped while it was read", c->folder);
}

finding read_part(checkpoint *c, void *bytes, size_t size, uint64_t offset, message *why) {
  finding found = GOOD;
  for (size_t done = 0; found == GOOD && done < size;) {
    const size_t step = size - done < READ_BYTES ? size - done : READ_BYTES;
    found = read_piece(c, (char *)bytes + done, step, offset + done, why);
    done += step;
    if (found == GOOD && stop_asked_after(step, &c->unasked)) {
      refuse_stopped(c, why);
      found = STOPPED;
    }
  }
  return found;
}

int finding_failure(finding found) {
  return found == UNREADABLE ? EXIT_FILES : found == STOPPED ? EXIT_STOPPED : 0;
}

/* Without ragged tables the length is exactly that of the rows, with them at least that of rows and counts. */
static bool length_fits(const checkpoint *c, const record_header *header) {
  const uint64_t least = header->count * c->identity.row_bytes + counts_bytes(c, header->count);
  return c->tails ? header->bytes >= least : header->bytes == least;
}

finding read_record_header(const checkpoint *c, uint64_t offset, record_header *header, message *why) {
  const finding found = read_piece(c, header, sizeof *header, offset, why);
  if (found != GOOD)
    return found;
  const uint64_t tasks = c->identity.tasks;
  const bool good = header->magic == RECORD_MAGIC && header->check == record_header_check(header) &&
                    header->count >= 1 && header->first < tasks && header->count <= tasks - header->first &&
                    length_fits(c, header);
  return good ? GOOD : BAD;
}

static finding verify_rows(checkpoint *c, uint64_t offset, const record_header *header, message *why) {
  uint64_t digest = 0;
  offset += sizeof *header;
  for (uint64_t left = header->bytes; left;) {
    const size_t step = left < PART_BUFFER_BYTES ? (size_t)left : PART_BUFFER_BYTES;
    const finding found = read_part(c, c->buffer, step, offset, why);
    if (found != GOOD)
      return found;
    digest = digest_bytes(digest, c->buffer, step);
    offset += step;
    left -= step;
  }
  return digest == header->rows ? GOOD : BAD;
}

static int compare_identity(const char *path, const checkpoint_identity *found, const checkpoint_identity *expected,
                            message *why) {
  if (strcmp(found->version, expected->version) != 0)
    return refuse(why, EXIT_USAGE, "%s: written by version \"%s\", this is \"%s\"", path, found->version,
                  expected->version);
  if (found->tasks != expected->tasks || found->row_bytes != expected->row_bytes ||
      memcmp(found->entry_bytes, expected->entry_bytes, sizeof found->entry_bytes) != 0)
    return refuse(why, EXIT_USAGE,
                  "%s: shape of another study: %llu tasks with rows of %llu bytes, expected %llu of %llu", path,
                  (unsigned long long)found->tasks, (unsigned long long)found->row_bytes,
                  (unsigned long long)expected->tasks, (unsigned long long)expected->row_bytes);
  if (found->digest != expected->digest)
    return refuse(why, EXIT_USAGE, "%s: belongs to another study (digest %016llx, expected %016llx)", path,
                  (unsigned long long)found->digest, (unsigned long long)expected->digest);
  return 0;
}

/* `scanned` stays 0 while the header is incomplete. */
static int scan_part_header(checkpoint *c, size_t number, message *why) {
  part_header header;
  const finding found = read_piece(c, &header, sizeof header, 0, why);
  if (found != GOOD)
    return finding_failure(found);
  if (header.magic != PART_MAGIC || header.check != part_header_check(&header))
    return 0;
  char path[PATH_MAX];
  path_of(c, number, path);
  if (header.format != PART_FORMAT)
    return refuse(why, EXIT_USAGE, "%s: checkpoint format %llu, this version reads %d", path,
                  (unsigned long long)header.format, PART_FORMAT);
  header.identity.version[sizeof header.identity.version - 1] = '\0';
  c->parts[number].scanned = sizeof header;
  c->mixed = c->mixed || header.identity.arithmetic != c->identity.arithmetic;
  return compare_identity(path, &header.identity, &c->identity, why);
}

/* Whether the record at `scanned` is complete. Its rows are digested if `rows`, or if they failed before (they may have
 * been incomplete then). */
static finding check_record(checkpoint *c, size_t number, uint64_t size, bool rows, record_header *header,
                            message *why) {
  part *p = &c->parts[number];
  const finding found = read_record_header(c, p->scanned, header, why);
  if (found != GOOD)
    return found;
  if (header->bytes > size || p->scanned + sizeof *header > size - header->bytes)
    return BAD; /* its rows extend beyond the end of the file */
  if (!rows && !p->suspect)
    return GOOD;
  const finding verified = verify_rows(c, p->scanned, header, why);
  p->suspect = verified == BAD;
  return verified;
}

static int scan_part(checkpoint *c, size_t number, bool rows, message *why) {
  part *p = &c->parts[number];
  int code = open_part(c, number, why);
  if (!code && !p->scanned)
    code = scan_part_header(c, number, why);
  if (code || !p->scanned)
    return code;
  struct stat status;
  if (fstat(c->read_fd, &status))
    return refuse_number(c, number, "read", why);
  record_header header;
  finding found;
  while ((found = check_record(c, number, (uint64_t)status.st_size, rows, &header, why)) == GOOD) {
    const index_range range = {
        .first = header.first, .count = header.count, .offset = p->scanned, .part = (uint64_t)number};
    code = index_add(&c->index, range, why);
    if (code)
      return code;
    p->scanned += sizeof header + header.bytes;
  }
  return finding_failure(found);
}

static int compare_parts(const void *a, const void *b) {
  const part *x = a, *y = b;
  if (x->generation != y->generation)
    return x->generation < y->generation ? -1 : 1;
  return (x->rank > y->rank) - (x->rank < y->rank);
}

static bool has_part(const checkpoint *c, unsigned generation, unsigned rank) {
  for (size_t i = 0; i < c->part_count; i++)
    if (c->parts[i].generation == generation && c->parts[i].rank == rank)
      return true;
  return false;
}

static int note_part(checkpoint *c, unsigned generation, unsigned rank, message *why) {
  part *parts = realloc(c->parts, (c->part_count + 1) * sizeof *parts);
  if (!parts)
    return refuse(why, EXIT_RUN, "%s: out of memory for %zu files", c->folder, c->part_count + 1);
  c->parts = parts;
  c->parts[c->part_count++] = (part){.generation = generation, .rank = rank};
  return 0;
}

/* New parts are sorted, so that every rank numbers them identically; known ones keep the numbers used in the index. */
static int find_parts(checkpoint *c, message *why) {
  DIR *entries = opendir(c->folder);
  if (!entries)
    return refuse_errno(c->folder, "read the folder", why);
  const size_t known = c->part_count;
  int code = 0;
  const struct dirent *entry;
  while (!code && (errno = 0, entry = readdir(entries))) {
    unsigned generation, rank;
    if (part_name_parse(entry->d_name, &generation, &rank) && !has_part(c, generation, rank))
      code = note_part(c, generation, rank, why);
  }
  if (!code && errno)
    code = refuse_errno(c->folder, "read the folder", why);
  closedir(entries);
  if (c->part_count > known)
    qsort(c->parts + known, c->part_count - known, sizeof *c->parts, compare_parts);
  return code;
}

int checkpoint_scan(checkpoint *c, bool rows, message *why) {
  free(c->before); /* the counts are those of the old ranges */
  c->before = NULL;
  int code = find_parts(c, why);
  for (size_t i = 0; !code && i < c->part_count; i++)
    code = scan_part(c, i, rows, why);
  return code ? code : index_settle(&c->index, c->identity.tasks, why);
}

int refuse_record(const checkpoint *c, const index_range *range, message *why) {
  char path[PATH_MAX];
  path_of(c, range->part, path);
  return refuse(why, EXIT_FILES, "%s: the record of tasks %llu to %llu has been damaged", path,
                (unsigned long long)range->first, (unsigned long long)(range->first + range->count - 1));
}

/* Records of two ranks that alternate make the files be opened again and again. */
static int open_part_of_rows(checkpoint *c, size_t number, message *why) {
  const bool opens = c->read_fd < 0 || c->read_part != number;
  return opens && stop_asked_after(OPENING_BYTES, &c->unasked) ? refuse_stopped(c, why) : open_part(c, number, why);
}

int select_record(checkpoint *c, const index_range *range, message *why) {
  const int code = open_part_of_rows(c, range->part, why);
  if (code || (c->verified_offset == range->offset && c->verified_part == range->part))
    return code;
  c->verified_offset = 0;
  finding found = read_record_header(c, range->offset, &c->verified, why);
  if (found == GOOD)
    found = verify_rows(c, range->offset, &c->verified, why);
  if (found != GOOD)
    return found == BAD ? refuse_record(c, range, why) : finding_failure(found);
  c->verified_part = range->part;
  c->verified_offset = range->offset;
  return 0;
}

int read_verified(checkpoint *c, void *bytes, uint64_t size, uint64_t offset, message *why) {
  const finding found = read_part(c, bytes, size, offset, why);
  if (found != BAD)
    return finding_failure(found);
  errno = EIO; /* it was longer when it was verified */
  return refuse_number(c, c->read_part, "read", why);
}

int checkpoint_read(checkpoint *c, uint64_t first, uint64_t count, void *rows, message *why) {
  unsigned char *to = rows;
  while (count) {
    const index_range *range = index_find(&c->index, first);
    if (!range)
      return refuse(why, EXIT_FILES, "%s: task %llu is in no record", c->folder, (unsigned long long)first);
    int code = select_record(c, range, why);
    if (code)
      return code;
    const uint64_t there = range->count - (first - range->first), step = count < there ? count : there;
    const size_t bytes = step * c->identity.row_bytes;
    const uint64_t skipped = (first - c->verified.first) * c->identity.row_bytes;
    const uint64_t rows_at = range->offset + sizeof c->verified + counts_bytes(c, c->verified.count);
    code = read_verified(c, to, bytes, rows_at + skipped, why);
    if (code)
      return code;
    to += bytes;
    first += step;
    count -= step;
  }
  return 0;
}
