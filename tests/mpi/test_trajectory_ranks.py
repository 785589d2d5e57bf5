"""Trajectories, whose tables of impacts are ragged, are the same for any number of ranks and however they are stopped."""

import signal

import h5py
import numpy as np
import program
from program import STOPPED, assert_same, names, run_attributes, tasks_in, trajectory, wait_until, write

ANY_COMMAND = ("heap_checksums",)  # holds addresses, which move with the length of the command line
TASKS = 60


def speeds(particles):
    return "v: [" + ", ".join(f"{1.1 + 0.02 * i:.2f}" for i in range(particles)) + "]"


def durations(points, low, high):
    return f"{{parameter: time.duration, from: {low}, to: {high}, points: {points}, scale: log}}"


SLOW = trajectory(100, start=speeds(100), time="samples: 11", sweep=durations(TASKS, 10, 100))  # some 30 ms a task


def run_on(ricochet, folder, ranks, text):
    """Each number of ranks in a folder of its own, so that the command lines are equal too."""
    own = folder / str(ranks)
    own.mkdir()
    write(own, "s.yaml", text)
    ricochet.run("s.yaml", cwd=own, ranks=ranks).expect_done()
    assert names(own) == ["s.h5", "s.yaml"]
    return own / "s.h5"


def assert_equal_for_all_ranks(ricochet, folder, text, counts=(1, 2, 3)):
    """Returns the offsets of the impacts."""
    paths = [run_on(ricochet, folder, ranks, text) for ranks in (0, *counts)]
    for path in paths[1:]:
        assert_same(paths[0], path)
        ricochet("show", path, "--verify", cwd=folder).expect_done()
    with h5py.File(paths[0]) as file:
        return file["trajectory/impact_offset"][()]


def test_tasks_with_very_different_numbers_of_impacts_are_equal_for_all_ranks(ricochet, folder):
    text = trajectory(3, start="v: [0.5, 1.2, 3]", time="samples: 7", sweep=durations(200, 0.1, 500))
    offsets = assert_equal_for_all_ranks(ricochet, folder, text)
    assert np.diff(offsets).min() == 0 and np.diff(offsets).max() > 100


def test_ragged_tables_of_many_chunks_are_equal_for_all_ranks(ricochet, folder):
    """More impacts than the blocks of several ranks hold, and blocks that begin in the middle of tasks."""
    text = trajectory(10, start=speeds(10), time="samples: 2", sweep=durations(60, 100, 8000))
    offsets = assert_equal_for_all_ranks(ricochet, folder, text, (2, 3))
    assert offsets[-1] > 3 * 65536, offsets[-1]


EXPONENTS = trajectory(10, start=speeds(10), time="samples: 3, lyapunov: true", sweep=durations(TASKS, 20, 400))


def test_exponents_are_equal_for_all_ranks_and_after_a_stop(ricochet, folder):
    assert_equal_for_all_ranks(ricochet, folder, EXPONENTS, (1, 3))
    own = folder / "stopped"
    own.mkdir()
    stopped(ricochet, own, EXPONENTS)
    ricochet.run("s.yaml", "--resume", cwd=own, ranks=3).expect_done()
    assert_same(folder / "0" / "s.h5", own / "s.h5", ANY_COMMAND)


def test_tables_without_any_impact_are_equal_for_all_ranks(ricochet, folder):
    text = trajectory(2, start="v: 0.5", sweep=durations(30, 1, 30))
    assert not assert_equal_for_all_ranks(ricochet, folder, text).any()


def test_one_task_on_many_ranks_is_one_task(ricochet, folder):
    offsets = assert_equal_for_all_ranks(ricochet, folder, trajectory(2, start="v: [1.5, 2]", duration=100), (1, 4))
    assert len(offsets) == 2 and offsets[1] > 40


def stopped(ricochet, folder, text=SLOW):
    """Leaves a checkpoint of a part of the study."""
    write(folder, "s.yaml", text)
    run = ricochet.start_run("s.yaml", cwd=folder, ranks=2)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= 10, "records")
    run.send_signal(signal.SIGUSR1)
    ricochet.end(run).expect(STOPPED)
    return tasks_in(folder / "s.h5.ckpt")


def test_stopped_runs_resume_with_another_number_of_ranks(ricochet, folder):
    done = stopped(ricochet, folder)
    assert 10 <= done < TASKS
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=3).expect_done()
    run = run_attributes(folder / "s.h5")
    assert run["tasks_resumed"] == done and run["tasks_computed"] == TASKS - done
    assert_same(ricochet.result_of(SLOW), folder / "s.h5", ANY_COMMAND)
    assert names(folder) == ["s.h5", "s.yaml"]


def test_killed_runs_resume_to_the_same_result(ricochet, folder):
    write(folder, "s.yaml", SLOW)
    for ranks in (2, 3):
        before = tasks_in(folder / "s.h5.ckpt")
        run = ricochet.start_run("s.yaml", "--resume", cwd=folder, ranks=ranks)
        wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= before + 5 or (folder / "s.h5").exists(), "records")
        if run.poll() is None:
            run.send_signal(signal.SIGKILL)
        ricochet.end(run)
    ricochet.run("s.yaml", "--resume", cwd=folder).expect_done()
    assert_same(ricochet.result_of(SLOW), folder / "s.h5", ANY_COMMAND)


def test_damaged_and_torn_checkpoints_never_reach_the_result(ricochet, folder):
    """Bits flipped in the counts of a record, in its rows, in its tails, and an end cut off."""
    stopped(ricochet, folder)
    kept = {path.name: path.read_bytes() for path in (folder / "s.h5.ckpt").glob("part-*")}
    name, whole = next((n, data) for n, data in sorted(kept.items()) if len(data) > program.PART_HEADER + 1000)
    size = int(np.frombuffer(whole, "<u8", 4, program.PART_HEADER)[3])
    places = [program.RECORD_HEADER + 3, size // 3, program.RECORD_HEADER + size - 5]
    damaged = [whole[: at + program.PART_HEADER] + bytes([whole[at + program.PART_HEADER] ^ 4])
               + whole[at + program.PART_HEADER + 1 :] for at in places]
    for data in (*damaged, whole[:-7], whole + whole[-500:]):
        own = folder / "own"
        (own / "s.h5.ckpt").mkdir(parents=True)
        write(own, "s.yaml", SLOW)
        for other, bytes_ in kept.items():
            write(own / "s.h5.ckpt", other, data if other == name else bytes_)
        ricochet.run("s.yaml", "--resume", cwd=own, ranks=2).expect_done()
        assert_same(ricochet.result_of(SLOW), own / "s.h5", ANY_COMMAND)
        for path in own.iterdir():
            path.unlink()
        own.rmdir()


def test_a_stop_is_quick_also_in_a_long_trajectory(ricochet, folder):
    write(folder, "s.yaml", trajectory(100, start=speeds(100), duration=1e6, time="samples: 2"))
    result = ricochet.run("s.yaml", "--max-time", "1s", cwd=folder, ranks=2)
    result.expect(STOPPED).expect_line("s.h5: ", "--max-time", "0 of 1 tasks", "--resume")
