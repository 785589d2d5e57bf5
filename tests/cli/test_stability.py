"""Multipliers and verdicts of orbits through the command line: values, critical parameters, and how they open."""

import csv
import io

import h5py
import numpy as np
import xarray
from program import USAGE, study, sweep, trajectory, words_of, write

CRITICAL = 0.132081944879  # of one particle in a ring of 30, T = 1.5 pi: a pair leaves the circle at +1
COUNTS = ("multiplier_outside", "multiplier_real_above", "multiplier_real_below", "multiplier_complex")


def run(ricochet, folder, text, *words, name="s"):
    write(folder, f"{name}.yaml", text)
    ricochet.run(f"{name}.yaml", *words, cwd=folder).expect_done()
    return folder / f"{name}.h5"


def ring(orbit, points=39, low=0, high=0.19, particles=30):
    return study(particles, at_start="[15]", orbit=orbit, sweep=sweep(points, low, high))


def read(path, group="orbits"):
    with h5py.File(path) as file:
        found = {name: data[()] for name, data in file[group].items()}
        return found | {f"{n}_words": words_of(d) for n, d in file[group].items() if h5py.check_enum_dtype(d.dtype)}


def test_only_what_was_asked_for_is_there(ricochet, folder):
    plain = read(run(ricochet, folder, ring("states: false", 3), name="plain"))
    assert not [name for name in plain if name.startswith(("multiplier", "stable"))]
    stable = run(ricochet, folder, ring("stable: true", 3), name="stable")
    with h5py.File(stable) as file:
        assert "multipliers" not in file["orbits"] and "multiplier" not in file
        assert {"stable", "stable_reason", "multiplier_max", *COUNTS} <= set(file["orbits"])
    with h5py.File(run(ricochet, folder, ring("multipliers: true", 3), name="all")) as file:
        assert file["orbits/multipliers"].shape == (3, 60) and file["multiplier"].shape == (60,)


def test_multipliers_are_complex_numbers_with_an_axis(ricochet, folder):
    path = run(ricochet, folder, ring("multipliers: true", 3))
    with h5py.File(path) as file:
        assert file["orbits/multipliers"].dtype == np.complex128
        tolerances = dict(file["orbits/stable"].attrs)
        assert 0 < tolerances["multiplier_tol"] < tolerances["band"] <= tolerances["band_at_one"] < 0.01
    with xarray.open_dataset(path, engine="h5netcdf", group="orbits") as opened:
        assert opened.multipliers.dims == ("task", "multiplier") and opened.multipliers.dtype == np.complex128
        assert opened.stable.attrs["flag_meanings"].split() == ["stable", "unstable", "undecided", "unknown"]
        opened.load()
    ricochet("show", path, "--verify", cwd=folder).expect_done()


def test_multipliers_come_in_reciprocal_and_conjugate_pairs(ricochet, folder):
    found = read(run(ricochet, folder, ring("multipliers: true")))
    mu = found["multipliers"]
    assert np.allclose(found["multiplier_max"], np.abs(mu).max(axis=1), rtol=1e-14)
    modulus = np.abs(mu)
    assert (modulus[:, :-1] >= modulus[:, 1:] - 1e-9).all()
    for row in mu:
        for other in (1 / row, row.conj()):
            assert max(np.abs(row - x).min() for x in other) < 1e-6
    assert np.allclose(np.prod(mu, axis=1), 1, atol=1e-8)


def test_the_verdict_changes_at_the_critical_parameter(ricochet, folder):
    path = run(ricochet, folder, ring("multipliers: true, special_points: true"))
    with h5py.File(path) as file:
        gammas = file["sweep/model.gamma"][()]
    found, special = read(path), read(path, "special")
    assert found["stable_words"] == ["stable" if gamma < CRITICAL else "unstable" for gamma in gammas]
    assert [reason == b"" for reason in found["stable_reason"]] == [w == "stable" for w in found["stable_words"]]
    above = (gammas > CRITICAL).astype(int)
    expected = {"multiplier_outside": above, "multiplier_real_above": above}
    for name in COUNTS:
        assert np.array_equal(found[name], expected.get(name, 0 * above)), name
    assert special["kind_words"] == ["plus_one"] and special["change_words"] == ["outwards"]
    assert special["outcome_words"] == ["admissible"] and special["mode"].tolist() == [-1]
    assert abs(special["parameter"][0] - CRITICAL) < 1e-9 and special["uncertainty"][0] < 1e-9
    assert special["multiplier"].dtype == np.complex128 and abs(special["multiplier"][0] - 1) < 1e-12


def test_critical_parameters_stand_among_the_special_points(ricochet, folder):
    """A range with resonances and singular points in it, along the coupling and along the period."""
    along_period = study(at_start="[14]", orbit="at_half: [15], stable: true, special_points: true", gamma="0.15",
                         sweep=sweep(60, 4, 5, "orbit.period"))
    for name, text in (("gamma", ring("stable: true, special_points: true", 60, 0.1, 0.25)), ("period", along_period)):
        special = read(run(ricochet, folder, text, name=name), "special")
        assert (np.diff(special["parameter"]) >= 0).all()
        kinds = np.array(special["kind_words"])
        critical = np.isin(kinds, ("plus_one", "minus_one", "collision"))
        assert critical.any() and {"resonance", "singular"} & set(kinds), (name, set(kinds))
        assert np.allclose(np.abs(special["multiplier"][critical]), 1, atol=1e-6)
        assert np.isnan(special["multiplier"][~critical]).all() and np.isnan(special["uncertainty"][~critical]).all()
        changes = np.array(special["change_words"])
        assert set(changes[~critical]) <= {"none"} and set(changes[critical]) <= {"outwards", "inwards"}
        assert (special["mode"][critical] == -1).all()
    plain = read(run(ricochet, folder, ring("special_points: true", 60, 0.1, 0.25), name="plain"), "special")
    assert set(plain["kind_words"]) <= {"resonance", "singular"} and "multiplier" not in plain


def test_a_sweep_of_one_value_has_no_critical_parameter(ricochet, folder):
    one = ring("stable: true, special_points: true", 1, 0.1, 0.1)
    assert len(read(run(ricochet, folder, one), "special")["kind"]) == 0


def test_the_verdict_is_the_same_with_and_without_the_multipliers(ricochet, folder):
    verdict = run(ricochet, folder, ring("stable: true"), name="verdict")
    both = run(ricochet, folder, ring("multipliers: true"), name="both")
    with h5py.File(verdict) as a, h5py.File(both) as b:
        for name in a["orbits"]:
            assert a["orbits"][name][()].tobytes() == b["orbits"][name][()].tobytes(), name


def test_long_chains_have_verdicts_too(ricochet, folder):
    """A localised orbit does not feel how long its ring is."""
    text = ring("stable: true, states: false", particles=1000).replace(sweep(39, 0, 0.19), "{parameter: model.gamma, "
                                                                       "values: [0.05, 0.1, 0.15, 0.17]}")
    found = read(run(ricochet, folder, text))
    short = read(run(ricochet, folder, text.replace("particles: 1000", "particles: 30"), name="short"))
    assert found["stable_words"] == short["stable_words"] == ["stable"] * 2 + ["unstable"] * 2
    assert np.allclose(found["multiplier_max"], short["multiplier_max"], rtol=1e-6)
    assert found["multiplier_outside"].tolist() == short["multiplier_outside"].tolist() == [0, 0, 1, 1]


def test_orbits_without_multipliers_are_unknown(ricochet, folder):
    """A grazing one, and patterns without an orbit."""
    grazing = study(at_start="[15]", orbit="multipliers: true", gamma=7 / 36)
    twice = "{parameter: 'orbit.at_start[1]', values: [1, 0]}"
    none = study(3, at_start="[0, 1]", orbit="multipliers: true", sweep=twice)
    for name, text, task in (("grazing", grazing, 0), ("none", none, 1)):
        found = read(run(ricochet, folder, text, name=name))
        assert found["stable_words"][task] == "unknown" and found["stable_reason"][task], (name, found["outcome_words"])
        assert np.isnan(found["multiplier_max"][task]) and np.isnan(found["multipliers"][task]).all()
        assert [found[count][task] for count in COUNTS] == [-1] * 4
    assert found["stable_words"][0] != "unknown"


def test_csv_and_show_have_complex_numbers(ricochet, folder):
    path = run(ricochet, folder, ring("multipliers: true, special_points: true", 20, 0.1, 0.25))
    special = read(path, "special")
    rows = list(csv.DictReader(io.StringIO(ricochet("show", path, "--csv=special", cwd=folder).expect_done().out)))
    read_back = np.array([complex(float(row["multiplier.r"]), float(row["multiplier.i"])) for row in rows])
    assert np.array_equal(read_back, special["multiplier"], equal_nan=True)
    out = ricochet("show", path, cwd=folder).expect_done().out
    for phrase in ("complex128  [task 20, multiplier 60]", "stable: stable", "plus_one", "1+0i"):
        assert phrase in out, (phrase, out)
    table = ricochet("show", path, "--csv", cwd=folder).expect_done().out.splitlines()
    assert "stable" in table[0].split(",") and len(table) == 21


def test_orbits_only_have_multipliers(ricochet, folder):
    text = trajectory().replace("start: {v: 2}", "orbit: {period: 4, at_start: [0], stable: true}")
    write(folder, "s.yaml", text)
    ricochet("check", "s.yaml", cwd=folder).expect_refused(USAGE, "s.yaml:3: orbit.stable is a key of kind: orbits")
