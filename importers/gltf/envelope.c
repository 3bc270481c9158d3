#include "importers/gltf/envelope.h"

#include <stdlib.h>
#include <string.h>

static bool no_memory(kiln_report *report) { return report_no_memory(report, "reading a glTF file"); }

/* "2.0" is 2000; 0 for what is no version. */
static unsigned version_number(const char *version) {
    char *end;
    unsigned long major = strtoul(version, &end, 10);
    if (end == version || *end != '.' || major > 1000) return 0;
    const char *minor_text = end + 1;
    unsigned long minor = strtoul(minor_text, &end, 10);
    return end == minor_text || *end || minor > 999 ? 0 : (unsigned)(1000 * major + minor);
}

static bool read_version(json_value asset, const char *key, unsigned *version, kiln_arena *arena,
                         const kiln_where *where, kiln_report *report) {
    json_value value;
    *version = 0;
    if (!json_member(asset, key, &value)) return true;
    kiln_where here = where_key(where, key);
    char *text = json_kind_of(value.at) == JSON_STRING ? json_text(value, arena) : arena_string(arena, "");
    if (!text) return no_memory(report);
    *version = version_number(text);
    return *version || report_error(report, KILN_CODE_SYNTAX, &here, "export the file again",
                                    "a version like \"2.0\" is expected");
}

bool envelope_check_version(json_value root, kiln_arena *arena, const kiln_where *file, kiln_report *report) {
    static const char convert[] = "convert the file to glTF 2.0";
    kiln_where where = where_key(file, "asset");
    json_value asset;
    unsigned version, minimum;
    if (!json_member(root, "asset", &asset))
        return report_error(report, KILN_CODE_SYNTAX, &where, "is this a glTF 2.0 file?", "asset.version is missing");
    if (!read_version(asset, "version", &version, arena, &where, report) ||
        !read_version(asset, "minVersion", &minimum, arena, &where, report))
        return false;
    if (minimum > 2000)
        return report_error(report, KILN_CODE_FILE_FORMAT, &where, convert,
                            "the file needs a reader of glTF %u.%u; kiln reads 2.0", minimum / 1000, minimum % 1000);
    if (version && version / 1000 != 2)
        return report_error(report, KILN_CODE_FILE_FORMAT, &where, convert, "this is glTF %u.%u; kiln reads 2.0",
                            version / 1000, version % 1000);
    return true;
}

static const char *asset_text(json_value asset, const char *key, kiln_arena *arena) {
    json_value value;
    return json_member(asset, key, &value) && json_kind_of(value.at) == JSON_STRING ? json_text(value, arena) : NULL;
}

void envelope_read_asset(json_value root, kiln_arena *arena, const char **generator, const char **copyright) {
    json_value asset;
    *generator = *copyright = NULL;
    if (!json_member(root, "asset", &asset)) return;
    *generator = asset_text(asset, "generator", arena);
    *copyright = asset_text(asset, "copyright", arena);
}

static bool read_source(json_value object, gltf_source *source, kiln_arena *arena, kiln_report *report) {
    *source = (gltf_source){.name = "", .mime_type = "", .buffer_view = -1};
    json_value key, value;
    json_cursor cursor = json_open(object);
    while (json_next(&cursor, &key, &value)) {
        uint64_t integer = 0;
        bool text = json_kind_of(value.at) == JSON_STRING;
        if (json_is(key, "uri")) source->uri = value;
        else if (json_is(key, "byteLength") && json_whole(value, &integer)) source->byte_length = integer;
        else if (json_is(key, "bufferView") && json_whole(value, &integer)) source->buffer_view = (int)integer;
        else if (json_is(key, "name") && text) source->name = json_text(value, arena);
        else if (json_is(key, "mimeType")) source->mime_type = json_text(value, arena);
        if (!source->name || !source->mime_type) return no_memory(report);
    }
    return true;
}

static bool read_sources(json_value array, gltf_sources *sources, kiln_arena *arena, kiln_report *report) {
    sources->array = array;
    json_value value;
    for (json_cursor cursor = json_open(array); json_next(&cursor, NULL, &value);) sources->count++;
    sources->items = ARENA_ARRAY(arena, gltf_source, sources->count);
    if (!sources->items) return no_memory(report);
    json_cursor cursor = json_open(array);
    for (size_t i = 0; json_next(&cursor, NULL, &value); i++)
        if (!read_source(value, &sources->items[i], arena, report)) return false;
    return true;
}

bool envelope_read(json_value root, gltf_envelope *envelope, kiln_arena *arena, const kiln_where *file,
                   kiln_report *report) {
    *envelope = (gltf_envelope){0};
    json_value buffers = {0}, images = {0};
    struct { const char *key; json_value *value; } rows[] = {{"buffers", &buffers},
                                                             {"images", &images},
                                                             {"extensionsUsed", &envelope->extensions_used},
                                                             {"extensionsRequired", &envelope->extensions_required}};
    json_value key, value;
    json_cursor cursor = json_open(root);
    while (json_next(&cursor, &key, &value))
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            if (!json_is(key, rows[i].key)) continue;
            kiln_where where = where_key(file, rows[i].key);
            if (rows[i].value->at)
                return report_error(report, KILN_CODE_SYNTAX, &where, "export the file again",
                                    "the property is there twice");
            *rows[i].value = value;
        }
    return (!buffers.at || read_sources(buffers, &envelope->buffers, arena, report)) &&
           (!images.at || read_sources(images, &envelope->images, arena, report));
}

char *envelope_strip(const gltf_envelope *envelope, const char *json, size_t json_size, size_t *size) {
    json_value first = envelope->buffers.array, second = envelope->images.array;
    if (second.at && (!first.at || second.at < first.at)) {
        json_value swap = first;
        first = second;
        second = swap;
    }
    char *text = malloc(json_size + 1), *out = text;
    if (!text) return NULL;
    const char *from = json;
    const json_value cuts[] = {first, second};
    for (int i = 0; i < 2; i++) {
        if (!cuts[i].at) continue;
        out = mempcpy(out, from, (size_t)(cuts[i].at - from));
        out = mempcpy(out, "[]", 2);
        from = cuts[i].end;
    }
    out = mempcpy(out, from, (size_t)(json + json_size - from));
    *out = '\0';
    *size = (size_t)(out - text);
    return text;
}
