#!/bin/sh
# walls.sh must see every breach: a tree is planted with a file for each rule that breaks it, in a folder of its own
# ("scene/a.c" becomes "scene/7/a.c"), and with files that break none.
set -eu
walls=$(dirname "$0")/walls.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
number=0
: >"$tree/wanted"

plant() { # path, text
  mkdir -p "$tree/$(dirname "$1")"
  printf '%s\n' "$2" >"$tree/$1"
}

sees() { # path, text, what walls.sh must say of it
  number=$((number + 1))
  path=$(dirname "$1")/$number/$(basename "$1")
  plant "$path" "$2"
  echo "$path $3" >>"$tree/wanted"
}

sees base/a.c '#include "scene/scene.h"' 'base must not include'
sees base/a.h '#include "kiln/scene.h"' 'base must not include'
sees image/a.c '#include "scene/scene.h"' 'image must not include'
sees scene/a.h '#include "image/image.h"' 'scene must not include'
sees importers/gltf/a.c '#include "render/render.h"' 'importers must not include'
sees importers/import.c '#include "kiln/film.h"' 'importers must not include'
sees render/path/a.c '#include "importers/mesh/complete.h"' 'render must not include'
sees render/a.c '#include "color/color.h"' 'render must not include'
sees color/a.cpp '#include "render/render.h"' 'color must not include'
sees job/a.c '#include "cli/print.h"' 'job must not include'
sees scene/a.c '#include "scene.h"' 'scene must not include'
sees scene/a.c '#include "../base/arena.h"' 'scene must not include'
sees importers/gltf/a.cpp '#include "importers/subdiv/osd.h"' 'gltf must not know subdiv'
sees importers/subdiv/a.c '#include "importers/gltf/gltf.h"' 'subdiv must not know gltf'
sees importers/mesh/a.c '#include "importers/gltf/gltf.h"' 'mesh must not know formats'
sees include/kiln/a.h '#include "base/vec.h"' 'public headers include'
sees examples/a.c '#include "scene/scene.h"' 'examples know'
sees render/path/a.c '#include <embree4/rtcore.h>' 'only render/accel/embree'
sees importers/import.c '#include <tiny_gltf.h>' 'only importers/gltf'
sees render/a.c '#include <opensubdiv/far/topologyRefiner.h>' 'only importers/subdiv'
sees importers/gltf/a.c '#include <png.h>' 'only image'
sees job/a.c '#include <OpenColorIO/OpenColorIO.h>' 'only color'
sees render/a.c '#include <jansson.h>' 'only (job'
sees render/a.cpp 'int x;' 'C++ belongs'
sees scene/a.hpp 'int x;' 'C++ belongs'
sees base/CMakeLists.txt 'kiln_module(base USES kiln_scene)' 'base must not link'
sees render/CMakeLists.txt 'kiln_module(render USES kiln_color)' 'render must not link'
sees importers/CMakeLists.txt 'kiln_module(importers USES kiln_render)' 'importers must not link'
sees importers/subdiv/CMakeLists.txt 'kiln_module(subdiv USES kiln_gltf)' 'subdiv and mesh must not link'
sees importers/gltf/CMakeLists.txt 'kiln_module(gltf USES kiln_subdiv)' 'gltf and mesh must not link'
sees scene/a.c '  printf ("x");' 'a library neither prints'
sees job/a.c 'if (x) abort();' 'a library neither prints'
sees render/a.c 'fprintf(stderr, "x");' 'a library neither prints'
sees cli/render.c 'exit(1);' 'only cli/main.c may exit'
sees scene/a.c '# if 0' 'finish it'
sees docs/a.md 'FIX''ME' 'finish it'
sees tests/a.c '/* TO''DO */' 'finish it'
sees tests/a.c 'open("/ho''me/me/x.glb")' 'a path of one machine'
sees scene/a.c "$(yes 'int x;' | head -n 501)" 'more than 500 lines'

plant scene/a.c '#include "base/arena.h"'
plant base/a.c 'snprintf(text, 4, "x"); path_exit(1);'
plant cli/main.c 'exit(1);'
plant render/albedo_table.c "$(yes 'int x;' | head -n 501)"
plant importers/gltf/a.cpp '#include <tiny_gltf.h>'

said=$(sh "$walls" "$tree") && { echo 'walls.sh sees no breach at all'; exit 1; }
failed=0
while read -r path wanted; do
  echo "$said" | grep -F "$path:" | grep -qF ": $wanted" || { echo "$path: walls.sh does not say '$wanted'"; failed=1; }
done <"$tree/wanted"
while read -r line; do
  grep -qF "${line%%:*} " "$tree/wanted" || { echo "walls.sh must let this pass: $line"; failed=1; }
done <<END
$said
END
exit "$failed"
