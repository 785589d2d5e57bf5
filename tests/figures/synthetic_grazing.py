"""Results of kind `grazing` of oscillators x'' + c x' + x = a cos(w t) beside a wall at 1, in closed form."""

import h5py
import numpy as np

OUTCOMES = ["grazing", "none", "degenerate", "failed", "failed_start", "refused"]
VERDICTS = ["continuous", "discontinuous", "undecided", "none"]
REGIMES = ["none", "chaos", "windows", "overlap", "border"]
EDGES = ["border", "flip", "fold", "complex", "zero", "open", "none"]
RESTITUTION, PHASE = 0.8, 0.3
STUDY = """kind: grazing
model: {{type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: {damping},
        force: 1, frequency: 2}}
orbit: {{motion: forced}}
"""


def motion(matrix, time):
    values, vectors = np.linalg.eig(matrix)
    return (vectors @ np.diag(np.exp(values * time)) @ np.linalg.inv(vectors)).real


def oscillator(damping, frequency):
    """Coefficients on the section a part PHASE of the period before the touch."""
    matrix, period = np.array([[0.0, 1.0], [-1.0, -damping]]), 2 * np.pi / frequency
    before, after = motion(matrix, PHASE * period), motion(matrix, (1 - PHASE) * period)
    jump = np.array([0, -(1 + RESTITUTION)])
    return {
        "parameter": np.hypot(1 - frequency**2, damping * frequency),
        "period": period,
        "A_g": frequency**2,
        "stretch": np.sqrt(2) * frequency,
        "L": motion(matrix, period),
        "eta": np.array([-1.0, 0.0]) @ before,
        "xi": after @ jump,
        "kappa": after @ (2 * matrix @ jump),
    }


def criterion(point, count=100):
    x, c = point["xi"], []
    for _ in range(count):
        c.append(point["eta"] @ x)
        x = point["L"] @ x
    negative = [i for i, value in enumerate(c) if value < 0]
    values, vectors = np.linalg.eig(point["L"])
    k = np.argmax(np.abs(values))
    size = values[k].real
    along, across = point["eta"] @ vectors[:, k], np.linalg.inv(vectors)[k] @ point["xi"]
    return {
        "coefficient": np.array(c),
        "first_negative": negative[0] if negative else -1,
        "settled": -1 if negative else 2,
        "multiplier": complex(values[k]),
        "alpha": np.nan if negative else (along * across).real,
        "verdict": "discontinuous" if negative else "continuous",
        "regime": "none" if negative else "chaos" if size > 2 / 3 else "windows" if size > 0.25 else "overlap",
    }


def put_words(group, name, kinds, words):
    words = np.array(words, dtype=object)
    numbers = np.array([kinds.index(word) for word in words.ravel()], dtype="u1").reshape(words.shape)
    dtype = h5py.enum_dtype({word: k for k, word in enumerate(kinds)}, basetype="u1")
    group.create_dataset(name, data=numbers, dtype=dtype)


def put_windows(group, points, found, periods):
    shape = (len(points), len(periods))
    border, flip = np.full(shape, np.nan), np.full(shape, np.nan)
    for row, (point, verdict) in enumerate(zip(points, found)):
        if verdict["verdict"] == "continuous":
            size, scale = verdict["multiplier"].real, (verdict["alpha"] * point["stretch"]) ** 2
            border[row] = scale * (1 - size) * size ** (2.0 * (periods - 2))
            flip[row] = scale * 0.75 * size ** (2.0 * (periods - 1))
    exists = flip < border
    group["window_period"] = np.tile(periods, (len(points), 1))
    put_words(group, "window_exists", ["FALSE", "TRUE"], np.where(exists, "TRUE", "FALSE"))
    group["window_low_d"] = np.where(exists, flip * 1.01, np.nan)
    group["window_high_d"] = np.where(exists, border * 1.01, np.nan)
    put_words(group, "window_low_kind", EDGES, np.where(exists, "flip", "none"))
    put_words(group, "window_high_kind", EDGES, np.where(exists, "border", "none"))
    group["predicted_border_d"], group["predicted_flip_d"] = border, flip


def put_curve(group, damping, frequencies, tasks):
    """Both ways from the middle of the frequencies, of the first task; a change of c_0 is marked between points."""
    middle = len(frequencies) // 2
    rows = [(part, w) for part, way in enumerate((frequencies[middle::-1], frequencies[middle:])) for w in way]
    points = [oscillator(damping, w) for _, w in rows]
    found = [criterion(point) for point in points]
    first = np.array([each["coefficient"][0] for each in found])
    change = np.where(np.append(False, np.diff(np.sign(first)) != 0), 0, -1)
    group["curve_offset"] = np.array([0] + [len(rows)] * tasks)
    group["curve_part"], group["curve_second"] = [part for part, _ in rows], [w for _, w in rows]
    group["curve_second"].attrs["long_name"] = "model.frequency"
    group["curve_parameter"] = [point["parameter"] for point in points]
    put_words(group, "curve_verdict", VERDICTS, [each["verdict"] for each in found])
    group["curve_first_negative"], group["curve_change"] = [each["first_negative"] for each in found], change


def write(path, damping, frequencies, periods=12, curve=None, outcomes=None):
    points = [oscillator(damping, w) for w in frequencies]
    found = [criterion(point) for point in points]
    with h5py.File(path, "w") as file:
        file.attrs["title"], file.attrs["study"] = "oscillators that graze a wall", STUDY.format(damping=damping)
        file["sweep/model.frequency"] = np.array(frequencies, dtype=float)
        file["sweep"].attrs["parameters"], file["sweep"].attrs["grid"] = "model.frequency", [len(points)]
        group = file.create_group("grazing")
        put_words(group, "outcome", OUTCOMES, outcomes or ["grazing"] * len(points))
        for name in ("parameter", "period", "A_g", "stretch", "L", "eta", "xi", "kappa"):
            group[name] = np.array([point[name] for point in points])
        group["parameter"].attrs["long_name"] = "model.force"
        for name in ("first_negative", "settled", "multiplier", "alpha"):
            group[name] = np.array([each[name] for each in found])
        group["coefficient"] = np.array([each["coefficient"][:16] for each in found])
        put_words(group, "verdict", VERDICTS, [each["verdict"] for each in found])
        put_words(group, "regime", REGIMES, [each["regime"] for each in found])
        if periods:
            put_windows(group, points, found, np.arange(1, periods + 1))
        if curve is not None:
            put_curve(group, damping, curve, len(points))
