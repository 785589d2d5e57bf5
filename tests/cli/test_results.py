"""What a result holds and how it opens: the schema that scripts rely on, and values of the impact chain."""

import csv
import io
import os
import re

import h5py
import numpy as np
import program
import pytest
import xarray
import yaml
from program import assert_same, coarser, names, study, sweep, words_of, write

TABLE = "{parameter: model.gamma, values: [0.05, 0.149153131912, 0.187, 0.19444444444444445]}"


def run(ricochet, folder, text, *words, name="s", **options):
    write(folder, f"{name}.yaml", text)
    ricochet.run(f"{name}.yaml", *words, cwd=folder, **options).expect_done()
    return folder / f"{name}.h5"


# Left out under sanitizers, where each takes a minute and more; other studies of the same kind and model stay.
SLOW = {"grazing_verdicts", "lyapunov", "stability_map", "vibro_impact_20", "vibro_impact_subharmonics"}


@pytest.fixture(scope="module")
def shipped_runs(ricochet, sanitized):
    """A folder with the results of all shipped studies, computed once on two ranks, and
    {study: (tasks that check tells, the finished run)}."""
    folder, runs = ricochet.new_folder(), {}
    for path in sorted(ricochet.studies.glob("*.yaml")):
        if sanitized and path.stem in SLOW:
            continue
        checked = ricochet("check", path, *coarser(path), cwd=folder).expect_done().out
        run = ricochet.run(path, *coarser(path), cwd=folder, ranks=2).expect_done()
        runs[path] = int(program.only(checked, r"tasks +(\d+)")), run
    assert names(folder) == sorted(f"{path.stem}.h5" for path in runs)
    return folder, runs


@pytest.mark.sanitized
def test_a_study_of_every_kind_goes_through_the_program(ricochet, folder, sanitized):
    """With all others these are run below; under sanitizers these few stand for them."""
    if not sanitized:
        pytest.skip("all shipped studies are run")
    for name in ("multipliers", "bouncing_chain", "duffing", "grazing_regimes", "diagram_map", "basin", "ritz"):
        path = ricochet.studies / f"{name}.yaml"
        ricochet.run(path, *coarser(path), cwd=folder).expect_done()
        ricochet("show", f"{name}.h5", "--verify", cwd=folder).expect_done()


@pytest.fixture(scope="module")
def shipped(shipped_runs):
    """The results of all shipped studies."""
    folder, runs = shipped_runs
    return [folder / f"{path.stem}.h5" for path in runs]


def test_the_last_line_of_every_shipped_study_counts_its_tasks(shipped_runs):
    for tasks, run in shipped_runs[1].values():
        assert run.out.startswith(f"{tasks} task{'s' if tasks > 1 else ''}: ") and run.err == "", run
        counts = [int(n) for n in program.re.findall(r"(\d+) [a-z_]+(?:,| ->)", run.out)]
        assert sum(counts) == tasks, run


def group_of(file):
    """The group of the study's kind."""
    return next(name for name in ("orbits", "trajectory", "branch", "grazing", "diagram", "basin") if name in file)


def data_sets(file):
    found = []
    file.visititems(lambda name, thing: found.append(thing) if isinstance(thing, h5py.Dataset) else None)
    return found


# --- how results open ---


def test_xarray_opens_every_group_with_no_option(ricochet, folder, shipped):
    for path in shipped:
        with h5py.File(path) as file:
            groups = [name for name in file if isinstance(file[name], h5py.Group)]
            assert {group_of(file), "sweep", "run"} <= set(groups), groups
            for group in groups:
                with xarray.open_dataset(path, engine="h5netcdf", group=group) as opened:
                    assert not [d for d in opened.sizes if "phantom" in d], (path, group, opened.sizes)
                    assert set(opened.variables) == set(file[group]), (path, group)
                    for name, variable in opened.variables.items():
                        assert variable.shape == file[group][name].shape


def test_axes_are_named_as_in_the_contract(ricochet, folder):
    path = run(ricochet, folder, study(at_start="[3, 9]", orbit="at_half: [5], special_points: true", sweep=sweep(7)))
    with xarray.open_dataset(path, engine="h5netcdf", group="orbits") as orbits:
        assert dict(orbits.sizes) == {"task": 7, "particle": 30, "impact": 3}
        assert orbits.q.dims == orbits.v.dims == ("task", "particle")
        assert orbits.impulse.dims == ("task", "impact")
        for name in ("outcome", "reason", "energy", "residual", "clearance", "clearance_time", "clearance_particle"):
            assert orbits[name].dims == ("task",), name
    with xarray.open_dataset(path, engine="h5netcdf", group="sweep") as swept:
        assert swept["model.gamma"].dims == ("task",)


def test_every_axis_hangs_on_a_scale_of_the_root_group(ricochet, folder, shipped):
    for path in shipped:
        with h5py.File(path) as file:
            for data in data_sets(file):
                if data.parent.name == "/":
                    assert h5py.h5ds.is_scale(data.id), data.name
                    assert (data[()] == np.arange(data.size)).all(), data.name
                    continue
                for axis in data.dims:
                    assert len(axis) == 1 and axis[0].parent.name == "/", data.name
                    assert axis[0].size == data.shape[list(data.dims).index(axis)], data.name


def test_every_data_set_has_checksums_and_says_what_it_is(ricochet, folder, shipped):
    for path in shipped:
        with h5py.File(path) as file:
            for data in data_sets(file):
                assert data.fletcher32 and data.chunks, data.name
                assert h5py.check_string_dtype(data.dtype) is None or h5py.check_string_dtype(data.dtype).length
                for attribute in ("units", "long_name", "source"):
                    assert attribute in data.attrs, (data.name, attribute)


def documented(page):
    """{name of a data set: [(its axes, its type)]} of the tables on the schema page. What ends a window has two rows, with
    the words of maps and of motions."""
    found = {}
    for line in page.splitlines():
        row = re.match(r"\| `/([\w/]+)` \| \[(.*?)\] \| (.*?) \| (.*\S) \|$", line)
        assert row or not line.startswith("| `/") or " | [" not in line, line
        if row:
            found.setdefault(row[1], []).append((row[2].split(", "), row[3]))
    return found


def type_of(data):
    """The type of a data set in the words of the schema page."""
    words = {"f": "float64", "i": "int64", "c": "complex", "S": "text", "b": "enum: `FALSE`, `TRUE`"}
    values = h5py.check_enum_dtype(data.dtype)
    if not values:
        return words[data.dtype.kind]
    assert sorted(values.values()) == list(range(len(values))), data.name
    return "enum: " + ", ".join(f"`{word}`" for word in sorted(values, key=values.get))


def test_every_data_set_stands_on_the_schema_page_with_its_axes_and_type(shipped, source):
    page = documented((source / "docs" / "results.md").read_text())
    seen = set()
    for path in shipped:
        with h5py.File(path) as file:
            for data in data_sets(file):
                group = data.name[1:].rpartition("/")[0]
                if group in ("", "sweep"):
                    continue
                axes = data.attrs["axes"].decode().split()
                assert (axes, type_of(data)) in page[data.name[1:]], (data.name, axes, type_of(data))
                seen.add(data.name[1:])
    assert len(seen) > 200


def test_enums_are_read_by_name(ricochet, folder):
    path = run(ricochet, folder, study(at_start="[15]", orbit="special_points: true", sweep=sweep(251, 0, 0.25)))
    with h5py.File(path) as file:
        outcomes = words_of(file["orbits/outcome"])
        assert {"admissible", "inadmissible"} <= set(outcomes), set(outcomes)
        known = set(h5py.check_enum_dtype(file["orbits/outcome"].dtype))
        assert {"admissible", "inadmissible", "grazing", "resonant", "singular", "not_converged", "failed"} <= known
        assert "resonance" in words_of(file["special/kind"])


def test_reasons_are_texts_of_fixed_length_where_there_is_something_to_say(ricochet, folder, shipped):
    for path in shipped:
        with h5py.File(path) as file:
            group = file[group_of(file)]
            assert group["reason"].dtype.kind == "S"
            for outcome, reason in zip(words_of(group["outcome"]), group["reason"][()]):
                quiet = outcome in ("admissible", "completed", "bound", "points", "closed", "periodic", "aperiodic")
                quiet = quiet or (group_of(file) == "grazing" and outcome == "grazing")
                assert (reason == b"") == quiet, (path.name, outcome, reason)
                reason.decode("ascii")


def test_the_root_says_where_the_result_comes_from(ricochet, folder):
    text = study(sweep=sweep(3)).replace("kind: orbits\n", "kind: orbits\ntitle: a title\n# a comment\n")
    path = run(ricochet, folder, text)
    with h5py.File(path) as file:
        for name in ("creator_version", "schema_version", "git_sha", "libraries", "compiler", "file_time"):
            assert name in file.attrs, name
        assert file.attrs["creator"] == b"ricochet"
        assert file.attrs["study"].decode() == text
        assert file.attrs["title"] == b"a title"
        for name in ("ranks", "host", "compute_seconds", "total_seconds", "tasks_computed", "tasks_resumed"):
            assert name in file["run"].attrs, name


def test_the_command_is_recorded_as_typed(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(3)))
    ricochet("run", "s.yaml", "--set", "model.gamma=0.2", "--progress", "never", cwd=folder).expect_done()
    with h5py.File(folder / "s.h5") as file:
        assert file.attrs["command"].decode() == "ricochet run s.yaml --set model.gamma=0.2 --progress never"


# --- /study ---

FILLED = {"branch.from", "iterate.observe"}  # what the kind chooses where the study leaves them out


def number(word):
    """A number of a study; NaN for null."""
    if word in ("null", ""):
        return np.nan
    if not word.endswith("pi"):
        return float(word)
    factor = word.removesuffix("pi").strip()
    return float(factor + "1" if factor in ("", "-") else factor) * np.pi


def leaves(section, name=""):
    """{path: value} of the keys below a section of a study, without its sweeps."""
    found = {}
    for key, value in section.items():
        path = f"{name}{key}"
        if isinstance(value, dict) and path != "sweep":
            found |= leaves(value, f"{path}.")
        elif path != "sweep":
            found[path] = value
    return found


def swept_first(sweeps):
    """[(parameter, its first value)] of the sweeps of a study."""
    entries = sweeps if isinstance(sweeps, list) else [sweeps] if sweeps else []
    return [(e["parameter"], e["values"][0] if "values" in e else e["from"]) for e in entries]


def defaults_of(reference, model):
    """{path: default as YAML text} from the reference of studies, where there is one."""
    found = {}
    for line in reference.splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) == 7 and re.fullmatch(r"`[\w.]+`", cells[1]) and cells[3].startswith("`"):
            own = re.search(rf"Default with `model.type: {model}`: `([^`]*)`", cells[5])
            found[cells[1].strip("`")] = own[1] if own else cells[3].strip("`")
    return found


def assert_holds(attributes, path, value):
    """An attribute of /study has the type of its key and the value that a study gives, words and lists of words."""
    stored = np.asarray(attributes[path])
    assert stored.shape == ((len(value),) if isinstance(value, list) else ()), (path, stored)
    if stored.dtype == bool:
        assert value == str(stored).lower(), (path, stored, value)
    elif stored.dtype.kind == "S":
        assert np.char.decode(stored, "utf-8").tolist() == value, (path, stored, value)
    else:
        assert stored.dtype in (np.float64, np.int64), (path, stored.dtype)
        expected = [number(v) for v in value] if isinstance(value, list) else number(value)
        np.testing.assert_allclose(stored.astype(float), expected, rtol=1e-15, err_msg=path)


def test_the_group_study_holds_every_value_of_the_study_and_every_default(ricochet, folder, shipped):
    reference = ricochet("check", "--reference", cwd=folder).expect_done().out
    for result in shipped:
        with h5py.File(result) as file:
            held = yaml.load(file.attrs["study"], yaml.BaseLoader)
            stored = dict(file["study"].attrs)
        given, swept = ([name.decode() for name in stored.pop(which)] for which in ("given", "swept"))
        stated, first = leaves(held), swept_first(held.get("sweep"))
        defaults = defaults_of(reference, held["model"]["type"])
        assert swept == [name for name, _ in first], result
        for name, value in first:
            path, _, item = name.rstrip("]").partition("[")
            stated[path] = [*stated[path][: int(item)], value, *stated[path][int(item) + 1 :]] if item else value
        followed = {held["branch"]["parameter"].partition("[")[0]} if "branch" in held else set()
        assert set(given) - followed == set(stated) - followed, result
        assert set(stated) <= set(stored), (result, set(stated) - set(stored))
        for path, value in stated.items():
            assert_holds(stored, path, value)
        for path in set(stored) - set(given) - FILLED - {"title"}:
            assert_holds(stored, path, yaml.load(defaults[path], yaml.BaseLoader))


def values_of(path):
    """The attributes of /study, down to the bits."""
    with h5py.File(path) as file:
        return program.contents(path)["study"], dict(file["study"].attrs)


def test_flow_style_block_style_and_set_give_the_same_values(ricochet, folder):
    flow = study(particles=3, gamma="0.25", orbit="tolerance: null, stable: true",
                 sweep=sweep(3, 1, 4, parameter="orbit.period"))
    block = """kind: orbits
model:
  type: chain
  gamma: 25e-2
  particles: 3.0
  ends: periodic
  floor: -1
orbit:
  period: 1.5 pi
  at_start:
    - 0
  tolerance:
  stable: true
sweep:
  - parameter: orbit.period
    from: 1
    to: 4
    points: 3
"""
    short = "{kind: orbits, model: {type: chain, ends: periodic}, orbit: {period: 1, stable: false}}"
    words = ["model.gamma=0.25", "model.particles=3", "model.floor=-1", "orbit.at_start=[0]", "orbit.tolerance=null",
             "orbit.stable=true", "sweep={parameter: orbit.period, from: 1, to: 4, points: 3}"]  # fmt: skip
    sets = [part for word in words for part in ("--set", word)]
    first, held = values_of(run(ricochet, folder, flow, name="flow"))
    assert values_of(run(ricochet, folder, block, name="block"))[0] == first
    assert values_of(run(ricochet, folder, short, *sets, name="short"))[0] == first
    assert held["model.particles"] == 3 and held["model.particles"].dtype == np.int64
    assert held["model.gamma"] == 0.25 and held["orbit.period"] == 1 and held["swept"].tolist() == [b"orbit.period"]
    assert held["orbit.stable"].dtype == bool and held["orbit.stable"] and not held["orbit.verify"]
    assert np.isnan(held["orbit.tolerance"]) and held["title"] == b"" and held["orbit.at_half"].shape == (0,)


def test_null_among_integers_and_in_lists_is_nan(ricochet, folder):
    text = program.trajectory(particles=3, floor="[-1, null, -2]", sweep="{parameter: 'model.floor[2]', values: [-3, -4]}")
    _, held = values_of(run(ricochet, folder, text))
    np.testing.assert_array_equal(held["model.floor"], [-1, np.nan, -3])
    assert held["swept"].tolist() == [b"model.floor[2]"] and b"model.floor" in held["given"]


def test_a_list_of_many_numbers_is_kept_whole(ricochet, folder):
    """Beyond 64 kB HDF5 has no checksum for it; --verify has."""
    forces = [i / 1024 for i in range(20000)]
    text = program.trajectory(particles=20000, model=f"force: {forces}", duration=0.01, time="samples: 2")
    path = run(ricochet, folder, text)
    ricochet("show", path, "--verify", cwd=folder).expect_done()
    with h5py.File(path) as file:
        np.testing.assert_array_equal(file["study"].attrs["model.force"], forces)
    data = path.read_bytes()
    at = data.index(np.array(forces[7000:7010]).tobytes())
    write(folder, "flipped.h5", data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :])
    ricochet("show", "flipped.h5", "--verify", cwd=folder).expect_refused(program.FILES, "flipped.h5: ", "/study")


def test_results_of_earlier_versions_without_the_group_are_still_sound(ricochet, folder):
    path = run(ricochet, folder, study(sweep=sweep(3)))
    with h5py.File(path, "r+") as file:
        del file["study"]
    ricochet("show", path, "--verify", cwd=folder).expect_refused(program.FILES, str(path), "/study")
    with h5py.File(path, "r+") as file:
        del file.attrs["study_values_checksum"]
    ricochet("show", path, "--verify", cwd=folder).expect_done()


def test_long_studies_fit_in_the_study_attribute(ricochet, folder):
    text = study(sweep=sweep(3)) + "# a long comment\n" * 20000
    path = run(ricochet, folder, text)
    with h5py.File(path) as file:
        assert file.attrs["study"].decode() == text
    ricochet("show", path, "--verify", cwd=folder).expect_done()


def test_only_what_was_asked_for_is_there(ricochet, folder):
    path = run(ricochet, folder, study(orbit="states: false", sweep=sweep(3)))
    with h5py.File(path) as file:
        assert "q" not in file["orbits"] and "v" not in file["orbits"] and "special" not in file
        assert "impulse" in file["orbits"]
    assert names(folder) == ["s.h5", "s.yaml"]


def test_a_study_without_a_sweep_has_one_task(ricochet, folder):
    path = run(ricochet, folder, study(at_start="[15]"))
    with h5py.File(path) as file:
        assert file["orbits/q"].shape == (1, 30)
    ricochet("show", path, cwd=folder).expect_done()
    ricochet("show", path, "--csv", cwd=folder).expect_done()


def test_the_last_sweep_of_a_grid_varies_fastest(ricochet, folder):
    periods, gammas = [4.5, 4.6], [0.0, 0.05, 0.1]
    text = study(sweep=f"\n- {{parameter: orbit.period, values: {periods}}}\n- {sweep(3, 0, 0.1)}")
    path = run(ricochet, folder, text)
    with h5py.File(path) as file:
        assert file["sweep"].attrs["grid"].tolist() == [2, 3]
        assert file["sweep/orbit.period"][()].tolist() == np.repeat(periods, 3).tolist()
        assert file["sweep/model.gamma"][()].tolist() == gammas * 2


def test_list_elements_and_logarithmic_ranges_are_swept(ricochet, folder):
    text = study(particles=3, at_start="[0]").replace("floor: -1", "floor: [-1, -1, -1]")
    text += "sweep: {parameter: 'model.floor[1]', values: [-1, -0.5, -3]}\n"
    with h5py.File(run(ricochet, folder, text)) as file:
        assert file["sweep/model.floor[1]"][()].tolist() == [-1, -0.5, -3]
        assert len(set(file["orbits/clearance"][()].tolist())) > 1
    text = study(sweep="{parameter: model.gamma, from: 1e-4, to: 1e-1, points: 4, scale: log}")
    with h5py.File(run(ricochet, folder, text, name="log")) as file:
        assert np.allclose(file["sweep/model.gamma"][()], [1e-4, 1e-3, 1e-2, 1e-1], rtol=1e-14, atol=0)


# --- CSV ---


def elements(name, values):
    """{name of the column: values [row]} of a data set: `q[3]` of elements, `.r` and `.i` of complex numbers."""
    if values.ndim > 1:
        columns = [elements(f"{name}[{k}]", values[:, k]) for k in range(values.shape[1])]
        # of three axes the second index stands behind the first: path[0][1]
        return {key: column for part in columns for key, column in part.items()}
    if values.dtype.kind == "c":
        return {f"{name}.r": values.real, f"{name}.i": values.imag}
    return {name: values}


def stored(data):
    """Values of a data set, of an enum its words."""
    words = {code: word for word, code in (h5py.check_enum_dtype(data.dtype) or {}).items()}
    words = words or ({False: "FALSE", True: "TRUE"} if data.dtype == bool else {})
    return np.vectorize(words.get, otypes=[object])(data[()]) if words else data[()]


def along(file, group, axis, place=0):
    """The data sets of a group that have this axis in this place."""
    sets = file[group].items()
    return {name: stored(data) for name, data in sets if data.ndim > place and data.dims[place][0].name == f"/{axis}"}


def expect_columns(out, columns):
    rows = list(csv.reader(io.StringIO(out)))
    assert rows[0] == list(columns)
    for name, texts, values in zip(columns, zip(*rows[1:]), columns.values()):
        if values.dtype.kind == "f":
            assert np.array_equal(np.array(texts, float), values, equal_nan=True), name
        else:
            assert list(texts) == [v.decode() if isinstance(v, bytes) else str(v) for v in values.tolist()], name


def test_csv_holds_exactly_the_values_of_the_file(ricochet, folder, shipped):
    for path in shipped:
        if path.stat().st_size > 2e6:  # seconds each; smaller ones have columns of all kinds
            continue
        with h5py.File(path) as file:
            columns = {name: file["sweep"][name][()] for name in file["sweep"]}
            for name, values in along(file, group_of(file), "task").items():
                columns |= elements(name, values)
        expect_columns(ricochet("show", path, "--csv", cwd=folder).expect_done().out, columns)


def test_csv_along_a_second_axis_has_a_row_for_each_of_its_indices(ricochet, folder):
    path = run(ricochet, folder, study(at_start="[15]", sweep=sweep(3, 0, 0.1)))
    with h5py.File(path) as file:
        columns = {"task": np.repeat(np.arange(3), 30), "particle": np.tile(np.arange(30), 3)}
        columns["model.gamma"] = np.repeat(file["sweep/model.gamma"][()], 30)
        columns |= {name: values.ravel() for name, values in along(file, "orbits", "particle", 1).items()}
    assert {"q", "v"} <= columns.keys()
    expect_columns(ricochet("show", path, "--csv=orbits/particle", cwd=folder).expect_done().out, columns)


def test_csv_of_another_group_holds_its_columns(ricochet, folder):
    path = run(ricochet, folder, study(at_start="[15]", orbit="special_points: true", sweep=sweep(51, 0, 0.25)))
    rows = list(csv.DictReader(io.StringIO(ricochet("show", path, "--csv=special", cwd=folder).expect_done().out)))
    with h5py.File(path) as file:
        assert [row["kind"] for row in rows] == words_of(file["special/kind"])
        assert [float(row["parameter"]) for row in rows] == file["special/parameter"][()].tolist()


# --- the same data, however it is computed ---


def test_a_task_does_not_depend_on_the_tasks_around_it(ricochet, folder):
    gammas = np.linspace(0, 1.2, 40)
    values = "{{parameter: model.gamma, values: {}}}"
    there = run(ricochet, folder, study(sweep=values.format(gammas.tolist())))
    back = run(ricochet, folder, study(sweep=values.format(gammas[::-1].tolist())), name="back")
    alone = run(ricochet, folder, study(sweep=values.format([gammas[17]])), name="alone")
    with h5py.File(there) as a, h5py.File(back) as b, h5py.File(alone) as c:
        for name in a["orbits"]:
            values = a["orbits"][name][()]
            assert values.tobytes() == b["orbits"][name][()][::-1].tobytes(), name
            assert values[17].tobytes() == c["orbits"][name][0].tobytes(), name


def test_the_order_of_the_sweeps_only_transposes_the_grid(ricochet, folder):
    first, second = sweep(12, 0, 0.6), sweep(9, 3.2, 6.2, "orbit.period")
    one = run(ricochet, folder, study(at_start="[15]", sweep=f"\n- {first}\n- {second}"))
    two = run(ricochet, folder, study(at_start="[15]", sweep=f"\n- {second}\n- {first}"), name="two")
    with h5py.File(one) as a, h5py.File(two) as b:
        for name in a["orbits"]:
            x, y = a["orbits"][name][()], b["orbits"][name][()]
            y = np.swapaxes(y.reshape(9, 12, *y.shape[1:]), 0, 1).reshape(x.shape)
            assert x.tobytes() == y.tobytes(), name


def test_the_same_command_gives_the_same_result(ricochet, folder):
    for name in ("a", "b"):
        (folder / name).mkdir()
        run(ricochet, folder / name, study(at_start="[15]", orbit="special_points: true", sweep=sweep(300, 0, 1.2)))
    assert_same(folder / "a" / "s.h5", folder / "b" / "s.h5")


def test_assignments_change_the_study_and_are_recorded_in_it(ricochet, folder):
    words = [w for s in ("model.gamma=0.05", "orbit.period=1.4 pi", "sweep.points=4", "title=x y") for w in ("--set", s)]
    path = run(ricochet, folder, study(at_start="[15]", sweep=sweep(9, 0, 0.1)), *words)
    with h5py.File(path) as file:
        assert file["orbits/energy"].shape == (4,)
        assert file.attrs["title"] == b"x y"
        recorded = file.attrs["study"].decode()
    again = run(ricochet, folder, recorded, name="again")
    program.assert_same_data(path, again)
    with h5py.File(path) as a, h5py.File(again) as b:
        assert a.attrs["study"] == b.attrs["study"] and a.attrs["study_digest"] == b.attrs["study_digest"]


def test_assignments_equal_the_same_study_written_out(ricochet, folder):
    by_set = run(ricochet, folder, study(at_start="[15]", gamma=0), "--set", f"sweep={TABLE}", "--set",
                 "model.ends=free")
    written = run(ricochet, folder, study(at_start="[15]", gamma=0, ends="free", sweep=TABLE), name="written")
    program.assert_same_data(by_set, written)


# --- values of the n = 30 ring with one impacting particle and T = 3 pi / 2 ---


def table(ricochet, folder, **changes):
    with h5py.File(run(ricochet, folder, study(at_start="[15]", sweep=TABLE, **changes))) as file:
        return {name: file["orbits"][name][()] for name in file["orbits"]} | {"words": words_of(file["orbits/outcome"])}


def test_speeds_after_impact_meet_the_table_of_the_source(ricochet, folder):
    v = table(ricochet, folder)["v"]
    assert abs(v[0, 15] - 0.823195058650) < 1e-11
    assert abs(v[2, 15] - 0.178528674603) < 1e-11


def test_the_energy_meets_its_value(ricochet, folder):
    assert abs(table(ricochet, folder)["energy"][1] - 1.067138152) < 1e-9


def test_the_linear_mode_at_seven_thirtysixths_is_grazing(ricochet, folder):
    orbits = table(ricochet, folder)
    assert orbits["words"] == ["admissible"] * 3 + ["grazing"]
    assert orbits["mode"].tolist() == [-1, -1, -1, 15]
    assert np.allclose(orbits["impulse"][3], 0, atol=1e-13)
    # every particle turns at its floor or at the opposite point
    assert np.allclose(np.abs(orbits["q"][3]), 1, atol=1e-12) and np.allclose(orbits["v"][3], 0, atol=1e-12)


def test_the_impacting_particle_is_at_its_floor_and_leaves_it(ricochet, folder):
    orbits = table(ricochet, folder)
    assert np.allclose(orbits["q"][:3, 15], -1, atol=1e-13)
    assert np.allclose(orbits["v"][:3, 15], orbits["impulse"][:3, 0] / 2, atol=1e-13)
    assert (orbits["q"][:3, :15] > -1).all()


def test_impulse_and_dense_agree(ricochet, folder):
    texts = [
        study(at_start="[15]", sweep=TABLE, orbit="method: METHOD"),
        study(at_start="[3, 4]", ends="fixed", orbit="at_half: [9], method: METHOD", sweep=sweep(9, 0, 0.3)),
        study(7, "free", at_start="[0, 2]", orbit="at_half: [5], method: METHOD", sweep=sweep(9, 0.1, 2)),
    ]
    for i, text in enumerate(texts):
        paths = [run(ricochet, folder, text.replace("METHOD", m), name=f"{m}{i}") for m in ("impulse", "dense")]
        with h5py.File(paths[0]) as a, h5py.File(paths[1]) as b:
            assert words_of(a["orbits/outcome"]) == words_of(b["orbits/outcome"]), i
            regular = [w in ("admissible", "inadmissible") for w in words_of(a["orbits/outcome"])]
            assert sum(regular) >= 3
            bound = 1e-12 * np.maximum(1, np.maximum(a["orbits/condition"][()], b["orbits/condition"][()]) / 100)
            size = np.maximum(1, np.abs(a["orbits/q"][()]).max(axis=1))
            for name in ("q", "v", "impulse"):
                off = np.abs(a["orbits"][name][()] - b["orbits"][name][()]).max(axis=1) / size
                assert (off <= bound)[regular].all(), (i, name, off, bound)


def test_turning_the_ring_turns_the_orbit(ricochet, folder):
    one = run(ricochet, folder, study(at_start="[15]", sweep=sweep(5)))
    other = run(ricochet, folder, study(at_start="[4]", sweep=sweep(5)), name="other")
    with h5py.File(one) as a, h5py.File(other) as b:
        for name in ("q", "v"):
            assert np.allclose(np.roll(a["orbits"][name][()], 4 - 15, axis=1), b["orbits"][name][()], atol=1e-12), name
        assert np.allclose(a["orbits/energy"][()], b["orbits/energy"][()], rtol=1e-13)


# --- memory ---


def test_an_old_result_is_not_read_before_it_is_replaced(ricochet, folder):
    """One of 1 GB, most of it a hole."""
    write(folder, "s.yaml", study(at_start="[15]", sweep=sweep(20)))
    with (folder / "s.h5").open("wb") as old:
        old.truncate(1 << 30)
    process = ricochet.start_run("s.yaml", "--force", cwd=folder)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0 and usage.ru_maxrss < 500_000, usage


# --- size ---


def test_texts_are_as_wide_as_the_longest_one(ricochet, folder):
    for name, gammas in (("some", [0.1, 0.25, 0.3]), ("none", [0.05, 0.1])):
        path = run(ricochet, folder, study(at_start="[15]", sweep=f"{{parameter: model.gamma, values: {gammas}}}"), name=name)
        with h5py.File(path) as file:
            reasons = file["orbits/reason"]
            assert reasons.dtype.itemsize == max(1, *(len(text) for text in reasons[()].tolist()))
            assert any(reasons[()]) == (name == "some")
