#include "output.h"

#include <errno.h>
#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "../result/result.h"
#include "../run/checkpoint.h"
#include "../run/ranks.h"
#include "../task/machine.h"

/* File name of the study without its folder and its last extension. */
static void stem_of(const char *path, char *stem, size_t size) {
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
  size_t length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
  snprintf(stem, size, "%.*s", (int)(length < size ? length : size - 1), name);
}

int output_name(output *out, const run_options *o, message *why) {
  char stem[4000];
  *out = (output){.finished = false};
  stem_of(o->study_path, stem, sizeof stem);
  int length = o->output ? snprintf(out->path, sizeof out->path, "%s", o->output)
                         : snprintf(out->path, sizeof out->path, "%s.h5", stem);
  if (length <= 0 || length >= 4000)
    return refuse(why, EXIT_USAGE, "-o: a path of %d bytes, expected 1 to 3999", length);
  snprintf(out->folder, sizeof out->folder, "%s.ckpt", out->path);
  return 0;
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

/* The result that is there, under --resume. */
static int look_at_result(output *out, uint64_t digest, message *why) {
  uint64_t theirs;
  message detail;
  if (result_study_digest(out->path, &theirs, &detail) != 0 || result_verify(out->path, &detail) != 0)
    return refuse(why, EXIT_FILES, "%s; use --force to compute it again", detail.text);
  if (theirs != digest)
    return refuse(why, EXIT_USAGE, "%s: is the result of another study; use -o or --force", out->path);
  out->finished = true;
  return 0;
}

static int look_around(output *out, const run_options *o, uint64_t digest, message *why) {
  if (o->force)
    return checkpoint_remove(out->folder, why);
  if (o->resume)
    return exists(out->path) ? look_at_result(out, digest, why) : 0;
  if (exists(out->path))
    return refuse(why, EXIT_USAGE,
                  "%s: exists; use --force to replace it, --resume to finish it, or -o for another one", out->path);
  if (has_checkpoint(out->folder))
    return refuse(why, EXIT_USAGE,
                  "%s: checkpoint of an unfinished run; use --resume to go on or --force to start over", out->folder);
  return 0;
}

static int check_room(const output *out, double needed, message *why) {
  char needs[32], has[32];
  double disk = machine_disk(out->path);
  if (needed <= disk)
    return 0;
  return refuse(why, EXIT_FILES, "%s: checkpoint and result take %s, the folder has %s free", out->path,
                machine_size(needed, needs, sizeof needs), machine_size(disk, has, sizeof has));
}

int output_claim(output *out, const run_options *o, uint64_t digest, double needed, message *why) {
  if (!o->force && !o->resume) { /* before a folder is made for the lock */
    int code = look_around(out, o, digest, why);
    if (code)
      return code;
  }
  int code = lock_take(out->folder, o->resume ? 10 : 0, &out->lock, why);
  if (!code)
    code = look_around(out, o, digest, why);
  if (!code && !out->finished)
    code = check_room(out, needed, why);
  if (code)
    lock_release(&out->lock, 1);
  return code;
}

int output_join(output *out, message *why) {
  int code = ranks_rank() == 0 ? 0 : lock_join(out->folder, ranks_rank(), &out->lock, why);
  return ranks_agree(code, why);
}

void output_release(output *out, bool done) {
  message ignored; /* a checkpoint that stays behind is no failure of the run */
  if (ranks_rank() == 0 && done)
    checkpoint_remove(out->folder, &ignored);
  if (ranks_rank() != 0)
    lock_release(&out->lock, 0);
  ranks_barrier();
  lock_release(&out->lock, done);
}
