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
    if (!envelope->extensions_required.at) return true;
    json_cursor cursor = json_open(envelope->extensions_required);
    for (size_t i = 0; json_next(&cursor, NULL, &name); i++) {
        kiln_where where = where_item(file, "extensionsRequired", i);
        char *text = json_text(name, arena);
        if (!text) return report_no_memory(report, "reading a glTF file");
        if (!require(text, &where, report)) return false;
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

/* Far more than any file has; what is beyond is noted and not listed. */
enum { LISTED_MAX = 256, NAME_MAX_BYTES = 128 };

typedef struct extension_finder {
    const gltf_envelope *envelope;
    kiln_arena *arena; /* of the list */
    scene_extension rows[LISTED_MAX];
    bool used[LISTED_MAX];
    uint32_t count;
    kiln_report *report;
} extension_finder;

/* The row of a name; LISTED_MAX: the list is full, or memory ran out. */
static uint32_t row_of(extension_finder *f, const char *name) {
    for (uint32_t i = 0; i < f->count; i++)
        if (strcmp(f->rows[i].name, name) == 0) return i;
    if (f->count == LISTED_MAX) return LISTED_MAX;
    scene_extension row = {arena_string(f->arena, name), names(f->envelope->extensions_required, name),
                           support_of(name, f->arena)};
    if (!row.name || !row.support) return LISTED_MAX;
    f->rows[f->count] = row;
    return f->count++;
}

static void copy_key(json_value string, char name[NAME_MAX_BYTES]) {
    size_t length = (size_t)(string.end - string.at) - 2;
    if (length >= NAME_MAX_BYTES) length = NAME_MAX_BYTES - 1;
    memcpy(name, string.at + 1, length);
    name[length] = '\0';
}

static void find_in(extension_finder *f, json_value object, bool extensions, const kiln_where *where);

/* Objects, and those in arrays. Arrays in arrays hold no objects in glTF. */
static void find_in_member(extension_finder *f, const char *name, json_value value, const kiln_where *where) {
    kiln_where here = where_key(where, name);
    json_value item;
    json_kind kind = json_kind_of(value.at);
    if (kind == JSON_OBJECT) find_in(f, value, strcmp(name, "extensions") == 0, &here);
    if (kind != JSON_ARRAY) return;
    json_cursor cursor = json_open(value);
    for (size_t i = 0; json_next(&cursor, NULL, &item); i++) {
        here = where_item(where, name, i);
        if (json_kind_of(item.at) == JSON_OBJECT) find_in(f, item, false, &here);
    }
}

/* extensions: the object's keys are names of extensions. Extras are anybody's. Recursion is bounded by
 * JSON_DEPTH_MAX. */
static void find_in(extension_finder *f, json_value object, bool extensions, const kiln_where *where) {
    json_value key, value;
    json_cursor cursor = json_open(object);
    while (json_next(&cursor, &key, &value)) {
        char name[NAME_MAX_BYTES];
        copy_key(key, name);
        if (extensions) {
            kiln_where here = where_key(where, name);
            uint32_t row = row_of(f, name);
            if (row < LISTED_MAX) f->used[row] = true;
            note_optional(name, &here, f->report);
        }
        if (strcmp(name, "extras") != 0) find_in_member(f, name, value, where);
    }
}

/* Lists the declared names, or notes them: what is declared and stands at no object is noted where it is declared. */
static void go_through_declared(extension_finder *f, bool note, const kiln_where *file) {
    json_value name;
    if (!f->envelope->extensions_used.at) return;
    json_cursor cursor = json_open(f->envelope->extensions_used);
    for (size_t i = 0; json_next(&cursor, NULL, &name); i++) {
        kiln_where where = where_item(file, "extensionsUsed", i);
        char text[NAME_MAX_BYTES];
        copy_key(name, text);
        uint32_t row = row_of(f, text);
        if (note && (row == LISTED_MAX || !f->used[row])) note_optional(text, &where, f->report);
    }
}

bool extensions_note(const gltf_envelope *envelope, json_value root, kiln_arena *arena, scene_source *source,
                     const kiln_where *file, kiln_report *report) {
    extension_finder f = {.envelope = envelope, .arena = arena, .report = report};
    go_through_declared(&f, false, file); /* first in the list, in their order */
    find_in(&f, root, false, file);
    go_through_declared(&f, true, file);
    source->extensions = arena_copy(arena, f.rows, f.count, sizeof *f.rows);
    source->extension_count = source->extensions ? f.count : 0;
    return source->extensions || report_no_memory(report, "reading a glTF file");
}
