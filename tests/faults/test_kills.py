"""Runs that are killed lose no more than what was being computed; --resume goes on with any number of ranks."""

import os
import signal

import program
from phases import ANY_COMMAND, finished_tasks, is_locked
from program import assert_same, names, ranks_of, records, run_attributes, study, sweep, tasks_in
from program import wait_until, write

TASKS = 300
SLOW = study(particles=60000, at_start="[7]", orbit="states: false", sweep=sweep(TASKS))  # some 6 ms a task
ENDLESS = SLOW.replace(f"points: {TASKS}", "points: 1000000")
LARGE = study(particles=1000, at_start="[7]", sweep=sweep(10000))  # its result takes a while to write: 170 MB


def expect_uninterrupted_result(ricochet, folder):
    assert_same(ricochet.result_of(SLOW), folder / "s.h5", ANY_COMMAND)
    assert names(folder) == ["s.h5", "s.yaml"], names(folder)


def start_and_wait_for(ricochet, folder, more, ranks, *words):
    """A run that has finished `more` tasks since it started."""
    before = tasks_in(folder / "s.h5.ckpt")
    run = ricochet.start_run("s.yaml", *words, cwd=folder, ranks=ranks)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= before + more, "records")
    return run


def kill_mpirun(run):
    run.send_signal(signal.SIGKILL)


def kill_a_rank(rank):
    def kill(run):
        os.kill(ranks_of(run)[rank], signal.SIGKILL)

    return kill


def terminate_mpirun(run):
    run.send_signal(signal.SIGTERM)


def interrupt_mpirun(run):
    run.send_signal(signal.SIGINT)


WAYS = [kill_mpirun, kill_a_rank(1), kill_a_rank(0), terminate_mpirun, interrupt_mpirun]


def test_however_runs_are_killed_no_finished_task_is_lost_or_computed_again(ricochet, folder):
    """Kill after kill, each run resumed with another number of ranks, and at once: ranks of the last may be alive. They
    go on for a second or two after mpirun is gone or told to end, so the study is one that never ends."""
    write(folder, "s.yaml", ENDLESS)
    for kill, ranks in zip(WAYS, (2, 3, 2, 4, 2)):
        run = start_and_wait_for(ricochet, folder, 20, ranks, "--resume")
        finished = set(finished_tasks(folder))
        kill(run)
        assert ricochet.end(run).code not in (0, program.STOPPED)
        assert finished <= set(finished_tasks(folder))
    wait_until(lambda: not is_locked(folder), "the end of the ranks")
    finished = finished_tasks(folder)
    assert len(finished) == len(set(finished)) >= 20 * len(WAYS)


def test_killed_twice_and_resumed_the_result_is_that_of_an_uninterrupted_run(ricochet, folder):
    for kill in (kill_mpirun, kill_a_rank(0)):
        own = folder / kill.__name__
        own.mkdir()
        write(own, "s.yaml", SLOW)
        for ranks in (2, 3):
            before = tasks_in(own / "s.h5.ckpt")
            run = ricochet.start_run("s.yaml", "--resume", cwd=own, ranks=ranks)
            # On a fast machine ranks may have come to the end before they died.
            wait_until(lambda: tasks_in(own / "s.h5.ckpt") >= before + 5 or (own / "s.h5").exists(), "records")
            if run.poll() is None:
                kill(run)
            ricochet.end(run)
        ricochet.run("s.yaml", "--resume", cwd=own, ranks=1).expect_done()
        expect_uninterrupted_result(ricochet, own)


def test_what_a_kill_costs_is_the_chunks_at_hand(ricochet, folder):
    """Finished chunks are in the checkpoint at once, not only at the interval; chunks are small beside the study."""
    write(folder, "s.yaml", SLOW)
    run = start_and_wait_for(ricochet, folder, 60, 2, "--checkpoint", "1h")
    kill_mpirun(run)
    ricochet.end(run)
    wait_until(lambda: not is_locked(folder), "the end of the ranks")
    finished = finished_tasks(folder)
    assert len(finished) >= 60 and len(finished) == len(set(finished))
    largest = max(count for _, count in records(folder / "s.h5.ckpt"))
    assert 2 * largest <= TASKS / 5, largest
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2).expect_done()
    run = run_attributes(folder / "s.h5")
    assert run["tasks_resumed"] == len(finished) and run["tasks_computed"] == TASKS - len(finished)


def test_a_killed_rank_ends_the_job_at_once(ricochet, folder):
    write(folder, "s.yaml", ENDLESS)
    for rank in (0, 1):
        run = start_and_wait_for(ricochet, folder, 5, 2, "--resume")
        kill_a_rank(rank)(run)
        assert ricochet.end(run).code != 0
    assert "s.h5" not in names(folder)


def test_ranks_do_not_outlive_a_killed_mpirun_for_long(ricochet, folder):
    write(folder, "s.yaml", ENDLESS)
    run = start_and_wait_for(ricochet, folder, 5, 2)
    assert is_locked(folder)
    kill_mpirun(run)
    wait_until(lambda: not is_locked(folder), "the end of the ranks")


def test_a_single_process_leaves_with_the_code_of_its_signal_and_a_usable_checkpoint(ricochet, folder):
    write(folder, "s.yaml", SLOW)
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL):
        run = start_and_wait_for(ricochet, folder, 20, 0, "--resume")
        finished = finished_tasks(folder)
        run.send_signal(number)
        assert ricochet.end(run).code in (-number, 128 + number)
        assert set(finished) <= set(finished_tasks(folder))
        assert "s.h5" not in names(folder)
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2).expect_done()
    assert run_attributes(folder / "s.h5")["tasks_resumed"] >= 60
    expect_uninterrupted_result(ricochet, folder)


def writing_since(folder):
    try:
        return os.stat(folder / "s.h5.tmp").st_mtime_ns
    except FileNotFoundError:
        return 0


def test_killed_while_it_writes_the_result_nothing_is_computed_again(ricochet, folder):
    write(folder, "s.yaml", LARGE)
    # A rank, not mpirun: without mpirun the ranks would live long enough to finish.
    for ranks, kill in [(2, kill_a_rank(0)), (2, kill_a_rank(1)), (0, lambda run: run.kill())]:
        before = writing_since(folder)  # a kill leaves the file
        run = ricochet.start_run("s.yaml", "--resume", cwd=folder, ranks=ranks)
        wait_until(lambda: writing_since(folder) > before, "the beginning of the result")
        kill(run)
        ricochet.end(run)
        wait_until(lambda: not is_locked(folder), "the end of the ranks")
        assert (folder / "s.h5.ckpt").exists() and not (folder / "s.h5").exists(), names(folder)
    assert tasks_in(folder / "s.h5.ckpt") == 10000
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=3).expect_done()
    run = run_attributes(folder / "s.h5")
    assert run["tasks_computed"] == 0 and run["tasks_resumed"] == 10000
    assert names(folder) == ["s.h5", "s.yaml"], names(folder)
    ricochet("show", "s.h5", "--verify", cwd=folder).expect_done()


def test_asked_to_stop_while_it_writes_the_result_a_run_stops_soon(ricochet, folder):
    write(folder, "s.yaml", LARGE)
    for ranks in (0, 2):
        before = writing_since(folder)
        run = ricochet.start_run("s.yaml", "--resume", cwd=folder, ranks=ranks)
        wait_until(lambda: writing_since(folder) > before, "the beginning of the result")
        run.send_signal(signal.SIGUSR1)
        stopped = ricochet.end(run, limit=10)
        assert "before it was written, with all tasks done; --resume writes it" in stopped.expect(program.STOPPED).err
        assert names(folder) == ["s.h5.ckpt", "s.yaml"] and tasks_in(folder / "s.h5.ckpt") == 10000
    ricochet.run("s.yaml", "--resume", cwd=folder).expect_done()
    assert run_attributes(folder / "s.h5")["tasks_computed"] == 0


def test_killed_after_the_result_is_there_resume_finds_it_and_clears_up(ricochet, folder):
    """A kill between the result's name and the end of the checkpoint, made up from its two halves."""
    write(folder, "s.yaml", SLOW)
    run = start_and_wait_for(ricochet, folder, 5, 0)
    run.send_signal(signal.SIGUSR1)
    ricochet.end(run).expect(program.STOPPED)
    (folder / "s.h5").write_bytes(ricochet.result_of(SLOW).read_bytes())
    ricochet.run("s.yaml", "--resume", cwd=folder).expect_done()
    expect_uninterrupted_result(ricochet, folder)
