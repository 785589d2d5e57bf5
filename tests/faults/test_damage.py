"""Damaged results and checkpoints are noticed, named and survived: no crash, no hang, no wrong number."""

import signal
from concurrent.futures import ThreadPoolExecutor

import h5py
import program
import pytest
from program import DONE, FILES, STOPPED, assert_same, contents, names, run_attributes, study, sweep, tasks_in
from program import wait_until, write

STUDY = study(at_start="[15]", orbit="special_points: true", sweep=sweep(300, 0, 1.2))
TASKS = 200
SLOW = study(particles=60000, at_start="[7]", orbit="states: false", sweep=sweep(TASKS))
ANY_COMMAND = ("heap_checksums",)  # holds addresses, which move with the length of the command line
COMMANDS = ([], ["--csv"], ["--verify"])


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


def test_a_flipped_bit_in_any_data_set_is_found_and_named(ricochet, folder):
    data = ricochet.result_of(STUDY).read_bytes()
    cases = [(name, at + o) for name, at, size in chunks(ricochet.result_of(STUDY)) for o in (0, size // 2, size - 1)]
    assert len(cases) > 50

    def look(case):
        name, at = case
        path = write(folder, f"{at}.h5", flipped(data, at, at % 8))
        ricochet("show", path.name, "--verify", cwd=folder).expect_refused(FILES, f"{path.name}: ", name.split("/")[-1])
        path.unlink()

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(look, cases))


def test_a_flipped_bit_anywhere_else_is_found_or_changes_nothing(ricochet, folder):
    """In what surrounds the data: names, shapes, attributes, references. Some bytes belong to nobody: a flip there goes
    unnoticed, but then h5py must read what it read before."""
    data = ricochet.result_of(STUDY).read_bytes()
    inside = [range(at, at + size) for _, at, size in chunks(ricochet.result_of(STUDY))]
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


def test_a_flipped_bit_in_the_values_of_the_study_is_found(ricochet, folder):
    data = ricochet.result_of(STUDY).read_bytes()
    with h5py.File(ricochet.result_of(STUDY)) as file:
        names_there = list(file["study"].attrs)
    assert len(names_there) > 30
    for name in names_there:
        at = data.index(name.encode() + b"\0")  # before its type and its value
        for place in (at, at + len(name) + 20):
            path = write(folder, "flipped.h5", flipped(data, place, place % 8))
            ricochet("show", path.name, "--verify", cwd=folder).expect_refused(FILES, f"{path.name}: ")


def test_whatever_is_damaged_show_neither_crashes_nor_hangs(ricochet, folder):
    data = ricochet.result_of(STUDY).read_bytes()

    def look(at):
        path = write(folder, f"{at}.h5", flipped(data, at, at % 8))
        for words in ([], ["--csv"]):
            shown = ricochet("show", path.name, *words, cwd=folder)
            assert shown.code in (DONE, FILES), (at, str(shown))
        path.unlink()

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(look, range(0, len(data), len(data) // 200)))


@pytest.mark.sanitized
def test_truncated_results_are_refused_by_every_command(ricochet, folder):
    data = ricochet.result_of(STUDY).read_bytes()
    for length in (0, 1, 8, 100, 2048, len(data) // 2, len(data) - 100, len(data) - 1):
        path = write(folder, "cut.h5", data[:length])
        for words in COMMANDS:
            ricochet("show", path.name, *words, cwd=folder).expect_refused(FILES, "cut.h5: ")


def test_overwritten_results_are_refused_by_verify(ricochet, folder):
    data = ricochet.result_of(STUDY).read_bytes()
    for low, high in [(0, 512), (512, 4096), (4096, 8192), (len(data) // 2, len(data)), (0, len(data))]:
        path = write(folder, "zeros.h5", data[:low] + bytes(high - low) + data[high:])
        for words in COMMANDS[:2]:
            assert ricochet("show", path.name, *words, cwd=folder).code in (DONE, FILES)
        ricochet("show", path.name, "--verify", cwd=folder).expect_refused(FILES, "zeros.h5: ")


def test_a_damaged_result_is_refused_on_resume_and_kept(ricochet, folder):
    data = ricochet.result_of(STUDY).read_bytes()
    write(folder, "r.yaml", STUDY)
    _, at, _ = next(c for c in chunks(ricochet.result_of(STUDY)) if c[0] == "orbits/energy")
    for damaged, ranks in [(flipped(data, at), 2), (data[:-1], 0), (b"", 0), (b"not HDF5", 0)]:
        write(folder, "r.h5", damaged)
        refused = ricochet.run("r.yaml", "--resume", cwd=folder, ranks=ranks)
        refused.expect_refused(FILES, "r.h5: ", "--force")
        assert (folder / "r.h5").read_bytes() == damaged and names(folder) == ["r.h5", "r.yaml"], names(folder)
    ricochet.run("r.yaml", "--force", cwd=folder).expect_done()
    assert_same(ricochet.result_of(STUDY), folder / "r.h5", ANY_COMMAND)


# --- checkpoints ---


@pytest.fixture(scope="module")
def checkpoint(ricochet):
    """The files of the checkpoint of a stopped run on two ranks, by name."""
    folder = ricochet.new_folder()
    write(folder, "s.yaml", SLOW)
    run = ricochet.start_run("s.yaml", cwd=folder, ranks=2)
    wait_until(lambda: tasks_in(folder / "s.h5.ckpt") >= 40, "records")
    run.send_signal(signal.SIGUSR1)
    ricochet.end(run).expect(STOPPED)
    return {path.name: path.read_bytes() for path in (folder / "s.h5.ckpt").glob("part-*")}


def assert_resumes(ricochet, folder, parts, change, ranks=2):
    """A checkpoint with one file changed is used as far as it is sound. Returns how many tasks were taken from it."""
    own = folder / str(len(names(folder)))
    (own / "s.h5.ckpt").mkdir(parents=True)
    write(own, "s.yaml", SLOW)
    largest = max(parts, key=lambda name: len(parts[name]))
    for name, data in parts.items():
        write(own / "s.h5.ckpt", name, change(data) if name == largest else data)
    ricochet.run("s.yaml", "--resume", cwd=own, ranks=ranks).expect_done()
    assert_same(ricochet.result_of(SLOW), own / "s.h5", ANY_COMMAND)
    assert names(own) == ["s.h5", "s.yaml"]
    return run_attributes(own / "s.h5")["tasks_resumed"]


def test_truncated_checkpoints_resume_from_their_whole_records(ricochet, folder, checkpoint):
    whole = assert_resumes(ricochet, folder, checkpoint, lambda data: data)
    assert whole >= 40
    assert 0 < assert_resumes(ricochet, folder, checkpoint, lambda data: data[:-1]) < whole
    assert 0 < assert_resumes(ricochet, folder, checkpoint, lambda data: data[:50], ranks=3) < whole


@pytest.mark.sanitized
def test_checkpoints_with_something_else_at_their_end_resume(ricochet, folder, checkpoint):
    whole = assert_resumes(ricochet, folder, checkpoint, lambda data: data + b"\0" * 5000)
    assert whole >= 40
    assert assert_resumes(ricochet, folder, checkpoint, lambda data: data + data[-500:]) == whole


def test_flipped_bits_in_a_checkpoint_never_reach_the_result(ricochet, folder, checkpoint):
    """In the head of a record, in its rows, in the head of the file."""
    for at in (program.PART_HEADER + 9, program.PART_HEADER + 100, 20):
        assert_resumes(ricochet, folder, checkpoint, lambda data: flipped(data, at, 3))


def test_a_folder_that_is_no_checkpoint_is_left_alone(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(3)))
    (folder / "s.h5.ckpt").mkdir()
    write(folder / "s.h5.ckpt", "notes.txt", "mine")
    ricochet.run("s.yaml", "--resume", cwd=folder).expect_done()
    assert names(folder / "s.h5.ckpt") == ["notes.txt"]
    ricochet("show", "s.h5", "--verify", cwd=folder).expect_done()
