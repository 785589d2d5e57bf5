"""Damaged results and checkpoints are noticed, named and survived: no crash, no hang, no wrong number."""

import functools
import signal
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))
import h5py
import program
from program import DONE, FILES, STOPPED, assert_same, contents, names, run_attributes, study, sweep, tasks_in, test
from program import wait_until, write

STUDY = study(at_start="[15]", orbit="special_points: true", sweep=sweep(300, 0, 1.2))
TASKS = 200
SLOW = study(particles=100000, at_start="[7]", orbit="states: false", sweep=sweep(TASKS))
ANY_COMMAND = ("heap_checksums",)  # holds addresses, which move with the length of the command line
COMMANDS = ([], ["--csv"], ["--verify"])


@functools.cache
def result(ricochet):
    write(ricochet.shared, "r.yaml", STUDY)
    ricochet.run("r.yaml", cwd=ricochet.shared, ranks=2).expect_done()
    return (ricochet.shared / "r.h5").read_bytes()


@functools.cache
def uninterrupted(ricochet):
    write(ricochet.shared, "s.yaml", SLOW)
    ricochet.run("s.yaml", cwd=ricochet.shared, ranks=2).expect_done()
    return ricochet.shared / "s.h5"


def flipped(data, at, bit=0):
    return data[:at] + bytes([data[at] ^ 1 << bit]) + data[at + 1 :]


def chunks(path):
    """(data set, first byte, bytes) of every stored chunk."""
    found = []

    def visit(name, data):
        if isinstance(data, h5py.Dataset) and name != "run":
            for i in range(data.id.get_num_chunks()):
                info = data.id.get_chunk_info(i)
                found.append((name, info.byte_offset, info.size))

    with h5py.File(path) as file:
        file.visititems(visit)
    return found


# --- results ---


@test
def a_flipped_bit_in_any_data_set_is_found_and_named(ricochet, folder):
    data = result(ricochet)
    cases = [(name, at + o) for name, at, size in chunks(ricochet.shared / "r.h5") for o in (0, size // 2, size - 1)]
    assert len(cases) > 50

    def look(case):
        name, at = case
        path = write(folder, f"{at}.h5", flipped(data, at, at % 8))
        ricochet("show", path.name, "--verify", cwd=folder).expect_refused(FILES, f"{path.name}: ", name.split("/")[-1])
        path.unlink()

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(look, cases))


@test
def a_flipped_bit_anywhere_else_is_found_or_changes_nothing(ricochet, folder):
    """In what surrounds the data: names, shapes, attributes, references. Some bytes belong to nobody: a flip there goes
    unnoticed, but then h5py must read what it read before."""
    data = result(ricochet)
    inside = [range(at, at + size) for _, at, size in chunks(ricochet.shared / "r.h5")]
    outside = [at for at in range(len(data)) if not any(at in r for r in inside)][::37]  # no part is shorter
    whole = contents(write(folder, "whole.h5", data))
    unnoticed = []

    def look(at):
        path = write(folder, f"{at}.h5", flipped(data, at, at % 8))
        shown = ricochet("show", path.name, "--verify", cwd=folder)
        assert shown.code in (DONE, FILES), (at, str(shown))
        if shown.code == FILES:
            shown.expect_refused(FILES, f"{path.name}: ")
            path.unlink()
        else:
            unnoticed.append(path)

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(look, outside))
    assert len(outside) > 100 and len(unnoticed) < len(outside) / 2, (len(outside), len(unnoticed))
    for path in unnoticed:
        try:
            same = contents(path) == whole
        except (OSError, RuntimeError, ValueError) as error:
            raise AssertionError(f"verify misses the damage at byte {path.stem}, h5py does not: {error}") from None
        assert same, f"verify misses the damage at byte {path.stem}"


@test
def whatever_is_damaged_show_neither_crashes_nor_hangs(ricochet, folder):
    data = result(ricochet)

    def look(at):
        path = write(folder, f"{at}.h5", flipped(data, at, at % 8))
        for words in ([], ["--csv"]):
            shown = ricochet("show", path.name, *words, cwd=folder, limit=30)
            assert shown.code in (DONE, FILES), (at, str(shown))
        path.unlink()

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(look, range(0, len(data), len(data) // 200)))


@test
def truncated_results_are_refused_by_every_command(ricochet, folder):
    data = result(ricochet)
    for length in (0, 1, 8, 100, 2048, len(data) // 2, len(data) - 100, len(data) - 1):
        path = write(folder, "cut.h5", data[:length])
        for words in COMMANDS:
            ricochet("show", path.name, *words, cwd=folder).expect_refused(FILES, "cut.h5: ")


@test
def overwritten_results_are_refused_by_verify(ricochet, folder):
    data = result(ricochet)
    for low, high in [(0, 512), (512, 4096), (4096, 8192), (len(data) // 2, len(data)), (0, len(data))]:
        path = write(folder, "zeros.h5", data[:low] + bytes(high - low) + data[high:])
        for words in COMMANDS[:2]:
            assert ricochet("show", path.name, *words, cwd=folder, limit=30).code in (DONE, FILES)
        ricochet("show", path.name, "--verify", cwd=folder).expect_refused(FILES, "zeros.h5: ")


@test
def a_damaged_result_is_refused_on_resume_and_kept(ricochet, folder):
    data = result(ricochet)
    write(folder, "r.yaml", STUDY)
    _, at, _ = next(c for c in chunks(ricochet.shared / "r.h5") if c[0] == "orbits/energy")
    for damaged, ranks in [(flipped(data, at), 2), (data[:-1], 0), (b"", 0), (b"not HDF5", 0)]:
        write(folder, "r.h5", damaged)
        refused = ricochet.run("r.yaml", "--resume", cwd=folder, ranks=ranks)
        refused.expect_refused(FILES, "r.h5: ", "--force")
        assert (folder / "r.h5").read_bytes() == damaged and names(folder) == ["r.h5", "r.yaml"], names(folder)
    ricochet.run("r.yaml", "--force", cwd=folder).expect_done()
    assert_same(ricochet.shared / "r.h5", folder / "r.h5", ANY_COMMAND)


# --- checkpoints ---


@functools.cache
def checkpoint(ricochet):
    """The files of the checkpoint of a stopped run on two ranks, by name."""
    folder = ricochet.shared / "stopped"
    folder.mkdir()
    write(folder, "s.yaml", SLOW)
    run = ricochet.start_run("s.yaml", cwd=folder, ranks=2)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= 40, "records")
    run.send_signal(signal.SIGUSR1)
    ricochet.end(run).expect(STOPPED)
    return {path.name: path.read_bytes() for path in (folder / "s.h5.ckpt").glob("part-*")}


def assert_resumes(ricochet, folder, change, ranks=2):
    """A checkpoint with one file changed is used as far as it is sound. Returns how many tasks were taken from it."""
    own = folder / str(len(names(folder)))
    (own / "s.h5.ckpt").mkdir(parents=True)
    write(own, "s.yaml", SLOW)
    parts = checkpoint(ricochet)
    largest = max(parts, key=lambda name: len(parts[name]))
    for name, data in parts.items():
        write(own / "s.h5.ckpt", name, change(data) if name == largest else data)
    ricochet.run("s.yaml", "--resume", cwd=own, ranks=ranks).expect_done()
    assert_same(uninterrupted(ricochet), own / "s.h5", ANY_COMMAND)
    assert names(own) == ["s.h5", "s.yaml"]
    return run_attributes(own / "s.h5")["tasks_resumed"]


@test
def truncated_checkpoints_resume_from_their_whole_records(ricochet, folder):
    whole = assert_resumes(ricochet, folder, lambda data: data)
    assert whole >= 40
    assert 0 < assert_resumes(ricochet, folder, lambda data: data[:-1]) < whole
    assert 0 < assert_resumes(ricochet, folder, lambda data: data[:50], ranks=3) < whole


@test
def checkpoints_with_something_else_at_their_end_resume(ricochet, folder):
    whole = assert_resumes(ricochet, folder, lambda data: data + b"\0" * 5000)
    assert whole >= 40
    assert assert_resumes(ricochet, folder, lambda data: data + data[-500:]) == whole


@test
def flipped_bits_in_a_checkpoint_never_reach_the_result(ricochet, folder):
    """In the head of a record, in its rows, in the head of the file."""
    for at in (program.PART_HEADER + 9, program.PART_HEADER + 100, 20):
        assert_resumes(ricochet, folder, lambda data: flipped(data, at, 3))


@test
def a_folder_that_is_no_checkpoint_is_left_alone(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(3)))
    (folder / "s.h5.ckpt").mkdir()
    write(folder / "s.h5.ckpt", "notes.txt", "mine")
    ricochet.run("s.yaml", "--resume", cwd=folder).expect_done()
    assert names(folder / "s.h5.ckpt") == ["notes.txt"]
    ricochet("show", "s.h5", "--verify", cwd=folder).expect_done()


if __name__ == "__main__":
    program.main()
