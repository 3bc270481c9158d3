/* Where renders happen, and how textures, factors and lights get there. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "color/color.h"
#include "color/gamut.h"
#include "color/names.h"

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* What configs call linear Rec.709: OpenColorIO's ACES configs from 2.1 on, the ACES 1 configs before them, Blender. */
static const char *const rec709_names[] = {"lin_rec709",     "lin_rec709_srgb",            "Linear Rec.709 (sRGB)",
                                           "Linear Rec.709", "Utility - Linear - Rec.709", "Utility - Linear - sRGB",
                                           "lin_rec709_scene", "lin_srgb"};

/* The 3 × 3 matrix that a conversion is. linear: whether it is one; the colours that tell reach beyond 1 and below 0.
 * False: reported. */
static bool measure(const ocio_config *config, const char *from, const char *to, double matrix[9], bool *linear,
                    const kiln_where *where, kiln_report *report) {
    ocio_processor *processor = ocio_convert(config, from, to, where, report);
    if (!processor) return false;
    enum { PROBES = 8 };
    static const float probes[PROBES][3] = {{1, 0, 0},   {0, 1, 0},           {0, 0, 1},          {0.18f, 0.18f, 0.18f},
                                            {10, 20, 5}, {0.9f, -0.1f, 0.3f}, {1e-3f, 2e-3f, 500}, {0, 0, 0}};
    float values[PROBES][3];
    memcpy(values, probes, sizeof values);
    ocio_apply(processor, values[0], PROBES);
    ocio_processor_free(processor);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) matrix[3 * row + column] = (double)values[column][row];
    *linear = true;
    for (int p = 0; p < PROBES; p++)
        for (int row = 0; row < 3; row++) {
            const double *m = matrix + 3 * row;
            double expected = m[0] * (double)probes[p][0] + m[1] * (double)probes[p][1] + m[2] * (double)probes[p][2];
            double scale = fabs((double)probes[p][0]) + fabs((double)probes[p][1]) + fabs((double)probes[p][2]);
            /* 1e-4 of the colour: float rounding through a few matrices is 1e-6, a curve is off by far more. */
            if (!(fabs((double)values[p][row] - expected) <= 1e-4 * scale)) *linear = false;
        }
    return true;
}

/* A space of the embedded config, reached in another config by way of ACES2065-1. False: reported. */
static bool by_interchange(const kiln_color *color, const char *name, linear_space *space, kiln_report *report) {
    bool linear;
    space->direct = false;
    space->space = ocio_config_find(color->config, COLOR_INTERCHANGE);
    return measure(color->embedded, name, COLOR_ACES, space->matrix, &linear, &color->where, report) &&
           (linear || report_error(report, KILN_CODE_COLOR, &color->where, "choose a scene-linear space",
                                   "the working space %s is not scene-linear", name));
}

static linear_space by_name(const char *space) {
    linear_space result = {.space = space, .direct = true};
    memcpy(result.matrix, identity, sizeof identity);
    return result;
}

/* Linear Rec.709 as this config knows it. */
static bool find_rec709(const kiln_color *color, linear_space *space, kiln_report *report) {
    for (size_t i = 0; i < sizeof rec709_names / sizeof *rec709_names; i++) {
        const char *found = ocio_config_find(color->config, rec709_names[i]);
        if (!found || ocio_config_reference(color->config, found) != OCIO_SCENE_REFERRED) continue;
        *space = by_name(found);
        return true;
    }
    if (ocio_config_has_role(color->config, COLOR_INTERCHANGE))
        return by_interchange(color, COLOR_LIN_REC709, space, report);
    return report_error(report, KILN_CODE_COLOR_CONFIG, &color->where,
                        "give the config a role " COLOR_INTERCHANGE " (its ACES2065-1), or its linear Rec.709 space "
                        "the alias " COLOR_LIN_REC709,
                        "the config does not say which of its colour spaces is linear Rec.709, that of glTF's colours");
}

/* Names of scene-linear spaces, for a message; all spaces when the config does not say which are linear. */
static name_list linear_names(kiln_color *color) {
    name_list list = {arena_array(&color->arena, color->spaces.count, sizeof *list.names), 0};
    for (size_t i = 0; list.names && i < color->spaces.count; i++)
        if (ocio_config_says_linear(color->config, color->spaces.names[i]))
            list.names[list.count++] = color->spaces.names[i];
    return list.count ? list : color->spaces;
}

static bool find_named(kiln_color *color, const char *name, linear_space *space, kiln_report *report) {
    const char *found = ocio_config_find(color->config, name);
    if (found) {
        *space = by_name(found);
        return ocio_config_reference(color->config, found) == OCIO_SCENE_REFERRED ||
               report_error(report, KILN_CODE_COLOR, &color->where, "choose a scene-linear space",
                            "the working space %s is not scene-linear", name);
    }
    if (strcmp(name, COLOR_LIN_REC709) == 0) return find_rec709(color, space, report);
    /* One of kiln's own spaces; a role that the config does not have is not kiln's to fill. */
    bool own = ocio_config_find(color->embedded, name) && !ocio_config_has_role(color->embedded, name) &&
               ocio_config_reference(color->embedded, name) == OCIO_SCENE_REFERRED;
    if (own && ocio_config_has_role(color->config, COLOR_INTERCHANGE))
        return by_interchange(color, name, space, report);
    name_list linear = linear_names(color);
    return color_unknown_name(color, "colour space", name, &linear, report);
}

bool color_find_working(kiln_color *color, const char *name, kiln_report *report) {
    linear_space rec709, working;
    if (!find_named(color, name, &working, report) || !find_rec709(color, &rec709, report)) return false;
    double between[9], into[9], inverse[9];
    bool linear;
    const char *spaces[2] = {arena_string(&color->arena, rec709.space), arena_string(&color->arena, working.space)};
    if (!spaces[0] || !spaces[1]) return report_no_memory(report, "finding the working space");
    if (!measure(color->config, spaces[0], spaces[1], between, &linear, &color->where, report)) return false;
    if (!linear || !matrix3_invert(working.matrix, inverse) || !matrix3_invert(between, into))
        return report_error(report, KILN_CODE_COLOR, &color->where, "choose a scene-linear space",
                            "the working space %s is not scene-linear", name);
    matrix3_multiply(between, rec709.matrix, into);
    matrix3_multiply(inverse, into, color->from_rec709);
    color->working = working;
    color->working.space = spaces[1];
    return true;
}

bool kiln_color_working_space(const kiln_color *color, kiln_decoding *decoding, kiln_report *report) {
    memset(decoding, 0, sizeof *decoding);
    /* What a texture's codes mean is glTF's to say, not the config's: sRGB is sRGB. */
    ocio_processor *srgb = ocio_convert(color->embedded, COLOR_SRGB_TEXTURE, COLOR_LIN_REC709, &color->where, report);
    if (!srgb) return false;
    float codes[256][3];
    for (int code = 0; code < 256; code++)
        codes[code][0] = codes[code][1] = codes[code][2] = (float)code / 255;
    ocio_apply(srgb, codes[0], 256);
    ocio_processor_free(srgb);
    for (int t = 0; t < KILN_TRANSFER_COUNT; t++) {
        for (int code = 0; code < 256; code++)
            decoding->curve[t][code] = t == KILN_TRANSFER_SRGB ? codes[code][1] : (float)code / 255;
        for (int k = 0; k < 9; k++)
            decoding->matrix[t][k] = (float)(t == KILN_TRANSFER_DATA ? identity[k] : color->from_rec709[k]);
    }
    decoding->present = true;
    return true;
}

/* A config speaks of whites as adapted to each other, so that chromaticities cannot be computed: the space is compared
 * with those that kiln knows. */
bool kiln_color_chromaticities(const kiln_color *color, float xy[8]) {
    bool found = false;
    kiln_report *unheard = kiln_report_create();
    for (size_t i = 0; unheard && !found && i < color_gamut_count; i++) {
        double matrix[9];
        bool linear;
        if (!measure(color->embedded, COLOR_LIN_REC709, color_gamuts[i].space, matrix, &linear, NULL, unheard)) break;
        found = true;
        /* 2e-3 covers other adaptations than Bradford's, and roundings in configs; the spaces differ by 1e-1. */
        for (int k = 0; k < 9; k++) found = found && fabs(matrix[k] - color->from_rec709[k]) < 2e-3;
        for (int k = 0; found && k < 8; k++) xy[k] = (float)color_gamuts[i].xy[k];
    }
    kiln_report_destroy(unheard);
    return found;
}
