/* From the working space to a display. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "color/color.h"
#include "color/gamut.h"
#include "color/names.h"
#include "color/neutral.h"

/* Half floats end here, and so do the tables in many configs. */
static const float largest = 65504;

/* Far beyond any exposure of a real scene: 2^64 still leaves room in a float. */
static const double exposure_max = 64;

/* Pixels that are worked on at a time: 24 kB, which stays in the first cache. */
enum { BLOCK = 2048 };

struct kiln_view {
    kiln_arena arena;
    ocio_processor *processor;
    const char *description;
    float scale;      /* 2^exposure */
    float matrix[9];  /* working space to the space that the processor begins in */
    bool direct;      /* the matrix is the identity */
    bool neutral;     /* Khronos PBR Neutral comes between matrix and processor */
    bool srgb;
    uint8_t cicp[2];  /* primaries and transfer by ITU-T H.273; 0: unknown */
};

static bool known(const name_list *list, const char *name) {
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->names[i], name) == 0) return true;
    return false;
}

static const name_list *views_of(const kiln_color *color, const char *display) {
    for (size_t d = 0; d < color->displays.count; d++)
        if (strcmp(color->displays.names[d], display) == 0) return &color->views[d];
    return NULL;
}

/* OpenColorIO's notation: looks apply in order ("a, -b": b undone), "|" separates alternatives. */
static bool check_looks(const kiln_color *color, const char *looks, kiln_report *report) {
    for (const char *at = looks; *at;) {
        at += strspn(at, " +-");
        size_t length = strcspn(at, ",:|"), rest = length;
        while (length && at[length - 1] == ' ') length--;
        char *name = strndup(at, length);
        if (!name) return report_no_memory(report, "preparing a view");
        bool fine = !length || known(&color->looks, name) ||
                    color_unknown_name(color, "look", name, &color->looks, report);
        free(name);
        if (!fine) return false;
        at += rest + (at[rest] != 0);
    }
    return true;
}

/* The names that the options leave open, and whether the others exist. */
static bool choose(const kiln_color *color, kiln_view_options *options, kiln_report *report) {
    if (!options->display || !*options->display) options->display = ocio_config_default_display(color->config);
    if (!options->display)
        return report_error(report, KILN_CODE_COLOR_CONFIG, &color->where, "choose a config with displays",
                            "the config has no display");
    const name_list *views = views_of(color, options->display);
    if (!views) return color_unknown_name(color, "display", options->display, &color->displays, report);
    if (!options->view || !*options->view)
        options->view = ocio_config_default_view(color->config, options->display);
    if (!options->view)
        return report_error(report, KILN_CODE_COLOR_CONFIG, &color->where, "choose another display",
                            "display \"%s\" has no view", options->display);
    if (!known(views, options->view)) return color_unknown_name(color, "view", options->view, views, report);
    if (!(fabs(options->exposure) <= exposure_max))
        return report_error(report, KILN_CODE_USAGE, NULL, "give a number of stops, such as --exposure -1.5",
                            "an exposure of %g stops is not between %g and %g", options->exposure, -exposure_max,
                            exposure_max);
    return !options->look || check_looks(color, options->look, report);
}

static bool describe(kiln_view *view, const kiln_view_options *options, kiln_report *report) {
    kiln_text text = {0};
    text_format(&text, "display %s, view %s", options->display, options->view);
    if (options->look) text_format(&text, ", look %s", *options->look ? options->look : "none");
    text_format(&text, ", exposure %+.6g", options->exposure);
    view->description = text.data ? arena_string(&view->arena, text.data) : NULL;
    text_free(&text);
    return view->description || report_no_memory(report, "preparing a view");
}

/* Whether the pixels of a view are sRGB: by the name of the space that they end in, as configs write it ("sRGB",
 * "sRGB - Display", "Output - sRGB"). */
static bool ends_in_srgb(const kiln_color *color, const kiln_view_options *options) {
    const char *name = ocio_config_view_space(color->config, options->display, options->view);
    const char *space = name ? ocio_config_find(color->config, name) : NULL;
    if (!space || ocio_config_reference(color->config, space) == OCIO_DATA) return false;
    return strcasestr(space, "srgb") && !strcasestr(space, "lin") && !strcasestr(space, "p3") &&
           !strcasestr(space, "ap1");
}

/* The displays of the embedded config that ITU-T H.273 has numbers for. What other configs call by these names need not
 * be the same. */
static void tag(kiln_view *view, const kiln_color *color, const kiln_view_options *options) {
    static const struct { const char *display; uint8_t primaries, transfer; } rows[] = {{"Rec.1886", 1, 1},
                                                                                        {"Display P3", 12, 13}};
    const char *space = ocio_config_view_space(color->config, options->display, options->view);
    if (!color_is_embedded(color) || !space || ocio_config_reference(color->config, space) == OCIO_DATA) return;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (strcmp(options->display, rows[i].display) == 0) {
            view->cicp[0] = rows[i].primaries;
            view->cicp[1] = rows[i].transfer;
        }
}

static bool prepare(kiln_view *view, const kiln_color *color, const kiln_view_options *options, kiln_report *report) {
    view->scale = (float)exp2(options->exposure);
    view->srgb = ends_in_srgb(color, options);
    tag(view, color, options);
    view->neutral = color_is_embedded(color) && strcmp(options->view, COLOR_VIEW_NEUTRAL) == 0;
    view->direct = view->neutral ? strcmp(color->working.space, COLOR_LIN_REC709) == 0 : color->working.direct;
    double matrix[9];
    memcpy(matrix, color->working.matrix, sizeof matrix);
    if (view->neutral && !matrix3_invert(color->from_rec709, matrix))
        return report_error(report, KILN_CODE_INTERNAL, &color->where, NULL, "the working space cannot be inverted");
    for (int k = 0; k < 9; k++) view->matrix[k] = (float)matrix[k];
    view->processor = ocio_show(color->config, view->neutral ? COLOR_LIN_REC709 : color->working.space,
                                options->display, options->view, options->look, &color->where, report);
    return view->processor && describe(view, options, report);
}

bool kiln_view_create(const kiln_color *color, const kiln_view_options *given, kiln_view **result,
                      kiln_report *report) {
    *result = NULL;
    kiln_view_options options = given ? *given : (kiln_view_options){0};
    if (!choose(color, &options, report)) return false;
    kiln_view *view = calloc(1, sizeof *view);
    if (!view) return report_no_memory(report, "preparing a view");
    if (!prepare(view, color, &options, report)) {
        kiln_view_destroy(view);
        return false;
    }
    *result = view;
    return true;
}

void kiln_view_destroy(kiln_view *view) {
    if (!view) return;
    ocio_processor_free(view->processor);
    arena_free(&view->arena);
    free(view);
}

const char *kiln_view_describe(const kiln_view *view) { return view->description; }
bool kiln_view_is_srgb(const kiln_view *view) { return view->srgb; }

void kiln_view_cicp(const kiln_view *view, uint8_t *primaries, uint8_t *transfer) {
    *primaries = view->cicp[0];
    *transfer = view->cicp[1];
}

static inline float scrub(float x) {
    x = x == x ? x : 0;
    x = x > -largest ? x : -largest;
    return x < largest ? x : largest;
}

static inline float clamp01(float x) {
    x = x > 0 ? x : 0; /* NaN too */
    return x < 1 ? x : 1;
}

/* Exposed first: a sun of 1e9 nit that is exposed by −20 stops is not to be cut before. */
static void load(const kiln_view *view, const float *pixels, uint32_t channels, float *rgb, size_t count) {
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++) rgb[3 * i + k] = scrub(pixels[channels * i + k] * view->scale);
    if (view->direct) return;
    const float *m = view->matrix;
    for (float *p = rgb; p < rgb + 3 * count; p += 3) {
        float r = p[0], g = p[1], b = p[2];
        for (int row = 0; row < 3; row++) p[row] = scrub(m[3 * row] * r + m[3 * row + 1] * g + m[3 * row + 2] * b);
    }
}

void kiln_view_apply(const kiln_view *view, float *pixels, size_t pixel_count, uint32_t channels) {
    float rgb[3 * BLOCK];
    for (size_t done = 0, count; done < pixel_count; done += count, pixels += channels * count) {
        count = pixel_count - done < BLOCK ? pixel_count - done : BLOCK;
        load(view, pixels, channels, rgb, count);
        if (view->neutral) neutral_apply(rgb, count);
        ocio_apply(view->processor, rgb, count);
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 3; k++) pixels[channels * i + k] = clamp01(rgb[3 * i + k]);
    }
}
