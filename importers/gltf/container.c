#include "importers/gltf/container.h"

#include <string.h>

enum {
    HEADER_BYTES = 12,
    CHUNK_HEADER_BYTES = 8,
    CHUNK_JSON = 0x4E4F534A, /* "JSON" */
    CHUNK_BINARY = 0x004E4942 /* "BIN" */
};

static const char again[] = "copy or export the file again";

static uint32_t read_u32(const unsigned char *at) {
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static bool check_header(const unsigned char *bytes, size_t size, const kiln_where *file, kiln_report *report) {
    if (size > UINT32_MAX)
        return report_error(report, KILN_CODE_LIMIT, file, "export a .gltf with several .bin buffers instead",
                            "a glb cannot be larger than 4 GiB");
    if (size < HEADER_BYTES)
        return report_error(report, KILN_CODE_FILE_TRUNCATED, file, again, "the glb ends inside its header (%zu bytes)",
                            size);
    uint32_t version = read_u32(bytes + 4), length = read_u32(bytes + 8);
    if (version != 2)
        return report_error(report, KILN_CODE_FILE_FORMAT, file, "convert the file to glTF 2.0",
                            "this is a glb of version %u; kiln reads version 2", version);
    if (length < HEADER_BYTES)
        return report_error(report, KILN_CODE_FILE_FORMAT, file, again, "the glb says that it is %u bytes long", length);
    if (length > size)
        return report_error(report, KILN_CODE_FILE_TRUNCATED, file, again,
                            "the glb is truncated: its header says %u bytes, the file has %zu", length, size);
    if (length < size)
        report_warning(report, KILN_CODE_FILE_FORMAT, file, NULL, "bytes behind the end of the glb are left out");
    return true;
}

static bool open_chunk(gltf_container *c, size_t index, uint32_t type, const unsigned char *data, uint32_t size,
                       const kiln_where *where, kiln_report *report) {
    if (index == 0) {
        if (type != CHUNK_JSON || size == 0)
            return report_error(report, KILN_CODE_FILE_FORMAT, where, again, "the first chunk is not JSON");
        while (size > 1 && data[size - 1] == 0) size--; /* some writers pad with zeros instead of spaces */
        c->json = (const char *)data;
        c->json_size = size;
        return true;
    }
    if (type == CHUNK_JSON || (type == CHUNK_BINARY && c->binary))
        return report_error(report, KILN_CODE_FILE_FORMAT, where, again, "a second chunk of this type");
    if (type != CHUNK_BINARY) return true; /* section 4.4.3.1: chunks of unknown types are ignored */
    c->binary = data;
    c->binary_size = size;
    return true;
}

static bool open_chunks(const unsigned char *bytes, size_t size, gltf_container *c, const kiln_where *file,
                        kiln_report *report) {
    size_t at = HEADER_BYTES;
    for (size_t index = 0; index == 0 || at < size; index++) {
        kiln_where where = where_item(file, "chunk", index);
        if (size - at < CHUNK_HEADER_BYTES)
            return report_error(report, KILN_CODE_FILE_TRUNCATED, &where, again, "the glb ends inside a chunk header");
        uint32_t length = read_u32(bytes + at), type = read_u32(bytes + at + 4);
        at += CHUNK_HEADER_BYTES;
        if (length > size - at)
            return report_error(report, KILN_CODE_FILE_TRUNCATED, &where, again,
                                "the chunk says %u bytes, but only %zu follow", length, size - at);
        if (!open_chunk(c, index, type, bytes + at, length, &where, report)) return false;
        at += length;
    }
    return true;
}

static bool is_json(const unsigned char *bytes, size_t size) {
    size_t at = 0;
    while (at < size && strchr(" \n\r\t", bytes[at]) && bytes[at]) at++;
    return at < size && (bytes[at] == '{' || bytes[at] == '[');
}

bool container_open(const unsigned char *bytes, size_t size, gltf_container *container, const kiln_where *file,
                    kiln_report *report) {
    *container = (gltf_container){0};
    if (size == 0) return report_error(report, KILN_CODE_FILE_TRUNCATED, file, again, "the file is empty");
    if (size >= 4 && memcmp(bytes, "glTF", 4) == 0) {
        if (!check_header(bytes, size, file, report)) return false;
        return open_chunks(bytes, read_u32(bytes + 8), container, file, report);
    }
    if (size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0) { /* a byte order mark */
        bytes += 3;
        size -= 3;
    }
    if (!is_json(bytes, size))
        return report_error(report, KILN_CODE_FILE_FORMAT, file, "give a .gltf or .glb file",
                            "this is neither a glb (it would begin with \"glTF\") nor glTF's JSON");
    container->json = (const char *)bytes;
    container->json_size = size;
    return true;
}
