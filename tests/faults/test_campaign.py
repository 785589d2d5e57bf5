"""What runs campaigns of faults: every trial has a verdict, hanging ones too, and a log that is gone on with."""

import subprocess
import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
from campaign import FAILED, HANGS, KNOWN, PASSED, Known, Log, Trial, run_trials, spread, summary


def fails(ricochet, folder):
    assert not list(folder.iterdir()), "not empty"
    raise AssertionError("two\nlines")


def knows(ricochet, folder):
    raise Known("a library")


def hangs(ricochet, folder):
    """Leaves a process behind, in a process group of its own."""
    child = subprocess.Popen(["sleep", "1000"], process_group=0)
    Path("child").write_text(str(child.pid))
    child.wait()


TRIALS = [Trial("good", lambda ricochet, folder: "fine"), Trial("bad", fails), Trial("wrong", lambda *_: 1 / 0),
          Trial("theirs", knows), Trial("slow", hangs, 2)]  # fmt: skip


@pytest.fixture
def binary(folder, monkeypatch):
    monkeypatch.chdir(folder)
    (folder / "program").write_text("a program")
    return folder / "program"


def run(trials, binary, deadline=float("inf"), goes_on=True):
    log = Log(Path("the.log"), binary, goes_on)
    run_trials([t for t in trials if not log.has_passed(t)], binary, 2, deadline, log.add)
    return log


def is_running(process):
    try:
        return Path("/proc", process, "cmdline").read_bytes() != b""  # empty once it has ended and nobody has asked how
    except FileNotFoundError:
        return False


def test_every_trial_has_a_verdict(binary, folder):
    log = run(TRIALS, binary)
    assert log.verdicts == {"good": PASSED, "bad": FAILED, "wrong": FAILED, "theirs": KNOWN, "slow": HANGS}
    assert summary(TRIALS, log) == 1 and summary([TRIALS[0], TRIALS[3]], log) == 0
    assert not is_running((folder / "child").read_text())
    lines = {line.split("\t")[0]: line.split("\t") for line in Path("the.log").read_text().splitlines()[1:]}
    assert lines["good"][3] == "fine" and lines["bad"][3] == "two | lines" and "division" in lines["wrong"][3]


def test_with_the_same_log_what_has_passed_is_left_out(binary):
    run(TRIALS[:2], binary)
    changed = [TRIALS[0]._replace(run=fails), TRIALS[1]._replace(run=TRIALS[0].run)]
    assert run(changed, binary).verdicts == {"good": PASSED, "bad": PASSED}
    assert run(changed, binary, goes_on=False).verdicts == {"good": FAILED, "bad": PASSED}


def test_a_log_of_another_build_is_refused(binary):
    run(TRIALS[:1], binary)
    binary.write_text("another program")
    with pytest.raises(SystemExit, match="another build"):
        run(TRIALS[:1], binary)


def test_nothing_begins_after_the_deadline(binary):
    log = run(TRIALS, binary, deadline=time.monotonic())
    assert log.verdicts == {} and summary(TRIALS, log) == 1


def test_a_sample_is_spread_over_the_list():
    assert spread(list("abcdef"), 3) == list("ace") and spread(list("ab"), 5) == spread(list("ab"), None) == list("ab")
