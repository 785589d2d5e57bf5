"""Usage of the four commands: help, what they complain about, what they print, and that only `run` starts MPI."""


import resource

import pytest
import program
from program import DONE, FILES, RUN, USAGE, names, study, sweep, write

COMMANDS = ("run", "check", "show", "examples")
NO_MPI = {"OMPI_MCA_pml": "nonexistent"}  # MPI_Init fails


def result_in(ricochet, folder, text=None):
    write(folder, "s.yaml", text or study(sweep=sweep(3)))
    ricochet.run("s.yaml", cwd=folder).expect_done()
    return folder / "s.h5"


def test_every_command_explains_itself(ricochet, folder):
    for words in [["--help"], ["-h"], *([command, "--help"] for command in COMMANDS)]:
        result = ricochet(*words, cwd=folder).expect(DONE)
        assert result.out.startswith("usage: ricochet") and result.err == "", result
    for option in ("--resume", "--force", "--checkpoint", "--max-time", "--progress", "--set", "-o", "75"):
        assert option in ricochet("run", "--help", cwd=folder).out, option


def test_no_command_shows_the_usage(ricochet, folder):
    result = ricochet(cwd=folder).expect(USAGE)
    assert result.err.startswith("usage: ricochet") and result.out == "", result


def test_version_names_its_libraries(ricochet, folder):
    out = ricochet("--version", cwd=folder).expect(DONE).out
    for name in ("ricochet ", "GSL ", "FFTW ", "SUNDIALS ", "HDF5 ", "MPI ", "libyaml "):
        assert name in out, (name, out)


def test_unknown_commands_and_options_are_named(ricochet, folder):
    write(folder, "s.yaml", study())
    for words, wrong in [
        (["frob"], "frob"),
        (["--frob"], "--frob"),
        (["run", "--frob", "s.yaml"], "--frob"),
        (["run", "s.yaml", "--frob"], "--frob"),
        (["run", "s.yaml", "-x"], "-x"),
        (["check", "s.yaml", "--frob"], "--frob"),
        (["check", "-x", "s.yaml"], "-x"),
        (["show", "s.h5", "--frob"], "--frob"),
        (["examples", "--frob"], "--frob"),
        (["examples", "nope"], "nope"),
    ]:
        ricochet(*words, cwd=folder).expect_refused(USAGE, "ricochet", wrong)
    assert names(folder) == ["s.yaml"]


def test_missing_values_are_named(ricochet, folder):
    write(folder, "s.yaml", study())
    for command, option in [
        ("run", "--set"),
        ("run", "-o"),
        ("run", "--output"),
        ("run", "--checkpoint"),
        ("run", "--max-time"),
        ("run", "--progress"),
        ("check", "--set"),
    ]:
        ricochet(command, "s.yaml", option, cwd=folder).expect_refused(USAGE, f"ricochet {command}: ", option, "value")
    assert names(folder) == ["s.yaml"]


def test_wrong_values_are_named_with_what_is_allowed(ricochet, folder):
    write(folder, "s.yaml", study())
    for option in ("--max-time", "--checkpoint"):
        for value in ("0", "-5s", "5x", "nan", "inf", "", "1e999", "s"):
            refused = ricochet("run", "s.yaml", option, value, cwd=folder)
            refused.expect_refused(USAGE, f"{option} {value}: ", "30s, 55m or 2h")
    refused = ricochet("run", "s.yaml", "--progress", "perhaps", cwd=folder)
    refused.expect_refused(USAGE, "--progress perhaps: ", "auto, always or never")
    assert names(folder) == ["s.yaml"]


def test_the_number_of_files_is_checked(ricochet, folder):
    write(folder, "s.yaml", study())
    for command in ("run", "check", "show"):
        ricochet(command, cwd=folder).expect_refused(USAGE, f"ricochet {command}: ", "given")
        ricochet(command, "s.yaml", "s.yaml", cwd=folder).expect_refused(USAGE, f"ricochet {command}: ", "given")
    ricochet("examples", "table", "grid", cwd=folder).expect_refused(USAGE, "ricochet examples: ", "given")
    ricochet("run", "s.yaml", "--resume", "--force", cwd=folder).expect_refused(USAGE, "ricochet run: ", "exclude")
    assert names(folder) == ["s.yaml"]


def test_nothing_starts_mpi_but_a_run_of_a_launcher(ricochet, folder):
    result_in(ricochet, folder)
    # The control: in this environment MPI does not start.
    assert ricochet("run", "s.yaml", "--force", "--mpi", "on", cwd=folder, env=NO_MPI).code != DONE
    for sign in ("OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_FD"):
        launched = ricochet("run", "s.yaml", "--force", cwd=folder, env={**NO_MPI, sign: "1"})
        assert launched.code != DONE, launched
        ricochet("run", "s.yaml", "--force", "--mpi", "off", cwd=folder, env={**NO_MPI, sign: "1"}).expect(DONE)
    for words in [
        ["run", "s.yaml", "--force"],
        ["check", "s.yaml"],
        ["show", "s.h5"],
        ["show", "s.h5", "--csv"],
        ["show", "s.h5", "--verify"],
        ["examples"],
        ["examples", "table"],
        ["--version"],
        ["run", "--help"],
    ]:
        ricochet(*words, cwd=folder, env=NO_MPI).expect(DONE)


def test_check_says_what_a_run_will_take(ricochet, folder):
    write(folder, "s.yaml", study(sweep=f"\n- {sweep(7)}\n- {sweep(3, 4, 5, 'orbit.period')}"))
    out = ricochet("check", "s.yaml", cwd=folder).expect(DONE).out
    assert program.only(out, r"tasks +(\d+)") == "21"
    for phrase in ("s.yaml", "orbits", "model.gamma: 7 values from 0 to 0.187", "memory", "result"):
        assert phrase in out, (phrase, out)
    assert names(folder) == ["s.yaml"]


def test_check_knows_the_size_of_the_result(ricochet, folder):
    path = result_in(ricochet, folder, study(particles=100, sweep=sweep(2000)))
    out = ricochet("check", "s.yaml", cwd=folder).expect(DONE).out
    number, unit = program.only(out, r"result +([\d.]+) (\w+)")
    said = float(number) * {"B": 1, "kB": 1e3, "MB": 1e6, "GB": 1e9}[unit]
    assert 0.8 < said / path.stat().st_size < 1.25, (said, path.stat().st_size)


def test_the_reference_has_every_key(ricochet, folder):
    out = ricochet("check", "--reference", cwd=folder).expect(DONE).out
    for key in ("kind", "model.particles", "model.gamma", "orbit.period", "orbit.at_start", "parameter", "points"):
        assert f"`{key}`" in out, key


def test_examples_are_the_shipped_studies(ricochet, folder):
    shipped = sorted(path.stem for path in ricochet.studies.glob("*.yaml"))
    listed = [line.split()[0] for line in ricochet("examples", cwd=folder).expect(DONE).out.splitlines()]
    assert sorted(listed) == shipped, (listed, shipped)
    for name in shipped:
        out = ricochet("examples", name, cwd=folder).expect(DONE).out
        assert out == (ricochet.studies / f"{name}.yaml").read_text(), name


def test_examples_can_be_piped_into_check_and_run(ricochet, folder):
    text = ricochet("examples", "table", cwd=folder).expect(DONE).out
    assert "tasks   15" in ricochet("check", "/dev/stdin", cwd=folder, stdin=text).expect(DONE).out
    for ranks in (0, 2):
        ricochet.run("/dev/stdin", "-o", f"{ranks}.h5", cwd=folder, stdin=text, ranks=ranks).expect_done()
    assert names(folder) == ["0.h5", "2.h5"]


def test_the_output_is_named_after_the_study_in_the_current_folder(ricochet, folder):
    (folder / "studies").mkdir()
    write(folder / "studies", "my.first.study.yaml", study())
    ricochet.run("studies/my.first.study.yaml", cwd=folder).expect_done()
    assert names(folder) == ["my.first.study.h5", "studies"]
    assert names(folder / "studies") == ["my.first.study.yaml"]


def test_the_last_line_counts_outcomes_and_names_the_result(ricochet, folder):
    write(folder, "s.yaml", study(at_start="[15]", sweep=sweep(11, 0, 0.5)))
    out = ricochet.run("s.yaml", cwd=folder).expect_done().out
    assert out.startswith("11 tasks: ") and " -> s.h5 (" in out and "inadmissible" in out, out
    assert len(out.splitlines()) == 1


def test_progress_is_silent_on_request_and_a_bar_when_asked(ricochet, folder):
    write(folder, "s.yaml", study(sweep=sweep(100)))
    assert ricochet("run", "s.yaml", "--progress", "never", cwd=folder).expect_done().err == ""
    for ranks in (0, 2):
        shown = ricochet("run", "s.yaml", "--force", "--progress", "always", cwd=folder, ranks=ranks).expect_done().err
        assert "\r" in shown and "100/100" in shown and shown.endswith("\n"), shown
    lines = ricochet("run", "s.yaml", "--force", cwd=folder).expect_done().err
    assert "\r" not in lines and len(lines.splitlines()) <= 2, lines


def test_show_lists_parameters_columns_and_outcomes(ricochet, folder):
    result_in(ricochet, folder, study(at_start="[15]", orbit="special_points: true", sweep=sweep(251, 0, 0.25)))
    out = ricochet("show", "s.h5", cwd=folder).expect(DONE).out
    for phrase in (
        "model.gamma: 251 values from 0 to 0.25",
        "/orbits",
        "[task 251, particle 30]",
        "admissible ",
        "inadmissible ",
        "/special",
        "resonance ",
    ):
        assert phrase in out, (phrase, out)


def test_show_verify_finds_a_whole_result_sound(ricochet, folder):
    result_in(ricochet, folder)
    assert ricochet("show", "s.h5", "--verify", cwd=folder).expect(DONE).out == "s.h5: sound\n"


def test_show_refuses_what_is_no_result(ricochet, folder):
    write(folder, "s.yaml", study())
    write(folder, "empty.h5", "")
    with program.h5py.File(folder / "other.h5", "w") as file:
        file["x"] = [1.0, 2.0]
    for name in ("s.yaml", "empty.h5", "other.h5", "nowhere.h5", "."):
        for option in ([], ["--csv"], ["--verify"]):
            ricochet("show", name, *option, cwd=folder).expect_refused(FILES, f"{name}: ")


def test_show_names_a_group_that_is_not_there(ricochet, folder):
    result_in(ricochet, folder)
    refused = ricochet("show", "s.h5", "--csv=nowhere", cwd=folder)
    assert refused.code in (USAGE, FILES), refused
    refused.expect_line("s.h5: ", "nowhere")


def test_a_full_standard_output_is_reported(ricochet, folder):
    result_in(ricochet, folder)
    for words in [["check", "s.yaml"], ["show", "s.h5"], ["show", "s.h5", "--csv"], ["examples"], ["--version"]]:
        with open("/dev/full", "w") as full:
            ricochet(*words, cwd=folder, out=full).expect(FILES).expect_line("ricochet: ", "standard output")


def test_show_into_a_closed_pipe_does_not_hang(ricochet, folder):
    result_in(ricochet, folder, study(sweep=sweep(20000), orbit="states: false"))
    process = ricochet.start("show", "s.h5", "--csv", cwd=folder)
    process.stdout.readline()
    process.stdout.close()
    process.stdout = None
    assert ricochet.end(process).code in (FILES, -program.signal.SIGPIPE)


def test_a_run_without_memory_says_so_and_leaves_nothing(ricochet, folder):
    if b"__asan_init" in ricochet.binary.read_bytes():
        pytest.skip("AddressSanitizer needs more address space than this test leaves")

    def little_memory():
        # MPI starts in this much address space; four numbers per particle do not fit.
        resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))

    write(folder, "s.yaml", study(particles="5e7", orbit="states: false"))
    result = ricochet.run("s.yaml", cwd=folder, before=little_memory)
    result.expect(RUN).expect_line("s.yaml: ", "memory")
    assert names(folder) == ["s.yaml"], names(folder)
