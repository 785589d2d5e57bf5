"""Campaigns of faults: many trials of one kind, too many for every change, one after the other and with a log.

A campaign is a file in campaigns/: its docstring says what it does, and `trials(ricochet)` lists its trials. A trial is
run in a process and an empty folder of its own; what it started is killed with it when its time is over."""

import argparse
import hashlib
import multiprocessing
import os
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from importlib import import_module
from multiprocessing.connection import wait
from pathlib import Path
from typing import NamedTuple

from program import Program

ROOT = Path(__file__).resolve().parent.parent.parent
CAMPAIGNS = Path(__file__).resolve().parent / "campaigns"
PASSED, KNOWN, FAILED, HANGS = "passed", "known", "failed", "hangs"
FINE = (PASSED, KNOWN)


class Known(Exception):
    """What a trial raises for a fault of a library that we know and cannot mend; it says whose and where. It is logged and
    counted, and does not fail the campaign."""


class Trial(NamedTuple):
    name: str  # the same in every run of the campaign
    run: Callable  # of (ricochet, folder); returns a few words for the log, or raises AssertionError or Known
    limit: float = 60  # seconds


# --- one trial ---


def verdict_of(trial, ricochet, folder):
    """(verdict, detail) of a trial, in its own process."""
    try:
        return PASSED, trial.run(ricochet, folder) or ""
    except Known as known:
        return KNOWN, str(known)
    except AssertionError as failure:
        return FAILED, str(failure) or traceback.format_exc(limit=-1)
    except Exception:  # whatever it is, the campaign goes on
        return FAILED, traceback.format_exc(limit=-3)


class Running:
    """A trial on its way."""

    def __init__(self, trial, binary):
        self.trial, self.began = trial, time.monotonic()
        self.place = tempfile.TemporaryDirectory(prefix="ricochet-", ignore_cleanup_errors=True)
        self.answer, answer = multiprocessing.Pipe(duplex=False)
        self.process = multiprocessing.Process(target=self.work, args=(binary, answer))
        self.process.start()
        answer.close()

    def work(self, binary, answer):
        os.setsid()  # so that everything it starts can be found
        folder, shared = Path(self.place.name) / "folder", Path(self.place.name) / "shared"
        folder.mkdir()
        shared.mkdir()
        answer.send(verdict_of(self.trial, Program(binary, ROOT, shared), folder))

    def seconds(self):
        return time.monotonic() - self.began

    def left(self):
        return max(0, self.trial.limit - self.seconds())

    def end(self):
        """(verdict, detail) of a trial that has ended or whose time is over; nothing of it is left."""
        late = self.process.is_alive() and not self.answer.poll()
        kill_session(self.process.pid)
        self.process.join()
        try:
            found = self.answer.recv() if not late else (HANGS, f"not over after {self.trial.limit:g} s")
        except EOFError:
            found = FAILED, f"the trial itself ended with {self.process.exitcode}"
        self.answer.close()
        self.place.cleanup()
        return found


def kill_session(leader):
    """Kills all processes of a session, mpirun's ranks among them, which have process groups of their own."""
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            if int((entry / "stat").read_text().rsplit(")", 1)[1].split()[3]) == leader:
                os.kill(int(entry.name), signal.SIGKILL)
        except (OSError, IndexError):  # it ended while we looked
            pass


def run_trials(trials, binary, jobs, deadline, tell):
    """Runs trials until all are over, or no more after the deadline. Calls tell(trial, verdict, detail, seconds)."""
    waiting, running = list(reversed(trials)), []
    while running or (waiting and time.monotonic() < deadline):
        while waiting and len(running) < jobs and time.monotonic() < deadline:
            running.append(Running(waiting.pop(), binary))
        ended = wait([r.answer for r in running], timeout=min((r.left() for r in running), default=0))
        for one in [r for r in running if r.answer in ended or r.left() == 0]:
            running.remove(one)
            seconds = one.seconds()
            tell(one.trial, *one.end(), seconds)


# --- the log ---


class Log:
    """A file with a line per trial: name, verdict, seconds, detail, with tabs between. Its first line names the program:
    what another build has passed says nothing."""

    def __init__(self, path, binary, goes_on):
        self.verdicts = {}
        head = f"# {hashlib.sha256(binary.read_bytes()).hexdigest()[:16]}\n"
        if goes_on and path.exists():
            with path.open() as file:
                if file.readline() != head:
                    sys.exit(f"{path}: of another build of the program; remove it, or name another log")
                self.verdicts = dict(line.split("\t")[:2] for line in file)
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(head)
        self.file = path.open("a")

    def has_passed(self, trial):
        return self.verdicts.get(trial.name) in FINE

    def add(self, trial, verdict, detail, seconds):
        self.verdicts[trial.name] = verdict
        words = " | ".join(line.strip() for line in detail.splitlines()).replace("\t", " ")
        self.file.write(f"{trial.name}\t{verdict}\t{seconds:.1f}\t{words}\n")
        self.file.flush()
        if verdict != PASSED:
            print(f"{verdict}: {trial.name}: {detail}", flush=True)


# --- the command ---


def spread(trials, count):
    """So many trials, at equal distances in the list."""
    count = min(count or len(trials), len(trials))
    return [trials[i * len(trials) // count] for i in range(count)]


def summary(trials, log):
    """Prints how many trials had which verdict; the exit code."""
    found = [log.verdicts.get(t.name, "not run") for t in trials]
    counts = ", ".join(f"{found.count(v)} {v}" for v in dict.fromkeys((PASSED, *sorted(set(found)))))
    print(f"{len(trials)} trials: {counts}; log: {log.file.name}")
    return 0 if all(v in (*FINE, "not run") for v in found) and set(found) & set(FINE) else 1


def described():
    names = sorted(path.stem for path in CAMPAIGNS.glob("*.py"))
    return "\n\n".join(f"{name}\n  " + import_module(name).__doc__.strip().replace("\n", "\n  ") for name in names)


def arguments():
    parser = argparse.ArgumentParser(
        prog="faults", formatter_class=argparse.RawDescriptionHelpFormatter, epilog="campaigns:\n\n" + described(),
        description="Runs a campaign of faults against the program. Exit code 0: no trial failed.")  # fmt: skip
    parser.add_argument("campaign", choices=sorted(path.stem for path in CAMPAIGNS.glob("*.py")))
    parser.add_argument("--log", type=Path, help="a line per trial; goes on with this log, and leaves out what has "
                        "passed. Default: a new one beside the build")  # fmt: skip
    parser.add_argument("--limit", type=float, default=float("inf"), metavar="MINUTES", help="starts no trial after them")
    parser.add_argument("--trials", type=int, metavar="N", help="N trials, at equal distances in the list")
    parser.add_argument("-k", default="", metavar="NAME", help="trials whose names contain this")
    parser.add_argument("-j", "--jobs", type=int, default=1, metavar="N", help="so many at a time")
    parser.add_argument("--list", action="store_true", help="prints the names of the trials only")
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release", help="folder of the build")
    return parser.parse_args()


def main():
    sys.path.append(str(CAMPAIGNS))
    given = arguments()
    binary = given.build.resolve() / "bin" / "ricochet"
    deadline = time.monotonic() + 60 * given.limit
    with tempfile.TemporaryDirectory(prefix="ricochet-") as shared:
        listed = import_module(given.campaign).trials(Program(binary, ROOT, Path(shared)))
        trials = spread([t for t in listed if given.k in t.name], given.trials)
        if given.list:
            return print("\n".join(t.name for t in trials))
        log = Log(given.log or given.build / "faults" / f"{given.campaign}.log", binary, goes_on=given.log is not None)
        left = [t for t in trials if not log.has_passed(t)]
        run_trials(left, binary, given.jobs, deadline, log.add)
    return summary(trials, log)
