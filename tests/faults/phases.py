"""A run at each moment of its life: the phases of a run, and how to wait for an instant in one of them.

The file calls of a run are paused (pause.c), so that even phases of a millisecond can be met."""

import os
import random
import re
import signal
import time
from pathlib import Path

from program import DONE, assert_same, hears, names, ranks_of, records, run_attributes, wait_until, write

ANY_COMMAND = ("heap_checksums",)  # holds addresses, which move with the length of the command line
PHASES = ("start", "tasks", "tables", "result", "end")
PAUSE_MS = 10


def kinds_of(ricochet, folder):
    """Asked from the program."""
    text = ricochet("--help", cwd=folder).expect(DONE).out.split("Kinds of study")[1].split("\n\n")[0]
    return re.findall(r"^  (\w+) ", text, re.M)


def shortened(text):
    """A shipped study with few points along its sweeps."""
    most = 15 if text.count("points: ") > 1 else 200
    return re.sub(r"points: (\d+)", lambda found: f"points: {min(int(found[1]), most)}", text)


def study_of(ricochet, kind):
    """The first shipped study of a kind: of those with tables besides those of the tasks, or of those with a sweep, if
    there are any."""
    texts = [path.read_text() for path in sorted(ricochet.studies.glob("*.yaml"))]
    texts = [text for text in texts if re.search(rf"^kind: *{kind}\b", text, re.M)]
    for wanted in (r"(windows|special_points): true", "^sweep:", ""):
        found = [text for text in texts if re.search(wanted, text, re.M)]
        if found:
            return shortened(found[0])
    raise AssertionError(f"no study of kind {kind} is shipped")


def paused(ricochet):
    """What slows the file calls of the program down."""
    library = ricochet.binary.parent / "libfault_pause.so"
    return {"LD_PRELOAD": str(library), "PAUSE_NAME": "s.h5", "PAUSE_MS": str(PAUSE_MS)}


class Paused:
    """A run of s.yaml in a folder, and what is to be seen of it from outside."""

    def __init__(self, ricochet, folder, ranks, tasks):
        self.ricochet, self.folder, self.tasks, self.ranks = ricochet, folder, tasks, ranks
        self.had_result = (folder / "s.h5").exists()
        self.run = ricochet.start_run("s.yaml", "--resume", cwd=folder, ranks=ranks, env=paused(ricochet))

    def phase(self):
        """The phase that the run is in, as far as its files tell."""
        if (self.folder / "s.h5").exists():
            return "end"
        if (self.folder / "s.h5.tmp").exists():
            return "result"
        done = sum(count for _, count in records(self.folder / "s.h5.ckpt"))
        return "tables" if done >= self.tasks else "tasks" if done > 0 else "start"

    def wait_for(self, phase):
        """False if the run ended before."""
        while PHASES.index(self.phase()) < PHASES.index(phase):
            if self.run.poll() is not None:
                return False
            time.sleep(0.001)
        return self.run.poll() is None

    def processes(self):
        """{rank: process}; a single one is rank 0."""
        return ranks_of(self.run) if self.ranks else {0: self.run.pid}

    def wait_for_handlers(self, number):
        """Until all its processes hear a signal, or it has ended. Before the first instruction of a program its signals
        are the system's."""

        def hear():
            pids = [self.run.pid, *self.processes().values()]
            return self.run.poll() is not None or all(hears(pid, number) for pid in pids)

        wait_until(hear, "the beginning of the program", 30)

    def end(self, limit):
        return self.ricochet.end(self.run, limit)

    def end_of_killed(self):
        """Waits for the end of a run of which something was killed; False if mpirun alone is left. That of Open MPI 4.1
        may wait for ever in PMIx_server_finalize, for a lock that nobody holds, if one of its ranks was killed."""
        wait_until(lambda: self.run.poll() is not None or not self.processes(), "the end of the ranks", 15)
        deadline = time.monotonic() + 5
        while self.run.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
        hangs = self.run.poll() is None
        if hangs:
            self.run.kill()
        self.end(5)
        wait_until(lambda: not is_locked(self.folder), "the end of the ranks", 15)
        return not hangs


class Subject:
    """A study that is run over and over, and its undisturbed result."""

    def __init__(self, name, text):
        self.name, self.text, self.lengths, self.whole = name, text, {}, None

    def prepare(self, ricochet):
        """The undisturbed result, and how long each phase of a paused run takes."""
        folder = ricochet.new_folder()
        write(folder, "s.yaml", self.text)
        checked = ricochet("check", "s.yaml", cwd=folder).expect(DONE).out
        self.tasks = int(re.search(r"tasks +(\d+)", checked)[1])
        run, begin = Paused(ricochet, folder, 0, self.tasks), time.monotonic()
        for phase in PHASES:
            run.wait_for(phase)
            self.lengths[phase] = time.monotonic()
        run.end(120).expect_done()
        times = [begin, *(self.lengths[p] for p in PHASES[1:]), time.monotonic()]
        self.lengths = {phase: max(times[i + 1] - times[i], 0.002) for i, phase in enumerate(PHASES)}
        self.whole = folder / "s.h5"

    def reach(self, ricochet, folder, ranks, phase, chance):
        """A run at a random instant of a phase, and whether it is not over."""
        run = Paused(ricochet, folder, ranks, self.tasks)
        run.wait_for(phase)
        mpi_starts = 0.5 if ranks and phase == "start" else 0
        time.sleep(chance.random() * (self.lengths[phase] + mpi_starts))
        return run, run.run.poll() is None

    def expect_whole(self, folder):
        assert names(folder) == ["s.h5", "s.yaml"], names(folder)
        assert_same(self.whole, folder / "s.h5", ANY_COMMAND)

    def expect_resumed(self, ricochet, folder, ranks, finished):
        """What was finished is not computed again, and the result is the undisturbed one."""
        there = (folder / "s.h5").exists()
        ricochet.run("s.yaml", "--resume", cwd=folder, ranks=ranks, limit=120).expect_done()
        self.expect_whole(folder)
        if not there:
            assert run_attributes(folder / "s.h5")["tasks_resumed"] >= len(finished) == len(set(finished))


def finished_tasks(folder):
    return [task for first, count in records(folder / "s.h5.ckpt") for task in range(first, first + count)]


def is_locked(folder):
    """Whether any process has the lock file of the output open."""
    path = str(folder / "s.h5.ckpt" / "lock")
    for link in Path("/proc").glob("[0-9]*/fd/*"):
        try:
            if os.readlink(link).removesuffix(" (deleted)") == path:
                return True
        except OSError:
            pass
    return False


# --- at whom ---


def send(pids, number):
    for pid in pids:
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            pass


def at_alone(run, number):
    send([run.run.pid], number)


def at_rank_0(run, number):
    send([run.processes().get(0, run.run.pid)], number)


def at_rank_1(run, number):
    send([run.processes().get(1, run.run.pid)], number)


def at_mpirun(run, number):
    send([run.run.pid], number)


def at_all(run, number):
    send([run.run.pid, *run.processes().values()], number)


TARGETS = {"alone": (at_alone, 0), "rank 0": (at_rank_0, 2), "rank 1": (at_rank_1, 3), "mpirun": (at_mpirun, 2),
           "all": (at_all, 3)}  # fmt: skip
KILL = signal.SIGKILL


def chance_of(name):
    """Random numbers that are the same in every run of the campaign."""
    return random.Random(name)
