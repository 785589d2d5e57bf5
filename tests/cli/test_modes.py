"""Nonlinear modes of Duffing chains before a wall: what their studies take, and what closed forms say of them."""

import h5py
import numpy as np
import program
from program import USAGE, assert_same, study, test, words_of, write

MODEL = "model: {type: duffing_chain, particles: 2, stiffness: [3, 1], cubic: [0, 0], wall: 2}\n"
ENERGY = "branch: {parameter: orbit.energy, from: 0.05, to: 3, step_most: 0.1, cross: true}\n"
MODES = f"kind: branch\n{MODEL}orbit: {{mode: 0}}\n{ENERGY}"
SWEPT = MODES + 'sweep:\n  - {parameter: orbit.mode, values: [0, 1]}\n  - {parameter: "model.cubic[1]", values: [0, 0.1, 0.2]}\n'
PERIOD = (f"kind: branch\n{MODEL}orbit: {{period: 7, at_start: [1]}}\nbranch: {{parameter: orbit.energy, to: 6, low: 1}}\n"
          "sweep: {parameter: orbit.period, values: [7, 14.9, 15]}\n")
LOWEST = np.sqrt((5 - np.sqrt(13)) / 2)  # of the springs, without their cubic terms


def run(ricochet, folder, text, *words, name="s"):
    write(folder, f"{name}.yaml", text)
    ricochet.run(f"{name}.yaml", *words, cwd=folder).expect_done()
    return folder / f"{name}.h5"


def read(path):
    with h5py.File(path) as file:
        found = {name: data[()] for name, data in file["branch"].items()}
        words = ("outcome", "point_outcome", "special_kind", "segment_origin")
        return found | {name: words_of(file["branch"][name]) for name in words}


def first_special(found, kind, task):
    begin, end = found["special_offset"][task : task + 2]
    return begin + found["special_kind"][begin:end].index(kind)


@test
def keys_of_a_type_of_model_are_refused_by_name(ricochet, folder):
    but = "is a key of model.type: chain, and this is model.type: duffing_chain"
    for old, new, *phrases in [
        ("wall: 2", "wall: 2, gamma: 0.1", f"s.yaml:2: model.gamma {but}"),
        ("wall: 2", "wall: 2, ends: fixed", f"s.yaml:2: model.ends {but}"),
        ("wall: 2", "wall: 2, link_cubic: 1", f"s.yaml:2: model.link_cubic {but}"),
        ("orbit.energy, from", "model.gamma, from", f"s.yaml:4: branch.parameter = model.gamma {but}"),
        ("[3, 1]", "[3, 1, 1]", "s.yaml:2: model.stiffness has 3 elements, expected 2"),
        ("mode: 0", "mode: 2", "s.yaml:3: orbit.mode = 2 is out of range, expected a mode from 0 to 1"),
        ("mode: 0", "mode: 0, at_start: [1]", "s.yaml:3: orbit.mode gives a first guess, and so do the impacts"),
        ("mode: 0", "period: 7, at_start: [0]", "s.yaml:3: orbit.at_start[0] = 0 has no floor or wall to hit"),
        ("orbit.energy, from", "model.wall, from", "s.yaml:3: orbit.mode without an energy"),
        ("orbit.energy, from: 0.05", "orbit.energy", "s.yaml:4: missing key branch.from (a number)"),
    ]:
        assert MODES.count(old) == 1, old
        write(folder, "s.yaml", MODES.replace(old, new))
        ricochet("check", "s.yaml", cwd=folder).expect_refused(USAGE, *phrases)
    write(folder, "s.yaml", f"kind: orbits\n{MODEL}orbit: {{period: 7, at_start: [1]}}\n")
    ricochet("check", "s.yaml", cwd=folder).expect_refused(
        USAGE, "s.yaml:2: model.type = duffing_chain is for kind: trajectory or branch, and this is kind: orbits")
    write(folder, "s.yaml", f"kind: trajectory\n{MODEL}orbit: {{period: 7, at_start: [1]}}\ntime: {{duration: 1}}\n")
    ricochet("check", "s.yaml", cwd=folder).expect_refused(
        USAGE, "s.yaml:2: model.type = duffing_chain, but a start on an orbit needs model.type = chain")


@test
def the_first_mode_touches_the_wall_where_its_closed_form_says(ricochet, folder):
    found = read(run(ricochet, folder, SWEPT))
    assert set(found["outcome"]) == {"bound"}
    energies = [found["special_energy"][first_special(found, "grazing", task)] for task in range(3)]
    assert abs(energies[0] - 1.5222821435) < 1e-9, energies
    begin, end = found["point_offset"][:2]
    smooth = found["point_segment"][begin:end] == 0
    assert np.allclose(found["point_period"][begin:end][smooth], 2 * np.pi / LOWEST, rtol=1e-10)
    periods = [found["special_period"][first_special(found, "grazing", task)] for task in range(3)]
    assert (np.diff(energies) > 0).all() and (np.diff(periods) < 0).all(), (energies, periods)
    outcome, energy = np.array(found["point_outcome"]), found["point_energy"]
    smooth = found["point_segment"] == 0
    assert set(outcome[begin:end][smooth[begin:end] & (energy[begin:end] > 1.53)]) == {"inadmissible"}
    assert "admissible" in outcome[begin:end][~smooth[begin:end]]
    assert found["segment_origin"][:2] == ["start", "grazing"]


@test
def energies_of_motions_with_an_impact_are_those_of_the_closed_form(ricochet, folder):
    period = 2 * np.pi / (1.1 * LOWEST)
    found = read(run(ricochet, folder, PERIOD, "--set", f"sweep.values=[{period:.17g}]"))
    assert abs(found["point_energy"][0] - 1.7113950296) < 1e-9 and abs(found["point_period"][0] - period) < 1e-11


@test
def branches_in_the_energy_start_at_a_period(ricochet, folder):
    found = read(run(ricochet, folder, PERIOD))
    first = found["point_offset"][:-1]
    assert np.allclose(found["point_period"][first], [7, 14.9, 15], rtol=1e-10)
    assert np.allclose(found["point_parameter"][first], found["point_energy"][first], rtol=1e-9)


@test
def starts_without_a_value_take_the_own_one(ricochet, folder):
    text = study(6, gamma="0.05", at_start="[3]").replace("kind: orbits", "kind: branch")
    own = run(ricochet, folder, text + "branch: {parameter: model.gamma, to: 0.1}\n")
    said = run(ricochet, folder, text + "branch: {parameter: model.gamma, from: 0.05, to: 0.1}\n", name="t")
    for name in ("point_parameter", "point_energy"):
        assert (read(own)[name] == read(said)[name]).all()
    assert read(own)["point_parameter"][0] == 0.05


@test
def modes_are_equal_for_all_ranks(ricochet, folder):
    paths = []
    for ranks in (1, 2, 3):
        own = folder / str(ranks)
        own.mkdir()
        write(own, "s.yaml", SWEPT)
        ricochet.run("s.yaml", cwd=own, ranks=ranks).expect_done()
        paths.append(own / "s.h5")
        assert_same(paths[0], paths[-1])


@test
def a_duffing_chain_keeps_its_energy_and_hits_its_wall(ricochet, folder):
    text = (f"kind: trajectory\n{MODEL}start: {{q: [0.5, 1.9], v: [0, 1]}}\ntime: {{duration: 50}}\n")
    with h5py.File(run(ricochet, folder, text, "--set", "model.cubic[1]=0.2")) as file:
        group = file["trajectory"]
        start, end = group["energy_start"][0], group["energy_end"][0]
        spring = 1.4**2 / 2 + 0.2 * 1.4**4 / 4
        assert abs(start - (3 * 0.25 / 2 + spring + 0.5)) < 1e-14 and abs(end - start) < 1e-10
        assert len(group["impact_particle"]) > 0 and set(group["impact_particle"][()]) == {1}


if __name__ == "__main__":
    program.main()
