"""What tests of branches share: studies, running them, reading their results."""

import h5py
from program import USAGE, names, words_of, write

BASE = """kind: branch
title: a ring of six
model:
  type: chain
  particles: 6
  gamma: 0
  floor: -1
  hertz: null
orbit:
  period: 1.5 pi
  at_start: [3]
branch:
  parameter: model.gamma
  from: 0
  to: 0.15
"""
WALL = """kind: branch
model: {type: chain, particles: 1, ends: free, gamma: 0, floor: null, wall: 1, restitution: 0.8, damping: 0.1,
        force: 0.05}
orbit: {motion: forced}
branch: {parameter: model.force, from: 0.05, to: 0.2, cross: true}
"""


def run(ricochet, folder, text, *words, name="s"):
    write(folder, f"{name}.yaml", text)
    ricochet.run(f"{name}.yaml", *words, cwd=folder).expect_done()
    return folder / f"{name}.h5"


def read(path):
    enums = ("outcome", "point_outcome", "point_stable", "special_kind", "segment_origin", "segment_outcome",
             "curve_outcome", "curve_end_outcome")
    with h5py.File(path) as file:
        found = {name: data[()] for name, data in file["branch"].items()}
        return found | {name: words_of(file["branch"][name]) for name in enums if name in found}


def rows(found, what, task=0):
    return slice(*found[f"{what}_offset"][task : task + 2])


def refuse(ricochet, folder, cases, base=BASE):
    """Cases of (old, new, line or 0, phrases...), replacements in the base."""
    for old, new, line, *phrases in cases:
        assert base.count(old) == 1, old
        write(folder, "s.yaml", base.replace(old, new))
        for command in ("check", "run"):
            place = f"s.yaml:{line}: " if line else "s.yaml: "
            ricochet(command, "s.yaml", cwd=folder).expect_refused(USAGE, place, *phrases)
        assert names(folder) == ["s.yaml"]
