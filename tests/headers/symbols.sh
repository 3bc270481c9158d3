#!/bin/sh
# symbols.sh libkiln.so kiln include/kiln: the library exports what the public headers declare, no less and no more, and
# no function of the program has the name of one in a library that it loads: the wrong one would be called.
set -eu
library=$1 program=$2 headers=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

nm -D --defined-only "$library" | awk '{print $3}' | LC_ALL=C sort > "$work/exported"
cat "$headers"/*.h | tr '\n' ' ' | grep -oE 'KILN_API [^;(]*\(' | grep -oE 'kiln_[a-z0-9_]+\($' | tr -d '(' |
  LC_ALL=C sort -u > "$work/declared"
if ! diff "$work/declared" "$work/exported" > "$work/difference"; then
  echo 'declared with KILN_API (<) and exported by the library (>) differ:'
  cat "$work/difference"
  exit 1
fi
[ "$(wc -l < "$work/exported")" -gt 50 ]

nm --defined-only "$program" | awk '$2 == "T" {print $3}' | grep -vE '^(_init|_fini|_start|main|__)' | LC_ALL=C sort -u > "$work/own"
ldd "$program" | awk '/=> \// {print $3}' | while read -r loaded; do
  nm -D --defined-only "$loaded" | awk '$2 ~ /^[TWi]$/ {print $3}' | sed 's/@.*//' | LC_ALL=C sort -u > "$work/theirs"
  LC_ALL=C comm -12 "$work/own" "$work/theirs" | grep -v '^_Z' | sed "s|^|$loaded: |"
done > "$work/clashes"
if [ -s "$work/clashes" ]; then
  echo 'functions of the program with names of loaded libraries:'
  cat "$work/clashes"
  exit 1
fi
