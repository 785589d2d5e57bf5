"""What the shared library exports, and which libraries it needs."""

import re
import subprocess

import pytest

# Functions of libm that every libm rounds the same way: their results are exact, or the nearest number. For all others
# there is ricochet/elementary.h.
EXACT = {"ceil", "copysign", "fabs", "floor", "fma", "fmax", "fmin", "fmod", "frexp", "ldexp", "llrint", "llround", "lround",
         "modf", "nearbyint", "nextafter", "remainder", "rint", "round", "scalbln", "scalbn", "sqrt", "trunc"}  # fmt: skip
UNWANTED = ("libgfortran", "libstdc++", "libmpi", "libhdf5", "libyaml", "libpython")


def output_of(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


@pytest.fixture
def library(build):
    return build / "bin" / "libricochet.so"


def test_every_exported_name_begins_with_ric(library):
    lines = output_of("nm", "-D", "--defined-only", library).splitlines()
    names = [line.split()[-1].split("@")[0] for line in lines]
    # What a sanitizer adds is not the library's.
    strangers = [n for n in names if not n.startswith(("ric_", "__asan", "__ubsan", "_init", "_fini"))]
    assert names and not strangers, strangers


def test_only_libraries_that_a_c_library_has_a_use_for_are_needed(library, sanitized):
    if sanitized:
        pytest.skip("the sanitizers bring libraries of their own")
    needed = re.findall(r"^\s*(lib\S+) =>", output_of("ldd", library), re.M)
    # SUNDIALS 7 of Debian 13 is built with MPI and hands that on.
    brought = ("libmpi",) if any(name.startswith("libsundials_core") for name in needed) else ()
    strangers = [name for name in needed if name.startswith(UNWANTED) and not name.startswith(brought)]
    assert any(name.startswith("libfftw3") for name in needed) and not strangers, needed


def names_of(path, kind):
    return {line.split()[-1].split("@")[0] for line in output_of("nm", "-D", f"--{kind}-only", path).splitlines()}


@pytest.mark.parametrize("name", ["libricochet.so", "ricochet"])
def test_what_libm_rounds_by_the_processor_is_not_called(build, name):
    libm = re.search(r"libm\.so\.6 => (\S+)", output_of("ldd", build / "bin" / "libricochet.so")).group(1)
    taken = names_of(build / "bin" / name, "undefined") & names_of(libm, "defined")
    assert "sqrt" in names_of(libm, "defined") and taken <= EXACT, taken - EXACT
