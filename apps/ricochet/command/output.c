#include "run.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../base/file_kind.h"
#include "../result/result.h"
#include "../run/checkpoint.h"
#include "../run/ranks.h"
#include "../kind/machine.h"

/* File name of the study without its folder and its last extension. */
static void stem_of(const char *path, char *stem, size_t size) {
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
  size_t length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
  snprintf(stem, size, "%.*s", (int)(length < size ? length : size - 1), name);
}

static bool is_same_file(const char *a, const char *b) {
  struct stat x, y;
  return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

int output_name(output *out, const run_options *o, message *why) {
  char stem[4000];
  *out = (output){.lock = NULL};
  stem_of(o->study_path, stem, sizeof stem);
  int length = o->output ? snprintf(out->path, sizeof out->path, "%s", o->output)
                         : snprintf(out->path, sizeof out->path, "%s.h5", stem);
  if (length <= 0 || length >= 4000)
    return refuse(why, EXIT_USAGE, "-o: a path of %d bytes, expected 1 to 3999", length);
  if (is_same_file(out->path, o->study_path))
    return refuse(why, EXIT_USAGE, "%s: the output would replace the study itself; use -o for another name", out->path);
  snprintf(out->folder, sizeof out->folder, "%s.ckpt", out->path);
  return 0;
}

/* Nothing but a result, its checkpoint and what a killed run left of a result is ever replaced or removed. */
static int check_names(const output *out, message *why) {
  int code = file_kind_expect(out->path, FILE_REGULAR, why);
  if (!code)
    code = file_kind_expect(out->folder, FILE_FOLDER, why);
  return code ? code : result_check_partial(out->path, why);
}

static bool exists(const char *path) {
  return access(path, F_OK) == 0;
}

/* Whether the checkpoint folder holds anything besides the lock. */
static bool has_checkpoint(const char *folder) {
  DIR *d = opendir(folder);
  bool found = false;
  for (struct dirent *e; d && !found && (e = readdir(d));)
    found = strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0 && strcmp(e->d_name, "lock") != 0;
  if (d)
    closedir(d);
  return found;
}

static int refuse_existing(const output *out, message *why) {
  return refuse(why, EXIT_USAGE, "%s: exists; use --force to replace it, --resume to finish it, or -o for another one",
                out->path);
}

static int check_existing(const output *out, const run_options *o, message *why) {
  if (o->resume)
    return 0;
  if (o->force)
    return checkpoint_remove(out->folder, why);
  if (exists(out->path)) /* again: it may have been created before the lock was taken */
    return refuse_existing(out, why);
  if (has_checkpoint(out->folder))
    return refuse(why, EXIT_USAGE,
                  "%s: checkpoint of an unfinished run; use --resume to go on or --force to start over", out->folder);
  return 0;
}

int output_claim(output *out, const run_options *o, message *why) {
  int code = check_names(out, why);
  if (!code && !o->force && !o->resume && exists(out->path)) /* before a folder is made for the lock */
    code = refuse_existing(out, why);
  if (code)
    return code;
  code = lock_take(out->folder, o->resume ? 10 : 0, &out->lock, why);
  if (!code)
    code = check_existing(out, o, why);
  if (code)
    lock_release(&out->lock, 1);
  return code;
}

int output_check_result(const output *out, uint64_t digest, uint64_t tasks, uint64_t done, bool *finished,
                        message *why) {
  uint64_t theirs = 0;
  message detail;
  *finished = false;
  if (!exists(out->path) || (done > 0 && done < tasks))
    return 0;
  int code = result_study_digest(out->path, &theirs, &detail);
  if (!code)
    code = result_verify(out->path, (ric_poll){.call = stop_poll}, &detail);
  if (code == EXIT_STOPPED)
    return code;
  const bool sound = code == 0;
  *finished = sound && theirs == digest;
  if (*finished || done == tasks) /* a complete checkpoint replaces the result, as the forced run would have */
    return 0;
  if (!sound)
    return refuse(why, EXIT_FILES, "%s; use --force to compute it again", detail.text);
  return refuse(why, EXIT_USAGE, "%s: is the result of another study; use -o or --force", out->path);
}

int output_check_room(const output *out, double needed, message *why) {
  char needs[32], has[32];
  double disk = machine_disk(out->path);
  if (needed <= disk)
    return 0;
  return refuse(why, EXIT_FILES, "%s: checkpoint and result need %s more, but the folder has %s free", out->path,
                machine_size(needed, needs, sizeof needs), machine_size(disk, has, sizeof has));
}

int output_join(output *out, message *why) {
  int code = ranks_rank() == 0 ? 0 : lock_join(out->folder, ranks_rank(), &out->lock, why);
  return ranks_agree(code, why);
}

void output_release(output *out, bool drop) {
  message ignored; /* a checkpoint that cannot be removed is not a failure of the run */
  if (ranks_rank() == 0 && drop)
    checkpoint_remove(out->folder, &ignored);
  if (ranks_rank() != 0)
    lock_release(&out->lock, 0);
  ranks_barrier();
  lock_release(&out->lock, 1);
}
