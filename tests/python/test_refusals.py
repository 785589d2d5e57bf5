"""What the package refuses: files that are no results, damaged ones, later schemas, names that are not there."""

import subprocess
import sys

import h5py
import numpy as np
import pytest
import ricochet as package
import small_results


@pytest.fixture
def path(folder):
    return small_results.grid(folder / "grid.h5")


def refused(path, reason):
    with pytest.raises(package.ResultError) as caught:
        package.open(path)
    assert caught.value.path == str(path)
    assert caught.value.reason.startswith(reason), caught.value.reason
    assert str(caught.value) == f"{path}: {caught.value.reason}"


def test_files_that_are_no_results(folder):
    refused(folder / "none.h5", "there is no such file")
    refused(folder, "there is no such file")
    (folder / "text.h5").write_text("kind: orbits\n")
    refused(folder / "text.h5", "it is not an HDF5 file")
    with h5py.File(folder / "other.h5", "w") as file:
        file["x"] = 1
    refused(folder / "other.h5", "it is not a result of ricochet")


def test_a_later_schema(folder):
    with h5py.File(folder / "later.h5", "w") as file:
        small_results.write_root(file, version=7)
    refused(folder / "later.h5", "schema_version = 7, this package reads 1 to 1")


def test_a_result_of_an_earlier_build(path):
    with h5py.File(path, "r+") as file:
        del file["study"]
    refused(path, "it has no group /study: an earlier build of ricochet wrote it; run its study again")


def test_a_truncated_file(path):
    with open(path, "r+b") as file:
        file.truncate(path.stat().st_size // 2)
    refused(path, "it is damaged, or cannot be read")


def test_a_number_that_changed_on_disk(path):
    with h5py.File(path) as file:
        at = file["orbits/energy"].id.get_chunk_info(0).byte_offset
    data = bytearray(path.read_bytes())
    data[at + 8] ^= 1
    path.write_bytes(data)
    with package.open(path) as result:
        with pytest.raises(package.ResultError, match="orbits/energy cannot be read, the file is damaged"):
            result["orbits"]["energy"]
        assert len(result["orbits"]["q"]) == 12


def change(path, name, values):
    with h5py.File(path, "r+") as file:
        file[name][...] = values


def test_offsets_that_do_not_bound_their_rows(path):
    for edges in ([1] + [3] * 12, [0] + [4] * 12, [0, 3, 2] + [3] * 10):
        change(path, "orbits/impact_offset", edges)
        with package.open(path) as result:
            with pytest.raises(package.ResultError, match="impact_offset does not bound the rows"):
                result["orbits/impact"]


def test_a_code_without_a_word(path):
    change(path, "orbits/outcome", np.full(12, 3, dtype="i1"))
    with package.open(path) as result, pytest.raises(package.ResultError, match="a code that has no word"):
        result["orbits"]["outcome"]


def test_tasks_that_do_not_fill_the_grid(path):
    with h5py.File(path, "r+") as file:
        file["sweep"].attrs["grid"] = np.array([3, 5])
    refused(path, "its 12 tasks do not fill the grid")


def test_a_study_that_says_too_little(path):
    with h5py.File(path, "r+") as file:
        del file["study"].attrs["swept"]
    refused(path, "/study has no swept")


def test_columns_of_different_length(path):
    with h5py.File(path, "r+") as file:
        del file["orbits/energy"]
        small_results.write(file, "orbits/energy", np.zeros(5), "task")
    with package.open(path) as result, pytest.raises(package.ResultError, match="damaged"):
        result["orbits"]["energy"]


def test_names_that_are_not_there(path):
    with package.open(path) as result:
        with pytest.raises(package.MissingError, match="no table orbit; it has orbits, orbits/impact, special$"):
            result["orbit"]
        with pytest.raises(KeyError, match="orbits has no column energie; it has energy, .*orbit.period, model.gamma"):
            result["orbits"]["energie"]


def test_a_closed_result(path):
    with package.open(path) as result:
        orbits = result["orbits"]
        energy = orbits["energy"]
    assert energy[0] == 0.5
    with pytest.raises(package.ResultError, match="it is closed"):
        orbits["q"]


def test_nothing_but_numpy_and_h5py_is_imported(source):
    code = "import sys, ricochet; print(*sorted({'matplotlib', 'xarray', 'pandas'} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-B", "-c", code], cwd=source / "scripts", capture_output=True, text=True)
    assert done.stdout == "\n" and done.returncode == 0, done


def test_the_version_is_that_of_the_project(source):
    assert f"project(ricochet VERSION {package.__version__} " in (source / "CMakeLists.txt").read_text()
