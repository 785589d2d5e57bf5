"""What the end-to-end tests share: running the program and mpirun, studies, folders, comparing results.

A test takes the fixtures `ricochet`, the program, and `folder`, empty and its own (conftest.py); its name states the
property."""

import os
import re
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

LIMIT = 300  # seconds until a run counts as hanging; many times what the slowest takes on a busy machine
DONE, RUN, USAGE, FILES, STOPPED = 0, 1, 2, 3, 75

# Shipped grids that are made for pictures, with fewer points.
COARSER = {"basin": {"[0]": 20, "[1]": 20}, "basin_oscillator": {"[0]": 5, "[1]": 5},
           "period_map": {"[0]": 20, "[1]": 20}, "diagram_oscillator": {"[1]": 16}, "diagram_overlaps": {"": 16},
           "diagram_five": {"": 6}, "diagram_discontinuous": {"": 16}, "diagram_scaled": {"": 200},
           "diagram_coexisting": {"": 100}}  # fmt: skip


def coarser(path):
    """Words of the command line that make a shipped study short."""
    return [word for entry, n in COARSER.get(path.stem, {}).items() for word in ("--set", f"sweep{entry}.points={n}")]


# --- running ---


class Result:
    def __init__(self, words, code, out, err):
        self.words, self.code, self.out, self.err = words, code, out, err

    def __str__(self):
        return f"{' '.join(map(str, self.words))}\n  code {self.code}\n  out {self.out!r}\n  err {self.err!r}"

    def expect(self, code):
        assert self.code == code, f"expected code {code}: {self}"
        return self

    def expect_done(self):
        return self.expect(DONE)

    def expect_refused(self, code, place, *phrases):
        """One line on standard error that begins with the place, and nothing on standard output."""
        self.expect(code)
        assert self.out == "", f"something on standard output: {self}"
        return self.expect_line(place, *phrases)

    def expect_line(self, place, *phrases):
        lines = self.err.splitlines()
        assert len(lines) == 1 and self.err.endswith("\n"), f"expected one line on standard error: {self}"
        assert lines[0].startswith(place), f"expected to begin with {place!r}: {self}"
        for phrase in phrases:
            assert phrase in lines[0], f"expected to say {phrase!r}: {self}"
        return self


def environment(extra=None):
    """Root in a container may run mpirun; nothing of an outer MPI job or of another locale gets in."""
    e = {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_", "PRTE_"))}
    e.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", LC_ALL="C")
    # Waiting ranks give their core away: more ranks than cores must not make the tests slow.
    e["OMPI_MCA_mpi_yield_when_idle"] = "1"
    # mpirun says nothing of its own when a rank fails: by these names in Open MPI 4 and 5.
    e.update(OMPI_MCA_orte_execute_quiet="1", PRTE_MCA_prte_execute_quiet="1")
    e.update(extra or {})
    return e


class Program:
    def __init__(self, binary, source, shared):
        self.binary = binary
        self.studies = source / "data" / "studies"
        self._shared = shared  # a folder that lasts as long as the session
        self._running = []
        self._results = {}

    def new_folder(self):
        """An empty folder that lasts as long as the session."""
        return Path(tempfile.mkdtemp(dir=self._shared))

    def _session(self):
        """A folder of its own for what Open MPI keeps of a run: runs that start together would otherwise race to make,
        and to remove, the one that they share."""
        return {"OMPI_MCA_orte_tmpdir_base": str(self.new_folder())}

    def words(self, words, ranks=0, mpi=()):
        line = [str(self.binary), *map(str, words)]
        return ["mpirun", "--oversubscribe", *mpi, "-n", str(ranks), *line] if ranks else line

    def start(self, *words, cwd, ranks=0, mpi=(), env=None, stdin=None, before=None, out=subprocess.PIPE):
        process = subprocess.Popen(
            self.words(words, ranks, mpi),
            cwd=cwd,
            env=environment({**self._session(), **(env or {})}),
            stdin=subprocess.PIPE if stdin is not None else subprocess.DEVNULL,
            stdout=out,
            stderr=subprocess.PIPE,
            preexec_fn=before,
        )
        process.told = stdin.encode() if stdin is not None else None
        self._running.append(process)
        return process

    def end(self, process, limit=LIMIT):
        """Waits for a started process."""
        try:
            out, err = process.communicate(process.told, timeout=limit)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"hangs: {' '.join(process.args)}") from None
        out, err = ((text or b"").decode() for text in (out, err))  # not text=True, which hides carriage returns
        return Result(process.args, process.returncode, out, err)

    def __call__(self, *words, cwd, limit=LIMIT, **options):
        """Runs to the end: a command, alone or with ranks=N under mpirun."""
        return self.end(self.start(*words, cwd=cwd, **options), limit)

    def run(self, *words, cwd, **options):
        """`ricochet run` without progress, so that standard error holds messages only."""
        return self("run", *words, "--progress", "never", cwd=cwd, **options)

    def start_run(self, *words, cwd, **options):
        return self.start("run", *words, "--progress", "never", cwd=cwd, **options)

    def result_of(self, text):
        """The result of a study, computed once for all tests of the session, on two ranks without an interruption."""
        if text not in self._results:
            folder = self.new_folder()
            write(folder, "s.yaml", text)
            self.run("s.yaml", cwd=folder, ranks=2).expect_done()
            self._results[text] = folder / "s.h5"
        return self._results[text]

    def end_all(self):
        for process in self._running:
            for pid in [*ranks_of(process).values(), process.pid]:
                if process.poll() is None:
                    _signal(pid, signal.SIGCONT)
                    _signal(pid, signal.SIGKILL)
            for stream in (process.stdin, process.stdout, process.stderr):
                if stream:
                    stream.close()
            process.wait()
        self._running.clear()


def _signal(pid, number):
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        pass


def ranks_of(mpirun):
    """{rank: process} of a running mpirun; they are its children."""
    found = {}
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
            words = (entry / "environ").read_bytes().split(b"\0") if parent == mpirun.pid else []
        except (OSError, IndexError):  # it ended while we looked
            continue
        for word in words:
            if word.startswith(b"OMPI_COMM_WORLD_RANK="):
                found[int(word.split(b"=")[1])] = int(entry.name)
    return found


def hears(pid, number):
    """Whether a process has a handler for a signal, or has ended."""
    try:
        caught = re.search(r"^SigCgt:\s*(\w+)", Path(f"/proc/{pid}/status").read_text(), re.M)[1]
    except OSError:
        return True
    return bool(int(caught, 16) >> (number - 1) & 1)


def wait_until(condition, what, limit=LIMIT):
    deadline = time.monotonic() + limit
    while not condition():
        assert time.monotonic() < deadline, f"waited in vain for {what}"
        time.sleep(0.005)


# --- studies and folders ---


def names(folder):
    return sorted(p.name for p in Path(folder).iterdir())


def write(folder, name, text):
    path = Path(folder) / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def study(particles=30, ends="periodic", gamma="0.1", at_start="[0]", orbit="", sweep=None, period="1.5 pi"):
    text = "kind: orbits\n"
    text += f"model: {{type: chain, particles: {particles}, ends: {ends}, gamma: {gamma}, floor: -1}}\n"
    text += f"orbit: {{period: {period}, at_start: {at_start}{orbit and ', ' + orbit}}}\n"
    return text + (f"sweep: {sweep}\n" if sweep else "")


def trajectory(particles=1, floor="-1", model="", start="v: 2", duration=20, time="", sweep=None):
    """Uncoupled particles of mass and stiffness 1, whose motions between impacts are sine waves."""
    text = "kind: trajectory\n"
    text += f"model: {{type: chain, particles: {particles}, gamma: 0, floor: {floor}{model and ', ' + model}}}\n"
    text += f"start: {{{start}}}\ntime: {{duration: {duration}{time and ', ' + time}}}\n"
    return text + (f"sweep: {sweep}\n" if sweep else "")


def sweep(points, low=0.0, high=0.187, parameter="model.gamma"):
    return f"{{parameter: {parameter}, from: {low}, to: {high}, points: {points}}}"


# --- checkpoints ---

PART_HEADER, RECORD_HEADER = 168, 48  # bytes, as the program's checkpoint_files.h lays them out


def records_of(part):
    """[(first task, number of tasks)] of every whole record in a file of a checkpoint."""
    found, data, at = [], part.read_bytes(), PART_HEADER
    while at + RECORD_HEADER <= len(data):
        _, first, count, size = np.frombuffer(data, "<u8", 4, at).tolist()
        at += RECORD_HEADER + size
        if at <= len(data):
            found.append((first, count))
    return found


def records(folder):
    """The same of all files in the folder of a checkpoint."""
    return [record for path in sorted(Path(folder).glob("part-*")) for record in records_of(path)]


def tasks_in(folder):
    return sum(count for _, count in records(folder))


# --- results ---

VARIES = {"file_time", "command"}  # root attributes that tell one run from another


def _attributes(thing, skip=()):
    # References to scales are addresses; what they lead to is compared by name.
    skip = {*skip, "DIMENSION_LIST", "REFERENCE_LIST"}
    return {k: (np.asarray(v).dtype, np.asarray(v).tobytes()) for k, v in thing.attrs.items() if k not in skip}


def _describe(thing):
    if not isinstance(thing, h5py.Dataset):
        return (_attributes(thing),)
    axes = [[scale.name for scale in axis.values()] for axis in thing.dims]
    return thing.dtype, thing.shape, thing.chunks, axes, _attributes(thing), thing[()].tobytes()


def contents(path, skip=()):
    """Everything in a result outside /run, down to the bits, besides what tells runs apart."""
    found = {}
    with h5py.File(path, "r") as file:
        found["/"] = (_attributes(file, {*VARIES, *skip}),)
        file.visititems(lambda name, thing: found.update({name: _describe(thing)}))
    return {k: v for k, v in found.items() if k != "run" and not k.startswith("run/")}


def assert_same(path, other, skip=()):
    a, b = contents(path, skip), contents(other, skip)
    assert a.keys() == b.keys(), f"{path} and {other} hold {sorted(a.keys() ^ b.keys())} only once"
    for name in a:
        assert a[name] == b[name], f"{path} and {other} differ in {name}: {a[name]!r:.600} {b[name]!r:.600}"


def assert_same_data(path, other):
    """Every data set outside /run, whatever the attributes say."""
    a, b = contents(path), contents(other)
    assert a.keys() == b.keys()
    for name in a:
        assert len(a[name]) == 1 or a[name][-1] == b[name][-1], f"{path} and {other} differ in {name}"


def run_attributes(path):
    with h5py.File(path, "r") as file:
        return dict(file["run"].attrs)


def words_of(data_set):
    """The values of an enum data set by name."""
    by_value = {v: k for k, v in h5py.check_enum_dtype(data_set.dtype).items()}
    return [by_value[v] for v in data_set[()].tolist()]


def only(text, pattern):
    """The one match of a pattern."""
    found = re.findall(pattern, text)
    assert len(found) == 1, f"{pattern!r} found {len(found)} times in {text!r}"
    return found[0]
