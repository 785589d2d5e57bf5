#!/bin/sh
# No Fortran runtime behind any binary.
set -eu
for binary in "$@"; do
  if ldd "$binary" | grep -i gfortran; then
    echo "$binary links a Fortran library"
    exit 1
  fi
done
