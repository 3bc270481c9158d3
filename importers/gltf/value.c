#include "importers/gltf/value.h"

#include <string.h>

const gltf_value *value_member(const gltf_value *object, const char *key) {
    if (!object || object->kind != GLTF_OBJECT) return NULL;
    for (size_t i = 0; i < object->count; i++)
        if (strcmp(object->keys[i], key) == 0) return &object->items[i];
    return NULL;
}

static bool refuse(const char *wanted, const char *key, const kiln_where *object, kiln_report *report) {
    kiln_where where = where_key(object, key);
    return report_error(report, KILN_CODE_SYNTAX, &where, "export the file again, or repair the property",
                        "%s is expected", wanted);
}

bool value_number(const gltf_value *object, const char *key, double *number, const kiln_where *where,
                  kiln_report *report) {
    const gltf_value *v = value_member(object, key);
    if (!v) return true;
    if (v->kind != GLTF_NUMBER) return refuse("a number", key, where, report);
    *number = v->number;
    return true;
}

bool value_float(const gltf_value *object, const char *key, float *number, const kiln_where *where,
                 kiln_report *report) {
    double value = (double)*number;
    if (!value_number(object, key, &value, where, report)) return false;
    *number = (float)value;
    return true;
}

bool value_floats(const gltf_value *object, const char *key, size_t count, float *numbers, const kiln_where *where,
                  kiln_report *report) {
    const gltf_value *v = value_member(object, key);
    if (!v) return true;
    bool fits = v->kind == GLTF_ARRAY && v->count == count;
    for (size_t i = 0; fits && i < count; i++) fits = v->items[i].kind == GLTF_NUMBER;
    static const char *const wanted[] = {[2] = "an array of 2 numbers", [3] = "an array of 3 numbers",
                                         [4] = "an array of 4 numbers"};
    if (!fits) return refuse(wanted[count], key, where, report);
    for (size_t i = 0; i < count; i++) numbers[i] = (float)v->items[i].number;
    return true;
}

bool value_index(const gltf_value *object, const char *key, int *index, const kiln_where *where, kiln_report *report) {
    double value = *index;
    if (!value_number(object, key, &value, where, report)) return false;
    if (value != *index && !(value >= 0 && value <= INT32_MAX && value == (double)(int)value))
        return refuse("a non-negative integer", key, where, report);
    *index = (int)value;
    return true;
}

bool value_bool(const gltf_value *object, const char *key, bool *flag, const kiln_where *where, kiln_report *report) {
    const gltf_value *v = value_member(object, key);
    if (!v) return true;
    if (v->kind != GLTF_BOOL) return refuse("true or false", key, where, report);
    *flag = v->boolean;
    return true;
}
