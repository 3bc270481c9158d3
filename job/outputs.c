#include "job/outputs.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct suffix_row {
    const char *suffix;
    output_kind kind;
    const char *format;
    bool transparent; /* can hold alpha */
    bool layers;      /* can hold AOVs */
} suffix_row;

static const suffix_row suffixes[] = {
    {".png", OUTPUT_DISPLAY, "PNG", true, false},   {".jpg", OUTPUT_DISPLAY, "JPEG", false, false},
    {".jpeg", OUTPUT_DISPLAY, "JPEG", false, false}, {".webp", OUTPUT_DISPLAY, "WebP", true, false},
    {".tif", OUTPUT_DISPLAY, "TIFF", true, false},  {".tiff", OUTPUT_DISPLAY, "TIFF", true, false},
    {".exr", OUTPUT_EXR, "OpenEXR", true, true},    {".hdr", OUTPUT_HDR, "Radiance HDR", false, false},
};

static const suffix_row *find_suffix(const char *path) {
    char suffix[16];
    path_suffix(path, suffix);
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++)
        if (strcmp(suffix, suffixes[i].suffix) == 0 || (i == 0 && strcmp(path, "-") == 0)) return &suffixes[i];
    return NULL;
}

output_kind output_kind_of(const char *path) {
    const suffix_row *row = find_suffix(path);
    return row ? row->kind : OUTPUT_UNKNOWN;
}

const char *output_format_name(const char *path) {
    const suffix_row *row = find_suffix(path);
    return row ? row->format : "unknown";
}

static bool check(const job_options *o, const char *path, kiln_report *report) {
    const suffix_row *row = find_suffix(path);
    kiln_where where = where_root(path);
    if (!row)
        return report_error(report, KILN_CODE_USAGE, &where, "use .exr, .hdr, .png, .jpg, .webp or .tif",
                            "the suffix of the output names no format that kiln writes");
    if (strcmp(path, "-") == 0 && isatty(STDOUT_FILENO))
        return report_error(report, KILN_CODE_USAGE, &where, "send it to a file or a pipe",
                            "a picture would go to the terminal");
    if (o->background.kind == KILN_BACKGROUND_TRANSPARENT && !row->transparent)
        return report_error(report, KILN_CODE_USAGE, &where,
                            "write .png, .webp, .tif or .exr, or give --background a colour",
                            "%s cannot be transparent", row->format);
    return true;
}

static bool add(const job_options *o, output_plan *plan, const char *pattern, const template_values *values,
                kiln_report *report) {
    kiln_where where = where_root("--output");
    kiln_text text = {0};
    if (!template_expand(pattern, values, &text, &where, report)) {
        text_free(&text);
        return false;
    }
    char *path = text_take(&text);
    if (!path) return report_no_memory(report, "naming outputs");
    if (!check(o, path, report)) {
        free(path);
        return false;
    }
    plan->items[plan->count++] = (output){.path = path, .kind = output_kind_of(path)};
    return true;
}

bool outputs_plan(const job_options *o, const template_values *values, output_plan *plan, kiln_report *report) {
    uint32_t given = o->outputs.count, count = given ? given : 1;
    *plan = (output_plan){.items = array_alloc(count, sizeof *plan->items)};
    if (!plan->items) return report_no_memory(report, "naming outputs");
    for (uint32_t i = 0; i < count; i++)
        if (!add(o, plan, given ? o->outputs.items[i] : "{name}.png", values, report)) return false;
    if (layers_any(&o->layers) && !outputs_any(plan, OUTPUT_EXR)) {
        kiln_where where = where_root("--aov");
        return report_error(report, KILN_CODE_USAGE, &where, "add an output that ends in .exr",
                            "no output can hold the layers that it asks for");
    }
    return true;
}

void outputs_free(output_plan *plan) {
    for (uint32_t i = 0; i < plan->count; i++) free(plan->items[i].path);
    free(plan->items);
    *plan = (output_plan){0};
}

bool outputs_any(const output_plan *plan, output_kind kind) {
    for (uint32_t i = 0; i < plan->count; i++)
        if (plan->items[i].kind == kind) return true;
    return false;
}

/* The path of output `index`, and of the statistics behind the last one; NULL: there are none. */
static const char *path_at(const output_plan *plan, const char *stats, uint32_t index) {
    return index < plan->count ? plan->items[index].path : stats;
}

bool outputs_check_distinct(const output_plan *plan, const char *stats, kiln_report *report) {
    for (uint32_t i = 1; i <= plan->count; i++) {
        const char *path = path_at(plan, stats, i);
        for (uint32_t k = 0; path && k < i; k++) {
            if (!file_same_target(path, plan->items[k].path)) continue;
            kiln_where where = where_root(path);
            return report_error(report, KILN_CODE_USAGE, &where, "give each a name of its own",
                                "%s is this file too", i < plan->count ? "another output" : "the picture's output");
        }
    }
    return true;
}

bool outputs_check_input(const output_plan *plan, const char *stats, file_identity input, const char *reader,
                         kiln_report *report) {
    for (uint32_t i = 0; i <= plan->count; i++) {
        const char *path = path_at(plan, stats, i);
        if (!path || strcmp(path, "-") == 0 || !file_same(file_identify(path), input)) continue;
        kiln_where where = where_root(path);
        return report_error(report, KILN_CODE_USAGE, &where,
                            i < plan->count ? "give another name with -o" : "give --stats another name",
                            "this would overwrite a file that %s", reader);
    }
    return true;
}

static bool is_special(const char *path) {
    struct stat status;
    return strcmp(path, "-") == 0 || (stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode));
}

/* The writer itself is asked: it makes its temporary file, which goes again. Devices and pipes are not touched before
 * there is something to write. */
static bool try_path(const char *path, kiln_report *report) {
    if (is_special(path)) return true;
    kiln_writer *writer = file_create(path, report);
    if (!writer) return false;
    file_discard(writer);
    return true;
}

bool outputs_try(const output_plan *plan, const char *stats, kiln_report *report) {
    for (uint32_t i = 0; i < plan->count; i++)
        if (!try_path(plan->items[i].path, report)) return false;
    return !stats || try_path(stats, report);
}
