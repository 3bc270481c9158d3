/* Scene-linear files with layers. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/text.h"
#include "job/json.h"
#include "job/layers.h"
#include "job/picture.h"

/* A layer's channels; beauty and measures stay as exact as they were computed, what a compositor looks at is half. */
typedef struct layer_row {
    const char *channels[3];
    bool full;
} layer_row;

static const layer_row layers[KILN_AOV_COUNT] = {
    [KILN_AOV_ALPHA] = {{"alpha.A"}, true},
    [KILN_AOV_ALBEDO] = {{"albedo.R", "albedo.G", "albedo.B"}, false},
    [KILN_AOV_NORMAL] = {{"normal.X", "normal.Y", "normal.Z"}, false},
    [KILN_AOV_DEPTH] = {{"depth.Z"}, true},
    [KILN_AOV_POSITION] = {{"position.X", "position.Y", "position.Z"}, true},
    [KILN_AOV_UV] = {{"uv.U", "uv.V"}, true},
    [KILN_AOV_OBJECT] = {{"object.Y"}, true},
    [KILN_AOV_MATERIAL] = {{"material.Y"}, true},
    [KILN_AOV_SAMPLES] = {{"samples.Y"}, true},
    [KILN_AOV_ERROR] = {{"error.Y"}, true},
};

static uint32_t channels_of(int aov) {
    uint32_t n = 0;
    while (n < 3 && layers[aov].channels[n]) n++;
    return n;
}

typedef struct assembly {
    const picture *picture;
    kiln_arena arena; /* of values and names */
    size_t pixels;
    kiln_exr_channel *channels;
    kiln_exr_attribute *attributes;
    uint32_t count, attribute_count;
    bool failed; /* out of memory */
} assembly;

/* Parts of the picture have no colour behind them, and sum to what has none either. */
static bool has_parts(const picture *p) { return kiln_film_part_count(p->film) > 0; }

static float *values_of(assembly *a, size_t channels) {
    float *values = ARENA_ARRAY(&a->arena, float, a->pixels * channels);
    a->failed |= !values;
    return values;
}

/* layer "": the picture itself. */
static void add(assembly *a, const char *layer, const char *channel, const float *values, size_t stride, bool full) {
    kiln_text name = {0};
    text_format(&name, "%s%s%s", layer, *layer ? "." : "", channel);
    const char *kept = name.data ? arena_string(&a->arena, name.data) : NULL;
    text_free(&name);
    a->failed |= !kept;
    if (kept) a->channels[a->count++] = (kiln_exr_channel){kept, values, stride, full};
}

static void add_rgb(assembly *a, const char *layer, const float *values) {
    static const char *const rgb[] = {"R", "G", "B"};
    for (size_t k = 0; k < 3; k++) add(a, layer, rgb[k], values + k, 3, true);
}

static void add_aov(assembly *a, int aov, const float *values) {
    const picture *p = a->picture;
    bool premultiplied = (p->transparent && !p->background) || (p->background && has_parts(p)); /* the film's RGB is */
    bool is_picture = aov == KILN_AOV_ALPHA && premultiplied;
    if (!is_picture && !(p->layers & 1u << aov)) return; /* it was only needed to put a colour behind */
    if (is_picture) add(a, "", "A", values, 1, true);
    else
        for (size_t k = 0; k < channels_of(aov); k++)
            add(a, "", layers[aov].channels[k], values + k, channels_of(aov), layers[aov].full);
}

/* The picture, and what the film holds by its own number. */
static void add_fixed_layers(assembly *a) {
    const picture *p = a->picture;
    uint32_t held = kiln_film_describe(p->film).aovs;
    float *beauty = values_of(a, 3), *alpha = NULL;
    for (int i = 0; i < KILN_AOV_COUNT && !a->failed; i++) {
        if (!(held & 1u << i)) continue;
        float *values = values_of(a, channels_of(i));
        if (!values) return;
        kiln_film_aov(p->film, (kiln_aov)i, values);
        if (i == KILN_AOV_ALPHA) alpha = values;
        add_aov(a, i, values);
    }
    if (a->failed) return;
    if (has_parts(p)) kiln_film_beauty(p->film, beauty);
    else picture_beauty(p, alpha, beauty);
    add_rgb(a, "", beauty);
}

/* All digits, so that the sums hold. */
static void add_parts(assembly *a) {
    for (uint32_t i = 0, n = kiln_film_part_count(a->picture->film); i < n && !a->failed; i++) {
        kiln_film_part_info part = kiln_film_describe_part(a->picture->film, i);
        kiln_text layer = {0};
        layers_name_part(&part, &layer);
        float *values = values_of(a, 3);
        if (values) kiln_film_part(a->picture->film, i, values);
        if (values) add_rgb(a, layer.data ? layer.data : "", values);
        a->failed |= layer.failed;
        text_free(&layer);
    }
}

/* {"name":"id in hexadecimal"} of what is seen; NULL: out of memory. */
static char *manifest_of(const kiln_film *film, kiln_matte matte) {
    uint32_t count;
    kiln_matte_name *names = kiln_film_matte_names(film, matte, &count);
    json_t *o = names ? json_object() : NULL;
    for (uint32_t i = 0; i < count; i++) {
        char id[9];
        json_t *name = json_text_of(names[i].name);
        snprintf(id, sizeof id, "%08x", names[i].id);
        if (name) put_text(o, json_string_value(name), id);
        json_decref(name);
    }
    char *text = o ? json_dumps(o, JSON_COMPACT | JSON_ENSURE_ASCII) : NULL;
    json_decref(o);
    free(names);
    return text;
}

/* Cryptomatte specification 1.2, 'Metadata': the key of a matte is the first seven digits of its name's hash. */
static void add_metadata(assembly *a, const char *layer, const char *what, const char *value) {
    kiln_text name = {0};
    char id[9];
    snprintf(id, sizeof id, "%08x", kiln_matte_id(layer));
    text_format(&name, "cryptomatte/%.7s/%s", id, what);
    const char *kept = name.data ? arena_string(&a->arena, name.data) : NULL;
    const char *text = value ? arena_string(&a->arena, value) : NULL;
    text_free(&name);
    a->failed |= !kept || !text;
    if (kept && text) a->attributes[a->attribute_count++] = (kiln_exr_attribute){kept, KILN_EXR_STRING, text, 0};
}

/* Two ranks a layer: id and share in R and G, the next in B and A. */
static void add_matte(assembly *a, kiln_matte matte) {
    static const char *const channels[] = {"R", "G", "B", "A"};
    const char *name = layers_name_matte(matte);
    float *values = values_of(a, 2 * KILN_MATTE_RANKS);
    if (!values) return;
    kiln_film_matte(a->picture->film, matte, values);
    for (size_t i = 0; i < 2 * KILN_MATTE_RANKS; i++) {
        char layer[32];
        snprintf(layer, sizeof layer, "%s%02zu", name, i / 4);
        add(a, layer, channels[i % 4], values + i, 2 * KILN_MATTE_RANKS, true);
    }
    char *manifest = manifest_of(a->picture->film, matte);
    add_metadata(a, name, "name", name);
    add_metadata(a, name, "hash", "MurmurHash3_32");
    add_metadata(a, name, "conversion", "uint32_to_float32");
    add_metadata(a, name, "manifest", manifest);
    free(manifest);
}

/* Room for all that add_… may add. */
static bool make_room(assembly *a, const kiln_film_desc *d) {
    enum { MATTE_ATTRIBUTES = 4 };
    const picture *p = a->picture;
    size_t channels = 4 + 3 * ((size_t)KILN_AOV_COUNT + kiln_film_part_count(p->film)) +
                      (size_t)KILN_MATTE_COUNT * 2 * KILN_MATTE_RANKS;
    a->pixels = (size_t)(d->crop[2] - d->crop[0]) * (d->crop[3] - d->crop[1]);
    a->channels = ARENA_ARRAY(&a->arena, kiln_exr_channel, channels);
    a->attributes = ARENA_ARRAY(&a->arena, kiln_exr_attribute,
                                (size_t)p->attribute_count + KILN_MATTE_COUNT * MATTE_ATTRIBUTES);
    if (!a->channels || !a->attributes) return false;
    if (p->attribute_count) memcpy(a->attributes, p->attributes, p->attribute_count * sizeof *a->attributes);
    a->attribute_count = p->attribute_count;
    return true;
}

static bool assemble(assembly *a, const kiln_film_desc *d) {
    if (!make_room(a, d)) return false;
    add_fixed_layers(a);
    add_parts(a);
    for (int m = 0; m < KILN_MATTE_COUNT && !a->failed; m++)
        if (d->mattes >> m & 1) add_matte(a, (kiln_matte)m);
    return !a->failed;
}

bool picture_write_exr(const picture *p, const char *path, kiln_report *report) {
    kiln_film_desc d = kiln_film_describe(p->film);
    assembly a = {.picture = p};
    float xy[8];
    bool done = assemble(&a, &d) || report_no_memory(report, "writing a picture");
    if (done) {
        kiln_exr_file file = {.width = d.width, .height = d.height, .channels = a.channels, .channel_count = a.count,
                              .attributes = a.attributes, .attribute_count = a.attribute_count,
                              .chromaticities = kiln_color_chromaticities(p->color, xy) ? xy : NULL};
        memcpy(file.crop, d.crop, sizeof file.crop);
        done = image_write_exr(path, &file, report);
    }
    arena_free(&a.arena);
    return done;
}
