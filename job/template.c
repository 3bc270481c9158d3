#include "job/template.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"

/* A camera's name comes out of a file that anybody may have written. */
static void append_part(const char *value, kiln_text *out) {
    bool dots = strcmp(value, ".") == 0 || strcmp(value, "..") == 0;
    if (!*value) text_append(out, "_");
    for (const char *c = value; *c; c++) {
        bool harmless = (unsigned char)*c >= 32 && *c != 127 && *c != '/' && !dots;
        text_append_bytes(out, harmless ? c : "_", 1);
    }
}

static void append_frame(int64_t frame, size_t digits, kiln_text *out) {
    text_format(out, "%0*lld", (int)digits, (long long)frame);
}

/* The inside of {…}. */
static bool append_field(const char *field, const template_values *v, kiln_text *out) {
    const struct {
        const char *name, *value;
    } rows[] = {{"name", v->name}, {"camera", v->camera}, {"variant", v->variant}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (strcmp(field, rows[i].name) == 0) {
            append_part(rows[i].value, out);
            return true;
        }
    uint64_t digits = 1;
    if (strncmp(field, "frame", 5) != 0 || (field[5] && field[5] != ':')) return false;
    if (field[5] && (!text_to_uint64(field + 6, &digits) || digits < 1 || digits > 18)) return false;
    append_frame(v->frame, (size_t)digits, out);
    return true;
}

static bool refuse(const char *pattern, const char *at, const kiln_where *where, kiln_report *report) {
    return report_error(report, KILN_CODE_USAGE, where,
                        "use {name} {camera} {frame} {frame:4} {variant} or ####; {{ and }} stand for braces",
                        "'%.100s' in '%.200s' cannot be filled in", at, pattern);
}

bool template_expand(const char *pattern, const template_values *v, kiln_text *out, const kiln_where *where,
                     kiln_report *report) {
    for (const char *c = pattern; *c;) {
        size_t hashes = strspn(c, "#");
        if ((c[0] == '{' || c[0] == '}') && c[1] == c[0]) {
            text_append_bytes(out, c, 1);
            c += 2;
        } else if (*c == '{') {
            char field[64];
            size_t length = strcspn(c, "}");
            if (!c[length] || length > sizeof field) return refuse(pattern, c, where, report);
            memcpy(field, c + 1, length - 1);
            field[length - 1] = '\0';
            if (!append_field(field, v, out)) return refuse(pattern, c, where, report);
            c += length + 1;
        } else if (*c == '}') {
            return refuse(pattern, c, where, report);
        } else if (hashes >= 2) {
            append_frame(v->frame, hashes < 18 ? hashes : 18, out);
            c += hashes;
        } else text_append_bytes(out, c++, 1);
    }
    return true;
}

char *template_asset_name(const char *path) {
    if (strcmp(path, "-") == 0) return strdup("stdin");
    const char *base = path_base(path), *dot = strrchr(base, '.');
    size_t length = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    return length ? strndup(base, length) : strdup("scene");
}
