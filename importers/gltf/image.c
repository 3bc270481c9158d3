#include "image/image.h"

#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "importers/gltf/reader.h"

/* Encoded bytes, and who owns them. */
typedef struct encoded {
    const unsigned char *data;
    size_t size;
    gltf_blob *owner; /* NULL: the scene must copy them */
} encoded;

/* A buffer that holds little else than images stays in memory for them; out of others, which would keep a whole
 * model's geometry alive, the scene copies them. */
static gltf_blob *owner_in(const gltf_reader *r, int index) {
    const gltf_buffer *buffer = &r->buffers[index];
    uint64_t image_bytes = 0;
    for (size_t i = 0; i < r->envelope.images.count; i++) {
        int view = r->envelope.images.items[i].buffer_view;
        if (view >= 0 && r->document.views[view].buffer == index) image_bytes += r->document.views[view].length;
    }
    return image_bytes >= buffer->size / 2 ? blob_share(buffer->blob) : NULL;
}

static bool open_view(gltf_reader *r, int view, encoded *e, const kiln_where *where) {
    const gltf_view *v = &r->document.views[view];
    const gltf_buffer *buffer = &r->buffers[v->buffer];
    if (!buffer->data)
        return report_error(r->report, KILN_CODE_REFERENCE, where, "export the asset with its data",
                            "buffer %d has neither a uri nor a binary chunk", v->buffer);
    *e = (encoded){buffer->data + v->offset, v->length, owner_in(r, v->buffer)};
    return true;
}

static bool open_image(gltf_reader *r, const gltf_source *source, encoded *e, const kiln_where *where) {
    if (source->buffer_view >= 0) return open_view(r, source->buffer_view, e, where);
    if (!source->uri.at)
        return report_error(r->report, KILN_CODE_REFERENCE, where, "export the asset with its images",
                            "the image has neither uri nor bufferView");
    e->owner = buffers_fetch(r, &source->uri, where);
    if (!e->owner) return false;
    e->data = blob_bytes(e->owner)->data;
    e->size = blob_bytes(e->owner)->size;
    return true;
}

/* The content says what it is; mimeType is often wrong. */
static bool probe(gltf_reader *r, const encoded *e, const kiln_where *where) {
    kiln_image_info info;
    if (image_kind(e->data, e->size) == KILN_IMAGE_KTX2)
        return report_error(r->report, KILN_CODE_IMAGE, where, "export the texture as PNG, JPEG or WebP",
                            "KTX2 images (KHR_texture_basisu) cannot be read");
    return image_probe(e->data, e->size, &info, where, r->report);
}

/* Its name, or that of its file. */
static const char *name_of(gltf_reader *r, const gltf_source *source) {
    if (*source->name || !source->uri.at || source->uri.end - source->uri.at > 512) return source->name;
    const char *uri = json_text(source->uri, &r->arena);
    return uri && strncmp(uri, "data:", 5) != 0 ? path_base(uri) : "";
}

/* For what turns out to be wrong only when the image is decoded: "car.glb: images[1] (wood.png)". NULL: no memory. */
static const char *place_of(gltf_reader *r, const char *name, const kiln_where *where) {
    char *place = where_text(where);
    kiln_text text = {0};
    text_append(&text, place ? place : "");
    if (*name) text_format(&text, " (%s)", name);
    const char *kept = place && text.data ? arena_string(&r->arena, text.data) : NULL;
    if (!kept) report_no_memory(r->report, "reading a glTF file");
    text_free(&text);
    free(place);
    return kept;
}

bool gltf_add_image(gltf_reader *r, int image, kiln_id *id) {
    if (r->images[image]) {
        *id = r->images[image];
        return true;
    }
    const gltf_source *source = &r->envelope.images.items[image];
    kiln_where here = where_item(&r->file, "images", (size_t)image);
    const char *name = name_of(r, source), *place = place_of(r, name, &here);
    encoded e = {0};
    if (!place || !open_image(r, source, &e, &here)) return false;
    if (!probe(r, &e, &here)) {
        blob_release(e.owner);
        return false;
    }
    kiln_image_desc desc = {.name = name, .place = place, .encoded = e.data, .encoded_size = e.size,
                            .release = e.owner ? blob_release : NULL, .release_user = e.owner};
    scene_locate(r->scene, &here);
    bool added = kiln_scene_add_image(r->scene, &desc, id, r->report);
    scene_locate(r->scene, &r->file);
    if (added) r->images[image] = *id;
    return added;
}
