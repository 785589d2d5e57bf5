"""What the stress of threads calls: functions of every public header that has some that can fail, so of every room."""

import re
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TESTS / "lib"))

from null_calls import functions_of  # noqa: E402  # behind the path to it


def test_the_stress_calls_functions_of_every_header(source):
    listed = (source / "tests" / "threads" / "CMakeLists.txt").read_text()
    benchmarks = [source / "apps" / "ricochet_bench" / name for name in re.findall(r"\$\{bench\}/(\w+\.c)", listed)]
    files = [*benchmarks, *(source / "tests" / "threads").glob("*.c"), *(source / "tests" / "scenario").glob("*.c")]
    called = {name for path in files for name in re.findall(r"\bric_\w+(?=\()", path.read_text())}
    idle = []
    for header in sorted((source / "lib" / "include" / "ricochet").glob("*.h")):
        names = {f.name for f in functions_of(header.read_text()) if f.can_fail and not f.name.endswith("_check")}
        if names and not names & called:
            idle.append(header.name)
    assert len(files) > 10 and not idle, idle
