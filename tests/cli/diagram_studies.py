"""What tests of diagrams and basins share: studies, running and reading them, the example map and its closed forms."""

import h5py
import numpy as np
from branches import run
from program import words_of

MAP = """kind: diagram
model: {type: grazing_map, lambda: 0.5, omega: 0.3, d: 0.01}
iterate: {transient: 2000, keep: 100}
"""
LISTED = """kind: diagram
model:
  type: grazing_map
  L: [0.5, 0, 0, 0, 0, -0.3, 0, 0.3, 0]
  eta: [1, 0, 0]
  xi: [1, 1, 1]
  kappa: [3.5, -5, 7]
  d: 0.01
iterate: {transient: 2000, keep: 100}
"""
OSCILLATOR = """kind: diagram
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 3, force: 22,
        frequency: 4}
iterate: {transient: 400, keep: 60}
"""
BEYOND = """kind: diagram
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 3, force: 1}
orbit: {motion: forced}
branch: {parameter: model.force, from: 1, to: 50}
iterate: {transient: 1000, keep: 100, lyapunov: true}
sweep:
  - {parameter: model.frequency, values: [4]}
  - {parameter: grazing.beyond, values: [1.3e-5, 1.2e-4, 5e-3]}
"""


def swept(text, *entries):
    return text + "sweep:\n" + "".join(f"  - {{parameter: {entry}}}\n" for entry in entries)


def read(path, group="diagram"):
    with h5py.File(path) as file:
        found = {name: data[()] for name, data in file[group].items()}
        words = {name for name, data in file[group].items() if h5py.check_enum_dtype(data.dtype)}
        return found | {name: words_of(file[group][name]) for name in words}


def found_by(ricochet, folder, text, *words, group="diagram", name="s"):
    return read(run(ricochet, folder, text, *words, name=name), group)


def step(z, d, decay=0.5, turn=0.3):
    """[FN97] (6.3), (6.4) as printed."""
    z1, z2, z3 = z
    if z1 > d:
        return np.array([decay * z1, -turn * z3, turn * z2])
    jump = decay * d + 3 * (d - z1), 5 * (z1 - d) - turn * z3, 7 * (d - z1) + turn * z2
    return np.sqrt(d - z1) + np.array(jump)


def iterates(d, transient, keep, start=(0, 0, 0), decay=0.5, turn=0.3):
    z, kept = np.array(start, dtype=float), []
    for i in range(transient + keep):
        z = step(z, d, decay, turn)
        kept += [z] if i >= transient else []
    return np.array(kept)


def border(n, decay):
    """Upper edge of the one-impact orbits of period n."""
    return (1 - decay) * decay ** (2 * (n - 2)) / (1 - decay ** (n - 2) * (3 - 2 * decay)) ** 2


def flip(n, decay):
    """Their lower edge."""
    c = decay ** (n - 1)
    s = c / 2 / (1 - 3 * c)
    return (s**2 * (1 + 3 * c) + c * s) / (1 - c * decay)
