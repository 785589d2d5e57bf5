"""Every allocation fails once, of the program and of its libraries: those whose callers differ from all before, over all
shipped studies made small, and over check and show; some 12,000 trials. For some, all later ones fail as well. Expected: done, with the same
result, or code 1 and a sentence that says memory, and then --resume gives the same result. Crashes of libraries are
known, with their stack, if the allocation was their own; --resume follows them too."""

import re

from campaign import Known, Trial
from injection import Injected, shipped_studies, study_of_every_kind
from program import DONE, RUN, names

READERS = (["check", "s.yaml"], ["show", "s.h5"], ["show", "s.h5", "--csv"], ["show", "s.h5", "--verify"])

# Libraries that do not survive that one of their own allocations fails, and what of it we can prevent: before they
# begin, the program looks whether there is room for all they take. One failure in their midst it cannot prevent.
LIBRARIES = {"libfftw3": "FFTW aborts while it plans", "libhdf5": "HDF5 crashes or exits with -1",
             "libsundials": "SUNDIALS crashes while it sets up vectors", "libgsl": "GSL crashes in a decomposition"}  # fmt: skip


def crash_of_a_library(run):
    """Whose crash it is, and where, if the allocation that failed was its own; None if the program did not crash. Fails
    for every other crash."""
    died = {what: stack for what, stack in run.stacks.items() if what.startswith("signal")}
    if run.result.code in (DONE, RUN) and not died:
        return None
    fault = next(stack for what, stack in run.stacks.items() if what not in died)
    asked = next(frame for frame in fault.split() if not frame.startswith("libc.so"))
    whose = next((why for library, why in LIBRARIES.items() if asked.startswith(library)), None)
    ended = run.result.code == 255 or "HDF5 ended while it read it" in run.result.err
    assert whose and (died or ended), run
    return f"{whose}: {fault}"


def expect_memory_in_words(run):
    """In the last line: SUNDIALS and HDF5 may have said it before, in their own words."""
    assert run.result.code == RUN, run
    line = run.result.err.splitlines()[-1]
    assert re.search(r"\b(no|out of|allocate) memory\b", line) and "damaged" not in line and "unknown reason" not in line, run


def fail_a_run(study, at, **settings):
    def trial(ricochet, folder):
        study.put(folder)
        run = study.run(ricochet, folder, calls="memory", at=at, **settings)
        crash = crash_of_a_library(run)
        if crash:
            study.expect_resumed(ricochet, folder)
            raise Known(crash)
        if run.result.code == DONE:
            study.expect_whole(folder)
            return "done"
        expect_memory_in_words(run)
        assert not [name for name in names(folder) if name.endswith(".tmp")], names(folder)
        study.expect_resumed(ricochet, folder)
        return run.result.err.strip()

    return trial


def fail_a_reader(study, words, at, said):
    def trial(ricochet, folder):
        study.put(folder)
        study.put_result(folder)
        run = Injected(ricochet, *words, cwd=folder, calls="memory", at=at)
        crash = crash_of_a_library(run)
        if crash:
            raise Known(crash)
        if run.result.code == DONE:
            assert run.result.out == said, run
            return "done"
        expect_memory_in_words(run)
        return run.result.err.strip()

    return trial


def trials(ricochet):
    seen, found = set(), []

    def new_places(run):
        fresh = [int(call) for call, digest, _ in run.places if digest not in seen]
        seen.update(digest for _, digest, _ in run.places)
        return fresh

    for study in shipped_studies(ricochet):
        for at in new_places(study.count("memory", places=1)):
            found.append(Trial(f"run {study.name} {at}", fail_a_run(study, at)))
            if len(found) % 10 == 0:
                found.append(Trial(f"run {study.name} {at} and all after", fail_a_run(study, at, on=1)))
    for study in study_of_every_kind(ricochet):
        study.count("memory")
        for words in READERS:
            run = Injected(ricochet, *words, cwd=study.folder, calls="memory", places=1)
            for at in new_places(run):
                name = " ".join([words[0], study.name, *words[2:], str(at)])
                found.append(Trial(name, fail_a_reader(study, words, at, run.result.expect(DONE).out)))
    return found
