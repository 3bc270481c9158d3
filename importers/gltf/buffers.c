#include "importers/gltf/buffers.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "importers/gltf/reader.h"
#include "importers/gltf/uri.h"

struct gltf_blob {
    atomic_uint owners;
    kiln_bytes bytes;
};

gltf_blob *blob_create(kiln_bytes *bytes) {
    gltf_blob *blob = malloc(sizeof *blob);
    if (!blob) {
        file_free(bytes);
        return NULL;
    }
    atomic_init(&blob->owners, 1);
    blob->bytes = *bytes;
    *bytes = (kiln_bytes){0};
    return blob;
}

gltf_blob *blob_share(gltf_blob *blob) {
    atomic_fetch_add(&blob->owners, 1);
    return blob;
}

void blob_release(void *owned) {
    gltf_blob *blob = owned;
    if (!blob || atomic_fetch_sub(&blob->owners, 1) != 1) return;
    file_free(&blob->bytes);
    free(blob);
}

const kiln_bytes *blob_bytes(const gltf_blob *blob) { return &blob->bytes; }

static bool fetch_file(gltf_reader *r, const char *uri, kiln_bytes *bytes, const kiln_where *where) {
    char *path = uri_resolve(uri, r->folder, r->allow_outside, where, r->report);
    if (!path) return false;
    bool read = file_read(path, r->budget, bytes, where, r->report) && reader_reserve(r, bytes->size, where);
    free(path);
    return read;
}

/* A data URI is decoded from the JSON in place, unless that has escapes in it. */
static bool fetch_bytes(gltf_reader *r, const json_value *uri, kiln_bytes *bytes, const kiln_where *where) {
    const char *text = uri->at + 1;
    size_t length = (size_t)(uri->end - uri->at) - 2;
    if (!uri_is_data(text, length) || memchr(text, '\\', length)) {
        if (!reader_reserve(r, length, where)) return false;
        char *decoded = json_text(*uri, &r->arena);
        if (!decoded) return report_no_memory(r->report, "reading a URI");
        text = decoded;
        length = strlen(decoded);
    }
    if (!uri_is_data(text, length)) return fetch_file(r, text, bytes, where);
    return reader_reserve(r, length / 4 * 3 + 4, where) && uri_decode_data(text, length, bytes, where, r->report);
}

gltf_blob *buffers_fetch(gltf_reader *r, const json_value *uri, const kiln_where *where) {
    kiln_where here = where_key(where, "uri");
    kiln_bytes bytes = {0};
    if (!fetch_bytes(r, uri, &bytes, &here)) {
        file_free(&bytes);
        return NULL;
    }
    gltf_blob *blob = blob_create(&bytes);
    if (!blob) report_no_memory(r->report, "reading a file");
    return blob;
}

static bool load(gltf_reader *r, size_t index) {
    const gltf_source *source = &r->envelope.buffers.items[index];
    gltf_buffer *buffer = &r->buffers[index];
    kiln_where where = where_item(&r->file, "buffers", index);
    size_t size = 0;
    if (source->uri.at) {
        buffer->blob = buffers_fetch(r, &source->uri, &where);
        if (!buffer->blob) return false;
        buffer->data = blob_bytes(buffer->blob)->data;
        size = blob_bytes(buffer->blob)->size;
    } else if (index == 0 && r->container.binary) { /* section 3.6.1.2: the first buffer is the binary chunk */
        buffer->blob = blob_share(r->bytes);
        buffer->data = r->container.binary;
        size = r->container.binary_size;
    } else {
        return true; /* an error only when something reads it: some writers leave placeholders */
    }
    buffer->size = (size_t)source->byte_length;
    return source->byte_length <= size ||
           report_error(r->report, KILN_CODE_FILE_TRUNCATED, &where, "copy or export the files again",
                        "byteLength is %llu, but there are only %zu bytes", (unsigned long long)source->byte_length, size);
}

/* The file that a source names, if it does, and if that exists: who reads it reports what is wrong. */
static file_identity identify(gltf_reader *r, const gltf_source *source, kiln_report *unread) {
    enum { URI_LONGEST = 3 * 4096 }; /* no path is longer, with each byte as %XX */
    size_t length = source->uri.at ? (size_t)(source->uri.end - source->uri.at) - 2 : 0;
    if (!length || length > URI_LONGEST || uri_is_data(source->uri.at + 1, length)) return (file_identity){0};
    char *uri = json_text(source->uri, &r->arena);
    char *path = uri ? uri_resolve(uri, r->folder, r->allow_outside, &r->file, unread) : NULL;
    file_identity file = path ? file_identify(path) : (file_identity){0};
    free(path);
    return file;
}

bool buffers_list_files(gltf_reader *r) {
    const gltf_sources *lists[] = {&r->envelope.buffers, &r->envelope.images};
    kiln_report *unread = kiln_report_create();
    file_identity *files =
        ARENA_ARRAY(&r->scene->arena, file_identity, 1 + lists[0]->count + lists[1]->count);
    bool done = unread && files;
    size_t count = 0;
    if (done && r->path) files[count++] = file_identify(r->path);
    for (int l = 0; done && l < 2; l++)
        for (size_t i = 0; i < lists[l]->count; i++) {
            file_identity file = identify(r, &lists[l]->items[i], unread);
            if (file.known) files[count++] = file;
        }
    r->scene->source.files = files;
    r->scene->source.file_count = count;
    kiln_report_destroy(unread);
    return done || report_no_memory(r->report, "reading a glTF file");
}

bool buffers_load(gltf_reader *r) {
    size_t count = r->envelope.buffers.count;
    r->buffers = reader_array(r, count, sizeof *r->buffers, &r->file);
    if (!r->buffers) return false;
    for (size_t i = 0; i < count; i++)
        if (!load(r, i)) return false;
    return true;
}

void buffers_free(gltf_reader *r) {
    for (size_t i = 0; r->buffers && i < r->envelope.buffers.count; i++) blob_release(r->buffers[i].blob);
}
