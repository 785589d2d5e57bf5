"""Calls that fail in a run of the program: inject.c preloaded, and what its log tells."""

import re
import shutil

import yaml
from program import DONE, contents, names, write

ANY_COMMAND = ("heap_checksums",)  # holds addresses, which move with the length of the command line


class Injected:
    """How a command went with `settings` (see inject.c) for the calls of a family."""

    def __init__(self, ricochet, *words, cwd, calls, limit=300, **settings):
        log = cwd.parent / f"{cwd.name}.log"
        log.unlink(missing_ok=True)
        env = {f"FAULT_{key.upper()}": str(value) for key, value in settings.items()}
        env.update(LD_PRELOAD=str(ricochet.binary.parent / "libfault_inject.so"), FAULT_CALLS=calls, FAULT_LOG=str(log))
        self.result = ricochet(*words, cwd=cwd, limit=limit, env=env)
        lines = [line.partition(": ") for line in log.read_text().splitlines()]
        self.stacks = {what: stack for what, _, stack in lines}  # of the fault by its function, of a `signal N`
        self.calls = int(self.stacks.pop("calls", 0))
        self.places = [rest.split() for what, _, rest in lines if what == "place"]  # [call, digest of its stack, innermost caller]

    def __str__(self):
        return "\n".join([str(self.result), *(f"  {what}: {stack}" for what, stack in self.stacks.items())])

    __repr__ = __str__  # for asserts


class Study:
    """A small study, and how a run without faults goes."""

    def __init__(self, ricochet, name, text):
        self.name, self.text, self.ricochet = name, text, ricochet
        self.folder = ricochet.new_folder()
        self.put(self.folder)
        self._whole = None

    def put(self, folder):
        write(folder, "s.yaml", self.text)

    def run(self, ricochet, folder, **options):
        return Injected(ricochet, "run", "s.yaml", "--mpi", "off", "--resume", "--progress", "never", cwd=folder, **options)

    def count(self, calls, **settings):
        """The undisturbed run, which also leaves the result that others are compared with."""
        done = self.run(self.ricochet, self.folder, calls=calls, **settings)
        done.result.expect(DONE)
        self._whole = contents(self.folder / "s.h5", ANY_COMMAND)
        return done

    def put_result(self, folder):
        shutil.copy(self.folder / "s.h5", folder)

    def expect_whole(self, folder):
        """Nothing but the study and the result, which is the undisturbed one in everything that is stored."""
        assert names(folder) == ["s.h5", "s.yaml"], names(folder)
        found = contents(folder / "s.h5", ANY_COMMAND)
        different = [name for name in self._whole.keys() | found.keys() if self._whole.get(name) != found.get(name)]
        assert not different, f"differ from an undisturbed run: {different}"

    def expect_resumed(self, ricochet, folder):
        ricochet.run("s.yaml", "--mpi", "off", "--resume", cwd=folder).expect_done()
        self.expect_whole(folder)


def kind_of(text):
    return re.search(r"^kind: *(\w+)", text, re.MULTILINE).group(1)


def shrunken(text):
    """A study with at most three values along each sweep."""
    read = yaml.safe_load(text)
    sweeps = read.get("sweep", [])
    for one in [sweeps] if isinstance(sweeps, dict) else sweeps:
        if "points" in one:
            one["points"] = min(one["points"], 3)
        if "values" in one:
            one["values"] = one["values"][:2]
    return yaml.safe_dump(read, sort_keys=False)


SLOW = {"grazing_verdicts", "vibro_impact_20"}  # seconds, for what others do as well


def shipped_studies(ricochet):
    """All that the program ships, made small."""
    paths = [path for path in sorted(ricochet.studies.glob("*.yaml")) if path.stem not in SLOW]
    return [Study(ricochet, path.stem, shrunken(path.read_text())) for path in paths]


def study_of_every_kind(ricochet):
    first = {}
    for study in shipped_studies(ricochet):
        first.setdefault(kind_of(study.text), study)
    return list(first.values())
