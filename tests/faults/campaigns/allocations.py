"""Every allocation fails once, of the program and of its libraries: those whose stack differs from all before, over all
shipped studies made small, and over check and show. What is expected: done, with the same result, or code 1 and a
sentence that says memory; then --resume gives the same result; never a signal, nothing left behind."""

import re

from campaign import Known, Trial
from injection import Injected, shipped_studies, study_of_every_kind
from program import DONE, RUN, names

READERS = (["check", "s.yaml"], ["show", "s.h5"], ["show", "s.h5", "--csv"], ["show", "s.h5", "--verify"])

# Crashes of libraries that have no memory, which nothing that we call prevents: the function that crashes, and whose.
KNOWN = {}


def expect_no_signal(run):
    """A crash of a library at a place that we know is told apart from all others."""
    for what, stack in run.stacks.items():
        for place, why in KNOWN.items():
            if what.startswith("signal") and re.search(place, stack):
                raise Known(f"{why}: {stack}")
    assert run.result.code >= 0 and not any(what.startswith("signal") for what in run.stacks), run


def expect_memory_in_words(run):
    assert run.result.code == RUN, run
    lines = run.result.err.splitlines()
    assert len(lines) == 1 and re.search(r"\b(no|out of|not enough) memory\b", lines[0]), run
    assert "damaged" not in lines[0] and "unknown reason" not in lines[0], run


def fail_a_run(study, at, settings):
    def trial(ricochet, folder):
        study.put(folder)
        run = study.run(ricochet, folder, calls="memory", at=at, **settings)
        expect_no_signal(run)
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
        expect_no_signal(run)
        if run.result.code == DONE:
            assert run.result.out == said, run
            return "done"
        expect_memory_in_words(run)
        return run.result.err.strip()

    return trial


def trials(ricochet):
    seen, found = set(), []

    def new_places(run):
        fresh = [int(call) for call, digest in run.places if digest not in seen]
        seen.update(digest for _, digest in run.places)
        return fresh

    for study in shipped_studies(ricochet):
        for at in new_places(study.count("memory", places=1)):
            found.append(Trial(f"run {study.name} {at}", fail_a_run(study, at, {})))
    for study in study_of_every_kind(ricochet):
        study.count("memory")
        for words in READERS:
            run = Injected(ricochet, *words, cwd=study.folder, calls="memory", places=1)
            for at in new_places(run):
                name = " ".join([words[0], study.name, *words[2:], str(at)])
                found.append(Trial(name, fail_a_reader(study, words, at, run.result.expect(DONE).out)))
    return found
