#include "scene/check.h"

#include <stdio.h>
#include <string.h>

/* Names come from files: control characters would reach the user's terminal, long ones drown the message. */
static void copy_name(char *out, size_t size, const char *name) {
    size_t n = 0;
    for (; name[n] && n + 1 < size; n++) {
        unsigned char c = (unsigned char)name[n];
        out[n] = c < 0x20 || c == 0x7f ? '?' : name[n];
    }
    if (name[n])
        while (n && ((unsigned char)out[n - 1] & 0xC0) == 0x80) n--; /* never half a UTF-8 sequence */
    if (name[n] && n && ((unsigned char)out[n - 1] & 0xC0) == 0xC0) n--;
    out[n] = '\0';
}

void place_set(scene_place *place, const kiln_scene *scene, const char *noun, const char *name, size_t number) {
    if (scene->where && scene->where->parent) { /* "car.glb: meshes[3]": the file's own words for the object */
        place->where = *scene->where;
        return;
    }
    if (name && *name) {
        char shown[80];
        copy_name(shown, sizeof shown, name);
        snprintf(place->label, sizeof place->label, "%s '%s'", noun, shown);
    } else {
        snprintf(place->label, sizeof place->label, "%s %zu", noun, number);
    }
    place->where = where_key(scene->where, place->label);
}

bool check_open(const kiln_scene *scene, const kiln_where *where, kiln_report *report) {
    return !scene->committed || report_error(report, KILN_CODE_USAGE, where, "add everything before the commit",
                                             "the scene is committed and cannot change");
}

float check_factor(float value, float low, float high, float fallback, const char *name, const kiln_where *where,
                   kiln_report *report) {
    if (!isfinite(value)) {
        report_warning(report, KILN_CODE_RANGE, where, NULL, "%s is not a number: %g is used", name, (double)fallback);
        return fallback;
    }
    if (value >= low && value <= high) return value;
    float nearest = value < low ? low : high;
    report_warning(report, KILN_CODE_RANGE, where, NULL, "%s is %g: %g is used", name, (double)value, (double)nearest);
    return nearest;
}

bool check_time_count(uint32_t count, const kiln_where *where, kiln_report *report) {
    enum { TIMES_MAX = 129 }; /* also Embree's limit (RTC_MAX_TIME_STEP_COUNT) */
    return count <= TIMES_MAX || report_error(report, KILN_CODE_LIMIT, where, "sample the motion more coarsely",
                                              "%u time samples (at most %d)", count, TIMES_MAX);
}

bool check_transform(double m[16], const kiln_where *where, kiln_report *report) {
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return report_error(report, KILN_CODE_RANGE, where, "repair the transform in the tool that wrote it",
                                "element %d of the transform is not a finite number", i);
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
        report_warning(report, KILN_CODE_RANGE, where, NULL,
                       "the transform is not affine: its last row is taken to be 0 0 0 1");
        m[3] = m[7] = m[11] = 0;
        m[15] = 1;
    }
    return true;
}

bool check_reference(kiln_id id, uint32_t count, bool none_allowed, const char *noun, const kiln_where *where,
                     kiln_report *report) {
    if (id == 0 ? none_allowed : id <= count) return true;
    return report_error(report, KILN_CODE_REFERENCE, where, NULL, "%s %u does not exist (the scene has %u)", noun, id,
                        count);
}

bool check_choice(unsigned value, unsigned count, const char *name, const kiln_where *where, kiln_report *report) {
    return value < count ||
           report_error(report, KILN_CODE_RANGE, where, NULL, "%s %u is none of the %u that exist", name, value, count);
}

bool array_room(void **array, uint32_t count, size_t size, kiln_report *report) {
    enum { FIRST = 8 };
    bool full = count < FIRST ? count == 0 : (count & (count - 1)) == 0; /* capacities are powers of two */
    if (!full) return true;
    if (count > UINT32_MAX / 2 || !array_resize(array, count < FIRST ? FIRST : 2 * (size_t)count, size))
        return report_no_memory(report, "building the scene");
    return true;
}
