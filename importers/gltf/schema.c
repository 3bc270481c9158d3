#include "importers/gltf/schema.h"

#include <stdlib.h>
#include <string.h>

static const char remedy[] = "export the file again, or repair the property";

static int compare_row(const void *key, const void *row) {
    const json_value *name = key;
    size_t length = (size_t)(name->end - name->at) - 2;
    const char *known = ((const schema_row *)row)->key;
    int order = strncmp(name->at + 1, known, length);
    return order ? order : known[length] ? -1 : 0;
}

static const schema_row *find_row(json_value key) {
    return bsearch(&key, schema_rows, schema_row_count, sizeof *schema_rows, compare_row);
}

typedef struct checker {
    size_t accessor_count;
    kiln_report *report;
} checker;

static bool mismatch(const checker *c, const char *wanted, const char *at, const kiln_where *where) {
    return report_error(c->report, KILN_CODE_SYNTAX, where, remedy, "%s is expected, not %s", wanted,
                        json_kind_name(json_kind_of(at)));
}

static bool check_integer(const checker *c, json_value value, uint64_t limit, const kiln_where *where) {
    uint64_t integer;
    int shown = value.end - value.at > 24 ? 24 : (int)(value.end - value.at);
    if (!json_whole(value, &integer))
        return report_error(c->report, KILN_CODE_RANGE, where, remedy, "a non-negative integer is expected, not %.*s",
                            shown, value.at);
    return integer <= limit ||
           report_error(c->report, KILN_CODE_RANGE, where, remedy, "%.*s is too large", shown, value.at);
}

/* What tinygltf checks itself, and would refuse without saying where. */
static bool check_index(const checker *c, json_value value, const schema_row *row, const kiln_where *where) {
    uint64_t index;
    if (!check_integer(c, value, INT32_MAX, where)) return false;
    json_whole(value, &index);
    if (strcmp(row->key, "indices") == 0 && index >= c->accessor_count)
        return report_error(c->report, KILN_CODE_REFERENCE, where, remedy,
                            "accessor %llu does not exist (the file has %zu)", (unsigned long long)index,
                            c->accessor_count);
    if (strcmp(row->key, "byteStride") == 0 && (index > 252 || index % 4))
        return report_error(c->report, KILN_CODE_RANGE, where, remedy, "%llu is no multiple of 4 from 4 to 252",
                            (unsigned long long)index);
    if (strcmp(row->key, "componentType") == 0 && (index < 5120 || index > 5126))
        return report_error(c->report, KILN_CODE_RANGE, where, remedy, "%llu is no component type",
                            (unsigned long long)index);
    return true;
}

/* The members of attributes are indices, those of extensions objects. */
static bool check_map(const checker *c, json_value object, unsigned types, const kiln_where *where) {
    json_value key, value;
    json_cursor cursor = json_open(object);
    while (json_next(&cursor, &key, &value)) {
        char name[64];
        size_t length = (size_t)(key.end - key.at) - 2;
        if (length >= sizeof name) length = sizeof name - 1;
        memcpy(name, key.at + 1, length);
        name[length] = '\0';
        kiln_where here = where_key(where, name);
        json_kind kind = json_kind_of(value.at), wanted = types & SCHEMA_MAP ? JSON_NUMBER : JSON_OBJECT;
        if (kind != wanted)
            return mismatch(c, types & SCHEMA_MAP ? "the index of an accessor" : "an object", value.at, &here);
        if (kind == JSON_NUMBER && !check_integer(c, value, INT32_MAX, &here)) return false;
    }
    return true;
}

static const char *wanted_name(unsigned types) {
    if (types & (SCHEMA_INDEX | SCHEMA_SIZE)) return "an integer";
    if (types & SCHEMA_NUMBER) return "a number";
    if (types & SCHEMA_STRING) return "a string";
    if (types & SCHEMA_BOOL) return "true or false";
    return types & SCHEMA_ARRAY ? "an array" : "an object";
}

static bool check_members(const checker *c, json_value object, const char *const required[3], const kiln_where *where);

/* Anything but an array. */
static bool check_single(const checker *c, json_value value, unsigned types, const schema_row *row,
                         const kiln_where *where) {
    switch (json_kind_of(value.at)) {
    case JSON_NUMBER:
        if (types & SCHEMA_INDEX) return check_index(c, value, row, where);
        if (types & SCHEMA_SIZE) return check_integer(c, value, (uint64_t)1 << 53, where);
        if (types & SCHEMA_NUMBER) return true;
        break;
    case JSON_STRING:
        if (types & SCHEMA_STRING) return true;
        break;
    case JSON_BOOL:
        if (types & SCHEMA_BOOL) return true;
        break;
    case JSON_OBJECT:
        if (types & (SCHEMA_MAP | SCHEMA_EXTENSIONS)) return check_map(c, value, types, where);
        if (types & SCHEMA_OBJECT) return check_members(c, value, row->required, where);
        break;
    case JSON_ARRAY:
    case JSON_NULL: break;
    }
    return mismatch(c, wanted_name(types), value.at, where);
}

static bool check_array(const checker *c, json_value array, const schema_row *row, const kiln_where *parent) {
    json_value value;
    size_t count = 0;
    for (json_cursor cursor = json_open(array); json_next(&cursor, NULL, &value); count++) {
        kiln_where here = where_item(parent, row->key, count);
        if (!check_single(c, value, row->elements, row, &here)) return false;
    }
    kiln_where here = where_key(parent, row->key);
    return !row->length || count == row->length ||
           report_error(c->report, KILN_CODE_RANGE, &here, remedy, "%zu numbers (%zu are expected)", count, row->length);
}

/* Recursion is bounded by JSON_DEPTH_MAX. */
static bool check_members(const checker *c, json_value object, const char *const required[3], const kiln_where *where) {
    json_value key, value;
    bool there[3] = {false};
    json_cursor cursor = json_open(object);
    while (json_next(&cursor, &key, &value)) {
        for (int i = 0; i < 3; i++) there[i] |= required[i] && json_is(key, required[i]);
        const schema_row *row = find_row(key);
        if (!row) continue;
        kiln_where here = where_key(where, row->key);
        bool array = row->types & SCHEMA_ARRAY && json_kind_of(value.at) == JSON_ARRAY;
        if (array ? !check_array(c, value, row, where) : !check_single(c, value, row->types, row, &here)) return false;
    }
    for (int i = 0; i < 3; i++)
        if (required[i] && !there[i])
            return report_error(c->report, KILN_CODE_SYNTAX, where, remedy, "%s is missing", required[i]);
    return true;
}

/* The type of each object in an array is one of the names. */
static bool check_types(const checker *c, json_value root, const char *key, const char *const *names,
                        const kiln_where *file) {
    json_value array, object, type;
    if (!json_member(root, key, &array)) return true;
    json_cursor cursor = json_open(array);
    for (size_t i = 0; json_next(&cursor, NULL, &object); i++) {
        bool known = false;
        if (!json_member(object, "type", &type)) continue;
        for (size_t k = 0; names[k]; k++) known |= json_is(type, names[k]);
        kiln_where item = where_item(file, key, i), where = where_key(&item, "type");
        int shown = type.end - type.at > 40 ? 40 : (int)(type.end - type.at);
        if (!known)
            return report_error(c->report, KILN_CODE_RANGE, &where, remedy, "%.*s is no known type", shown, type.at);
    }
    return true;
}

/* An object of the type kind has a member object of that name: cameras, and KHR_lights_punctual's spots. */
static bool check_described(const checker *c, json_value array, const char *key, const char *kind,
                            const kiln_where *parent) {
    json_value object, type, description;
    json_cursor cursor = json_open(array);
    for (size_t i = 0; json_next(&cursor, NULL, &object); i++) {
        kiln_where where = where_item(parent, key, i);
        if (!json_member(object, "type", &type))
            return report_error(c->report, KILN_CODE_SYNTAX, &where, remedy, "type is missing");
        bool described = json_member(object, kind, &description) && json_kind_of(description.at) == JSON_OBJECT;
        if (json_is(type, kind) && !described)
            return report_error(c->report, KILN_CODE_SYNTAX, &where, remedy, "%s is missing", kind);
    }
    return true;
}

static bool check_lights(const checker *c, json_value root, const kiln_where *file) {
    json_value extensions, punctual, lights;
    if (!json_member(root, "extensions", &extensions) || !json_member(extensions, "KHR_lights_punctual", &punctual) ||
        !json_member(punctual, "lights", &lights))
        return true;
    kiln_where list = where_key(file, "extensions"), extension = where_key(&list, "KHR_lights_punctual");
    return check_described(c, lights, "lights", "spot", &extension);
}

static bool check_cameras(const checker *c, json_value root, const kiln_where *file) {
    static const char *const types[] = {"perspective", "orthographic", NULL};
    json_value cameras;
    return !json_member(root, "cameras", &cameras) ||
           (check_types(c, root, "cameras", types, file) && check_described(c, cameras, "cameras", types[0], file) &&
            check_described(c, cameras, "cameras", types[1], file));
}

bool schema_check(json_value root, const kiln_where *file, kiln_report *report) {
    static const char *const required[3] = {"asset"},
                             *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4", NULL};
    checker c = {0, report};
    json_value accessors, value;
    if (json_kind_of(root.at) != JSON_OBJECT) return mismatch(&c, "an object", root.at, file);
    if (json_member(root, "accessors", &accessors))
        for (json_cursor cursor = json_open(accessors); json_next(&cursor, NULL, &value);) c.accessor_count++;
    return check_members(&c, root, required, file) && check_types(&c, root, "accessors", types, file) &&
           check_cameras(&c, root, file) && check_lights(&c, root, file);
}
