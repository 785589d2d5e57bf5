"""Nonlinear modes of Duffing chains before a wall: what their studies take, and what closed forms say of them."""

import h5py
import numpy as np
from program import USAGE, assert_same, study, words_of, write

MODEL = "model: {type: duffing_chain, particles: 2, stiffness: [3, 1], cubic: [0, 0], wall: 2}\n"
ENERGY = "branch: {parameter: orbit.energy, from: 0.05, to: 3, step_most: 0.1, cross: true}\n"
MODES = f"kind: branch\n{MODEL}orbit: {{mode: 0}}\n{ENERGY}"
SWEPT = MODES + 'sweep:\n  - {parameter: orbit.mode, values: [0, 1]}\n  - {parameter: "model.cubic[1]", values: [0, 0.1, 0.2]}\n'
PERIOD = (f"kind: branch\n{MODEL}orbit: {{period: 7, at_start: [1]}}\nbranch: {{parameter: orbit.energy, to: 6, low: 1}}\n"
          "sweep: {parameter: orbit.period, values: [7, 14.9, 15]}\n")
TOUCH = (f"kind: branch\n{MODEL}orbit: {{mode: 0, at_start: [1]}}\n"
         "branch: {parameter: orbit.energy, to: 200, low: 1, points: 3, step: 0.01, states: true}\n"
         "sweep:\n  - {parameter: orbit.mode, values: [0, 1]}\n"
         '  - {parameter: "model.cubic[1]", values: [0, 0.1, 0.2]}\n  - {parameter: orbit.swings, values: [1, 2, 3]}\n')
RITZ = (f"kind: orbits\n{MODEL}orbit: {{period: 6.8, at_start: [1], method: ritz, verify: true, stable: true}}\n"
        'sweep:\n  - {parameter: "model.cubic[1]", values: [0, 0.1]}\n  - {parameter: orbit.functions, values: [8, 16, 32, 64]}\n')
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


def test_keys_of_a_type_of_model_are_refused_by_name(ricochet, folder):
    but = "is a key of model.type: chain, and this is model.type: duffing_chain"
    for old, new, *phrases in [
        ("wall: 2", "wall: 2, gamma: 0.1", f"s.yaml:2: model.gamma {but}"),
        ("wall: 2", "wall: 2, ends: fixed", f"s.yaml:2: model.ends {but}"),
        ("wall: 2", "wall: 2, link_cubic: 1", f"s.yaml:2: model.link_cubic {but}"),
        ("orbit.energy, from", "model.gamma, from", f"s.yaml:4: branch.parameter = model.gamma {but}"),
        ("[3, 1]", "[3, 1, 1]", "s.yaml:2: model.stiffness has 3 elements, expected 2"),
        ("mode: 0", "mode: 2", "s.yaml:3: orbit.mode = 2 is out of range, expected a mode from 0 to 1"),
        ("mode: 0", "mode: 0, period: 7", "s.yaml:3: orbit.period and orbit.mode both give a period, expected one of them"),
        ("mode: 0", "mode: 0, at_start: [1]", "s.yaml:3: orbit.mode gives a first guess, and so do the impacts"),
        ("mode: 0", "period: 7, at_start: [0]", "s.yaml:3: orbit.at_start[0] = 0 has no floor or wall to hit"),
        ("mode: 0", "mode: 0, swings: 2", "s.yaml:3: orbit.swings counts periods of orbit.mode between impacts"),
        ("orbit.energy, from", "model.wall, from", "s.yaml:3: orbit.mode needs an energy"),
        ("orbit.energy, from: 0.05", "orbit.energy", "s.yaml:4: missing key branch.from (a number)"),
        ("mode: 0}\nbranch: {parameter: orbit.energy, from: 0.05,",
         "period: 7, at_start: [1]}\nbranch: {parameter: orbit.energy, low: 7, high: 5,",
         "s.yaml:4: branch.low = 7, expected less than branch.high = 5"),
    ]:
        assert MODES.count(old) == 1, old
        write(folder, "s.yaml", MODES.replace(old, new))
        ricochet("check", "s.yaml", cwd=folder).expect_refused(USAGE, *phrases)
    write(folder, "s.yaml", f"kind: trajectory\n{MODEL}orbit: {{period: 7, at_start: [1]}}\ntime: {{duration: 1}}\n")
    ricochet("check", "s.yaml", cwd=folder).expect_refused(
        USAGE, "s.yaml:2: model.type = duffing_chain, but a start on an orbit needs model.type = chain")


def test_starts_at_touches_are_refused_by_what_they_lack(ricochet, folder):
    for old, new, phrase in [
        ("at_start: [1]", "at_half: [1]", "s.yaml:4: missing key branch.from (a number), the energy at the start"),
        ("low: 1", "low: 1, from: 2", "s.yaml:3: orbit.mode gives a first guess, and so do the impacts"),
        ("wall: 2", "wall: 2, hertz: 100", "s.yaml:3: orbit.mode with orbit.at_start: the mode grazes a rigid obstacle"),
        ("mode: 0,", "mode: 0, swings: 0,", "s.yaml:3: orbit.swings = 0 is out of range"),
    ]:
        assert TOUCH.count(old) == 1, old
        write(folder, "s.yaml", TOUCH.split("sweep:")[0].replace(old, new))
        ricochet("check", "s.yaml", cwd=folder).expect_refused(USAGE, phrase)


def test_orbits_of_duffing_chains_are_refused_by_place_and_value(ricochet, folder):
    for old, new, phrase in [
        ("ritz", "impulse", "s.yaml:3: orbit.method = impulse is for model.type: chain, and this is model.type: duffing"),
        ("at_start: [1]", "at_half: [1]", "s.yaml:3: orbit.method = ritz is for one impact per period, expected one"),
        ("ritz", "ritz, functions: 0", "s.yaml:3: orbit.functions = 0 is out of range, expected an integer from 1 to"),
        ("ritz", "ritz, tolerance: 0", "s.yaml:3: orbit.tolerance = 0 is out of range"),
        ("wall: 2", "wall: 2, damping: 0.1", "s.yaml:2: model.damping = 0.1, but kind: orbits needs model.damping = 0"),
        ("wall: 2", "wall: 2, restitution: 0.9", "s.yaml:2: model.restitution = 0.9 is not in this version"),
        ("wall: 2", "wall: 2, hertz: 100", "s.yaml:2: model.hertz = 100, but kind: orbits needs model.hertz = null"),
        ("wall: 2", "wall: null", "s.yaml:3: orbit.at_start[0] = 1 has no floor or wall to hit"),
    ]:
        assert RITZ.count(old) == 1, old
        write(folder, "s.yaml", RITZ.replace(old, new))
        ricochet("check", "s.yaml", cwd=folder).expect_refused(USAGE, phrase)


    write(folder, "s.yaml", study(at_start="[3]", orbit="special_points: true", sweep="{parameter: model.gamma, values: [0]}"))
    ricochet("check", "s.yaml", "--set", "orbit.method=shooting", cwd=folder).expect_refused(
        USAGE, "s.yaml:", "orbit.special_points = true with orbit.method = shooting, expected method: impulse or dense")


def test_shooting_finds_the_orbits_of_chains_and_nonlinear_ones_too(ricochet, folder):
    """Those of linear chains are known by impulse responses; the others an event-driven run confirms."""
    base = study(6, at_start="[3]", sweep="{parameter: model.gamma, from: 0, to: 0.15, points: 4}")
    found = {}
    for method in ("impulse", "shooting"):
        path = run(ricochet, folder, base, "--set", f"orbit.method={method}", "--set", "orbit.multipliers=true", name=method)
        with h5py.File(path) as file:
            found[method] = {name: file["orbits"][name][()] for name in ("q", "v", "energy", "impulse", "multiplier_max")}
            found[method]["outcome"] = words_of(file["orbits/outcome"])
    for name, values in found["impulse"].items():
        if name != "outcome":
            assert np.allclose(values, found["shooting"][name], rtol=1e-7, atol=1e-9), name
    assert found["impulse"]["outcome"] == found["shooting"]["outcome"]
    hard = run(ricochet, folder, base, "--set", "orbit.method=shooting", "--set", "model.cubic=0.1", "--set",
               "orbit.verify=true", name="hard")  # fmt: skip
    with h5py.File(hard) as file:
        assert words_of(file["orbits/verified"]) == ["verified"] * 4, file["orbits/reason"][()]
        assert (file["orbits/energy"][()] != found["impulse"]["energy"]).all()


def test_approximations_by_ritz_converge_as_they_say(ricochet, folder):
    """As the third power of their number with constants; without, they stall. The orbit is the one found by shooting."""
    with h5py.File(run(ricochet, folder, RITZ, name="ritz")) as file:
        orbits = {name: data[()] for name, data in file["orbits"].items()}
        assert words_of(file["orbits/outcome"]) == ["admissible"] * 8
        assert words_of(file["orbits/verified"]) == ["verified"] * 8
        assert words_of(file["orbits/stable"]) == ["stable"] * 8
    errors = orbits["ritz_error"].reshape(2, 4)
    assert orbits["ritz_functions"].tolist() == [8, 16, 32, 64] * 2
    rates = -np.log2(errors[:, 1:] / errors[:, :-1])
    assert (abs(rates - 3) < 0.15).all(), rates
    for name, rate in (("ritz_error_v", 2), ("ritz_defect", 1)):
        values = orbits[name].reshape(2, 4)
        assert (abs(-np.log2(values[:, 1:] / values[:, :-1]) - rate) < 0.15).all(), name
    with h5py.File(run(ricochet, folder, RITZ.replace("ritz", "shooting"), name="shot")) as file:
        energy = file["orbits/energy"][()]
    assert (abs(orbits["energy"] - energy).reshape(2, 4) < 30 * errors).all()
    with h5py.File(run(ricochet, folder, RITZ, "--set", "orbit.constants=false", name="stalled")) as file:
        stalled = file["orbits/ritz_error"][()]
    assert (stalled > 0.02).all() and (stalled < 0.1).all(), stalled


def test_fewer_functions_are_taken_when_a_tolerance_is_enough(ricochet, folder):
    path = run(ricochet, folder, RITZ, "--set", "orbit.tolerance=1e-3")
    with h5py.File(path) as file:
        functions, error = file["orbits/ritz_functions"][()], file["orbits/ritz_error"][()]
    assert (functions >= 4).all() and (functions <= 8).all() and (error <= 1e-3).all()


def test_orbits_that_do_not_exist_are_rows(ricochet, folder):
    """At the blow-up of the linear part nothing is found; beyond it the impulse pulls."""
    text = RITZ.replace("ritz", "shooting").split("sweep:")[0] + "sweep: {parameter: orbit.period, values: [6.8, 6.07, 1e-9]}\n"
    with h5py.File(run(ricochet, folder, text, "--set", "model.cubic=0")) as file:
        assert words_of(file["orbits/outcome"])[:2] == ["admissible", "inadmissible"]
        assert words_of(file["orbits/outcome"])[2] in ("failed", "inadmissible") and len(file["orbits/reason"][1]) > 10


def test_orbits_that_end_before_all_nonlinear_terms_say_where(ricochet, folder):
    """A spring that softens: the family has a fold at a cubic coefficient, whatever the last one is."""
    text = RITZ.replace("ritz", "shooting").split("sweep:")[0] + 'sweep: {parameter: "model.cubic[1]", values: [-0.05, -0.1, -10]}\n'
    with h5py.File(run(ricochet, folder, text)) as file:
        assert words_of(file["orbits/outcome"]) == ["admissible", "failed", "failed"]
        reasons = [reason.decode() for reason in file["orbits/reason"][1:]]
    for reason, part in zip(reasons, ("0.576", "0.00576")):
        assert f"does not continue to all nonlinear terms: its family has a fold at {part}" in reason, reason


def test_the_first_mode_touches_the_wall_where_its_closed_form_says(ricochet, folder):
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


def test_energies_of_motions_with_an_impact_are_those_of_the_closed_form(ricochet, folder):
    period = 2 * np.pi / (1.1 * LOWEST)
    found = read(run(ricochet, folder, PERIOD, "--set", f"sweep.values=[{period:.17g}]"))
    assert abs(found["point_energy"][0] - 1.7113950296) < 1e-9 and abs(found["point_period"][0] - period) < 1e-11


def test_branches_in_the_energy_start_at_a_period(ricochet, folder):
    found = read(run(ricochet, folder, PERIOD))
    first = found["point_offset"][:-1]
    assert np.allclose(found["point_period"][first], [7, 14.9, 15], rtol=1e-10)
    assert np.allclose(found["point_parameter"][first], found["point_energy"][first], rtol=1e-9)


def test_families_that_turn_back_before_all_nonlinear_terms_are_told(ricochet, folder):
    """Newton's method from the motion of the linear part would fail there, or find a motion of another family."""
    text = PERIOD.replace("cubic: [0, 0]", "cubic: [0, 0.1]")
    found = read(run(ricochet, folder, text, "--set", "sweep.values=[5.9, 12, 27.6]"))
    assert found["outcome"][:2] == ["failed_start"] * 2 and found["outcome"][2] == "bound"
    for task, period, factor in ((0, "5.9", 0.138024), (1, "12", 0.0128931)):
        reason = found["reason"][task].decode()
        words = f"the motion of the linear part with the period {period} does not continue to all nonlinear terms: its family has a fold at "
        assert reason.startswith(words) and abs(float(reason[len(words):].split()[0]) / factor - 1) < 1e-3, reason
    assert abs(found["point_period"][0] - 27.6) < 1e-9 and abs(found["point_energy"][0] - 2.15221) < 1e-5


def test_orbits_say_where_their_family_turns_back(ricochet, folder):
    text = RITZ.replace("ritz", "shooting").split("sweep:")[0] + "sweep: {parameter: orbit.period, values: [6]}\n"
    with h5py.File(run(ricochet, folder, text, "--set", "model.cubic[1]=0.1")) as file:
        assert words_of(file["orbits/outcome"]) == ["failed"]
        assert file["orbits/reason"][0].decode().endswith("its family has a fold at 0.0205 of them")


def test_families_start_where_a_mode_touches_after_some_swings(ricochet, folder):
    """There energy and period are those of the smooth mode; from there on the impact pushes."""
    found = read(run(ricochet, folder, TOUCH))
    first = found["point_offset"][:-1]
    assert set(found["outcome"]) == {"points"}, found["reason"]
    energy, period = (found[name][first].reshape(2, 3, 3) for name in ("point_energy", "point_period"))
    assert np.allclose(energy, energy[:, :, :1], rtol=1e-9) and np.allclose(period / period[:, :, :1], [1, 2, 3], rtol=1e-9)
    squares = (5 + np.sqrt(13) * np.array([-1, 1])) / 2  # of the frequencies; the modes are (1, 4 - square)
    assert np.allclose(energy[:, 0, 0], squares / 2 * (2**2 + (2 / (4 - squares)) ** 2), rtol=1e-10), energy[:, 0, 0]
    assert np.allclose(period[:, 0, 0], 2 * np.pi / np.sqrt(squares), rtol=1e-10)
    smooth = read(run(ricochet, folder, SWEPT, "--set", "branch.to=60", "--set", "branch.step_most=0.5", name="smooth"))
    for mode, cubic in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2)):
        at = first_special(smooth, "grazing", 3 * mode + cubic)
        assert abs(energy[mode, cubic, 0] / smooth["special_energy"][at] - 1) < 1e-7
        assert abs(period[mode, cubic, 0] / smooth["special_period"][at] - 1) < 1e-8
    later = ~np.isin(found["impact_point"], [-1, *first])
    assert later.sum() > 18 and (found["impact_impulse"][later] > 0).all()


def test_modes_that_do_not_touch_are_told(ricochet, folder):
    """In the second mode of three equal particles the one in the middle stands still."""
    text = ("kind: branch\nmodel: {type: chain, particles: 3, ends: fixed, gamma: 1, floor: -1}\n"
            "orbit: {mode: 1, at_start: [1]}\nbranch: {parameter: orbit.energy, to: 6}\n")
    found = read(run(ricochet, folder, text))
    assert found["outcome"] == ["failed_start"] and b"moves particle 1 by" in found["reason"][0], found["reason"]


def test_motions_of_a_period_before_compliant_walls_start_branches_in_the_energy(ricochet, folder):
    """They have no impacts, whoever presses the wall."""
    found = read(run(ricochet, folder, PERIOD, "--set", "model.hertz=1000", "--set", "sweep.values=[7]"))
    assert found["outcome"] == ["bound"] and abs(found["point_period"][0] - 7) < 1e-9, found["reason"]


def test_energies_outside_the_bounds_are_told(ricochet, folder):
    for bound, phrase in (("low=5", "at least branch.low = 5"), ("high=1.5", "at most branch.high = 1.5")):
        found = read(run(ricochet, folder, PERIOD, "--set", f"branch.{bound}", "--set", "sweep.values=[7]", name=bound))
        reason = found["reason"][0].decode()
        assert found["outcome"] == ["failed_start"] and reason.startswith("the branch would start at the energy 1.62582"), reason
        assert reason.endswith(f"expected {phrase}"), reason


def test_branches_go_on_from_modes_that_a_sweep_names(ricochet, folder):
    """The mode was the first guess there: here it is the state. Along the period, its energy is no longer given."""
    found = read(run(ricochet, folder, SWEPT))
    special = first_special(found, "grazing", 1) - found["special_offset"][1]
    restart = f"restart: {{file: s.h5, task: 1, special: {special}}}\n"
    for parameter, value in (("orbit.energy", "special_energy"), ("orbit.period", "special_period")):
        branch = f"branch: {{parameter: {parameter}, to: 9, high: 9, points: 5}}\n"
        text = MODES.replace(ENERGY, branch).replace("orbit: {mode: 0}\n", "orbit: {motion: even}\n") + restart
        went = read(run(ricochet, folder, text, name=parameter))
        assert abs(went["point_parameter"][0] - found[value][found["special_offset"][1] + special]) < 1e-10
        assert went["points"][0] > 1, went["outcome"]


def test_starts_without_a_value_take_the_own_one(ricochet, folder):
    text = study(6, gamma="0.05", at_start="[3]").replace("kind: orbits", "kind: branch")
    own = run(ricochet, folder, text + "branch: {parameter: model.gamma, to: 0.1}\n")
    said = run(ricochet, folder, text + "branch: {parameter: model.gamma, from: 0.05, to: 0.1}\n", name="t")
    for name in ("point_parameter", "point_energy"):
        assert (read(own)[name] == read(said)[name]).all()
    assert read(own)["point_parameter"][0] == 0.05


def test_modes_are_equal_for_all_ranks(ricochet, folder):
    paths = []
    for ranks in (1, 2, 3):
        own = folder / str(ranks)
        own.mkdir()
        write(own, "s.yaml", SWEPT)
        ricochet.run("s.yaml", cwd=own, ranks=ranks).expect_done()
        paths.append(own / "s.h5")
        assert_same(paths[0], paths[-1])


def test_a_duffing_chain_keeps_its_energy_and_hits_its_wall(ricochet, folder):
    text = (f"kind: trajectory\n{MODEL}start: {{q: [0.5, 1.9], v: [0, 1]}}\ntime: {{duration: 50}}\n")
    with h5py.File(run(ricochet, folder, text, "--set", "model.cubic[1]=0.2")) as file:
        group = file["trajectory"]
        start, end = group["energy_start"][0], group["energy_end"][0]
        spring = 1.4**2 / 2 + 0.2 * 1.4**4 / 4
        assert abs(start - (3 * 0.25 / 2 + spring + 0.5)) < 1e-14 and abs(end - start) < 1e-10
        assert len(group["impact_particle"]) > 0 and set(group["impact_particle"][()]) == {1}
