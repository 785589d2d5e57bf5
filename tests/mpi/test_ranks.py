"""Runs under mpirun give the same result for any number of ranks and over any transport."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))
import h5py
import program
from program import STOPPED, assert_same, names, run_attributes, study, sweep, test, write

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


@test
def results_are_equal_for_one_to_four_ranks(ricochet, folder):
    text = (ricochet.studies / "nonsmooth_modes.yaml").read_text()
    assert_equal_for_all_ranks(ricochet, folder, text)


@test
def large_rows_in_many_chunks_are_equal_for_all_ranks(ricochet, folder):
    """Rows that do not fill the chunks of the file evenly, some 20 MB of them."""
    assert_equal_for_all_ranks(ricochet, folder, study(particles=1009, at_start="[15, 400]", sweep=sweep(1237)), (2, 3))


@test
def a_grid_of_two_parameters_is_equal_for_all_ranks(ricochet, folder):
    assert_equal_for_all_ranks(ricochet, folder, (ricochet.studies / "grid.yaml").read_text(), (2, 4))


@test
def multipliers_and_critical_parameters_are_equal_for_all_ranks(ricochet, folder):
    assert_equal_for_all_ranks(ricochet, folder, (ricochet.studies / "multipliers.yaml").read_text(), (1, 3))


@test
def verdicts_are_equal_for_all_ranks(ricochet, folder):
    """By both methods: that of short chains, and that of long ones."""
    for particles in (30, 402):
        (folder / str(particles)).mkdir()
        text = study(particles, at_start="[3, 15]", orbit="at_half: [9], stable: true", sweep=sweep(20))
        assert_equal_for_all_ranks(ricochet, folder / str(particles), text, (1, 3))


@test
def more_ranks_than_tasks_stay_idle(ricochet, folder):
    text = study(at_start="[15]", sweep=sweep(2))
    assert_same(run_on(ricochet, folder, 1, text), run_on(ricochet, folder, 5, text))


@test
def one_task_on_many_ranks_is_one_task(ricochet, folder):
    text = study(at_start="[15]")
    assert_same(run_on(ricochet, folder, 1, text), run_on(ricochet, folder, 4, text))


@test
def the_run_group_counts_the_tasks(ricochet, folder):
    path = run_on(ricochet, folder, 2, study(particles=20000, orbit="states: false", sweep=sweep(100)))
    assert run_attributes(path)["tasks_computed"] == 100 and run_attributes(path)["tasks_resumed"] == 0


@test
def standard_output_holds_the_summary_once(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(5)))
    result = ricochet.run("s.yaml", cwd=folder, ranks=4).expect_done()
    assert len(result.out.splitlines()) == 1 and result.err == "", result


@test
def studies_and_assignments_reach_every_rank(ricochet, folder):
    path = run_on(ricochet, folder, 3, study(sweep=sweep(5)), "--set", "model.particles=7", "--set", "sweep.points=64")
    with h5py.File(path) as file:
        assert file["orbits/q"].shape == (64, 7)


@test
def results_over_tcp_are_the_same(ricochet, folder):
    text = study(particles=100000, orbit="states: false", sweep=sweep(24))
    assert_same(run_on(ricochet, folder, 1, text), run_on(ricochet, folder, 2, text, mpi=OVER_TCP))


def seconds_of(ricochet, folder, runs, **options):
    """Computing time of the slowest of some runs of one study at once."""
    started = [ricochet.start_run("s.yaml", "-o", f"{i}.h5", "--force", cwd=folder, **options) for i in range(runs)]
    for run in started:
        ricochet.end(run).expect_done()
    return max(run_attributes(folder / f"{i}.h5")["compute_seconds"] for i in range(runs))


@test
def a_rank_with_a_long_task_does_not_hold_up_the_others(ricochet, folder):
    """Two long tasks: were rank 1 held up by the owner of the counter, it would begin when the first task ends, and two
    ranks would take as long as one. One attempt that succeeds proves the point; one that fails proves something only if
    the machine had two cores for us, which two runs side by side tell."""
    write(folder, "s.yaml", study(particles=2000000, orbit="states: false", sweep=sweep(2, 0.1, 0.11)))
    failures = []
    for _ in range(8):
        one, two = seconds_of(ricochet, folder, 1), seconds_of(ricochet, folder, 1, ranks=2, mpi=OVER_TCP)
        if two < 0.8 * one:
            return
        if seconds_of(ricochet, folder, 2) < 1.2 * one:
            failures.append((one, two))
    if len(failures) < 2:
        raise program.Skip("no second core is free")
    raise AssertionError(f"one rank and two ranks take {failures} seconds")


@test
def a_time_limit_reaches_a_rank_in_a_long_task_over_tcp(ricochet, folder):
    """The limit passes while both ranks are in their first task, which takes about a second."""
    write(folder, "s.yaml", study(particles=8000000, orbit="states: false", sweep=sweep(200)))
    result = ricochet.run("s.yaml", "--max-time", "1s", cwd=folder, ranks=2, mpi=OVER_TCP)
    result.expect(STOPPED).expect_line("s.h5: ", "--max-time", "of 200 tasks", "--resume")


if __name__ == "__main__":
    program.main()
