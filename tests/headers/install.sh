#!/bin/sh
# install.sh BUILD SOURCE CC: what is installed is enough to build an example with pkg-config, and to run it.
set -eu
build=$1 source=$2 cc=$3
command -v pkg-config > /dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/usr" > "$work/log" || { cat "$work/log"; exit 1; }
pc=$(find "$work/usr" -name kiln.pc)
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046 # words
"$cc" -std=c11 -Wall -Wextra -Werror "$source/examples/minimal.c" $(pkg-config --cflags kiln) -o "$work/minimal" $(pkg-config --libs kiln)
LD_LIBRARY_PATH=$(dirname "$(dirname "$pc")") "$work/minimal" "$source/tests/data/gltf/pairs/unlit_a.gltf" "$work/a.png"
[ -s "$work/a.png" ]
"$work/usr/bin/kiln" version | grep -q '^kiln '
