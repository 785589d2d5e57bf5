"""Results for tests of figures, each made when it is first asked for: of a study, or changed by hand."""

import h5py
import numpy as np


class Shelf:
    """Results in a folder: `makers[name](shelf, path)` makes one."""

    def __init__(self, folder, makers):
        self.folder, self._makers, self._made = folder, makers, set()

    def __getitem__(self, name):
        path = self.folder / f"{name}.h5"
        if name not in self._made:
            self._makers[name](self, path)
            self._made.add(name)
        return path


def computed(ricochet, studies):
    """Makers of the results of studies."""

    def maker(text):
        def make(shelf, path):
            path.with_suffix(".yaml").write_text(text)
            ricochet.run(f"{path.stem}.yaml", cwd=shelf.folder).expect_done()

        return make

    return {name: maker(text) for name, text in studies.items()}


def altered(name, change):
    """A maker of a copy of a result, changed by `change(file)`."""

    def make(shelf, path):
        path.write_bytes(shelf[name].read_bytes())
        with h5py.File(path, "r+") as file:
            change(file)

    return make


def broken(name, group, rows, outcomes):
    """A copy in which some tasks ended with these outcomes in turn: their numbers are NaN, as the program has them."""

    def change(file):
        columns = file[group]
        kinds = h5py.check_enum_dtype(columns["outcome"].dtype)
        for i, row in enumerate(rows):
            columns["outcome"][row] = kinds[outcomes[i % len(outcomes)]]
            for column in columns.values():
                if column.dtype.kind in "fc" and len(column) == len(columns["outcome"]):
                    column[row] = np.nan
            if "attractor_period" in columns:
                columns["attractor_period"][row] = 0

    return altered(name, change)


def put_text(file, name, row, text):
    """Another text in a row: texts are stored as wide as the longest."""
    texts, attributes = file[name][()], dict(file[name].attrs)
    texts = texts.astype(f"S{max(texts.dtype.itemsize, len(text))}")
    texts[row] = text
    del file[name]
    file[name] = texts
    kept = {key: value for key, value in attributes.items() if key not in ("DIMENSION_LIST", "REFERENCE_LIST")}
    file[name].attrs.update(kept)


# --- studies of orbits ---

RING = """kind: orbits
title: {title}
model: {{type: chain, particles: 6, ends: periodic, gamma: 0.1, floor: -1}}
orbit: {{period: 1.5 pi, at_start: [3]{orbit}}}
sweep:
{sweep}
"""


def ring(title, sweep, orbit=""):
    return RING.format(title=title, sweep=sweep, orbit=orbit)


def over_gamma(values):
    return f"  - {{parameter: model.gamma, {values}}}"


FAMILY = ring("a family", over_gamma("from: 0, to: 0.19, points: 12"))
