"""A few of the faults of the campaigns, at places that once went wrong: a failing allocation or call on a file ends with
its code and a sentence, and --resume gives the undisturbed result."""

import errno
import sys
from pathlib import Path

import pytest
from program import DONE, FILES, RUN, names, study, sweep, trajectory

sys.path.insert(0, str(Path(__file__).resolve().parent))
from injection import Injected, Study

ORBITS = study(at_start="[15]", sweep=sweep(3))
BRANCH = """kind: branch
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05, frequency: 1}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 0.2, points: 5, states: true}
"""


@pytest.fixture
def counted(ricochet):
    def count(text, calls, **settings):
        one = Study(ricochet, "s", text)
        return one, one.count(calls, **settings)

    return count


def spread(count, most):
    return sorted({1 + k * count // most for k in range(most)})


def expect_memory(run):
    run.result.expect(RUN)
    assert "memory" in run.result.err and "damaged" not in run.result.err, run


# --- files ---


@pytest.mark.parametrize("only", ["close", "ftruncate", "pwrite"])
def test_a_call_on_a_file_that_fails_ends_with_its_code_and_a_sentence(ricochet, folder, counted, only):
    """Also the last ones, when HDF5 closes the file: at exit it would then crash."""
    one, whole = counted(ORBITS, "files", name="s.h5", only=only)
    for at in [*spread(whole.calls, 8), whole.calls]:
        one.put(folder)
        run = one.run(ricochet, folder, calls="files", name="s.h5", only=only, at=at, error=errno.EIO)
        assert run.result.code in (DONE, FILES) and "s.h5.tmp" not in names(folder), run
        assert run.result.code == DONE or "Input/output error" in run.result.err, run
        one.expect_resumed(ricochet, folder)
        (folder / "s.h5").unlink()


# --- memory ---


def own_calls(whole):
    """What the program itself allocates, at its places."""
    return [int(call) for call, _, innermost in whole.places if innermost.startswith("ricochet+")]


@pytest.mark.parametrize("text", [BRANCH, trajectory()], ids=["branch", "trajectory"])
def test_records_that_do_not_fit_are_no_outcome(ricochet, folder, counted, text):
    """Tables of a task grow by realloc."""
    one, whole = counted(text, "memory", only="realloc", places=1)
    codes = []
    for at in own_calls(whole):
        one.put(folder)
        run = one.run(ricochet, folder, calls="memory", only="realloc", at=at)
        codes.append(run.result.code)
        if run.result.code == DONE:
            one.expect_whole(folder)
        else:
            expect_memory(run)
            one.expect_resumed(ricochet, folder)
        (folder / "s.h5").unlink()
    assert RUN in codes, codes


def test_what_hdf5_cannot_allocate_is_memory_and_no_damage(ricochet, folder, counted):
    one, _ = counted(ORBITS, "memory")
    one.put(folder)
    one.put_result(folder)
    words = ("show", "s.h5", "--verify")
    whole = Injected(ricochet, *words, cwd=folder, calls="memory", places=1)
    said, survived = whole.result.expect(DONE).out, 0
    for call in spread(whole.calls, 60):
        run = Injected(ricochet, *words, cwd=folder, calls="memory", at=call)
        if run.result.code in (DONE, RUN) and not any(what.startswith("signal") for what in run.stacks):
            survived += 1
            assert run.result.code == RUN or run.result.out == said, run
            assert run.result.code == DONE or "memory" in run.result.err, run
        else:  # HDF5 does not survive all of it
            assert "memory ran out" in run.result.expect(FILES).err, run
    assert survived > 30
