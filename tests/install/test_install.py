"""What a user does with an installation: starts the program, imports the Python package, builds against the library in
C and C++, by CMake and by pkg-config. Nothing is set that a user would not set, and the installation is moved before it
is used: nothing in it may name the place it was put to first."""

import os
import shutil
import subprocess
from pathlib import Path

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


def import_from(folder, cwd):
    """Where python3 of the system finds the package if PYTHONPATH names this folder."""
    code = "import ricochet; print(ricochet.__version__, ricochet.__file__)"
    return output_of("/usr/bin/python3", "-B", "-c", code, cwd=cwd, env={"PYTHONPATH": str(folder)}).split()


def test_the_python_package_is_installed_without_its_byte_code(prefix, folder, source):
    installed = next(prefix.rglob("ricochet/__init__.py")).parent
    version, file = import_from(installed.parent, folder)
    assert file == str(installed / "__init__.py")
    package = source / "scripts" / "ricochet"
    shipped = {p.relative_to(package) for ending in ("*.py", "*.typed") for p in package.rglob(ending)}
    assert {p.relative_to(installed) for p in installed.rglob("*") if p.is_file()} == shipped
    assert output_of(prefix / "bin" / "ricochet", "--version").split()[1].startswith(version)


def test_the_command_for_figures_finds_its_package(prefix, folder):
    output_of(prefix / "bin" / "ricochet", "run", prefix / "share" / "ricochet" / "studies" / "table.yaml", cwd=folder)
    assert output_of(prefix / "bin" / "ricochet-plot", "table.h5", "modes", cwd=folder) == "table_modes.png\n"
    assert (folder / "table_modes.png").stat().st_size > 10000


def test_python_of_the_system_finds_the_package_under_usr_local(prefix):
    """Only the folder is compared: nothing is installed there."""
    installed = next(prefix.rglob("ricochet/__init__.py")).parent.parent.relative_to(prefix)
    path = output_of("/usr/bin/python3", "-c", "import sys; print(*sys.path, sep='\\n')").splitlines()
    assert str(Path("/usr/local") / installed) in path


def test_pip_installs_the_package_from_the_checkout(source, folder):
    """From a copy, as pip leaves its build folder there."""
    shutil.copytree(source / "scripts" / "ricochet", folder / "scripts" / "ricochet")
    shutil.copy(source / "scripts" / "pyproject.toml", folder / "scripts")
    pip = ("/usr/bin/python3", "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--target")
    output_of(*pip, folder / "target", folder / "scripts", cwd=folder, env={"PIP_ROOT_USER_ACTION": "ignore"})
    version, file = import_from(folder / "target", folder)
    assert file == str(folder / "target" / "ricochet" / "__init__.py")
    assert (folder / "target" / f"ricochet-{version}.dist-info").is_dir()
    assert (folder / "target" / "ricochet" / "py.typed").exists()
    command = folder / "target" / "bin" / "ricochet-plot"
    env = {"PYTHONPATH": str(folder / "target")}
    assert "modes" in output_of("/usr/bin/python3", "-B", command, "--list", cwd=folder, env=env)
