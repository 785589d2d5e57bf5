"""What the shared library exports, and which libraries it needs."""

import re
import subprocess

import pytest

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
