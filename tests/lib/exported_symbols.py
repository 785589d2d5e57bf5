"""Fails when the shared library exports a name without the prefix ric_, or none at all."""
import subprocess
import sys

nm, library = sys.argv[1:]
lines = subprocess.run([nm, "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
names = [line.split()[-1].split("@")[0] for line in lines.splitlines()]
# What a sanitizer adds is not the library's.
strangers = [n for n in names if not n.startswith(("ric_", "__asan", "__ubsan", "_init", "_fini"))]
print(f"{len(names)} exported names", *strangers, sep="\n")
sys.exit(1 if strangers or not names else 0)
