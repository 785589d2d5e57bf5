#!/bin/sh
# Every C file is as clang-format leaves it.
set -eu
find "$1/lib" "$1/apps" "$1/tests" -name '*.[ch]' -exec clang-format --dry-run -Werror {} +
