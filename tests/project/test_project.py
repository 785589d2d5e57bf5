"""Includes of the application: mpi.h in run/ and result/ only, hdf5.h in result/ only, yaml.h in study/ only, public
headers of the library only, and between rooms only towards study <- task, run <- result <- command."""
import pathlib
import re
import sys

ALLOWED = {"study": {"study"}, "task": {"task", "study"}, "run": {"run", "study"},
           "result": {"result", "study", "task", "run"}, "command": {"command", "study", "task", "run", "result"}}
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


found = list(violations(pathlib.Path(sys.argv[1]) / "apps" / "ricochet"))
print("\n".join(found))
print(f"{int(not found)} passed, {len(found)} failed")
sys.exit(bool(found))
