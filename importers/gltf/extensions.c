#include "importers/gltf/extensions.h"

#include <string.h>

#include "base/text.h"

static const extension_row *find_row(const char *name) {
    for (size_t i = 0; i < extension_row_count; i++)
        if (strcmp(extension_rows[i].name, name) == 0) return &extension_rows[i];
    return NULL;
}

/* "kiln reads EXT_…, KHR_…" */
static void append_readable(kiln_text *text) {
    text_append(text, "export without it; kiln reads");
    const char *comma = " ";
    for (size_t i = 0; i < extension_row_count; i++) {
        if (extension_rows[i].support != EXTENSION_READ) continue;
        text_append(text, comma);
        text_append(text, extension_rows[i].name);
        comma = ", ";
    }
}

static bool require(const char *name, const kiln_where *where, kiln_report *report) {
    const extension_row *row = find_row(name);
    if (row && row->support != EXTENSION_LEFT_OUT) return true;
    kiln_text remedy = {0};
    append_readable(&remedy);
    report_error(report, KILN_CODE_EXTENSION, where, remedy.data, "the file requires %.100s, which kiln does not read",
                 name);
    text_free(&remedy);
    return false;
}

static void note_optional(const char *name, const kiln_where *where, kiln_report *report) {
    const extension_row *row = find_row(name);
    if (!row)
        report_warning(report, KILN_CODE_IGNORED, where, NULL, "%.100s is not known to kiln: it is left out", name);
    else if (row->support == EXTENSION_LEFT_OUT)
        report_warning(report, KILN_CODE_IGNORED, where, NULL, "%s is left out: %s", name, row->without);
}

bool extensions_check(const gltf_envelope *envelope, kiln_arena *arena, const kiln_where *file, kiln_report *report) {
    json_value name;
    if (envelope->extensions_required.at) {
        json_cursor cursor = json_open(envelope->extensions_required);
        for (size_t i = 0; json_next(&cursor, NULL, &name); i++) {
            kiln_where where = where_item(file, "extensionsRequired", i);
            char *text = json_text(name, arena);
            if (!text) return report_no_memory(report, "reading a glTF file");
            if (!require(text, &where, report)) return false;
        }
    }
    if (!envelope->extensions_used.at) return true;
    json_cursor cursor = json_open(envelope->extensions_used);
    for (size_t i = 0; json_next(&cursor, NULL, &name); i++) {
        kiln_where where = where_item(file, "extensionsUsed", i);
        char *text = json_text(name, arena);
        if (!text) return report_no_memory(report, "reading a glTF file");
        note_optional(text, &where, report);
    }
    return true;
}

static bool names(json_value array, const char *name) {
    json_value item;
    if (!array.at) return false;
    json_cursor cursor = json_open(array);
    while (json_next(&cursor, NULL, &item))
        if (json_is(item, name)) return true;
    return false;
}

static const char *support_of(const char *name, kiln_arena *arena) {
    const extension_row *row = find_row(name);
    if (!row) return "unknown";
    if (row->support == EXTENSION_READ) return "read";
    if (row->support == EXTENSION_NO_PICTURE) return "says nothing about the picture";
    kiln_text text = {0};
    text_format(&text, "left out: %s", row->without);
    const char *support = text.data ? arena_string(arena, text.data) : NULL;
    text_free(&text);
    return support;
}

bool extensions_list(const gltf_envelope *envelope, kiln_arena *arena, scene_source *source, kiln_report *report) {
    json_value name;
    uint32_t count = 0;
    if (!envelope->extensions_used.at) return true;
    json_cursor cursor = json_open(envelope->extensions_used);
    while (json_next(&cursor, NULL, &name)) count++;
    scene_extension *rows = ARENA_ARRAY(arena, scene_extension, count);
    bool done = rows != NULL;
    cursor = json_open(envelope->extensions_used);
    for (uint32_t i = 0; done && json_next(&cursor, NULL, &name); i++) {
        char *text = json_text(name, arena);
        if (text) rows[i] = (scene_extension){text, names(envelope->extensions_required, text), support_of(text, arena)};
        done = text && rows[i].support;
    }
    source->extensions = rows;
    source->extension_count = done ? count : 0;
    return done || report_no_memory(report, "reading a glTF file");
}
