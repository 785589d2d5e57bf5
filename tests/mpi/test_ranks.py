"""Runs under mpirun give the same result for any number of ranks and over any transport."""


import signal
from pathlib import Path

import h5py
import pytest
from program import STOPPED, assert_same, coarser, names, records_of, run_attributes, study, sweep, tasks_in, trajectory
from program import wait_until, write

# Without shared memory: the counter moves only while its owner is inside MPI.
OVER_TCP = ("--mca", "btl", "tcp,self", "--mca", "osc", "^sm")


def run_on(ricochet, folder, ranks, text, *words, **options):
    """Each number of ranks in a folder of its own, so that the command lines are equal too."""
    own = folder / str(ranks)
    own.mkdir()
    write(own, "s.yaml", text)
    ricochet.run("s.yaml", *words, cwd=own, ranks=ranks, **options).expect_done()
    assert names(own) == ["s.h5", "s.yaml"]
    return own / "s.h5"


def assert_equal_for_all_ranks(ricochet, folder, text, counts=(1, 2, 3, 4)):
    paths = [run_on(ricochet, folder, ranks, text) for ranks in (0, *counts)]
    for path, ranks in zip(paths[1:], counts):
        assert_same(paths[0], path)
        assert run_attributes(path)["ranks"] == ranks
        ricochet("show", path, "--verify", cwd=folder).expect_done()


def test_results_are_equal_for_one_to_four_ranks(ricochet, folder):
    text = (ricochet.studies / "nonsmooth_modes.yaml").read_text()
    assert_equal_for_all_ranks(ricochet, folder, text)


def test_large_rows_in_many_chunks_are_equal_for_all_ranks(ricochet, folder):
    """Rows that do not fill the chunks of the file evenly, some 20 MB of them."""
    assert_equal_for_all_ranks(ricochet, folder, study(particles=1009, at_start="[15, 400]", sweep=sweep(1237)), (2, 3))


def test_a_grid_of_two_parameters_is_equal_for_all_ranks(ricochet, folder):
    assert_equal_for_all_ranks(ricochet, folder, (ricochet.studies / "grid.yaml").read_text(), (2, 4))


def test_multipliers_and_critical_parameters_are_equal_for_all_ranks(ricochet, folder):
    assert_equal_for_all_ranks(ricochet, folder, (ricochet.studies / "multipliers.yaml").read_text(), (1, 3))


@pytest.mark.parametrize("points", [6, pytest.param(20, marks=pytest.mark.long)])
def test_verdicts_are_equal_for_all_ranks(ricochet, folder, points):
    """By both methods: that of short chains, and that of long ones."""
    for particles in (30, 402):
        (folder / str(particles)).mkdir()
        text = study(particles, at_start="[3, 15]", orbit="at_half: [9], stable: true", sweep=sweep(points))
        assert_equal_for_all_ranks(ricochet, folder / str(particles), text, (1, 3))


@pytest.mark.long
def test_every_shipped_study_is_the_same_alone_and_on_two_ranks(ricochet, folder):
    for path in sorted(ricochet.studies.glob("*.yaml")):
        text = ricochet("examples", path.stem, cwd=folder).expect_done().out
        own = folder / path.stem
        own.mkdir()
        paths = [run_on(ricochet, own, ranks, text, *coarser(path)) for ranks in (0, 2)]
        assert_same(*paths)


def test_more_ranks_than_tasks_stay_idle(ricochet, folder):
    text = study(at_start="[15]", sweep=sweep(2))
    assert_same(run_on(ricochet, folder, 1, text), run_on(ricochet, folder, 5, text))


def test_one_task_on_many_ranks_is_one_task(ricochet, folder):
    text = study(at_start="[15]")
    assert_same(run_on(ricochet, folder, 1, text), run_on(ricochet, folder, 4, text))


def test_the_run_group_counts_the_tasks(ricochet, folder):
    path = run_on(ricochet, folder, 2, study(particles=20000, orbit="states: false", sweep=sweep(100)))
    assert run_attributes(path)["tasks_computed"] == 100 and run_attributes(path)["tasks_resumed"] == 0


def test_standard_output_holds_the_summary_once(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(5)))
    result = ricochet.run("s.yaml", cwd=folder, ranks=4).expect_done()
    assert len(result.out.splitlines()) == 1 and result.err == "", result


def test_studies_and_assignments_reach_every_rank(ricochet, folder):
    path = run_on(ricochet, folder, 3, study(sweep=sweep(5)), "--set", "model.particles=7", "--set", "sweep.points=64")
    with h5py.File(path) as file:
        assert file["orbits/q"].shape == (64, 7)


def test_results_over_tcp_are_the_same(ricochet, folder):
    text = study(particles=100000, orbit="states: false", sweep=sweep(24))
    assert_same(run_on(ricochet, folder, 1, text), run_on(ricochet, folder, 2, text, mpi=OVER_TCP))


LONG_TASK_FIRST = trajectory(particles=200, model="damping: 0", time="samples: 2",
                             sweep="{parameter: time.duration, values: [1e9, " + ", ".join(["1"] * 60) + "]}")


def tasks_by_rank(folder):
    """{rank: number of finished tasks} of a checkpoint."""
    counts = {}
    for path in Path(folder).glob("part-*"):
        rank = int(path.name.split("-")[-1])
        counts[rank] = counts.get(rank, 0) + sum(count for _, count in records_of(path))
    return counts


def test_a_rank_with_a_long_task_does_not_hold_up_the_others(ricochet, folder):
    """Over TCP the counter moves only while rank 0, its owner, is inside MPI. Rank 0 has a task without end and does
    nothing but poll; rank 1 takes all others. Should rank 1 have been first to take one, that proves nothing: again."""
    write(folder, "s.yaml", LONG_TASK_FIRST)
    for i in range(10):
        checkpoint = folder / f"{i}.h5.ckpt"
        run = ricochet.start_run("s.yaml", "-o", f"{i}.h5", cwd=folder, ranks=2, mpi=OVER_TCP)
        wait_until(lambda: tasks_in(checkpoint) == 60, "the short tasks")
        counts = tasks_by_rank(checkpoint)
        run.send_signal(signal.SIGUSR1)
        ricochet.end(run).expect(STOPPED)
        if counts.get(0, 0) == 0:
            assert counts[1] == 60
            return
    raise AssertionError("rank 0 never took the first task")


def test_a_time_limit_reaches_a_rank_in_a_long_task_over_tcp(ricochet, folder):
    """The limit passes while both ranks are in their first task, which takes about a second."""
    write(folder, "s.yaml", study(particles=8000000, orbit="states: false", sweep=sweep(200)))
    result = ricochet.run("s.yaml", "--max-time", "1s", cwd=folder, ranks=2, mpi=OVER_TCP)
    result.expect(STOPPED).expect_line("s.h5: ", "--max-time", "of 200 tasks", "--resume")


# --- nothing between runs ---


@pytest.mark.parametrize("ranks", [0, 2])
def test_a_semaphore_that_somebody_left_holds_no_run_up(ricochet, folder, ranks):
    """MPI-IO takes one that is named after the file, machine-wide; a rank that dies leaves it taken."""
    name = f"{folder.name}.h5"
    left = [Path(f"/dev/shm/sem.OMPIO_{name}{ending}") for ending in ("", ".tmp")]
    write(folder, "s.yaml", study(particles=30, at_start="[15]", sweep=sweep(20)))
    try:
        for path in left:
            path.write_bytes(bytes(32))
            path.chmod(0o666)
        ricochet.run("s.yaml", "-o", name, cwd=folder, ranks=ranks, limit=60).expect_done()
    finally:
        for path in left:
            path.unlink(missing_ok=True)


@pytest.mark.parametrize("ranks", [0, 2])
def test_paths_of_results_may_be_long(ricochet, folder, ranks):
    deep = folder / ("d" * 200) / ("e" * 200)
    deep.mkdir(parents=True)
    write(folder, "s.yaml", study(particles=30, at_start="[15]", sweep=sweep(20)))
    name = "r" * 200 + ".h5"
    ricochet.run("s.yaml", "-o", deep / name, cwd=folder, ranks=ranks).expect_done()
    assert names(deep) == [name]
