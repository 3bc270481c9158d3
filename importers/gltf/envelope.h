/* importers/gltf/envelope.h: what kiln reads of the JSON itself: version, extensions, and the two arrays that bring
 * bytes. tinygltf would load those eagerly, from wherever they point, with a copy of everything; it gets the JSON
 * without them. */
#ifndef KILN_IMPORTERS_GLTF_ENVELOPE_H
#define KILN_IMPORTERS_GLTF_ENVELOPE_H

#include "importers/gltf/json.h"

/* A buffer or an image. */
typedef struct gltf_source {
    const char *name, *mime_type;
    json_value uri;      /* a string; at is NULL: there is none */
    uint64_t byte_length; /* buffers */
    int buffer_view;      /* images; -1: none */
} gltf_source;

typedef struct gltf_sources {
    gltf_source *items;
    size_t count;
    json_value array; /* in the JSON; at is NULL: there is none */
} gltf_sources;

typedef struct gltf_envelope {
    gltf_sources buffers, images;
    json_value extensions_used, extensions_required; /* at is NULL: absent */
} gltf_envelope;

/* asset.version, which decides what everything else means. root: of checked JSON. */
bool envelope_check_version(json_value root, kiln_arena *, const kiln_where *file, kiln_report *);

/* asset.generator and asset.copyright, in the arena; NULL where they are not texts. */
void envelope_read_asset(json_value root, kiln_arena *, const char **generator, const char **copyright);

/* root: of JSON that fits the schema. */
bool envelope_read(json_value root, gltf_envelope *, kiln_arena *, const kiln_where *file, kiln_report *);

/* The JSON with [] in place of buffers and images; free(). NULL: memory ran out. */
char *envelope_strip(const gltf_envelope *, const char *json, size_t json_size, size_t *size);

#endif
