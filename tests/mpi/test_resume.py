"""Runs that are stopped on request go on with --resume; one output belongs to one run at a time."""

import os
import re
import signal
import time
from pathlib import Path

import pytest
from program import (
    FILES,
    PART_HEADER,
    STOPPED,
    USAGE,
    assert_same,
    hears,
    names,
    only,
    ranks_of,
    records,
    run_attributes,
    study,
    sweep,
    tasks_in,
    wait_until,
    write,
)

TASKS = 200
SLOW = study(particles=60000, at_start="[7]", orbit="states: false", sweep=sweep(TASKS))  # some 6 ms a task
WINDOWS = """kind: diagram
model: {type: grazing_map, lambda: 0.5, omega: 0.3}
iterate: {transient: 150000000, keep: 0, measure: 10, start: [0, 0, 0], windows: true}
sweep: {parameter: model.d, values: [0.003, 0.005]}
"""  # two tasks of seconds, and then a search of 10 s
OTHER = SLOW.replace("at_start: [7]", "at_start: [8]")
ANY_COMMAND = ("heap_checksums",)  # holds addresses, which move with the length of the command line


def expect_uninterrupted_result(ricochet, folder, output="s.h5"):
    assert_same(ricochet.result_of(SLOW), folder / output, ANY_COMMAND)
    assert names(folder) == sorted([output, "s.yaml"]), names(folder)


def stopped(ricochet, folder, text=SLOW, *words, ranks=2, output="s.h5"):
    """Leaves a checkpoint of a part of the study. Stopped by a signal when there are records: a time limit would stop a
    slow machine before the first of them."""
    write(folder, "s.yaml", text)
    run = ricochet.start_run("s.yaml", "-o", output, *words, cwd=folder, ranks=ranks)
    wait_until(lambda: tasks_in(folder / f"{output}.ckpt") >= 5, "records")
    run.send_signal(signal.SIGUSR1)
    result = ricochet.end(run).expect(STOPPED)
    assert 5 <= tasks_in(folder / f"{output}.ckpt") < TASKS
    return result


def tasks_in_message(result):
    assert "--resume goes on" in result.err, result
    return int(only(result.err, r"with (\d+) of"))


# --- stops ---


@pytest.mark.sanitized
def test_sigusr1_stops_with_a_checkpoint_and_resume_computes_only_the_rest(ricochet, folder):
    for ranks, more in [(0, 3), (3, 2)]:
        own = folder / str(ranks)
        own.mkdir()
        message = stopped(ricochet, own, ranks=ranks).expect_line("s.h5: ", "SIGUSR1", f"of {TASKS} tasks", "--resume")
        assert names(own) == ["s.h5.ckpt", "s.yaml"]
        done = tasks_in_message(message)
        assert done == tasks_in(own / "s.h5.ckpt")
        ricochet.run("s.yaml", "--resume", cwd=own, ranks=more).expect_done()
        run = run_attributes(own / "s.h5")
        assert run["tasks_resumed"] == done and run["tasks_computed"] == TASKS - done
        expect_uninterrupted_result(ricochet, own)


def computed_elsewhere(part):
    """Changes the digest of the arithmetic in the header of a checkpoint's file, and the header's own with it (FNV-1a)."""
    data = bytearray(part.read_bytes())
    data[88] ^= 1
    digest = 0xCBF29CE484222325
    for byte in data[: PART_HEADER - 8]:
        digest = (digest ^ byte) * 0x100000001B3 % 2**64
    data[PART_HEADER - 8 : PART_HEADER] = digest.to_bytes(8, "little")
    part.write_bytes(data)


def test_rows_of_another_processor_are_told(ricochet, folder):
    stopped(ricochet, folder)
    computed_elsewhere(next((folder / "s.h5.ckpt").glob("part-*")))
    result = ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2).expect_done()
    result.expect_line("s.h5: ", "some rows", "last bits may differ")
    assert run_attributes(folder / "s.h5")["arithmetic"] == b"mixed"
    assert run_attributes(ricochet.result_of(SLOW))["arithmetic"] != b"mixed"
    expect_uninterrupted_result(ricochet, folder)


def test_max_time_stops_on_any_number_of_ranks(ricochet, folder):
    write(folder, "s.yaml", SLOW.replace(f"points: {TASKS}", "points: 100000"))
    for ranks in (0, 2):
        result = ricochet.run("s.yaml", "--max-time", "1s", "--resume", cwd=folder, ranks=ranks)
        result.expect(STOPPED).expect_line("s.h5: ", "--max-time", "of 100000 tasks", "--resume")
    assert names(folder) == ["s.h5.ckpt", "s.yaml"]


def test_stop_after_stop_computes_every_task_once(ricochet, folder):
    write(folder, "s.yaml", SLOW)
    for ranks in (2, 3, 1):
        before = tasks_in(folder / "s.h5.ckpt")
        run = ricochet.start_run("s.yaml", "--resume", cwd=folder, ranks=ranks)
        wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= before + 20, "records")
        run.send_signal(signal.SIGUSR1)
        ricochet.end(run).expect(STOPPED)
    found = [task for first, count in records(folder / "s.h5.ckpt") for task in range(first, first + count)]
    assert len(found) == len(set(found)) >= 60
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=4).expect_done()
    expect_uninterrupted_result(ricochet, folder)


def test_a_stop_is_quick_also_in_a_long_task(ricochet, folder):
    """A dense orbit of the largest chain takes long; the stop comes within it, so that no task more is done than when
    the signal was sent. (One that was just being recorded may be, but not each time.)"""
    write(folder, "s.yaml", study(particles=400, orbit="method: dense", sweep=sweep(50)))
    more = []
    for i in range(5):
        checkpoint = folder / f"{i}.h5.ckpt"
        run = ricochet.start_run("s.yaml", "-o", f"{i}.h5", cwd=folder)
        wait_until(lambda: tasks_in(checkpoint) > 0, "records")
        run.send_signal(signal.SIGSTOP)  # the signal meets the run where it stands now
        done = tasks_in(checkpoint)
        run.send_signal(signal.SIGUSR1)
        run.send_signal(signal.SIGCONT)
        more.append(tasks_in_message(ricochet.end(run).expect(STOPPED)) - done)
    assert set(more) <= {0, 1} and 0 in more, more


def test_a_stop_of_one_rank_stops_the_search_of_all(ricochet, folder):
    """The ranks work by themselves then."""
    write(folder, "s.yaml", WINDOWS)
    run = ricochet.start_run("s.yaml", cwd=folder, ranks=2)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") == 2, "the end of the tasks")
    time.sleep(0.2)
    os.kill(ranks_of(run)[1], signal.SIGUSR1)
    ricochet.end(run, 5).expect(STOPPED).expect_line("s.h5: ", "SIGUSR1", "with all tasks done")


# --- what --resume finds ---


def test_resume_with_nothing_there_starts_from_the_beginning(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(5)))
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2).expect_done()
    run = run_attributes(folder / "s.h5")
    assert run["tasks_resumed"] == 0 and run["tasks_computed"] == 5
    assert names(folder) == ["s.h5", "s.yaml"]


def test_resume_of_a_finished_result_leaves_it_untouched(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(5)))
    ricochet.run("s.yaml", cwd=folder).expect_done()
    before, bytes_before = os.stat(folder / "s.h5"), (folder / "s.h5").read_bytes()
    for ranks in (0, 2):
        result = ricochet.run("s.yaml", "--resume", cwd=folder, ranks=ranks).expect_done()
        assert result.out == "s.h5: finished and verified, nothing to do\n" and result.err == "", result
    after = os.stat(folder / "s.h5")
    assert (before.st_ino, before.st_mtime_ns) == (after.st_ino, after.st_mtime_ns)
    assert (folder / "s.h5").read_bytes() == bytes_before
    assert names(folder) == ["s.h5", "s.yaml"]


def test_comments_and_layout_do_not_make_another_study(ricochet, folder):
    done = tasks_in_message(stopped(ricochet, folder))
    write(folder, "s.yaml", "# a comment\n" + SLOW.replace("gamma: 0.1", "gamma: 1e-1"))
    again = ricochet.run("s.yaml", "--resume", "--max-time", "0.001s", cwd=folder).expect(STOPPED)
    assert tasks_in_message(again) >= done


def test_the_result_of_another_study_is_refused_on_resume(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(5)))
    ricochet.run("s.yaml", cwd=folder).expect_done()
    before = (folder / "s.h5").read_bytes()
    result = ricochet.run("s.yaml", "--set", "orbit.period=5", "--resume", cwd=folder)
    result.expect_refused(USAGE, "s.h5: ", "another study", "--force")
    assert (folder / "s.h5").read_bytes() == before and names(folder) == ["s.h5", "s.yaml"]


def test_the_checkpoint_of_another_study_is_refused_and_kept(ricochet, folder):
    stopped(ricochet, folder)
    found = records(folder / "s.h5.ckpt")
    for text in (OTHER, SLOW.replace("points: 200", "points: 100"), SLOW.replace("states: false", "states: true")):
        write(folder, "s.yaml", text)
        ricochet.run("s.yaml", "--resume", cwd=folder).expect_refused(USAGE, "s.h5.ckpt", "another study")
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2).expect_refused(USAGE, "s.h5.ckpt", "another study")
    assert records(folder / "s.h5.ckpt") == found


def test_a_checkpoint_is_refused_without_resume_or_force_and_kept(ricochet, folder):
    stopped(ricochet, folder)
    found = records(folder / "s.h5.ckpt")
    for ranks in (0, 2):
        refused = ricochet.run("s.yaml", cwd=folder, ranks=ranks)
        refused.expect_refused(USAGE, "s.h5.ckpt: ", "--resume", "--force")
    assert records(folder / "s.h5.ckpt") == found


def test_outputs_in_one_folder_do_not_disturb_each_other(ricochet, folder):
    stopped(ricochet, folder, output="a.h5")
    found = records(folder / "a.h5.ckpt")
    ricochet.run("s.yaml", "--set", "model.particles=30", "-o", "b.h5", cwd=folder, ranks=2).expect_done()
    assert names(folder) == ["a.h5.ckpt", "b.h5", "s.yaml"]
    assert records(folder / "a.h5.ckpt") == found


# --- --force ---


def test_force_replaces_a_result_and_drops_a_checkpoint(ricochet, folder):
    stopped(ricochet, folder)
    write(folder, "s.h5", "no result at all")
    write(folder, "s.yaml", study(sweep=sweep(5)))
    ricochet.run("s.yaml", "--force", cwd=folder, ranks=2).expect_done()
    assert run_attributes(folder / "s.h5")["tasks_resumed"] == 0
    assert names(folder) == ["s.h5", "s.yaml"]
    ricochet("show", "s.h5", "--verify", cwd=folder).expect_done()


def test_the_old_result_stays_until_the_new_one_replaces_it(ricochet, folder):
    write(folder, "s.h5", "old")
    stopped(ricochet, folder, SLOW, "--force")
    assert (folder / "s.h5").read_text() == "old"


def test_a_forced_run_that_was_stopped_goes_on_over_the_result_of_another_study(ricochet, folder):
    """Its message promises that --resume goes on."""
    write(folder, "s.yaml", study(sweep=sweep(5)))
    ricochet.run("s.yaml", cwd=folder).expect_done()
    done = tasks_in_message(stopped(ricochet, folder, SLOW, "--force"))
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2).expect_done()
    assert run_attributes(folder / "s.h5")["tasks_resumed"] == done
    expect_uninterrupted_result(ricochet, folder)


def test_a_forced_run_that_was_stopped_goes_on_over_the_result_of_the_same_study(ricochet, folder):
    (folder / "s.h5").write_bytes(ricochet.result_of(SLOW).read_bytes())
    done = tasks_in_message(stopped(ricochet, folder, SLOW, "--force"))
    ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2).expect_done()
    assert run_attributes(folder / "s.h5")["tasks_resumed"] == done
    expect_uninterrupted_result(ricochet, folder)


# --- two runs on one output ---


def test_a_second_run_is_refused_and_the_first_loses_nothing(ricochet, folder):
    """The first is stopped while the second waits in vain, so that no speed matters."""
    write(folder, "s.yaml", SLOW)
    first = ricochet.start_run("s.yaml", cwd=folder)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= 5, "records")
    first.send_signal(signal.SIGSTOP)
    found = records(folder / "s.h5.ckpt")
    holder = f"process {first.pid}"
    refused = ricochet.run("s.yaml", cwd=folder)
    assert refused.code in (USAGE, FILES), refused
    refused.expect_line("s.h5.ckpt")
    ricochet.run("s.yaml", "--force", cwd=folder).expect_refused(FILES, "s.h5.ckpt/lock: ", "held by", holder)
    refused = ricochet.run("s.yaml", "--resume", cwd=folder, ranks=2)
    refused.expect_refused(FILES, "s.h5.ckpt/lock: ", "held by", holder)
    assert float(only(refused.err, r"waited ([\d.]+) s")) >= 10, refused
    assert records(folder / "s.h5.ckpt") == found
    first.send_signal(signal.SIGCONT)
    ricochet.end(first).expect_done()
    expect_uninterrupted_result(ricochet, folder)


def test_a_run_beside_another_is_told_that_it_is_running(ricochet, folder):
    """To call the folder that of an unfinished run, and to advise --force, would be bad advice while it runs."""
    write(folder, "s.yaml", SLOW)
    first = ricochet.start_run("s.yaml", cwd=folder)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= 5, "records")
    first.send_signal(signal.SIGSTOP)
    ricochet.run("s.yaml", cwd=folder).expect_line("s.h5.ckpt", "held by", f"process {first.pid}")


def test_resume_waits_for_the_holder_to_leave(ricochet, folder):
    write(folder, "s.yaml", SLOW)
    first = ricochet.start_run("s.yaml", cwd=folder, ranks=2)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= 5, "records")
    for pid in ranks_of(first).values():
        os.kill(pid, signal.SIGSTOP)
    second = ricochet.start_run("s.yaml", "--resume", cwd=folder)
    time.sleep(1)
    assert second.poll() is None
    for pid in ranks_of(first).values():
        os.kill(pid, signal.SIGKILL)
    ricochet.end(second).expect_done()
    expect_uninterrupted_result(ricochet, folder)


@pytest.mark.parametrize("delay", [0, 0.05, 0.1, 0.2, 0.4])
@pytest.mark.parametrize("mpi", ["on", "off"])
def test_a_signal_is_heard_from_the_first_instant(ricochet, folder, mpi, delay):
    """Also while MPI starts, which takes half a second."""
    write(folder, "s.yaml", SLOW)
    run = ricochet.start_run("s.yaml", "--mpi", mpi, cwd=folder)
    wait_until(lambda: hears(run.pid, signal.SIGUSR1), "the beginning of the program")
    time.sleep(delay)
    run.send_signal(signal.SIGUSR1)
    ricochet.end(run).expect(STOPPED)


# --- runs that wait ---


def waits_for_a_pipe(ricochet, folder, ranks):
    """For a writer that never comes."""
    os.mkfifo(folder / "s.yaml")
    return ricochet.start_run("s.yaml", cwd=folder, ranks=ranks)


def waits_for_input(ricochet, folder, ranks):
    """For the rest of a study on standard input."""
    ends = os.pipe()
    os.write(ends[1], b"kind: orbits\n")
    run = ricochet.start_run("/dev/stdin", "-o", "s.h5", cwd=folder, ranks=ranks, before=lambda: os.dup2(ends[0], 0))
    run.kept_open = ends
    return run


def waits_for_the_lock(ricochet, folder, ranks):
    """Of a run that is stopped."""
    write(folder, "s.yaml", SLOW)
    holder = ricochet.start_run("s.yaml", cwd=folder)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= 5, "records")
    holder.send_signal(signal.SIGSTOP)
    return ricochet.start_run("s.yaml", "--resume", cwd=folder, ranks=ranks)


WAITS = [waits_for_a_pipe, waits_for_input, waits_for_the_lock]


def started(run, ranks):
    """The processes of a run, each of which hears signals by now."""
    wait_until(lambda: not ranks or len(ranks_of(run)) == ranks, "the ranks")
    processes = list(ranks_of(run).values()) if ranks else [run.pid]
    wait_until(lambda: all(hears(p, signal.SIGUSR1) for p in processes), "the beginning of the program")
    return processes


@pytest.mark.parametrize("ranks", [0, 2])
@pytest.mark.parametrize("wait", WAITS)
def test_a_run_that_waits_is_ended_by_a_signal(ricochet, folder, wait, ranks):
    """By each of them within seconds; SIGUSR1 says that nothing was done."""
    for number in (signal.SIGUSR1, signal.SIGTERM, signal.SIGINT):
        own = folder / str(int(number))
        own.mkdir()
        run = wait(ricochet, own, ranks)
        started(run, ranks)
        time.sleep(0.7 if ranks else 0.1)  # MPI starts
        assert run.poll() is None
        run.send_signal(number)
        ended = ricochet.end(run, limit=10)
        if number == signal.SIGUSR1:
            ended.expect(STOPPED).expect_line("", "stopped by SIGUSR1 before its first task", "--resume")
        else:
            assert ended.code != 0
        assert "s.h5" not in names(own)


def test_the_time_limit_holds_for_a_run_that_waits(ricochet, folder):
    os.mkfifo(folder / "s.yaml")
    stopped_early = ricochet.run("s.yaml", "--max-time", "1s", cwd=folder, limit=20)
    stopped_early.expect_refused(STOPPED, "s.yaml: ", "by --max-time")
    assert names(folder) == ["s.yaml"]
