/* importers/gltf/container.h: a .gltf or .glb file in memory, and where its JSON and its binary chunk lie. */
#ifndef KILN_IMPORTERS_GLTF_CONTAINER_H
#define KILN_IMPORTERS_GLTF_CONTAINER_H

#include "base/report.h"

typedef struct gltf_container {
    const char *json; /* not terminated */
    size_t json_size;
    const unsigned char *binary; /* the BIN chunk; NULL: there is none */
    size_t binary_size;
} gltf_container;

/* Tells the two formats apart by content (glTF 2.0, section 4: GLB file format) and checks every length. */
bool container_open(const unsigned char *bytes, size_t size, gltf_container *, const kiln_where *file, kiln_report *);

#endif
