#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text.h"
#include "color/color.h"
#include "color/names.h"

/* A config is text, or an archive with a few LUTs. */
enum { CONFIG_BYTES_MAX = 256 * 1024 * 1024 };

/* The number behind "ocio_profile_version:" at the start of a line; false: not found, OpenColorIO shall say why. */
static bool find_version(const char *text, unsigned *major, unsigned *minor) {
    static const char key[] = "ocio_profile_version:";
    for (const char *at = text; (at = strstr(at, key)); at++) {
        if (at != text && at[-1] != '\n') continue;
        *minor = 0;
        return sscanf(at + sizeof key - 1, "%u.%u", major, minor) >= 1;
    }
    return false;
}

static bool check_file(const char *path, const kiln_where *where, kiln_report *report) {
    kiln_bytes bytes;
    if (!file_read(path, CONFIG_BYTES_MAX, &bytes, where, report)) return false;
    unsigned major, minor;
    bool too_new = find_version((const char *)bytes.data, &major, &minor) && ocio_version_too_new(major, minor);
    file_free(&bytes);
    if (!too_new) return true;
    kiln_text remedy = {0};
    text_format(&remedy, "save the config as profile version %.3s, use an older release of it, or build kiln with "
                         "OpenColorIO %u.%u", ocio_version(), major, minor);
    report_error(report, KILN_CODE_COLOR_CONFIG, where, remedy.data,
                 "the config's profile version %u.%u needs OpenColorIO %u.%u or newer; kiln runs with %s", major, minor,
                 major, minor, ocio_version());
    text_free(&remedy);
    return false;
}

static bool check_builtin(const kiln_color *color, kiln_report *report) {
    return !ocio_version_too_new(2, 2) ||
           report_error(report, KILN_CODE_COLOR_CONFIG, &color->where, "name a config file",
                        "OpenColorIO brings configs of its own from version 2.2 on; kiln runs with %s", ocio_version());
}

/* $OCIO that is set but empty is not set. */
static const char *config_path(const kiln_color_options *options, bool *from_environment) {
    const char *path = options && options->config && *options->config ? options->config : NULL;
    const char *environment = path ? NULL : getenv("OCIO");
    *from_environment = environment && *environment;
    return *from_environment ? environment : path;
}

static bool open_config(kiln_color *color, const kiln_color_options *options, kiln_report *report) {
    bool from_environment;
    const char *path = config_path(options, &from_environment);
    color->embedded = ocio_config_embedded(report);
    if (!color->embedded) return false;
    if (!path) {
        color->config = color->embedded;
        color->where = where_root("embedded kiln config");
        return true;
    }
    kiln_text place = {0};
    text_format(&place, from_environment ? "%s ($OCIO)" : "%s", path);
    color->where = where_root(arena_string(&color->arena, place.data));
    text_free(&place);
    if (!color->where.name) return report_no_memory(report, "reading a colour config");
    if (!(strncmp(path, "ocio://", 7) == 0 ? check_builtin(color, report) : check_file(path, &color->where, report)))
        return false;
    color->config = ocio_config_read(path, &color->where, report);
    return color->config != NULL;
}

static bool list_names(kiln_color *color, ocio_kind kind, const char *display, name_list *list) {
    size_t count = 0;
    while (ocio_config_name(color->config, kind, display, count)) count++;
    list->names = arena_array(&color->arena, count, sizeof *list->names);
    for (; list->names && list->count < count; list->count++) {
        const char *name = ocio_config_name(color->config, kind, display, list->count);
        if (!(list->names[list->count] = arena_string(&color->arena, name))) return false;
    }
    return list->names != NULL;
}

static bool list_everything(kiln_color *color, kiln_report *report) {
    bool done = list_names(color, OCIO_DISPLAYS, NULL, &color->displays) &&
                list_names(color, OCIO_LOOKS, NULL, &color->looks) &&
                list_names(color, OCIO_SPACES, NULL, &color->spaces);
    color->views = done ? arena_array(&color->arena, color->displays.count, sizeof *color->views) : NULL;
    for (size_t d = 0; color->views && d < color->displays.count; d++)
        if (!list_names(color, OCIO_VIEWS, color->displays.names[d], &color->views[d])) color->views = NULL;
    return color->views || report_no_memory(report, "listing a colour config");
}

static bool describe(kiln_color *color, const char *working_space, kiln_report *report) {
    const char *title = ocio_config_title(color->config);
    kiln_text text = {0};
    if (!color_is_embedded(color)) text_append(&text, "config ");
    if (!color_is_embedded(color) && *title) text_format(&text, "%s, ", title);
    text_format(&text, "%s, working space %s", color->where.name, working_space);
    color->description = text.data ? arena_string(&color->arena, text.data) : NULL;
    text_free(&text);
    return color->description || report_no_memory(report, "describing a colour config");
}

bool kiln_color_create(const kiln_color_options *options, kiln_color **result, kiln_report *report) {
    *result = NULL;
    kiln_color *color = calloc(1, sizeof *color);
    if (!color) return report_no_memory(report, "reading a colour config");
    const char *working = options && options->working_space && *options->working_space ? options->working_space
                                                                                        : COLOR_LIN_REC709;
    if (!open_config(color, options, report) || !list_everything(color, report) ||
        !color_find_working(color, working, report) || !describe(color, working, report)) {
        kiln_color_destroy(color);
        return false;
    }
    *result = color;
    return true;
}

void kiln_color_destroy(kiln_color *color) {
    if (!color) return;
    if (!color_is_embedded(color)) ocio_config_free(color->config);
    ocio_config_free(color->embedded);
    arena_free(&color->arena);
    free(color);
}

const char *kiln_color_describe(const kiln_color *color) { return color->description; }

static const char *name_at(const name_list *list, size_t index) {
    return index < list->count ? list->names[index] : NULL;
}

const char *kiln_color_display(const kiln_color *color, size_t index) { return name_at(&color->displays, index); }
const char *kiln_color_look(const kiln_color *color, size_t index) { return name_at(&color->looks, index); }
const char *kiln_color_space(const kiln_color *color, size_t index) { return name_at(&color->spaces, index); }

const char *kiln_color_view(const kiln_color *color, const char *display, size_t index) {
    for (size_t d = 0; d < color->displays.count; d++)
        if (strcmp(color->displays.names[d], display) == 0) return name_at(&color->views[d], index);
    return NULL;
}

static void append_names(kiln_text *text, const name_list *known) {
    enum { LISTED = 100 }; /* a studio's config has some dozens */
    for (size_t i = 0; i < known->count && i < LISTED; i++)
        text_format(text, "%s\"%s\"", i ? ", " : "", known->names[i]);
    if (known->count > LISTED) text_format(text, " and %zu more", known->count - LISTED);
}

bool color_unknown_name(const kiln_color *color, const char *what, const char *given, const name_list *known,
                        kiln_report *report) {
    kiln_text text = {0}, remedy = {0};
    if (known->count) text_append(&text, known->count == 1 ? "there is: " : "there are: ");
    else text_append(&text, "there is none");
    append_names(&text, known);
    const char *nearest = text_nearest(given, known->names, known->count);
    if (nearest) text_format(&remedy, "did you mean \"%s\"?", nearest);
    else if (known->count) text_append(&remedy, "choose one of them, or another config with --ocio or $OCIO");
    else text_append(&remedy, "choose another config with --ocio or $OCIO");
    report_error(report, KILN_CODE_COLOR, &color->where, remedy.data, "%s \"%s\" does not exist; %s", what, given,
                 text.data ? text.data : "");
    text_free(&text);
    text_free(&remedy);
    return false;
}
