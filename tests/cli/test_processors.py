"""Results do not depend on the processor: neither on libm's variants nor on the vector instructions that it has."""

import shutil
import subprocess

import pytest
from program import assert_same_data, coarser, environment, study, write

# A large ring, so that the sines of the transform count, and steps chosen by CVODES.
RING = study(particles=100003, ends="free", gamma="0.1", at_start="[7]", orbit="verify: false", period="5.5")
CVODES = """kind: trajectory
model: {type: chain, particles: 3, ends: fixed, gamma: 0.2, floor: -0.5, restitution: 0.9, force: 0.3, frequency: 1.1}
start: {v: 1.2}
time: {duration: 300, samples: 50, flow: cvodes}
"""
# Of the shipped ones those that libm's sin, exp or pow would change, and one of every other kind.
SHIPPED = ("impact_oscillator", "vibro_impact_5", "multipliers", "neighbours_in_phase", "duffing", "grazing_two_masses",
           "diagram_map", "attractor", "basin")  # fmt: skip
WITHOUT_FMA = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA_Usable,-AVX2_Usable"}
EMULATOR = shutil.which("qemu-x86_64")


def same(ricochet, folder, text, words=(), **options):
    """Whether a run in another environment gives the same bits."""
    write(folder, "s.yaml", text)
    for name, where in (("here", {}), ("there", options)):
        ricochet.run("s.yaml", *words, "-o", f"{name}.h5", cwd=folder, **where).expect_done()
    assert_same_data(folder / "here.h5", folder / "there.h5")


@pytest.mark.parametrize("text", [RING, CVODES], ids=["ring", "cvodes"])
def test_another_libm_gives_the_same_bits(ricochet, folder, text):
    same(ricochet, folder, text, env=WITHOUT_FMA)


@pytest.mark.parametrize("name", SHIPPED)
def test_another_libm_gives_the_same_bits_of_shipped_studies(ricochet, folder, name):
    path = ricochet.studies / f"{name}.yaml"
    same(ricochet, folder, path.read_text(), coarser(path), env=WITHOUT_FMA)


@pytest.mark.long
def test_another_libm_gives_the_same_bits_of_all_shipped_studies(ricochet, folder):
    for path in sorted(ricochet.studies.glob("*.yaml")):
        same(ricochet, folder, path.read_text(), (*coarser(path), "--force"), env=WITHOUT_FMA)


@pytest.mark.skipif(not EMULATOR, reason="qemu-user is not installed")
@pytest.mark.parametrize("model", ["Nehalem", "Haswell"])
@pytest.mark.parametrize("text", [CVODES, "multipliers", "impact_oscillator", "diagram_map"],
                         ids=["cvodes", "multipliers", "branch", "map"])  # fmt: skip
def test_another_processor_gives_the_same_bits(ricochet, folder, text, model):
    path = ricochet.studies / f"{text}.yaml"
    words = coarser(path) if "\n" not in text else ()
    write(folder, "s.yaml", text if "\n" in text else path.read_text())
    ricochet.run("s.yaml", *words, "-o", "here.h5", cwd=folder).expect_done()
    line = [EMULATOR, "-cpu", model, ricochet.binary, "run", "s.yaml", *words, "-o", "there.h5", "--mpi", "off"]
    subprocess.run(line, cwd=folder, env=environment(), capture_output=True, check=True)
    assert_same_data(folder / "here.h5", folder / "there.h5")
