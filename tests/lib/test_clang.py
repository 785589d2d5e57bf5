"""Every file of the library compiles with clang where that is installed, without a word about what is not declared:
glibc has macros for GCC alone."""

import json
import shlex
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest

KEPT = ("-I", "-D", "-std=", "-isystem")


@pytest.fixture
def clang():
    return shutil.which("clang") or pytest.skip("clang is not installed")


def options_of(command):
    """Those that say what is compiled; warnings and the level of optimisation are a compiler's own."""
    words = shlex.split(command)
    found = [word for word in words if word.startswith(KEPT)]
    return found + [other for word, after in zip(words, words[1:]) if word == "-isystem" for other in [after]]


def test_the_library_compiles(clang, build, source):
    def compiled(entry):
        words = [clang, *options_of(entry["command"]), "-fsyntax-only", "-Werror=implicit-function-declaration"]
        return subprocess.run([*words, entry["file"]], cwd=entry["directory"], capture_output=True, text=True)

    entries = json.loads((build / "compile_commands.json").read_text())
    entries = [entry for entry in entries if entry["file"].startswith(str(source / "lib"))]
    with ThreadPoolExecutor() as workers:
        trouble = [done.stderr for done in workers.map(compiled, entries) if done.returncode]
    assert len(entries) > 50 and not trouble, "\n".join(trouble)[:4000]
