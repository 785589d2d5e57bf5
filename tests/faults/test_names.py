"""What others have under the names that a run uses is neither replaced nor removed nor followed."""

import os

import pytest
from program import USAGE, names, study, sweep, write

STUDY = study(at_start="[15]", sweep=sweep(20))


@pytest.fixture
def place(folder):
    """A folder with a study, and one with what belongs to somebody else."""
    (folder / "theirs").mkdir()
    (folder / "theirs" / "part-0001-0000").write_text("a part of something")
    (folder / "theirs" / "notes").write_text("their notes")
    write(folder, "s.yaml", STUDY)
    return folder


def link_to(target):
    return lambda path: path.symlink_to(target)


# name that the run uses, what stands there, words of the refusal
TAKEN = [
    ("s.h5", link_to("theirs/notes"), "s.h5: is a symbolic link, expected the name of a file"),
    ("s.h5", link_to("nothing"), "s.h5: is a symbolic link"),
    ("s.h5", os.mkfifo, "s.h5: is neither a file nor a folder"),
    ("s.h5", os.mkdir, "s.h5: is a folder, expected the name of a file"),
    ("s.h5.tmp", link_to("theirs/notes"), "s.h5.tmp: is a symbolic link"),
    ("s.h5.tmp", os.mkdir, "s.h5.tmp: is a folder"),
    ("s.h5.tmp", lambda path: path.write_text("my own notes"), "s.h5.tmp: is there and no part of a result"),
    ("s.h5.ckpt", link_to("theirs"), "s.h5.ckpt: is a symbolic link, expected the name of a folder"),
    ("s.h5.ckpt", lambda path: path.write_text("my own notes"), "s.h5.ckpt: is a file"),
]


def everything(folder):
    """{path: what it is} below a folder, links not followed."""
    found = {}
    for path in sorted(folder.rglob("*")):
        at = str(path.relative_to(folder))
        found[at] = os.readlink(path) if path.is_symlink() else path.read_text() if path.is_file() else path.is_fifo()
    return found


@pytest.mark.parametrize("name, make, words", TAKEN)
@pytest.mark.parametrize("word", ["--force", "--resume", None])
def test_names_that_are_taken_are_refused_before_anything_is_computed(ricochet, place, name, make, words, word):
    make(place / name)
    before = everything(place)
    ricochet.run("s.yaml", *([word] if word else []), cwd=place).expect_refused(USAGE, words)
    assert everything(place) == before


def test_what_a_killed_run_left_of_its_result_is_replaced(ricochet, place):
    for left in (b"", b"\x89HDF\r\n\x1a\n and more"):
        (place / "s.h5.tmp").write_bytes(left)
        ricochet.run("s.yaml", "--force", cwd=place).expect_done()
        assert names(place) == ["s.h5", "s.yaml", "theirs"]
