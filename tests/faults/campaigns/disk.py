"""Every call on the files of a run (result, checkpoint, lock) fails once with an I/O error and once for want of space:
open, read, write, sync, truncate, close, rename, unlink and so on; a small study of every kind, some 3,000 trials of a
second. Expected: code 3 and a sentence, or done with the same result; then --resume gives the same result; no crash, no
temporary file left."""

import errno

from campaign import Trial
from injection import study_of_every_kind
from program import DONE, FILES, names

ERRORS = (errno.EIO, errno.ENOSPC)
REMOVALS = ("unlink", "unlinkat", "rmdir")  # what they do not remove stays until --resume


def fail_a_call(study, at, error):
    def trial(ricochet, folder):
        study.put(folder)
        run = study.run(ricochet, folder, calls="files", name="s.h5", at=at, error=error)
        what = next(iter(run.stacks))
        if run.result.code == DONE:
            assert run.result.err == "" or what in REMOVALS, run
        else:
            assert run.result.code == FILES and "s.h5" in run.result.err, run
            assert len(run.result.err.splitlines()) == 1 and not run.result.out, run
        assert what in REMOVALS or "s.h5.tmp" not in names(folder), f"{names(folder)} {run}"
        study.expect_resumed(ricochet, folder)
        return f"{what}: {run.result.err.strip() or 'done'}"

    return trial


def trials(ricochet):
    return [
        Trial(f"{study.name} {errno.errorcode[error]} {at}", fail_a_call(study, at, error))
        for study in study_of_every_kind(ricochet)
        for at in range(1, study.count("files", name="s.h5").calls + 1)
        for error in ERRORS
    ]
