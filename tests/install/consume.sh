#!/bin/sh
# Installs the library into a folder of its own and builds a stand-alone consumer against it, once through the CMake
# package and once through pkg-config. usage: consume.sh BUILD_DIR SOURCE_DIR
set -eu
build=$1
here=$2/tests/install
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
expected="admissible, speed after the impact 0.823195058650"

run() {
  said=$(LD_LIBRARY_PATH="$libdir" "$1")
  [ "$said" = "$expected" ] || { echo "consumer said: $said"; exit 1; }
}

cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"
libdir=$(dirname "$(find "$work/prefix" -name 'libricochet.*' | head -n 1)")

cmake -G Ninja -S "$here/consumer" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/configure.log"
cmake --build "$work/consumer" >"$work/build.log"
run "$work/consumer/consumer"

# The .pc file names the prefix of the configuration, not of this installation: override it.
export PKG_CONFIG_PATH="$libdir/pkgconfig"
flags=$(pkg-config --define-variable=includedir="$work/prefix/include" --define-variable=libdir="$libdir" \
  --cflags --libs ricochet)
# shellcheck disable=SC2086 # the flags are words
cc -std=c17 -o "$work/by_pkg_config" "$here/consumer/consumer.c" $flags
run "$work/by_pkg_config"
echo "2 passed, 0 failed"
