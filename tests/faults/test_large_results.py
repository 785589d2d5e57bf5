"""The memory of a rank stays bounded by its chunk, however large the result: every kind runs in an address space that
leaves it a tenth of the bytes of its result, fresh and over an old one."""

import re
import resource

import pytest
from program import names, write

# What the program needs for a study of one task, and what a run has besides, in MB.
ALONE, RANK, ROOM = 44, 252, 28
DRIVEN = """model: {type: chain, particles: %d, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8,
        damping: %g, force: 0.05, frequency: 1}
orbit: {motion: forced}
"""
STUDIES = {
    "orbits": """model: {type: chain, particles: 4000, ends: periodic, gamma: 0.1, floor: -1}
orbit: {period: 1.5 pi, at_start: [7]}
sweep: {parameter: model.gamma, from: 0, to: 0.187, points: 5000}
""",
    "trajectory": """model: {type: chain, particles: 1, gamma: 0, floor: -1}
start: {v: 2}
time: {duration: 1000, samples: 10000}
sweep: {parameter: model.force, from: 0, to: 0.1, points: 1200}
""",
    "branch": DRIVEN % (1, 0.1) + """branch: {parameter: model.force, from: 0.01, to: 0.04, samples: 2000}
sweep: {parameter: model.damping, from: 0.1, to: 0.2, points: 180}
""",
    "grazing": DRIVEN % (200, 0) + """branch: {parameter: model.force, from: 0.05, to: 20}
grazing: {coefficients: 64, windows: 0}
sweep: {parameter: model.restitution, from: 0.1, to: 0.9, points: 150}
""",
    "diagram": """model: {type: grazing_map, lambda: 0.5, omega: 0.3}
iterate: {transient: 100, keep: 20000, start: [0, 0, 0]}
sweep: {parameter: model.d, from: 5e-5, to: 0.03, points: 2000}
""",
    "basin": """model: {type: grazing_map, lambda: 0.1, omega: 0.05, d: 0.0155}
iterate: {transient: 10, start: [0, 0, 0]}
sweep:
  - {parameter: 'iterate.start[1]', from: -0.5, to: 0.5, points: 3000}
  - {parameter: 'iterate.start[0]', from: -0.5, to: 0.5, points: 1000}
""",
}


def limited(megabytes):
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))


def run(ricochet, folder, kind, ranks, *words):
    before = limited((RANK if ranks else ALONE) + ROOM)
    ricochet.run("s.yaml", *words, cwd=folder, ranks=ranks, before=before).expect_done()
    assert (folder / "s.h5").stat().st_size > 10 * (ROOM << 20), kind
    ricochet("show", "s.h5", "--verify", cwd=folder, before=limited(ALONE + ROOM)).expect_done()
    ricochet("show", "s.h5", cwd=folder, before=limited(ALONE + ROOM)).expect_done()


@pytest.fixture
def place(folder, sanitized):
    if sanitized:
        pytest.skip("AddressSanitizer takes more address space than these limits")
    return folder


@pytest.mark.long
@pytest.mark.parametrize("ranks", [0, 2])
@pytest.mark.parametrize("kind", STUDIES)
def test_the_memory_of_a_rank_does_not_grow_with_the_result(ricochet, place, kind, ranks):
    write(place, "s.yaml", f"kind: {kind}\n{STUDIES[kind]}")
    run(ricochet, place, kind, ranks)
    run(ricochet, place, kind, ranks, "--force")
    assert names(place) == ["s.h5", "s.yaml"]


def test_memory_is_examined_for_every_kind(ricochet, folder):
    printed = ricochet("--help", cwd=folder).expect_done().out
    kinds = re.search(r"^Kinds of study.*\n((?:  .*\n)+)", printed, re.MULTILINE).group(1)
    assert [line.split()[0] for line in kinds.splitlines()] == list(STUDIES)


def test_memory_does_not_grow_with_the_rows_of_a_trajectory(ricochet, place):
    write(place, "s.yaml", f"kind: trajectory\n{STUDIES['trajectory']}")
    run(ricochet, place, "trajectory", 0)
