/* job/study_report.c: report.html: one file with everything in it, which needs no network. */
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/image.h"
#include "job/study.h"

/* job/study/report.html and so on, embedded by CMake. */
extern const char study_report_html[], study_report_css[], study_report_js[];

static void append_base64(const unsigned char *bytes, size_t size, kiln_text *out) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = (uint32_t)bytes[i] << 16;
        if (i + 1 < size) word |= (uint32_t)bytes[i + 1] << 8;
        if (i + 2 < size) word |= bytes[i + 2];
        char code[4] = {digits[word >> 18], digits[word >> 12 & 63], '=', '='};
        if (i + 1 < size) code[2] = digits[word >> 6 & 63];
        if (i + 2 < size) code[3] = digits[word & 63];
        text_append_bytes(out, code, 4);
    }
}

/* "data:image/webp;base64,…" of a picture of the study; null where there is none, as in one that was interrupted. */
static json_t *embed(const study *s, const char *name, const char *suffix) {
    kiln_text relative = {0}, uri = {0};
    kiln_bytes bytes;
    text_format(&relative, "pictures/%s%s", name, suffix);
    char *path = relative.data ? study_path(s, relative.data) : NULL;
    kiln_report *silent = kiln_report_create();
    json_t *value = NULL;
    if (path && silent && file_read(path, (uint64_t)1 << 30, &bytes, NULL, silent)) {
        text_append(&uri, "data:image/webp;base64,");
        append_base64(bytes.data, bytes.size, &uri);
        value = json_string(uri.data ? uri.data : "");
        file_free(&bytes);
    }
    kiln_report_destroy(silent);
    free(path);
    text_free(&relative);
    text_free(&uri);
    return value ? value : json_null();
}

static json_t *embed_all(const study *s) {
    json_t *pictures = json_object();
    for (uint32_t i = 0; i < s->plan.config_count; i++) {
        json_t *both = json_object();
        put(both, "picture", embed(s, s->plan.configs[i].name, ".webp"));
        put(both, "error", embed(s, s->plan.configs[i].name, ".error.webp"));
        put(pictures, s->plan.configs[i].name, both);
    }
    json_t *reference = json_object();
    put(reference, "picture", embed(s, "reference", ".webp"));
    put(pictures, "reference", reference);
    return pictures;
}

static bool write_reference(const study *s) {
    char *path = study_path(s, "pictures/reference.webp");
    const kiln_image_write_options options = {.srgb = true, .quality = 90};
    kiln_image image = {s->run.view.width, s->run.view.height, 3, KILN_PIXELS_F32, s->reference.display};
    bool done = path && image_write_display(path, &image, &options, s->run.report);
    free(path);
    return done;
}

/* Inside of a script element '<' could end it; in JSON it stands in strings alone, where \u003c is the same. */
static void append_json(const json_t *json, kiln_text *out) {
    char *text = json_dumps(json, JSON_COMPACT | JSON_REAL_PRECISION(6));
    if (!text) out->failed = true;
    for (const char *at = text; at && *at;) {
        size_t plain = strcspn(at, "<");
        text_append_bytes(out, at, plain);
        if (at[plain]) text_append(out, "\\u003c");
        at += plain + (at[plain] != '\0');
    }
    free(text);
}

static void append_escaped(const char *text, kiln_text *out) {
    for (; *text; text++) switch (*text) {
        case '<': text_append(out, "&lt;"); break;
        case '>': text_append(out, "&gt;"); break;
        case '&': text_append(out, "&amp;"); break;
        case '"': text_append(out, "&quot;"); break;
        default: text_append_bytes(out, text, 1);
        }
}

static void append_advice(const json_t *description, kiln_text *out) {
    const json_t *line;
    size_t i;
    json_array_foreach(json_object_get(description, "advice"), i, line) {
        text_append(out, "<p>");
        append_escaped(json_string_value(line), out);
        text_append(out, "</p>\n");
    }
}

static void append_part(const study *s, const json_t *description, const char *name, size_t length, kiln_text *out) {
    const char *scene = json_string_value(json_object_get(description, "scene"));
    if (strncmp(name, "scene", length) == 0) append_escaped(scene ? path_base(scene) : "", out);
    else if (strncmp(name, "advice", length) == 0) append_advice(description, out);
    else if (strncmp(name, "style", length) == 0) text_append(out, study_report_css);
    else if (strncmp(name, "script", length) == 0) text_append(out, study_report_js);
    else if (strncmp(name, "study", length) == 0) append_json(description, out);
    else if (strncmp(name, "pictures", length) == 0) {
        json_t *pictures = embed_all(s);
        append_json(pictures, out);
        json_decref(pictures);
    }
}

/* The template with what stands in {{double braces}} filled in. */
bool study_write_report(const study *s, const json_t *description) {
    kiln_text page = {0};
    if (!write_reference(s)) return false;
    for (const char *at = study_report_html; *at;) {
        const char *open = strstr(at, "{{"), *close = open ? strstr(open, "}}") : NULL;
        if (!close) {
            text_append(&page, at);
            break;
        }
        text_append_bytes(&page, at, (size_t)(open - at));
        append_part(s, description, open + 2, (size_t)(close - open - 2), &page);
        at = close + 2;
    }
    char *path = study_path(s, "report.html");
    bool done = path && (page.data && !page.failed ? file_replace(path, page.data, page.length, s->run.report)
                                                   : report_no_memory(s->run.report, "writing a report"));
    free(path);
    text_free(&page);
    return done;
}
