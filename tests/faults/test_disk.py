"""A disk that fills up ends a run with one line, a usable checkpoint and the old result as it was."""

import os
import re
import resource
import subprocess

import pytest
from program import FILES, assert_same, names, run_attributes, study, sweep, tasks_in
from program import trajectory, wait_until, write

# Files grow until a limit instead of a full disk. The shared memory of MPI would meet it first, and below some 5 MB the
# files through which mpirun and its ranks find each other.
NO_SHARED_MEMORY = ("--mca", "btl", "tcp,self", "--mca", "osc", "^sm")
SMALL, MIDDLE = 8 << 20, 20 << 20  # less than the checkpoint of a rank; more than that, less than the result
WIDE = study(particles=400, at_start="[7]", sweep=sweep(4000))  # 6.7 kB a task: 27 MB in all
SLOW = study(particles=100000, at_start="[7]", orbit="states: false", sweep=sweep(500))  # some 10 ms a task
# Rows of 700 bytes with some 20 MB of impacts behind them.
RAGGED = trajectory(10, start="v: [1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2]", time="samples: 2",
                    sweep="{parameter: time.duration, from: 100, to: 16000, points: 60, scale: log}")
ANY_COMMAND = ("heap_checksums",)  # holds addresses, which move with the length of the command line


def files_up_to(size):
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def whole_size(ricochet, folder, text):
    """Bytes of the finished result, which also stays as `whole.h5`."""
    write(folder, "s.yaml", text)
    ricochet.run("s.yaml", "-o", "whole.h5", cwd=folder).expect_done()
    return os.stat(folder / "whole.h5").st_size


def fill_the_checkpoint(ricochet, folder, study):
    """Runs of two ranks until all tasks are done, with files too small for the result. A rank that takes more than its
    half may fill its file before; then the next run has what is left, which is less than a file holds."""
    for _ in range(3):
        result = ricochet.run(
            study, "--resume", cwd=folder, ranks=2, mpi=NO_SHARED_MEMORY, before=files_up_to(MIDDLE)
        )
        result.expect_refused(FILES, "s.h5", "cannot write", "File too large")
        if tasks_in(folder / "s.h5.ckpt") == 4000:
            return result
    raise AssertionError(f"{tasks_in(folder / 's.h5.ckpt')} tasks after three runs")


# --- a limit on the size of files ---


def test_no_space_for_the_checkpoint(ricochet, folder):
    whole_size(ricochet, folder, WIDE)
    for ranks in (0, 2):
        result = ricochet.run(
            "s.yaml", "--resume", cwd=folder, ranks=ranks, mpi=NO_SHARED_MEMORY, before=files_up_to(SMALL)
        )
        result.expect_refused(FILES, "s.h5.ckpt/part-", "cannot write", "File too large")
        assert names(folder) == ["s.h5.ckpt", "s.yaml", "whole.h5"]
        assert tasks_in(folder / "s.h5.ckpt") > 0
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2).expect_done()
    assert run_attributes(folder / "s.h5")["tasks_resumed"] > 0
    assert_same(folder / "whole.h5", folder / "s.h5", ANY_COMMAND)
    assert names(folder) == ["s.h5", "s.yaml", "whole.h5"]


def test_no_space_for_the_result(ricochet, folder):
    """The checkpoint of two ranks is several files of at most this size: they fit where the result does not."""
    whole_size(ricochet, folder, WIDE)
    fill_the_checkpoint(ricochet, folder, "s.yaml")
    for _ in range(2):
        result = fill_the_checkpoint(ricochet, folder, "s.yaml")
        result.expect_refused(FILES, "s.h5: ", "cannot write", "File too large")
        assert names(folder) == ["s.h5.ckpt", "s.yaml", "whole.h5"]
        assert tasks_in(folder / "s.h5.ckpt") == 4000
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=3).expect_done()
    assert run_attributes(folder / "s.h5")["tasks_resumed"] == 4000
    assert_same(folder / "whole.h5", folder / "s.h5", ANY_COMMAND)


def test_the_last_bytes_of_the_result_are_missed_too(ricochet, folder):
    size = whole_size(ricochet, folder, WIDE)
    for missing in (1, 4096):
        result = ricochet.run(
            "s.yaml", "--resume", cwd=folder, ranks=2, mpi=NO_SHARED_MEMORY, before=files_up_to(size - missing)
        )
        result.expect_refused(FILES, "s.h5: ", "File too large")
        assert names(folder) == ["s.h5.ckpt", "s.yaml", "whole.h5"]


def test_the_old_result_outlives_a_forced_run_without_space(ricochet, folder):
    whole_size(ricochet, folder, WIDE)
    before = (folder / "whole.h5").read_bytes()
    for limit in (SMALL, MIDDLE):
        result = ricochet.run(
            "s.yaml", "-o", "whole.h5", "--force", cwd=folder, ranks=2, mpi=NO_SHARED_MEMORY, before=files_up_to(limit)
        )
        result.expect_refused(FILES, "whole.h5", "File too large")
        assert (folder / "whole.h5").read_bytes() == before
        assert names(folder) == ["s.yaml", "whole.h5", "whole.h5.ckpt"]


def test_no_space_for_what_comes_on_top_of_the_rows(ricochet, folder):
    """Impacts are of no known number before they are computed: the checkpoint, or the result, meets the limit."""
    size = whole_size(ricochet, folder, RAGGED)
    for limit, place in ((6 << 20, "s.h5.ckpt/part-"), (size - 1, "s.h5: ")):
        result = ricochet.run(
            "s.yaml", "--resume", cwd=folder, ranks=2, mpi=NO_SHARED_MEMORY, before=files_up_to(limit)
        )
        result.expect_refused(FILES, place, "cannot write", "File too large")
        assert names(folder) == ["s.h5.ckpt", "s.yaml", "whole.h5"]
    assert tasks_in(folder / "s.h5.ckpt") == 60
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=3).expect_done()
    assert run_attributes(folder / "s.h5")["tasks_computed"] == 0
    assert_same(folder / "whole.h5", folder / "s.h5", ANY_COMMAND)


# --- a small file system ---


class SmallDisk:
    def __init__(self, folder, size):
        self.path = folder / "disk"
        self.path.mkdir()
        words = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(self.path)]
        if subprocess.run(words, capture_output=True).returncode != 0:
            pytest.skip("mounting is not permitted")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", "-l", str(self.path)], check=True)

    def fill(self):
        """Takes whatever space is left, to the last page."""
        with open(self.path / "ballast", "ab", buffering=0) as file:
            try:
                while True:
                    file.write(b"x" * 4096)
            except OSError:
                pass

    def empty(self):
        (self.path / "ballast").unlink()


def test_a_disk_without_room_is_refused_at_once(ricochet, folder):
    write(folder, "s.yaml", WIDE)
    with SmallDisk(folder, "40m") as disk:
        for ranks in (0, 2):
            result = ricochet.run(folder / "s.yaml", cwd=disk.path, ranks=ranks)
            result.expect_refused(FILES, "s.h5: ", "free")
            assert names(disk.path) == []


def test_a_disk_that_fills_up_while_tasks_are_computed(ricochet, folder):
    write(folder, "s.yaml", SLOW)
    with SmallDisk(folder, "2m") as disk:
        for ranks in (0, 2, 3):
            before = tasks_in(disk.path / "s.h5.ckpt")
            run = ricochet.start_run(folder / "s.yaml", "--resume", cwd=disk.path, ranks=ranks)
            wait_until(lambda: tasks_in(disk.path / "s.h5.ckpt") >= before + 2, "records")
            disk.fill()
            result = ricochet.end(run)
            result.expect_refused(FILES, "s.h5", "No space left on device")
            assert names(disk.path) == ["ballast", "s.h5.ckpt"]
            disk.empty()
        ricochet.run(folder / "s.yaml", "--resume", cwd=disk.path, ranks=2).expect_done()
        assert run_attributes(disk.path / "s.h5")["tasks_resumed"] >= 6
        assert names(disk.path) == ["s.h5"]
        ricochet("show", "s.h5", "--verify", cwd=disk.path).expect_done()


def test_a_disk_without_space_for_the_result(ricochet, folder):
    """All tasks are done and half of the disk is taken since: the result fails, before or while it is written."""
    write(folder, "s.yaml", WIDE)
    with SmallDisk(folder, "120m") as disk:
        fill_the_checkpoint(ricochet, disk.path, folder / "s.yaml")
        disk.fill()
        for ranks in (0, 2):
            result = ricochet.run(folder / "s.yaml", "--resume", cwd=disk.path, ranks=ranks)
            result.expect(FILES).expect_line("s.h5")
            assert re.search("No space left on device|free", result.err), result
            assert names(disk.path) == ["ballast", "s.h5.ckpt"]
            assert tasks_in(disk.path / "s.h5.ckpt") == 4000
        disk.empty()
        ricochet.run(folder / "s.yaml", "--resume", cwd=disk.path).expect_done()
        assert names(disk.path) == ["s.h5"]


def test_room_for_the_rest_is_enough_to_resume(ricochet, folder):
    """With all tasks in the checkpoint a run needs no more than the space of the result."""
    write(folder, "s.yaml", WIDE)
    with SmallDisk(folder, "66m") as disk:
        fill_the_checkpoint(ricochet, disk.path, folder / "s.yaml")
        ricochet.run(folder / "s.yaml", "--resume", cwd=disk.path).expect_done()


def test_a_file_system_that_is_read_only(ricochet, folder):
    write(folder, "s.yaml", WIDE)
    with SmallDisk(folder, "120m") as disk:
        if subprocess.run(["mount", "-o", "remount,ro", str(disk.path)], capture_output=True).returncode != 0:
            pytest.skip("remounting is not permitted")
        for words in ([], ["--resume"], ["--force"]):
            refused = ricochet.run(folder / "s.yaml", *words, cwd=disk.path)
            refused.expect_refused(FILES, "s.h5", "Read-only file system")
