"""Diagrams of motions through the command line: sections, the map beside them, windows on their cycles, there and back."""

import numpy as np
from branches import run
from diagram_studies import MAP, OSCILLATOR, BEYOND, swept, read, found_by

# --- motions ---


def test_motions_without_impacts_are_the_closed_form(ricochet, folder):
    """x'' + 3 x' + x = 10 cos(4 t) stays below the wall; the section is at a phase of the force."""
    text = swept(OSCILLATOR.replace("force: 22", "force: 10").replace("keep: 60", "keep: 4, states: true, lyapunov: true, exponents: 2"),
                 "iterate.phase, values: [0, 0.25, 0.7]")
    found = found_by(ricochet, folder, text)
    assert found["outcome"] == 3 * ["periodic"] and (found["attractor_period"] == 1).all() and (found["impacts"] == 0).all()
    answer = 10 / (1 - 16 + 12j)
    for task, phase in enumerate((0, 0.25, 0.7)):
        z = answer * np.exp(2j * np.pi * phase)
        assert np.allclose(found["state"][task], [z.real, (4j * z).real], atol=1e-11), phase
    rates = (-3 + np.sqrt(5) * np.array([1, -1])) / 2 * np.pi / 2
    assert np.allclose(found["exponents"], rates, rtol=1e-3)


def test_sections_at_impacts_see_every_impact(ricochet, folder):
    text = OSCILLATOR.replace("keep: 60", "keep: 60, states: true, section: impact, observe: time")
    found = found_by(ricochet, folder, text)
    strobe = found_by(ricochet, folder, OSCILLATOR, name="strobe")
    assert found["state"].shape == (1, 60, 3) and (found["values"] == found["state"][:, :, 2]).all()
    assert np.allclose(found["state"][0, :, 0], 1, atol=1e-12) and (found["state"][0, :, 1] < 0).all()
    assert (found["values"] >= 0).all() and (found["values"] < np.pi / 2).all() and found["impacts"][0] == 1
    assert found["outcome"] == ["periodic"] and strobe["outcome"] == ["periodic"]
    per_cycle = strobe["impacts"][0] * strobe["attractor_period"][0]
    assert abs(per_cycle - found["attractor_period"][0]) < 0.1
    other = found_by(ricochet, folder, text.replace("observe: time", "observe: v0, particle: 0"), name="v0")
    assert (other["values"] == found["state"][:, :, 1]).all()


def test_motions_that_cannot_be_cut_are_rows(ricochet, folder):
    rows = found_by(ricochet, folder, swept(OSCILLATOR, "model.frequency, values: [4, 0]"))
    assert rows["outcome"] == ["periodic", "failed"] and rows["reason"][1].startswith(b"model.frequency = 0, expected > 0")
    assert np.isnan(rows["values"][1]).all() and rows["attractor_period"][1] == 0
    rows = found_by(ricochet, folder, swept(OSCILLATOR.replace("keep: 60", "keep: 5, section: impact"), "model.force, values: [22, 1]"),
                    name="still")
    assert rows["outcome"] == ["periodic", "failed"] and rows["reason"][1].startswith(b"no impact for ")
    slow = OSCILLATOR.replace("force: 22,\n        frequency: 4", "force: 3, frequency: 0.005")
    slow = found_by(ricochet, folder, slow.replace("keep: 60", "keep: 5, section: impact"), name="slow")
    assert slow["outcome"] != ["failed"] and slow["impacts"].tolist() == [1]
    pushed = OSCILLATOR.replace("force: 22", "stiffness: -1, force: 0").replace("keep: 60", "keep: 3") + "start: {q: -0.5}\n"
    assert found_by(ricochet, folder, pushed, name="away")["outcome"] == ["diverged"]


def test_motions_beyond_grazing_stand_beside_their_map(ricochet, folder):
    """x'' + 3 x' + x = a cos(4 t): three windows, in which the map is right to first order."""
    path = run(ricochet, folder, BEYOND)
    found = read(path)
    mu, grazes = np.array([1.3e-5, 1.2e-4, 5e-3]), np.hypot(15, 12)
    assert np.allclose(found["parameter"], grazes * (1 + mu), rtol=1e-12) and np.allclose(found["d"], mu, rtol=1e-6)
    assert found["outcome"] == 3 * ["periodic"] and not any(found["reason"])
    assert (found["attractor_period"] == found["map_period"]).all() and len(set(found["map_period"])) == 3
    assert (np.diff(found["map_period"]) < 0).all()
    assert np.allclose(found["impacts"], 1 / found["attractor_period"], atol=0.02)
    assert (found["distance"] < 30 * mu).all() and (found["distance"] > 0).all()
    assert np.allclose(found["lyapunov"], found["map_lyapunov"], atol=0.05) and (found["lyapunov"] < 0).all()
    for k in range(3):
        apart = np.abs(found["values"][k][:, None] - found["map_values"][k])
        farthest = max(apart.min(axis=0).max(), apart.min(axis=1).max())
        assert np.isclose(farthest / np.ptp(found["map_values"][k]), found["distance"][k], rtol=1e-12)
    none = found_by(ricochet, folder, BEYOND, "--set", "branch.to=2", name="none")
    assert none["outcome"] == 3 * ["failed"] and b"no obstacle is touched" in none["reason"][0]
    assert np.isnan(none["parameter"]).all() and np.isnan(none["map_values"]).all()


def test_periods_of_motions_are_those_of_the_map(ricochet, folder):
    """Nearer to grazing than an integrator's errors, stretched by the square root, are to rounding."""
    text = BEYOND.replace("values: [4]", "values: [1.5]").replace("values: [1.3e-5, 1.2e-4, 5e-3]", "from: 1e-6, to: 1e-4, points: 60, scale: log")
    found = found_by(ricochet, folder, text.replace("lyapunov: true", "states: true"))
    assert (found["attractor_period"] == found["map_period"]).mean() > 0.95 and set(found["map_period"]) == {4, 5}
    still = OSCILLATOR.replace("force: 22", "force: 10").replace("keep: 60", "keep: 3, tolerance: 1e-9")
    assert found_by(ricochet, folder, still, name="still")["attractor_period"].tolist() == [1]


def test_windows_of_motions_are_located_on_their_cycles(ricochet, folder):
    text = BEYOND.replace("lyapunov: true", "windows: true").replace("keep: 100", "keep: 0, measure: 10")
    text = text.replace("values: [1.3e-5, 1.2e-4, 5e-3]", "from: 3.2e-4, to: 6.3e-4, points: 10, scale: log")
    found = found_by(ricochet, folder, text, group="window")
    one = np.flatnonzero(found["impacts"] == 1)
    assert len(one) == 1 and found["period"][one[0]] == 9
    k = one[0]
    assert found["low_kind"][k] == "period_doubling" and found["high_kind"][k] == "grazing" and not found["reason"][k]
    assert abs(found["low"][k] / found["map_low"][k] - 1) < 1e-3 and abs(found["high"][k] / found["map_high"][k] - 1) < 1e-3
    assert found["low"][k] < 3.2e-4 and found["high"][k] > 6.3e-4


def test_windows_end_where_the_parameter_is_zero(ricochet, folder):
    """No bracket around zero is narrow relative to it."""
    text = swept(MAP.replace(", d: 0.01", "").replace("keep: 100", "keep: 0, windows: true"), "model.d, from: -0.01, to: 0.012, points: 5")
    found = found_by(ricochet, folder, text, group="window")
    assert found["period"][0] == 1 and found["impacts"][0] == 0 and found["high_kind"][0] == "border" and found["high"][0] == 0
    assert -1e-11 < found["high_inside"][0] <= 0 < found["high_outside"][0] < 1e-11


BESIDE_JUMP = """kind: diagram
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1, frequency: 1.8}
iterate: {transient: 300, keep: 0, measure: 50, follow: true, windows: true}
"""


def test_windows_of_one_period_are_told_apart_by_their_impacts(ricochet, folder):
    """Both motions of x'' + 0.1 x' + x = a cos(1.8 t) have the period of the force, without an impact and with one."""
    text = swept(BESIDE_JUMP, "model.force, values: [2.6, 2.4, 2.2, 2, 1.8, 1.6, 1.4, 1.2, 1]")
    found = found_by(ricochet, folder, text, group="window")
    assert found["period"].tolist() == [1, 1] and found["impacts"].tolist() == [1, 0] and found["tasks"].tolist() == [7, 2]
    assert found["low_kind"][0] == "fold" and found["high_kind"][1] == "grazing"


def test_brackets_of_a_line_that_is_followed_are_followed(ricochet, folder):
    """Starts anew would come to the motion without impacts long before the fold."""
    text = swept(BESIDE_JUMP, "model.force, values: [2.6, 2.4, 2.2, 2, 1.8, 1.6, 1.4, 1.2, 1]")
    found = found_by(ricochet, folder, text, group="window")
    assert found["low_outside"][0] < found["low"][0] < found["low_inside"][0] < 1.02 * found["low_outside"][0]


def test_motions_that_are_followed_jump_at_grazing(ricochet, folder):
    """x'' + 0.1 x' + x = a cos(1.8 t) grazes at a = 2.2472 with c_0 < 0, and jumps; on the way back it hits the wall in
    every period down to a fold at 1.2544."""
    text = BESIDE_JUMP.replace("keep: 0, measure: 50, follow: true, windows: true", "keep: 40, follow: true")
    found = found_by(ricochet, folder, swept(text, "model.force, from: 1, to: 2.6, points: 33, back: true"))
    up, down = found["impacts"][:33], found["impacts"][:32:-1]
    force = np.linspace(1, 2.6, 33)
    assert (up == (force > 2.2472)).all() and (down == (force > 1.2544)).all()
    assert abs(found["values"][25, -1] - found["values"][24, -1]) > 2
