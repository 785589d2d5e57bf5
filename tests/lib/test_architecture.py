"""Reads the #include lines and the words of the library: which way they point.

Rooms include their own headers, those of rooms to their left, and the base below all; the numerics know no MPI, no
HDF5, no YAML, no files and no output.
"""
import re

ROOMS = ["numeric", "model", "flow", "impact", "orbit", "floquet", "shooting", "continuation", "family", "grazing",
         "attractor"]
PUBLIC = {  # public headers by room
    "numeric": {"elementary", "polynomial"},
    "model": {"chain", "resonance", "obstacle", "lattice", "mck", "user_system", "system", "normal_modes"},
    "flow": {"segment", "flow"},
    "impact": {"event", "trajectory", "saltation"},
    "orbit": {"pattern", "orbit", "verify", "impact_modes"},
    "floquet": {"monodromy", "multipliers", "orbit_multipliers", "lyapunov", "special_points"},
    "shooting": {"shooting", "ritz"},
    "continuation": {"continuation"},
    "family": {"explore", "family", "guess"},
    "grazing": {"bypass", "grazing", "grazing_criterion", "grazing_map"},
    "attractor": {"attractor", "basin", "cycle_window", "motion_section", "motion_window", "windows"},
}
BASE = {"status", "export", "version"}
UMBRELLA = "ricochet.h"
# Continuation knows its problem through its residual only.
FORBIDDEN_PAIRS = {("continuation", room) for room in ROOMS[1:ROOMS.index("continuation")]}
FORBIDDEN_HEADERS = re.compile(r"^(mpi|hdf5|yaml|omp|pthread|time|sys/time)\.h$|^H5")
FORBIDDEN_WORDS = re.compile(
    r"\b(FILE\b|stdin\b|stdout\b|stderr\b|"
    r"(?:fopen|v?f?printf|f?puts|putchar|putc|perror|exit|abort|getenv|signal)(?=\s*\())")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
COMMENT_OR_STRING = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', re.S)


def room_of_public(stem):
    """Room of a public header; "base" below all of them; None if it is in no list."""
    if stem in BASE:
        return "base"
    return next((room for room, stems in PUBLIC.items() if stem in stems), None)


def room_of_file(path, lib):
    parts = path.relative_to(lib).parts
    if parts[0] == "include":
        return room_of_public(path.name.split(".")[0])
    return parts[0] if len(parts) > 1 else "base"


def room_of_include(name, including):
    """Room of an included header of the library, None for headers of others."""
    folder, _, base = name.rpartition("/")
    stem = base.split(".")[0]
    if folder == "ricochet":
        return room_of_public(stem)
    if folder in ROOMS:
        return folder
    if (including.parent / name).exists():
        return room_of_public(stem) if "include" in including.parts else including.parent.name
    return None


def level(room):
    return -1 if room == "base" else ROOMS.index(room)


def complaints_of(path, lib):
    text = path.read_text()
    here = room_of_file(path, lib)
    if here != "base" and here not in ROOMS:
        yield f"{here}: no such room"
        return
    for quote, name in INCLUDE.findall(text):
        if FORBIDDEN_HEADERS.search(name):
            yield f"includes {name}"
        there = room_of_include(name, path)
        if there is None:
            if quote == '"':
                yield f'"{name}" belongs to no room'
        elif level(there) > level(here) or (here, there) in FORBIDDEN_PAIRS:
            yield f"room {here} includes {name} of room {there}"
    for word in sorted(set(FORBIDDEN_WORDS.findall(COMMENT_OR_STRING.sub(" ", text)))):
        yield f"uses {word}"


def test_includes_point_one_way_and_the_numerics_know_no_files(source):
    lib = source / "lib"
    files = [p for p in sorted(lib.rglob("*")) if p.name.endswith((".c", ".h", ".h.in")) and p.name != UMBRELLA]
    found = [f"{p.relative_to(lib)}: {c}" for p in files for c in complaints_of(p, lib)]
    assert files and not found, "\n".join(found)


def test_public_headers_are_for_cpp_too(source):
    headers = sorted((source / "lib" / "include" / "ricochet").glob("*.h*"))
    declaring = [p for p in headers if p.name not in ("export.h", UMBRELLA)]
    for path in declaring:
        words = re.findall(r"^RIC_(?:BEGIN|END)_DECLARATIONS$", path.read_text(), re.M)
        assert words == ["RIC_BEGIN_DECLARATIONS", "RIC_END_DECLARATIONS"], path.name
    assert len(declaring) > 30
