"""Made-up results that 1, 2, 3 and 4 ranks write (result_ranks.c) are equal outside /run and open in h5py and xarray,
neither with an option or a helper; failures are alike on every rank, and leave no file."""

import math
import subprocess

import h5py
import numpy
import pytest
import xarray
from program import environment, names

VARY = {"/": {"file_time", "command"}}
DIMENSIONS = {
    "/": {"task": 20, "particle": 6, "impact": 0, "sample": 5, "multiplier": 12, "special_point": 50, "none": 0},
    "orbits": {"task": 20, "particle": 6, "impact": 0, "sample": 5, "multiplier": 12},
    "special": {"special_point": 50},
    "nothing": {"none": 0},
    "sweep": {"task": 20},
    "run": {},
}


def contents(path):
    """Everything in a file outside /run: attributes and data by name, as bytes with their types and shapes."""
    found = {}

    def take(name, thing):
        if name == "run":
            return
        for key, value in thing.attrs.items():
            if key in VARY.get(name, ()) or key in ("DIMENSION_LIST", "REFERENCE_LIST"):
                continue
            array = numpy.asarray(value)
            found[name, key] = (str(array.dtype), array.shape, array.tobytes())
        if isinstance(thing, h5py.Dataset):
            found[name, None] = (thing.dtype.str, thing.shape, thing.chunks, thing[...].tobytes())

    with h5py.File(path) as file:
        take("/", file)
        file.visititems(take)
    return found


def check_data_sets(file):
    def check(name, thing):
        if not isinstance(thing, h5py.Dataset):
            return
        assert thing.fletcher32, f"{name} has no checksum"
        assert thing.chunks, f"{name} is not chunked"
        for key in ("units", "long_name", "source", "axes"):
            assert key in thing.attrs, f"{name} lacks {key}"
        if h5py.h5ds.is_scale(thing.id):
            assert thing.parent.name == "/" and (thing[...] == numpy.arange(thing.size)).all(), name
            return
        axes = thing.attrs["axes"].decode().split()
        assert len(axes) == thing.ndim, name
        for axis, dimension in zip(axes, thing.dims):
            assert [scale.name for scale in dimension.values()] == ["/" + axis], (name, axis)

    file.visititems(check)


def check_study(values):
    expected = {
        "title": numpy.bytes_("made up, à la carte".encode()),
        "model.ends": numpy.bytes_(b"periodic"),
        "orbit.states": numpy.bool_(True),
        "orbit.mode": numpy.float64("nan"),
        "orbit.excited": numpy.array([3, 1, 2]),
        "orbit.sequence": numpy.array([], dtype=int),
        "branch.kinds": numpy.array([b"zero", b"grazing"]),
        "model.force": numpy.arange(3.0),
        "model.gamma": numpy.float64(0),
        "model.floor": numpy.array([-1, math.nan, 0.5, -1, -1]),
        "model.floor:units": numpy.bytes_(b"length"),
        "swept": numpy.array([b"model.gamma", b"model.floor[3]"]),
        "given": numpy.array(
            [b"title", b"orbit.states", b"orbit.excited", b"model.force", b"model.gamma", b"model.floor"]
        ),
    }
    assert set(values) == set(expected)
    for name, value in expected.items():
        stored = numpy.asarray(values[name])
        assert (stored.dtype, stored.shape) == (value.dtype, value.shape), name
        numpy.testing.assert_array_equal(stored, value, name)


def check_values(file):
    assert file.attrs["creator"] == b"ricochet" and file.attrs["schema_version"] == 1
    assert file.attrs["title"].decode() == "made up, à la carte"
    assert file.attrs["study_digest"] == b"0123456789abcdf1"
    assert file.attrs["study"].decode().startswith("kind: orbits")
    assert list(file["sweep"].attrs["grid"]) == [5, 4]
    assert file["sweep"].attrs["parameters"] == b"model.gamma model.floor[3]"
    numpy.testing.assert_array_equal(file["sweep/model.gamma"], 0.1 * numpy.repeat(numpy.arange(5.0), 4))
    numpy.testing.assert_array_equal(file["sweep/model.floor[3]"], numpy.tile([-1.0, -2, -3, -4], 5))
    check_study(file["study"].attrs)
    assert file["special/gamma"].attrs["parameter"] == b"model.gamma"
    assert file["orbits/energy"].attrs["observed"] == b"q0"
    assert file["sweep/model.floor[3]"].attrs["parameter"] == b"model.floor[3]"
    words = h5py.check_enum_dtype(file["orbits/outcome"].dtype)
    assert words == {"admissible": 0, "inadmissible": 1, "grazing": 2, "failed": 3}, words
    numpy.testing.assert_array_equal(file["orbits/outcome"], numpy.arange(20) ** 2 % 4)
    q = numpy.sin(numpy.arange(20.0)[:, None] + 0.001 * numpy.arange(6))
    q[3::7, 0], q[4::7, 0] = math.nan, -math.inf
    numpy.testing.assert_allclose(file["orbits/q"], q, rtol=1e-14)
    path = numpy.sin(numpy.arange(20.0)[:, None] + 0.001 * numpy.arange(30)).reshape(20, 5, 6)
    path[3::7, 0, 0], path[4::7, 0, 0] = math.nan, -math.inf
    numpy.testing.assert_allclose(file["orbits/path"], path, rtol=1e-14)
    parts = numpy.sin(numpy.arange(20.0)[:, None] + 0.001 * numpy.arange(24)).reshape(20, 12, 2)
    parts[3::7, 0, 0], parts[4::7, 0, 0] = math.nan, -math.inf
    assert file["orbits/multipliers"].dtype == numpy.complex128
    numpy.testing.assert_allclose(file["orbits/multipliers"][()].view(float).reshape(20, 12, 2), parts, rtol=1e-14)
    assert file["orbits/outcome"].attrs["tolerance"] == 1e-6 and file["orbits/outcome"].attrs["band"] == 0.25
    assert "band" not in file["orbits/energy"].attrs and file["nothing/other"].dtype == numpy.complex128
    assert file["orbits/reason"][2].decode() == "café" and len(file["orbits/reason"][3]) == 32
    assert file["orbits/clearance_particle"][7] == 7 * 1000003 - 5
    assert file["orbits/impulse"].shape == (20, 0)


def check_xarray(path):
    for group, dimensions in DIMENSIONS.items():
        with xarray.open_dataset(path, engine="h5netcdf", group=group) as opened:
            assert dict(opened.sizes) == dimensions, (group, dict(opened.sizes))
            opened.load()
    with xarray.open_dataset(path, engine="h5netcdf", group="orbits") as orbits:
        assert orbits.path.dims == ("task", "sample", "particle")
        assert orbits.multipliers.dims == ("task", "multiplier") and orbits.multipliers.dtype == numpy.complex128
        assert orbits.q.dims == ("task", "particle") and orbits.energy.dims == ("task",)
        assert orbits.outcome.attrs["flag_meanings"].split()[1] == "inadmissible"
    with xarray.open_dataset(path, engine="h5netcdf", group="run") as run:
        assert run.attrs["ranks"] >= 1 and run.attrs["tasks_computed"] == 20 and "host" in run.attrs


def write(build, path, *sizes, ranks, program="result_ranks"):
    """The finished mpirun of a program that writes a made-up result."""
    command = ["mpirun", "--oversubscribe", "-n", str(ranks), build / "bin" / program, path, *sizes]
    return subprocess.run(list(map(str, command)), cwd=path.parent, env=environment(), capture_output=True, text=True,
                          timeout=120)


@pytest.fixture(scope="module")
def written(build, ricochet):
    """The same tables written by 1 to 4 ranks."""
    folder = ricochet.new_folder()
    paths = [folder / f"by_{ranks}.h5" for ranks in (1, 2, 3, 4)]
    for ranks, path in enumerate(paths, start=1):
        done = write(build, path, ranks=ranks)
        assert done.returncode == 0, done
    return paths


def test_any_number_of_ranks_writes_the_same(written):
    first = contents(written[0])
    assert len(first) > 100
    for path in written[1:]:
        other = contents(path)
        assert first.keys() == other.keys(), first.keys() ^ other.keys()
        for key, value in first.items():
            assert value == other[key], f"{path} differs from {written[0]} in {key}"


def test_values_axes_and_checksums_are_there(written):
    for ranks, path in enumerate(written, start=1):
        with h5py.File(path) as file:
            check_data_sets(file)
            check_values(file)
            assert file["run"].attrs["ranks"] == ranks


def test_xarray_opens_every_group_with_its_dimensions(written):
    for path in written:
        check_xarray(path)


@pytest.mark.parametrize(
    "sizes, ranks",
    [((1, 3, 200000, 1, 0, 300), 2), ((2, 2, 3, 1, 0, 200000), 2), ((0, 0, 0, 0, 0, 0), 3)],
    ids=["more columns than a chunk holds", "a study of more than 64 kB", "no sweep at all"],
)
def test_results_of_odd_sizes_are_written(build, folder, sizes, ranks):
    done = write(build, folder / "a.h5", *sizes, ranks=ranks)
    assert done.returncode == 0 and names(folder) == ["a.h5"], done


@pytest.mark.parametrize("ranks", [1, 2, 3, 4])
def test_writing_fails_alike_on_every_rank(build, folder, ranks):
    """Every way in which it can fail: see result_failures.c."""
    done = write(build, folder / "unused", ranks=ranks, program="result_failures")
    assert done.returncode == 0, done


@pytest.mark.parametrize(
    "ranks, kilobytes, fits",
    [(1, 4, False), (2, 100, None), (1, 300, None), (3, 400, None), (1, 430, None), (2, 4000, True)],
)
def test_a_full_disk_is_an_error_with_path_and_reason(build, folder, ranks, kilobytes, fits):
    """A file system of this size; where `fits` is None, both ends are right."""
    mount = ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", str(folder)]
    if subprocess.run(mount, capture_output=True).returncode != 0:
        pytest.skip("mounting is not permitted")
    try:
        done, left = write(build, folder / "a.h5", 30, 20, 30, 2, ranks=ranks), names(folder)
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)
    text = done.stdout + done.stderr
    if done.returncode == 0:
        assert fits is not False and left == ["a.h5"], left
        return
    assert fits is not True and done.returncode == 3 and left == [], (done.returncode, left, text)
    assert f"{folder}/a.h5: cannot write" in text and "No space left on device" in text, text
