"""What a user does with an installation: starts the program, builds against the library in C and C++, by CMake and by
pkg-config. Nothing is set that a user would not set, and the installation is moved before it is used: nothing in it may
name the place it was put to first."""

import os
import subprocess

import h5py
import pytest

C, CPP = "admissible, speed after the impact 0.823195058650\n", "10 impacts, height 0.500000\n"


def output_of(*words, **options):
    e = {k: v for k, v in os.environ.items() if not k.startswith(("OMPI_", "PMIX_", "PMI_", "LD_"))}
    e.update(options.pop("env", {}))
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, env=e, **options)
    assert done.returncode == 0, (words, done.stdout[-3000:], done.stderr[-3000:])
    return done.stdout


@pytest.fixture(scope="module")
def prefix(build, ricochet):
    folder = ricochet.new_folder()
    output_of("cmake", "--install", build, "--prefix", folder / "first")
    return (folder / "first").rename(folder / "moved")


@pytest.fixture(scope="module")
def libdir(prefix):
    return next(prefix.rglob("libricochet.*")).parent


@pytest.fixture
def consumer(source):
    return source / "tests" / "install" / "consumer"


def test_the_program_starts_and_computes(prefix, folder):
    program = prefix / "bin" / "ricochet"
    assert output_of(program, "--version").startswith("ricochet ")
    study = prefix / "share" / "ricochet" / "studies" / "table.yaml"
    assert "15 tasks" in output_of(program, "run", study, cwd=folder)
    with h5py.File(folder / "table.h5") as file:
        assert file["orbits/outcome"].shape == (15,)


def test_licence_and_studies_are_there(prefix, source):
    assert [p.read_text() for p in prefix.rglob("LICENSE")] == [(source / "LICENSE").read_text()]
    installed = prefix / "share" / "ricochet" / "studies"
    shipped = source / "data" / "studies"
    assert {p.name for p in installed.iterdir()} == {p.name for p in shipped.iterdir()}
    assert all((installed / p.name).read_bytes() == p.read_bytes() for p in shipped.iterdir())


def test_c_and_cpp_programs_build_by_the_cmake_package(prefix, consumer, folder):
    output_of("cmake", "-G", "Ninja", "-S", consumer, "-B", folder, f"-DCMAKE_PREFIX_PATH={prefix}")
    output_of("cmake", "--build", folder)
    assert output_of(folder / "consumer") == C
    assert output_of(folder / "consumer_cpp") == CPP


def test_c_and_cpp_programs_build_by_pkg_config(libdir, consumer, folder):
    """As README says: a library outside the system's folders is named to the program by -rpath."""
    rpath = '-Wl,-rpath,"$(pkg-config --variable=libdir ricochet)"'
    flags = f"$(pkg-config --cflags --libs ricochet) {rpath}"
    env = {"PKG_CONFIG_PATH": str(libdir / "pkgconfig")}
    for compiler, name, expected in (("cc -std=c17", "consumer.c", C), ("c++ -std=c++11", "consumer.cpp", CPP)):
        output_of("sh", "-c", f"{compiler} -Wall -Wextra -Wpedantic -Werror {consumer / name} {flags}", cwd=folder, env=env)
        assert output_of(folder / "a.out") == expected
