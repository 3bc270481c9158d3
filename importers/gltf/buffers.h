/* importers/gltf/buffers.h: the bytes that a document refers to. */
#ifndef KILN_IMPORTERS_GLTF_BUFFERS_H
#define KILN_IMPORTERS_GLTF_BUFFERS_H

#include "base/file.h"

/* Bytes with several owners: the buffers that lie in them, and the images that the scene reads in place. */
typedef struct gltf_blob gltf_blob;
gltf_blob *blob_create(kiln_bytes *); /* takes the bytes over; NULL: no memory, and they are freed */
gltf_blob *blob_share(gltf_blob *);
void blob_release(void *blob); /* NULL is fine; void: a kiln_image_desc's release */
const kiln_bytes *blob_bytes(const gltf_blob *);

typedef struct gltf_buffer {
    gltf_blob *blob;
    const unsigned char *data; /* NULL: the file gives none (a glb without binary chunk) */
    size_t size;               /* byteLength */
} gltf_buffer;

struct gltf_reader;
/* Tells the scene which files the asset consists of, those too that nothing in it uses. */
bool buffers_list_files(struct gltf_reader *);
/* Loads every buffer of the envelope: the glb's binary chunk in place, data URIs, files. */
bool buffers_load(struct gltf_reader *);
void buffers_free(struct gltf_reader *);
/* The bytes behind the URI of a buffer or an image; at is its string in the JSON. NULL: an error was added. */
struct json_value;
gltf_blob *buffers_fetch(struct gltf_reader *, const struct json_value *uri, const kiln_where *);

#endif
