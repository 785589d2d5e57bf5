"""Small results by the schema of docs/results.md, written with h5py: what the package reads, and what it refuses."""

import h5py
import numpy as np

FLAG = h5py.enum_dtype({"FALSE": 0, "TRUE": 1}, basetype="i1")
OUTCOME = h5py.enum_dtype({"admissible": 0, "inadmissible": 1, "failed": 2}, basetype="i1")
SIDE = h5py.enum_dtype({"floor": 0, "wall": 1}, basetype="i1")
PERIODS, GAMMAS = np.array([3.0, 4.0, 5.0]), np.array([0.0, 0.1, 0.2, 0.3])
ROWS = [2, 0, 1] + [0] * 9  # rows of the ragged table per task
PARAMETERS = {
    "kind": "orbits",
    "title": " ",
    "model.type": "chain",
    "model.particles": np.int64(2),
    "model.gamma": 0.0,
    "model.wall": np.nan,
    "model.floor": np.array([-1.0, np.nan]),
    "model.restitution": 0.8,
    "orbit.period": 3.0,
    "orbit.at_start": np.array([1], dtype=np.int64),
    "orbit.at_half": np.zeros(0, dtype=np.int64),
    "orbit.states": True,
    "branch.trace.kinds": ["grazing", "fold"],
}


def fixed(texts):
    """Strings of fixed length in UTF-8."""
    encoded = [text.encode() for text in texts]
    return np.array(encoded, dtype=f"S{max([len(text) for text in encoded], default=1)}")


def write_study(file, swept=("orbit.period", "model.gamma"), given=("kind", "model.particles"), **changed):
    group = file.create_group("study")
    for name, value in {**PARAMETERS, **changed}.items():
        if isinstance(value, bool):
            group.attrs.create(name, value, dtype=FLAG)
        elif isinstance(value, str):
            group.attrs[name] = np.bytes_(value.strip().encode() or b"\0")
        else:
            group.attrs[name] = fixed(value) if isinstance(value, list) else value
    group.attrs["swept"], group.attrs["given"] = fixed(swept), fixed(given)


def write_sweep(file, **axes):
    """The grid over the given axes, the last of which varies fastest."""
    group = file.create_group("sweep")
    group.attrs["parameters"] = np.bytes_(" ".join(axes))
    columns = np.meshgrid(*axes.values(), indexing="ij")
    for name, column in zip(axes, columns):
        write(file, f"sweep/{name}", column.ravel(), "task")
    if axes:
        group.attrs["grid"] = np.array([len(axis) for axis in axes.values()], dtype=np.int64)
    tasks = columns[0].size if axes else 1
    write(file, "task", np.arange(tasks), "task")
    return tasks


def write(file, name, values, axes, **options):
    data = file.create_dataset(name, data=values, **options)
    data.attrs["axes"], data.attrs["long_name"] = np.bytes_(axes), np.bytes_(f"the {name}")
    return data


def write_root(file, version=1, creator="ricochet"):
    file.attrs["creator"], file.attrs["schema_version"] = np.bytes_(creator), np.int64(version)


def write_orbits(file, tasks):
    count = np.arange(tasks)
    write(file, "orbits/outcome", (count % 3).astype("i1"), "task", dtype=OUTCOME)
    write(file, "orbits/reason", fixed([("grün" if i % 3 else "") for i in count]), "task")
    write(file, "orbits/energy", count + 0.5, "task", chunks=(tasks,), fletcher32=True)
    write(file, "orbits/q", count[:, None] + np.array([0.0, 100.0]), "task particle")
    multipliers = np.stack([count + 1j, count - 1j], axis=1)
    write(file, "orbits/multipliers", multipliers, "task multiplier")


def write_special(file):
    write(file, "special/kind", np.array([1, 0], dtype="i1"), "special_point", dtype=SIDE)
    write(file, "special/parameter", np.array([0.05, 0.25]), "special_point")


def grid(path, **changed):
    """Orbits on a grid of 3 periods and 4 couplings, two special points; the ragged table orbits/impact."""
    with h5py.File(path, "w") as file:
        write_root(file)
        write_study(file, **changed)
        tasks = write_sweep(file, **{"orbit.period": PERIODS, "model.gamma": GAMMAS})
        write_orbits(file, tasks)
        write_special(file)
        write(file, "orbits/impact_offset", np.concatenate([[0], np.cumsum(ROWS)]), "task_edge")
        write(file, "orbits/impact_particle", np.array([1, 0, 1]), "impact_row")
        write(file, "orbits/impact_side", np.array([0, 1, 1], dtype="i1"), "impact_row", dtype=SIDE)
        write(file, "orbits/impact_q", np.arange(6.0).reshape(3, 2), "impact_row particle")
    return path


def single(path):
    """One orbit, nothing swept."""
    with h5py.File(path, "w") as file:
        write_root(file)
        write_study(file, swept=(), given=())
        write_orbits(file, write_sweep(file))
    return path


def there_and_back(path):
    """Orbits along one parameter, and back; the first element of a list is swept."""
    with h5py.File(path, "w") as file:
        write_root(file)
        write_study(file, swept=("model.floor[1]",))
        write_orbits(file, write_sweep(file, **{"model.floor[1]": np.array([-3.0, -2.0, -2.0, -3.0])}))
    return path
