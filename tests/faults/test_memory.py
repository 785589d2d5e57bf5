"""Memory is not an outcome: a run that gets too little stops with 1 and keeps what is finished; a row never depends on
it."""

import resource

import h5py
import pytest
from program import DONE, RUN, assert_same, study, sweep, trajectory, write

# A large prime: the transform takes the most memory.
ORBITS = study(particles=300007, at_start="[7]", orbit="states: false, verify: true", sweep=sweep(2, 0.1, 0.12))
MOTION = trajectory(600000, start="v: 1.2", duration=3, time="samples: 2", sweep="{parameter: model.gamma, values: [0.1, 0.2]}")
ANY_COMMAND = ("heap_checksums",)


def limited(megabytes):
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))


@pytest.mark.parametrize("text, most", [(ORBITS, 400), (MOTION, 500)], ids=["orbits", "trajectory"])
def test_a_run_has_memory_or_stops(ricochet, folder, sanitized, text, most):
    if sanitized:
        pytest.skip("AddressSanitizer takes more address space than these limits")
    write(folder, "s.yaml", text)
    codes = []
    for megabytes in range(120, most, 20):
        done = ricochet.run("s.yaml", "--resume", "--mpi", "off", cwd=folder, before=limited(megabytes))
        codes.append(done.code)
        if done.code == DONE:
            break
        done.expect(RUN)
        assert "memory" in done.err, done
    assert codes[-1] == DONE and RUN in codes, codes
    assert_same(ricochet.result_of(text), folder / "s.h5", ANY_COMMAND)
    with h5py.File(folder / "s.h5") as file:
        group = next(name for name in ("orbits", "trajectory") if name in file)
        assert not any(b"memory" in reason for reason in file[group]["reason"][()].tolist())
