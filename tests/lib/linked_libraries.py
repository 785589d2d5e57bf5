"""Fails when the shared library drags in a library that a C library has no use for."""
import subprocess
import sys

UNWANTED = ("libgfortran", "libstdc++", "libmpi", "libhdf5", "libyaml", "libpython")

ldd, library = sys.argv[1:]
text = subprocess.run([ldd, library], check=True, capture_output=True, text=True).stdout
found = [line.strip() for line in text.splitlines() if line.strip().startswith(UNWANTED)]
print(text if not found else "\n".join(found))
sys.exit(1 if found or "libfftw3" not in text else 0)
