#!/bin/sh
# docs/studies.md is what the schema table prints. To renew it: ricochet check --reference > docs/studies.md
set -eu
"$1" check --reference | diff -u "$2/docs/studies.md" -
