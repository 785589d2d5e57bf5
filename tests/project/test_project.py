"""What holds for the project as a whole: includes of the application (mpi.h in run/ only, hdf5.h in result/
only, yaml.h in study/ only, public headers of the library only, between rooms one way, and between kinds what KINDS
says), formatting, generated pages, linked libraries, the benchmark's output."""

import json
import re
import subprocess

ORDER = ["base", "study", "run", "result", "model", "kind", "command"]
FORBIDDEN = {("model", "run"), ("model", "result"), ("kind", "run")}  # what tasks compute knows no rank and no checkpoint
KINDS = {  # what the folder of a kind uses of others
    "family": {"trajectory"}, "orbits": {"trajectory"}, "trajectory": set(),
    "branch": {"family", "orbits"}, "grazing": {"family"}, "diagram": {"family", "grazing"}}  # fmt: skip
HOMES = {"mpi.h": {"run"}, "hdf5.h": {"result"}, "hdf5_hl.h": {"result"}, "yaml.h": {"study"}}


def room_and_kind(path):
    """("kind", "orbits") of kind/orbits/task.c, ("run", None) of run/lock.c."""
    return path.parts[0], path.parts[1] if path.parts[0] == "kind" and len(path.parts) == 3 else None


def complaint_about(here, name, there):
    """What is wrong with an include of a file of the application; None if nothing."""
    (room, kind), (other, other_kind) = room_and_kind(here), room_and_kind(there)
    if ORDER.index(other) > ORDER.index(room) or (room, other) in FORBIDDEN:
        return f"{here}: {room} may not include {name}"
    if kind and other_kind and other_kind != kind and other_kind not in KINDS[kind]:
        return f"{here}: the kind {kind} may not include {name}"
    return None


def violations(folder):
    for path in sorted(folder.rglob("*.[ch]")):
        here = path.relative_to(folder)
        for quote, name in re.findall(r'#include\s+([<"])([^>"]+)[>"]', path.read_text(encoding="utf-8")):
            if name in HOMES and here.parts[0] not in HOMES[name]:
                yield f"{here}: {name} belongs to {sorted(HOMES[name])}"
            found = [p for p in (path.parent / name, folder / name) if quote == '"' and p.exists()]
            if quote == '"' and not found:
                yield f"{here}: {name} is not a file of the application"
            for complaint in (complaint_about(here, name, p.resolve().relative_to(folder)) for p in found[:1]):
                if complaint:
                    yield complaint


def test_includes_of_the_application_point_one_way(source):
    found = list(violations(source / "apps" / "ricochet"))
    assert not found, "\n".join(found)


def test_sources_are_as_clang_format_leaves_them(source):
    files = [path for room in ("lib", "apps", "tests") for path in (source / room).rglob("*.[ch]")]
    done = subprocess.run(["clang-format", "--dry-run", "-Werror", *files], capture_output=True, text=True)
    assert files and done.returncode == 0, done.stderr[-2000:]


def test_files_and_functions_that_the_architecture_page_names_are_there(source):
    page = (source / "docs" / "architecture.md").read_text()
    sources = [p for room in ("lib", "apps") for p in (source / room).rglob("*") if p.suffix in (".c", ".h", ".inc")]
    text = "\n".join(p.read_text(encoding="utf-8") for p in sources)
    files = {p.name for p in sources} | set(HOMES)
    for name in re.findall(r"`(?:[\w/]+/)?(\w+\.(?:c|h|inc))`", page):
        assert name in files, name
    for name in re.findall(r"`([a-z]\w*_\w+)`", page):
        assert re.search(rf"\b{name}\b", text), name


def words_of(text, heading):
    """Names of the chapters under a heading of the study reference, in order."""
    chapter = re.search(rf"^## {heading}\n(.*?)(?=^## |\Z)", text, re.M | re.S).group(1)
    return re.findall(r"^### `[\w.]+: (\w+)`$", chapter, re.M)


def test_every_kind_and_model_has_a_chapter_with_an_example_and_a_line_of_help(ricochet, source, folder):
    reference = (source / "docs" / "studies.md").read_text()
    help_text = ricochet("--help", cwd=folder).expect_done().out
    for heading, key in (("Kinds of study", "kind"), ("Models", "model.type")):
        allowed = re.search(rf"^\| `{key}` \| one of ([\w, ]+) \|", reference, re.M).group(1).split(", ")
        assert words_of(reference, heading) == allowed
        for word in allowed:
            chapter = reference.split(f"### `{key}: {word}`")[1].split("\n##")[0]
            assert re.search(rf"```yaml\n.*\b{key.split('.')[-1]}: {word}\b.*?```", chapter, re.S), word
            assert re.search(rf"^  {word} +\w", help_text, re.M), word


def test_examples_of_the_study_reference_are_studies(ricochet, source, folder):
    examples = re.findall(r"```yaml\n(.*?)```", (source / "docs" / "studies.md").read_text(), re.S)
    assert examples
    for example in examples:
        (folder / "example.yaml").write_text(example)
        ricochet("check", "example.yaml", cwd=folder).expect_done()


def test_the_study_reference_is_what_the_schema_table_prints(ricochet, source, folder):
    """To renew it: ricochet check --reference > docs/studies.md."""
    printed = ricochet("check", "--reference", cwd=folder).expect_done().out
    assert printed == (source / "docs" / "studies.md").read_text()


def test_the_schema_page_is_what_the_lists_of_columns_print(ricochet, source, folder):
    """To renew it: ricochet show --reference > docs/results.md."""
    printed = ricochet("show", "--reference", cwd=folder).expect_done().out
    assert printed == (source / "docs" / "results.md").read_text()


def test_every_axis_of_the_schema_page_is_in_its_table_of_scales(source):
    page = (source / "docs" / "results.md").read_text()
    scales = re.search(r"^\| scale \| meaning \|\n(.*?)\n\n", page, re.M | re.S).group(1)
    listed = {name for line in scales.splitlines() for name in re.findall(r"`/(\w+)`", line.split(" | ")[0])}
    used = {name for axes in re.findall(r"^\| `/[\w/]+` \| \[(.*?)\] \|", page, re.M) for name in axes.split(", ")}
    assert used == listed and len(used) > 20, used ^ listed


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
