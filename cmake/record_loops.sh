#!/bin/sh
# A compiler launcher: runs gcc with -fopt-info-vec-optimized-missed and keeps what it says of loops beside the object,
# OBJECT.loops; what else it says is said. A file of gcc's own would be missing where a compiler cache has the object.
set -u
object=
previous=
for word; do
  [ "$previous" = -o ] && object=$word
  previous=$word
done
"$@" 2>"$object.loops"
status=$?
grep -vE ': (optimized|missed): |^ scalar_type: ' "$object.loops" >&2
exit "$status"
