"""Results that somebody else made are shown without harm: their texts are not obeyed, their numbers not believed, and
files that make HDF5 crash end in a sentence."""

import sys
from itertools import islice
from pathlib import Path

import h5py
import numpy as np
import pytest
from program import DONE, FILES, names, study, sweep, write

sys.path.insert(0, str(Path(__file__).resolve().parent))
from forged import crowded, look, mutants

COMMANDS = (["show"], ["show", "--csv"], ["show", "--verify"])
BRANCH = """kind: branch
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 0.06, states: true}
"""


@pytest.fixture
def result(ricochet, folder):
    write(folder, "s.yaml", study(at_start="[15]", orbit="special_points: true", sweep=sweep(20)))
    ricochet.run("s.yaml", cwd=folder).expect_done()
    return folder / "s.h5"


def put(owner, name, text):
    del owner.attrs[name]
    owner.attrs[name] = np.bytes_(text if isinstance(text, bytes) else text.encode())


def test_control_characters_in_texts_are_shown_as_escapes(ricochet, folder, result):
    with h5py.File(result, "r+") as file:
        put(file, "title", "a \x1b]0;window title\x07 \x1b[2J and \u009b2J")
        put(file, "compiler", "gcc\x1b[31m")
        # Latin-1, a character that is cut, a surrogate, and one of four bytes
        put(file, "libraries", "fft\u00e9 ".encode() + b"\x9b2J \xc3 \xed\xa0\x80 \xf0\x9f\x98\x80")
        put(file["orbits/energy"], "long_name", "energy\x1b[31m")
        put(file["orbits/energy"], "units", "\r\x1b[1A")
    shown = ricochet("show", result, cwd=folder).expect(DONE).out
    assert all(ord(letter) >= 0x20 or letter == "\n" for letter in shown) and "\u009b" not in shown
    for word in ("a \\x1b]0;window title\\x07 \\x1b[2J and \\x9b2J", "gcc\\x1b[31m", "energy\\x1b[31m", "\\x0d\\x1b[1A",
                 "fft\u00e9 \\x9b2J \\xc3 \\xed\\xa0\\x80 \U0001f600"):  # fmt: skip
        assert word in shown, shown


def test_a_name_with_control_characters_is_refused(ricochet, folder, result):
    with h5py.File(result, "r+") as file:
        file.move("orbits/energy", "orbits/energy\x1b[2J")
    for words in COMMANDS:
        refused = ricochet(*words, result, cwd=folder).expect(FILES)
        assert "control characters" in refused.err and "\x1b" not in refused.err


@pytest.mark.parametrize(("shape", "chunk", "of"), [((2**62,), (1024,), "f8"), ((2**40, 2**40), (1024, 1024), "f8"),
                                                    ((2**24,), (1,), "i1"), ((2**12, 2**12), (1, 1), "i1")])  # fmt: skip
def test_a_data_set_that_claims_more_than_the_file_holds_is_refused_at_once(ricochet, folder, result, shape, chunk, of):
    with h5py.File(result, "r+") as file:
        data = file["orbits"].create_dataset("huge", shape, of, chunks=chunk, fletcher32=True)
        for name in ("units", "long_name", "source"):
            data.attrs[name] = np.bytes_("1")
        data.attrs["axes"] = np.bytes_("task" if len(shape) == 1 else "task sample")
    for words in COMMANDS:
        refused = ricochet(*words, result, cwd=folder, limit=20).expect(FILES)
        assert "huge claims more values than the file can hold" in refused.err, refused


def test_a_file_that_makes_hdf5_crash_is_refused(ricochet, folder, result):
    data = result.read_bytes()
    write(folder, "sound.h5", data)
    result.write_bytes(crowded(data))
    for words in COMMANDS:
        refused = ricochet(*words, "s.h5", cwd=folder).expect(FILES)
        assert refused.err.splitlines()[-1].startswith("s.h5: "), refused
        assert ricochet(*words, "sound.h5", cwd=folder).expect(DONE).err == ""


@pytest.mark.parametrize("seed", range(2))
def test_forged_results_end_in_a_sentence(ricochet, folder, result, seed):
    for mutant in islice(mutants(result.read_bytes(), seed), 5):
        look(ricochet, folder, *mutant)


def test_a_restart_from_a_file_that_makes_hdf5_crash_is_refused(ricochet, folder):
    write(folder, "b.yaml", BRANCH)
    ricochet.run("b.yaml", cwd=folder).expect_done()
    write(folder, "r.yaml", BRANCH.replace("from: 0.05, ", "") + "restart: {file: b.h5, point: 1}\n")
    for ranks in (0, 2):
        ricochet.run("r.yaml", "--force", cwd=folder, ranks=ranks).expect_done()
    (folder / "r.h5").unlink()
    write(folder, "b.h5", crowded((folder / "b.h5").read_bytes()))
    ricochet("check", "r.yaml", cwd=folder).expect(FILES)
    for ranks in (0, 2):
        refused = ricochet.run("r.yaml", cwd=folder, ranks=ranks).expect(FILES)
        assert "b.h5: " in refused.err and names(folder) == ["b.h5", "b.yaml", "r.yaml"], refused


@pytest.mark.parametrize("link", [h5py.SoftLink("/orbits/energy"), h5py.ExternalLink("other.h5", "/energy")])
def test_links_that_lead_elsewhere_are_refused(ricochet, folder, result, link):
    with h5py.File(folder / "other.h5", "w") as other:
        other["energy"] = np.arange(20.0)
    with h5py.File(result, "r+") as file:
        file["orbits/other"] = link
    for words in COMMANDS:
        assert "other is a link to somewhere else" in ricochet(*words, result, cwd=folder).expect(FILES).err


def test_values_in_another_file_are_refused(ricochet, folder, result):
    (folder / "other").write_bytes(bytes(160))
    with h5py.File(result, "r+") as file:
        attributes = dict(file["orbits/energy"].attrs)
        del file["orbits/energy"]
        data = file["orbits"].create_dataset("energy", 20, "f8", external=[("other", 0, 160)])
        for name in ("units", "long_name", "source", "axes"):
            data.attrs[name] = attributes[name]
    for words in COMMANDS:
        assert "the values of" in ricochet(*words, result, cwd=folder).expect(FILES).err
