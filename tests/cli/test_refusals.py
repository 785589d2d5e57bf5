"""Every bad study is refused through the command line, alike by `check` and `run`: exit code 2, one line that begins
with the place and says what is allowed, and nothing is left behind."""

import os
from concurrent.futures import ThreadPoolExecutor

import pytest
from program import FILES, USAGE, names, study, sweep, write

BASE = """kind: orbits
title: one particle
model:
  type: chain
  particles: 30
  ends: periodic
  gamma: 0.1
  floor: -1
  restitution: 1
orbit:
  period: 1.5 pi
  at_start: [15, 3]
  at_half: [4]
  method: impulse
  states: true
sweep:
  - parameter: model.gamma
    from: 0
    to: 0.187
    points: 15
"""


def refused_by_both(ricochet, folder, text, place, *phrases):
    """Both commands refuse the study `s.yaml` with this text, in the same words, and leave nothing."""
    write(folder, "s.yaml", text)
    by_check = ricochet("check", "s.yaml", cwd=folder).expect_refused(USAGE, place, *phrases)
    by_run = ricochet("run", "s.yaml", cwd=folder).expect_refused(USAGE, place, *phrases)
    assert by_check.err == by_run.err
    assert names(folder) == ["s.yaml"], names(folder)


def refuse_all(ricochet, folder, cases):
    """Cases of (text, line, phrases...), several at a time."""

    def refuse(number, text, line, *phrases):
        own = folder / str(number)
        own.mkdir()
        refused_by_both(ricochet, own, text, f"s.yaml:{line}: ", *phrases)

    with ThreadPoolExecutor(4) as pool:
        for done in [pool.submit(refuse, i, *case) for i, case in enumerate(cases)]:
            done.result()


def refuse_variations(ricochet, folder, cases):
    """Cases of (old, new, line, phrases...), replacements in the base."""
    for old, *_ in cases:
        assert BASE.count(old) == 1, old
    refuse_all(ricochet, folder, [(BASE.replace(old, new), *rest) for old, new, *rest in cases])


def refuse_sweeps(ricochet, folder, cases):
    """Cases of (sweep, line, phrases...)."""
    head = BASE[: BASE.index("sweep:")]
    refuse_all(ricochet, folder, [(f"{head}sweep: {text}\n", *rest) for text, *rest in cases])


def test_the_base_of_all_variations_is_accepted(ricochet, folder):
    write(folder, "s.yaml", BASE)
    ricochet("check", "s.yaml", cwd=folder).expect_done()
    ricochet.run("s.yaml", cwd=folder).expect_done()


def test_unknown_keys_name_the_nearest(ricochet, folder):
    refuse_variations(
        ricochet,
        folder,
        [
            ("  gamma:", "  gama:", 7, "unknown key 'gama'", "did you mean 'gamma'?"),
            ("  period:", "  perod:", 11, "unknown key 'perod'", "did you mean 'period'?"),
            ("model:", "modle:", 3, "unknown key 'modle'", "did you mean 'model'?"),
            ("    from:", "    form:", 18, "unknown key 'form'", "did you mean 'from'?"),
        ],
    )


def test_duplicate_keys_are_refused(ricochet, folder):
    refuse_variations(
        ricochet,
        folder,
        [
            ("  floor: -1", "  gamma: 0.2", 8, "duplicate key 'gamma'", "line 7"),
            ("title: one particle", "kind: orbits", 2, "duplicate key 'kind'", "line 1"),
        ],
    )


def test_wrong_types_are_refused(ricochet, folder):
    refuse_variations(
        ricochet,
        folder,
        [
            ("gamma: 0.1", "gamma: [0.1]", 7, "model.gamma = a list", "a number >= 0"),
            ("gamma: 0.1", "gamma: {a: 1}", 7, "model.gamma = a mapping", "a number >= 0"),
            ("gamma: 0.1", 'gamma: "0.1"', 7, "a quoted string", "a number >= 0"),
            ("gamma: 0.1", "gamma:", 7, "model.gamma = null", "a number >= 0"),
            ("[15, 3]", "15", 12, "orbit.at_start = 15", "a list of integers"),
            ("states: true", "states: 1", 15, "orbit.states = 1", "true or false"),
            ("ends: periodic", "ends: ring", 6, "model.ends = ring", "periodic, fixed, free"),
            ("kind: orbits", "kind: orbit", 1, "kind = orbit", "expected one of orbits, trajectory"),
        ],
    )


def test_trailing_characters_are_refused(ricochet, folder):
    refuse_variations(
        ricochet,
        folder,
        [
            ("gamma: 0.1", "gamma: 0.1x", 7, "model.gamma = 0.1x", "a number >= 0"),
            ("1.5 pi", "1.5 pie", 11, "orbit.period = 1.5 pie", "a number > 0"),
            ("particles: 30", "particles: 30,", 5, "model.particles = 30,", "an integer from 1"),
        ],
    )


def test_infinite_numbers_and_nan_are_refused(ricochet, folder):
    refuse_variations(
        ricochet,
        folder,
        [
            *(
                ("gamma: 0.1", f"gamma: {word}", 7, f"model.gamma = {word} ", ">= 0")
                for word in (".nan", "nan", ".inf", "inf", "1e999")
            ),
            ("1.5 pi", "inf", 11, "orbit.period = inf", "> 0"),
            ("floor: -1", "floor: -.inf", 8, "model.floor = -.inf", "a number"),
            ("to: 0.187", "to: 1e999", 19, "to = 1e999", "a number"),
        ],
    )


def test_numbers_out_of_range_are_refused(ricochet, folder):
    refuse_variations(
        ricochet,
        folder,
        [
            ("gamma: 0.1", "gamma: -0.1", 7, "model.gamma = -0.1", ">= 0"),
            ("1.5 pi", "0", 11, "orbit.period = 0", "> 0"),
            ("1.5 pi", "-1.5 pi", 11, "orbit.period = -1.5 pi", "> 0"),
            ("particles: 30", "particles: 0", 5, "model.particles = 0", "from 1 to 1000000000"),
            ("particles: 30", "particles: 2.5", 5, "model.particles = 2.5", "an integer from 1"),
            ("particles: 30", "particles: -3", 5, "model.particles = -3", "an integer from 1"),
            ("particles: 30", "particles: 1e12", 5, "model.particles = 1e12", "from 1 to 1000000000"),
            ("restitution: 1", "restitution: 1.2", 9, "model.restitution = 1.2", "from 0 to 1"),
        ],
    )


def test_patterns_outside_the_chain_are_refused(ricochet, folder):
    refuse_variations(
        ricochet,
        folder,
        [
            ("[15, 3]", "[15, 30]", 12, "orbit.at_start[1] = 30", "from 0 to 29"),
            ("[15, 3]", "[15, -1]", 12, "orbit.at_start[1] = -1", ">= 0"),
            ("[15, 3]", "[15, 2.5]", 12, "orbit.at_start[1] = 2.5", "an integer"),
            ("[15, 3]", "[15, 3, 15]", 12, "orbit.at_start[2] = 15", "twice", "orbit.at_start[0]"),
            ("at_half: [4]", "at_half: [4, 3]", 13, "orbit.at_half[1] = 3", "twice", "orbit.at_start[1]"),
            ("[15, 3]\n  at_half: [4]", "[]", 12, "empty", "at least one"),
            ("floor: -1", "floor: null", 12, "orbit.at_start[0] = 15", "no floor"),
            ("floor: -1", "floor: [-1, -1]", 8, "model.floor has 2 elements", "expected 30"),
        ],
    )


def test_ranges_that_are_none_are_refused(ricochet, folder):
    refuse_sweeps(
        ricochet,
        folder,
        [
            (sweep(3, 2, 1), 16, "reversed range from 2 to 1", "from <= to"),
            (sweep(3, 1, 1), 16, "empty range from 1 to 1", "points: 1"),
            (sweep(0), 16, "points = 0", "from 1"),
            (sweep(1.5), 16, "points = 1.5", "an integer"),
            (sweep("1e12"), 16, "points = 1e12", "an integer from 1 to"),
            (sweep(3, -1, 1), 16, "model.gamma = -1", ">= 0"),
            ("{parameter: model.gamma, values: []}", 16, "values is empty", "one number or more"),
            ("{parameter: model.gamma, values: [0.1, nan]}", 16, "values[1] = nan", "a number"),
            ("{parameter: model.gamma}", 16, "missing key sweep.from", "either values"),
            ("{parameter: model.gamma, from: 0, to: 1, points: 3, scale: log}", 16, "from = 0", "> 0"),
            ("[]", 16, "sweep has 0 entries", "from 1 to 8"),
            (f"\n- {sweep('1e7')}\n- {sweep('1e7', 1, 2, 'orbit.period')}", 17, "grid points", "2^40"),
        ],
    )


def test_parameters_that_cannot_be_swept_are_refused(ricochet, folder):
    refuse_sweeps(
        ricochet,
        folder,
        [
            (sweep(3, parameter="model.gama"), 16, "'model.gama'", "did you mean 'model.gamma'?"),
            (sweep(3, parameter="colour"), 16, "'colour'", "such as model.gamma"),
            (sweep(3, parameter="model.ends"), 16, "model.ends", "a word"),
            (sweep(3, parameter="model.particles"), 16, "model.particles", "shape"),
            (sweep(3, parameter="orbit.at_start"), 16, "orbit.at_start is a list", "orbit.at_start[0]"),
            (f"\n- {sweep(3)}\n- {sweep(3)}", 18, "model.gamma is swept twice", "once"),
        ],
    )


def test_what_is_not_one_yaml_mapping_is_refused(ricochet, folder):
    cases = [
        ("", 1, "empty"),
        ("# only a comment\n", 1, "empty"),
        ("- 1\n- 2\n", 1, "a list", "mapping"),
        ("just words\n", 1, "expected a mapping"),
        ("kind: [orbits\n", 2, "not YAML"),
        ("kind: orbits\n\tmodel: 1\n", 2, "not YAML"),
        (b"\x89HDF\r\n\x1a\n\0\0", 3, "NUL"),
        (b"kind: orbits\ntitle: \xff\xfe\n", 2, "not UTF-8"),
        (BASE + "---\n" + BASE, 21, "second document"),
    ]
    refuse_all(ricochet, folder, cases)


def test_deep_nesting_is_refused_at_once(ricochet, folder):
    for depth in (33, 100000):  # the second takes libyaml's tree minutes
        refused_by_both(ricochet, folder, "model: " + "[" * depth + "]" * depth, "s.yaml:1: ", "deeper than 32")


def test_aliases_anchors_and_tags_are_refused(ricochet, folder):
    refuse_variations(
        ricochet,
        folder,
        [
            ("gamma: 0.1", "gamma: &g 0.1", 7, "anchor &g"),
            ("gamma: 0.1", "gamma: *g", 7, "alias *g"),
            ("gamma: 0.1", "gamma: !!float 0.1", 7, "tag"),
        ],
    )


def test_studies_over_8_MiB_are_refused(ricochet, folder):
    refused_by_both(ricochet, folder, BASE + "#" * (8 << 20), "s.yaml: ", "8 MiB")


def test_what_later_versions_bring_is_refused_by_name(ricochet, folder):
    later = "not in this version"
    kinds = ("atlas",)
    cases = [
        *(("kind: orbits", f"kind: {kind}", 1, f"kind = {kind}", later, "orbits") for kind in kinds),
        ("type: chain", "type: oscillator", 4, "model.type = oscillator", later, "chain"),
        ("restitution: 1", "restitution: 0.8", 9, "model.restitution = 0.8", later),
    ]
    refuse_variations(ricochet, folder, cases)


def test_assignments_are_refused_like_the_study(ricochet, folder):
    write(folder, "s.yaml", BASE)
    cases = [
        ("model.gamma=0.1x", "model.gamma = 0.1x", "a number >= 0"),
        ("model.gamma=-1", "model.gamma = -1", "a number >= 0"),
        ("model.gama=1", "unknown key 'gama'", "did you mean 'gamma'?"),
        ("model.particles=1e12", "model.particles = 1e12", "from 1 to 1000000000"),
        ("orbit.at_start[7]=1", "at_start"),
        ("sweep[0].points=1e12", "points = 1e12", "from 1 to"),
        ("model.type=oscillator", "not in this version"),
        ("orbit.method=newton", "expected one of impulse, dense, shooting, ritz"),
        ("model.gamma", "no '='", "path=value"),
        ("=3", "no path", "path=value"),
        ("model.gamma=[0.1", "not YAML"),
    ]
    for words, *phrases in cases:
        for command in ("check", "run"):
            ricochet(command, "s.yaml", "--set", words, cwd=folder).expect_refused(USAGE, f"--set {words}: ", *phrases)
    assert names(folder) == ["s.yaml"]


def test_sizes_beyond_the_memory_are_refused(ricochet, folder):
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if memory > 45e9:
        pytest.skip("this machine may well hold the largest chain there is")
    refused_by_both(ricochet, folder, BASE.replace("particles: 30", "particles: 1e9"), "s.yaml:5: ", "model.particles",
                    "GB of memory")


def test_dense_orbits_of_long_chains_are_refused(ricochet, folder):
    refused_by_both(ricochet, folder, BASE.replace("particles: 30", "particles: 100000").replace("impulse", "dense"),
                    "s.yaml:14: ", "orbit.method = dense", "method: impulse")


def test_multipliers_of_long_chains_are_refused(ricochet, folder):
    long = BASE.replace("particles: 30", "particles: 401")
    refused_by_both(ricochet, folder, long.replace("states: true", "multipliers: true"), "s.yaml:15: ",
                    "orbit.multipliers = true with 401 particles", "at most 400", "orbit.stable")
    both = long.replace("states: true", "stable: true\n  special_points: true")
    refused_by_both(ricochet, folder, both, "s.yaml:16: ", "orbit.special_points = true with orbit.stable", "400")
    write(folder, "s.yaml", long.replace("states: true", "stable: true"))
    ricochet("check", "s.yaml", cwd=folder).expect_done()


def test_results_beyond_the_disk_are_refused(ricochet, folder):
    write(folder, "s.yaml", study(1000000, sweep=sweep("1e7")))
    ricochet("run", "s.yaml", cwd=folder).expect_refused(FILES, "s.h5: ", "free")
    assert names(folder) == ["s.yaml"]


def test_studies_that_cannot_be_read_are_refused(ricochet, folder):
    (folder / "folder").mkdir()
    for command in ("check", "run"):
        ricochet(command, "nowhere.yaml", cwd=folder).expect_refused(FILES, "nowhere.yaml: ", "No such file")
        ricochet(command, "folder", cwd=folder).expect_refused(FILES, "folder: ", "directory")
    assert names(folder) == ["folder"]


def test_an_output_that_exists_is_refused_and_kept(ricochet, folder):
    write(folder, "s.yaml", BASE)
    write(folder, "s.h5", "precious")
    for ranks in (0, 2):
        refused = ricochet("run", "s.yaml", cwd=folder, ranks=ranks)
        refused.expect_refused(USAGE, "s.h5: ", "exists", "--force", "--resume")
    assert (folder / "s.h5").read_text() == "precious"
    assert names(folder) == ["s.h5", "s.yaml"]


def test_folders_that_cannot_be_written_are_refused(ricochet, folder):
    write(folder, "s.yaml", BASE)
    for output, ranks in [("/proc/x.h5", 2), ("s.yaml/x.h5", 0), ("nowhere/x.h5", 0)]:
        ricochet("run", "s.yaml", "-o", output, cwd=folder, ranks=ranks).expect_refused(FILES, output)
    assert names(folder) == ["s.yaml"]


def test_a_study_is_not_overwritten_by_its_own_result(ricochet, folder):
    text = write(folder, "s.h5", BASE).read_bytes()  # the default output of a study with this name is itself
    for words in ([], ["--force"], ["--resume"], ["-o", "./s.h5", "--force"]):
        ricochet.run("s.h5", *words, cwd=folder).expect_refused(USAGE, "s.h5: " if "-o" not in words else "./s.h5: ")
    assert (folder / "s.h5").read_bytes() == text and names(folder) == ["s.h5"]


def test_a_folder_as_output_is_refused_before_anything_is_computed(ricochet, folder):
    write(folder, "s.yaml", BASE)
    (folder / "x.h5").mkdir()
    for words in ([], ["--force"], ["--resume"]):
        result = ricochet.run("s.yaml", "-o", "x.h5", *words, cwd=folder)
        assert result.code in (USAGE, FILES), result
        result.expect_line("x.h5: ")
        assert names(folder) == ["s.yaml", "x.h5"], (words, names(folder))


def test_output_names_that_cannot_be_are_refused(ricochet, folder):
    write(folder, "s.yaml", BASE)
    ricochet("run", "s.yaml", "-o", "", cwd=folder).expect_refused(USAGE, "-o: ", "1 to")
    ricochet("run", "s.yaml", "-o", "x" * 5000, cwd=folder).expect_refused(USAGE, "-o: ", "1 to")
    result = ricochet("run", "s.yaml", "-o", "x" * 300, cwd=folder)
    result.expect_refused(FILES, "xxx", "name too long")
    assert names(folder) == ["s.yaml"]


def test_refusals_are_said_once_by_many_ranks(ricochet, folder):
    write(folder, "s.yaml", BASE.replace("0.1", "0.1x"))
    ricochet("run", "s.yaml", cwd=folder, ranks=3).expect_refused(USAGE, "s.yaml:7: ", "model.gamma = 0.1x", ">= 0")
    ricochet("run", "nowhere.yaml", cwd=folder, ranks=3).expect_refused(FILES, "nowhere.yaml: ")
    ricochet("run", "s.yaml", "--frob", cwd=folder, ranks=3).expect_refused(USAGE, "ricochet run: ", "--frob")
    assert names(folder) == ["s.yaml"]
