"""What tests of branches share: studies, running them, reading their results."""

import os
import resource
import signal

import h5py
from program import DONE, FILES, STOPPED, USAGE, assert_same, names, run_attributes, tasks_in, wait_until, words_of, write

BASE = """kind: branch
title: a ring of six
model:
  type: chain
  particles: 6
  gamma: 0
  floor: -1
  hertz: null
orbit:
  period: 1.5 pi
  at_start: [3]
branch:
  parameter: model.gamma
  from: 0
  to: 0.15
"""
WALL = """kind: branch
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 0.2, cross: true}
"""


def run(ricochet, folder, text, *words, name="s"):
    write(folder, f"{name}.yaml", text)
    ricochet.run(f"{name}.yaml", *words, cwd=folder).expect_done()
    return folder / f"{name}.h5"


def read(path):
    enums = ("outcome", "point_outcome", "point_stable", "special_kind", "segment_origin", "segment_outcome",
             "curve_outcome", "curve_end_outcome")
    with h5py.File(path) as file:
        found = {name: data[()] for name, data in file["branch"].items()}
        return found | {name: words_of(file["branch"][name]) for name in enums if name in found}


def rows(found, what, task=0):
    return slice(*found[f"{what}_offset"][task : task + 2])


def refuse(ricochet, folder, cases, base=BASE):
    """Cases of (old, new, line or 0, phrases...), replacements in the base."""
    for old, new, line, *phrases in cases:
        assert base.count(old) == 1, old
        write(folder, "s.yaml", base.replace(old, new))
        for command in ("check", "run"):
            place = f"s.yaml:{line}: " if line else "s.yaml: "
            ricochet(command, "s.yaml", cwd=folder).expect_refused(USAGE, place, *phrases)
        assert names(folder) == ["s.yaml"]


def _stop(ricochet, folder, how):
    """Stops a run when it has some tasks done. A fast one may come to its end before."""
    process = ricochet.start_run("s.yaml", cwd=folder, ranks=2)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= 4 or (folder / "s.h5").exists(), "records")
    if process.poll() is None:
        process.send_signal(how)
    return ricochet.end(process)


def _leave_half(ricochet, folder, size):
    """Leaves a checkpoint with about half of what a run records, which ends in a torn record. `size`: of the result, which
    then cannot be written, so that the checkpoint stays."""
    limit = (size - 1, size - 1)
    ricochet.run("s.yaml", cwd=folder, before=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit)).expect(FILES)
    (part,) = (folder / "s.h5.ckpt").glob("part-*")
    os.truncate(part, part.stat().st_size // 2)
    assert tasks_in(folder / "s.h5.ckpt") > 0


def equal_for_all_ranks_and_after_stops(ricochet, folder, text, ranks):
    """Runs a study of 5 tasks or more without mpirun, with numbers of ranks, and resumed with the last of them after a
    stop, a kill, and half of a checkpoint. Returns the first result."""
    paths = []
    for count in (0, *ranks):
        own = folder / str(count)
        own.mkdir()
        write(own, "s.yaml", text)
        ricochet.run("s.yaml", cwd=own, ranks=count).expect_done()
        paths.append(own / "s.h5")
        assert_same(paths[0], paths[-1])
    for name in ("stopped", "killed", "half"):
        own = folder / name
        own.mkdir()
        write(own, "s.yaml", text)
        if name == "stopped":
            assert _stop(ricochet, own, signal.SIGUSR1).code in (STOPPED, DONE)
        elif name == "killed":
            _stop(ricochet, own, signal.SIGKILL)
        else:
            _leave_half(ricochet, own, paths[0].stat().st_size)
        finished, done = (own / "s.h5").exists(), tasks_in(own / "s.h5.ckpt")
        ricochet.run("s.yaml", "--resume", cwd=own, ranks=ranks[-1]).expect_done()
        assert name == "killed" or finished or run_attributes(own / "s.h5")["tasks_resumed"] == done
        assert_same(paths[0], own / "s.h5", ("heap_checksums",))  # addresses, which move with the command line
    return paths[0]
