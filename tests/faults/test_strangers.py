"""Results that somebody else made are shown without harm: their texts are not obeyed, their numbers not believed."""

import h5py
import numpy as np
import pytest
from program import DONE, FILES, study, sweep, write


@pytest.fixture
def result(ricochet, folder):
    write(folder, "s.yaml", study(at_start="[15]", orbit="special_points: true", sweep=sweep(20)))
    ricochet.run("s.yaml", cwd=folder).expect_done()
    return folder / "s.h5"


def put(owner, name, text):
    del owner.attrs[name]
    owner.attrs[name] = np.bytes_(text.encode())


def test_control_characters_in_texts_are_shown_as_escapes(ricochet, folder, result):
    with h5py.File(result, "r+") as file:
        put(file, "title", "a \x1b]0;window title\x07 \x1b[2J and \u009b2J")
        put(file, "compiler", "gcc\x1b[31m")
        put(file["orbits/energy"], "long_name", "energy\x1b[31m")
        put(file["orbits/energy"], "units", "\r\x1b[1A")
    shown = ricochet("show", result, cwd=folder).expect(DONE).out
    assert all(ord(letter) >= 0x20 or letter == "\n" for letter in shown) and "\u009b" not in shown
    for word in ("a \\x1b]0;window title\\x07 \\x1b[2J and \\x9b2J", "gcc\\x1b[31m", "energy\\x1b[31m", "\\x0d\\x1b[1A"):
        assert word in shown, shown


def test_a_name_with_control_characters_is_refused(ricochet, folder, result):
    with h5py.File(result, "r+") as file:
        file.move("orbits/energy", "orbits/energy\x1b[2J")
    for words in (["show"], ["show", "--csv"], ["show", "--verify"]):
        refused = ricochet(*words, result, cwd=folder).expect(FILES)
        assert "control characters" in refused.err and "\x1b" not in refused.err


@pytest.mark.parametrize("shape", [(2**62,), (2**40, 2**40)])
def test_a_data_set_that_claims_more_than_the_file_holds_is_refused_at_once(ricochet, folder, result, shape):
    with h5py.File(result, "r+") as file:
        chunks = (1024,) * len(shape)
        data = file["orbits"].create_dataset("huge", shape, "f8", chunks=chunks, fletcher32=True)
        for name in ("units", "long_name", "source"):
            data.attrs[name] = np.bytes_("1")
        data.attrs["axes"] = np.bytes_("task" if len(shape) == 1 else "task sample")
    for words in (["show"], ["show", "--csv"], ["show", "--verify"]):
        refused = ricochet(*words, result, cwd=folder, limit=20).expect(FILES)
        assert "huge claims more values than the file can hold" in refused.err, refused
