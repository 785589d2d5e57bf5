"""What holds for the project as a whole: includes of the application (mpi.h in run/ and result/ only, hdf5.h in result/
only, yaml.h in study/ only, public headers of the library only, and between rooms only towards
base <- study <- task, run <- result <- command), formatting, generated pages, linked libraries, the benchmark's output."""

import json
import re
import subprocess

ALLOWED = {"base": {"base"}, "study": {"base", "study"}, "task": {"base", "study", "task"},
           "run": {"base", "study", "run"}, "result": {"base", "study", "task", "run", "result"},
           "command": {"base", "study", "task", "run", "result", "command"}}
HOMES = {"mpi.h": {"run", "result"}, "hdf5.h": {"result"}, "hdf5_hl.h": {"result"}, "yaml.h": {"study"}}


def violations(folder):
    for path in sorted(folder.glob("*/*.[ch]")):
        room = path.parent.name
        for name in re.findall(r'#include\s+[<"]([^>"]+)[>"]', path.read_text(encoding="utf-8")):
            if name in HOMES and room not in HOMES[name]:
                yield f"{path}: {name} belongs to {sorted(HOMES[name])}"
            other = re.match(r"(?:\.\./)?(\w+)/\w+\.h$", name)
            if other and other[1] in ALLOWED and other[1] not in ALLOWED[room]:
                yield f"{path}: {room} may not include {name}"
            if re.search(r"(model|flow|orbit)/", name):
                yield f"{path}: {name} is internal to the library"


def test_includes_of_the_application_point_one_way(source):
    found = list(violations(source / "apps" / "ricochet"))
    assert not found, "\n".join(found)


def test_sources_are_as_clang_format_leaves_them(source):
    files = [path for room in ("lib", "apps", "tests", "examples") for path in (source / room).rglob("*.[ch]")]
    done = subprocess.run(["clang-format", "--dry-run", "-Werror", *files], capture_output=True, text=True)
    assert files and done.returncode == 0, done.stderr[-2000:]


def test_the_study_reference_is_what_the_schema_table_prints(ricochet, source, folder):
    """To renew it: ricochet check --reference > docs/studies.md."""
    printed = ricochet("check", "--reference", cwd=folder).expect_done().out
    assert printed == (source / "docs" / "studies.md").read_text()


def test_no_fortran_runtime_is_behind_any_binary(build):
    for binary in ("ricochet", "ricochet_bench", "libricochet.so"):
        linked = subprocess.run(["ldd", build / "bin" / binary], check=True, capture_output=True, text=True).stdout
        assert "libc.so" in linked and "gfortran" not in linked, (binary, linked)


def test_the_benchmark_prints_one_json_line_per_scenario(build):
    program = build / "bin" / "ricochet_bench"
    done = subprocess.run([program, "table", "ring_prime"], check=True, capture_output=True, text=True)
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    assert [r["scenario"] for r in rows] == ["table", "ring_prime"], rows
    assert all(r["seconds"] > 0 and r["repeats"] > 0 and r["tasks"] > 0 and r["n"] > 0 for r in rows), rows
    unknown = subprocess.run([program, "no_such_scenario"], capture_output=True, text=True)
    assert unknown.returncode == 2 and "no such scenario" in unknown.stderr
