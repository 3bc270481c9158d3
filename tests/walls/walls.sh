#!/bin/sh
# The walls of the architecture, as far as text shows them: walls.sh ROOT prints every breach as "file:line: rule" and
# fails if there is one. docs/architecture.md says what the walls are for.
# shellcheck disable=SC2086,SC2016,SC2038 # word lists, regular expressions, and file names without spaces
set -eu
cd "$1"

libraries='base image scene importers render color job'
breaches=$(mktemp)
trap 'rm -f "$breaches"' EXIT

# Lines of `grep -n` on standard input are breaches of a rule.
breach() { sed -E "s#^(\./)?([^:]*:[0-9]+):.*#\2: $1#" >>"$breaches"; }

# What a folder's files may include from other folders, itself included; public headers are looked at by name.
beneath() {
  case $1 in
    base) echo base ;;
    image) echo image base ;;
    scene) echo scene base ;;
    importers | render | color) echo "$1 scene image base" ;;
    job) echo job importers render color scene image base ;;
    cli) echo cli job importers render color scene image base ;;
  esac
}

# Public headers stand on the same levels as the folders that implement them.
public_beneath() {
  low='api|report'
  case $1 in
    base) echo "$low" ;;
    image) echo "$low|image|compare" ;;
    scene) echo "$low|image|material|mesh|scene|render" ;; # render.h: kiln_decoding
    importers) echo "$low|image|material|mesh|scene|import" ;;
    render) echo "$low|difference|effects|film|image|material|mesh|render|scene" ;;
    color) echo "$low|image|material|mesh|scene|render|color" ;;
    job | cli) echo '[a-z]+' ;;
  esac
}

sources() { find "$@" -name '*.[ch]' -o -name '*.cpp' -o -name '*.hpp' 2>/dev/null; }

check_includes() {
  for folder in $libraries cli; do
    [ -d "$folder" ] || continue
    inside=$(beneath "$folder" | tr ' ' '|')
    sources "$folder" | xargs -r grep -nHE '#include "' |
      grep -vE "#include \"(($inside)/[a-z0-9_/]+\.hp?p?|kiln/($(public_beneath "$folder"))\.h)\"" |
      breach "$folder must not include this"
  done
  # The parts of importers: gltf and subdiv stand on mesh and know nothing of each other.
  sources importers/gltf | xargs -r grep -nHE '#include "importers/subdiv/' | breach 'gltf must not know subdiv'
  sources importers/subdiv | xargs -r grep -nHE '#include "importers/gltf/' | breach 'subdiv must not know gltf'
  sources importers/mesh | xargs -r grep -nHE '#include "importers/(gltf|subdiv)/' | breach 'mesh must not know formats'
  sources include | xargs -r grep -nHE '#include "' | grep -vE '#include "kiln/[a-z]+\.h"' |
    breach 'public headers include public headers alone'
  sources examples | xargs -r grep -nHE '#include "' | grep -vE '#include "kiln/[a-z]+\.h"' |
    breach 'examples know the public headers alone'
}

# Each library has one folder that knows it.
check_library() { # headers, folders where they may be included
  sources $libraries cli include examples | grep -vE "^($2)" | xargs -r grep -nHE "#include <($1)" |
    breach "only $2 may include this"
}
check_libraries() {
  check_library 'embree[0-9]*/' 'render/accel/embree\.h'
  check_library 'tiny_gltf' 'importers/gltf/'
  check_library 'opensubdiv/' 'importers/subdiv/'
  check_library 'OpenColorIO/' 'color/'
  check_library 'png\.h|jpeglib|jerror|tiffio|webp/|openexr|OpenEXR' 'image/'
  check_library 'jansson' '(job|cli)/'
}

check_cpp() {
  find $libraries cli include examples \( -name '*.cpp' -o -name '*.hpp' -o -name '*.cc' -o -name '*.cxx' \) 2>/dev/null |
    grep -vE '^(importers/gltf|importers/subdiv|color)/' | sed 's/$/:1:/' |
    breach 'C++ belongs to importers\/gltf, importers\/subdiv and color'
}

# Link lists: the kiln_… words of a folder's CMake files.
check_links() {
  for folder in $libraries; do
    [ -d "$folder" ] || continue
    inside="flags|module|$(beneath "$folder" | tr ' ' '|')"
    case $folder in
      importers) inside="$inside|gltf|subdiv|mesh|importers" ;;
      render) inside="$inside|path_[a-z0-9$\{\}]+" ;;
      job) inside="$inside|gltf|subdiv|mesh" ;;
    esac
    find "$folder" -name CMakeLists.txt | xargs -r grep -noHE '\bkiln_[a-z0-9_${}]+' |
      grep -vE ":kiln_($inside)$" | breach "$folder must not link this"
  done
  find importers/gltf importers/mesh -name CMakeLists.txt 2>/dev/null | xargs -r grep -nHE 'kiln_subdiv' |
    breach 'gltf and mesh must not link subdiv'
  find importers/subdiv importers/mesh -name CMakeLists.txt 2>/dev/null | xargs -r grep -nHE 'kiln_gltf' |
    breach 'subdiv and mesh must not link gltf'
}

check_habits() {
  # A library neither prints nor ends the process; asserts stay, for mistakes of our own.
  sources $libraries |
    xargs -r grep -nHE '(^|[^a-zA-Z0-9_])(v?f?printf|puts|fputs|putchar|perror|exit|_exit|abort|quick_exit)[[:space:]]*\(' |
    breach 'a library neither prints nor exits'
  sources cli | grep -v '^cli/main\.c$' | xargs -r grep -nHE '(^|[^a-zA-Z0-9_])(exit|abort|quick_exit)[[:space:]]*\(' |
    breach 'only cli\/main.c may exit'
  written=$(find . \( -path ./build -o -path ./out -o -path ./.git -o -path ./tests/data -o -path ./tests/walls \) -prune \
    -o -type f \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.hpp' -o -name '*.py' -o -name '*.sh' -o -name '*.cmake' \
    -o -name 'CMakeLists.txt' -o -name '*.md' -o -path './script/*' -o -path './.ci/*' \) -print)
  echo "$written" | xargs grep -nHE '^[[:space:]]*#[[:space:]]*if 0|TODO|FIXME' | breach 'finish it or leave it out'
  echo "$written" | xargs grep -nHE '(^|[^A-Za-z0-9_.~$}/-])/(work|home|root|Users)/' | breach 'a path of one machine'
  echo "$written" | grep -v '_table\.[ch]$' | xargs wc -l | awk '$2 != "total" && $1 > 500 { print $2 ":" $1 ":" }' |
    breach 'more than 500 lines'
}

check_includes
check_libraries
check_cpp
check_links
check_habits
sort -u "$breaches"
[ ! -s "$breaches" ]
