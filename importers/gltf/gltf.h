/* importers/gltf/gltf.h: glTF 2.0 into a scene. */
#ifndef KILN_IMPORTERS_GLTF_GLTF_H
#define KILN_IMPORTERS_GLTF_GLTF_H

#include "kiln/import.h"

/* Fills an empty scene from a .gltf or .glb file, or from a glb on standard input for "-". False: an error was added,
 * and the scene is good for nothing but kiln_scene_destroy. */
bool gltf_import(const char *path, const kiln_import_options *, kiln_scene *, kiln_report *);

/* The same from memory; name stands in messages, folder is where relative URIs start (NULL: nowhere). */
bool gltf_import_memory(const char *name, const void *bytes, size_t size, const char *folder,
                        const kiln_import_options *, kiln_scene *, kiln_report *);

#endif
