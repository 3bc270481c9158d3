/* importers/gltf/extensions.h: which extensions kiln reads, which it leaves out, and what it says then. */
#ifndef KILN_IMPORTERS_GLTF_EXTENSIONS_H
#define KILN_IMPORTERS_GLTF_EXTENSIONS_H

#include "importers/gltf/envelope.h"
#include "scene/scene.h"

/* A required extension that kiln does not read is an error. */
bool extensions_check(const gltf_envelope *, kiln_arena *, const kiln_where *file, kiln_report *);

/* Warns of every other one that kiln does not read: once for each object that carries it, declared or not, and once
 * where it is declared for nothing. *source gets the list of all, in the arena, for those who ask. */
bool extensions_note(const gltf_envelope *, json_value root, kiln_arena *, scene_source *, const kiln_where *file,
                     kiln_report *);

typedef enum extension_support {
    EXTENSION_READ,
    EXTENSION_LEFT_OUT, /* known, and the picture misses something without it */
    EXTENSION_NO_PICTURE /* says nothing about the picture */
} extension_support;

typedef struct extension_row {
    const char *name;
    extension_support support;
    const char *without; /* LEFT_OUT: what its absence does */
} extension_row;

extern const extension_row extension_rows[];
extern const size_t extension_row_count;

#endif
