/* Scene-linear files with layers. */
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
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
    [KILN_AOV_SAMPLES] = {{"samples.Y"}, true},
    [KILN_AOV_ERROR] = {{"error.Y"}, true},
};

enum { CHANNELS_MAX = 4 + 3 * KILN_AOV_COUNT };

static uint32_t channels_of(int aov) {
    uint32_t n = 0;
    while (n < 3 && layers[aov].channels[n]) n++;
    return n;
}

typedef struct assembly {
    kiln_exr_channel channels[CHANNELS_MAX];
    uint32_t count;
    float *beauty, *aovs[KILN_AOV_COUNT];
} assembly;

static void add(assembly *a, const char *name, const float *values, size_t stride, bool full) {
    a->channels[a->count++] = (kiln_exr_channel){name, values, stride, full};
}

static bool read_layers(const picture *p, size_t pixels, assembly *a) {
    kiln_film_desc d = kiln_film_describe(p->film);
    for (int i = 0; i < KILN_AOV_COUNT; i++) {
        if (!(d.aovs & 1u << i)) continue;
        a->aovs[i] = array_alloc(pixels, channels_of(i) * sizeof(float));
        if (!a->aovs[i]) return false;
        kiln_film_aov(p->film, (kiln_aov)i, a->aovs[i]);
    }
    a->beauty = array_alloc(pixels, 3 * sizeof(float));
    if (a->beauty) picture_beauty(p, a->aovs[KILN_AOV_ALPHA], a->beauty);
    return a->beauty != NULL;
}

static void add_layers(const picture *p, assembly *a) {
    static const char *const rgb[] = {"R", "G", "B"};
    bool premultiplied = p->transparent && !p->background; /* the film's RGB is */
    for (size_t k = 0; k < 3; k++) add(a, rgb[k], a->beauty + k, 3, true);
    for (int i = 0; i < KILN_AOV_COUNT; i++) {
        if (!a->aovs[i]) continue;
        bool is_picture = i == KILN_AOV_ALPHA && premultiplied;
        if (!is_picture && !(p->layers & 1u << i)) continue; /* it was only needed to put a colour behind */
        for (uint32_t k = 0, n = channels_of(i); k < n; k++)
            add(a, is_picture ? "A" : layers[i].channels[k], a->aovs[i] + k, n, layers[i].full);
    }
}

bool picture_write_exr(const picture *p, const char *path, kiln_report *report) {
    kiln_film_desc d = kiln_film_describe(p->film);
    assembly a = {0};
    float xy[8];
    bool done = read_layers(p, (size_t)(d.crop[2] - d.crop[0]) * (d.crop[3] - d.crop[1]), &a) ||
                report_no_memory(report, "writing a picture");
    if (done) {
        add_layers(p, &a);
        kiln_exr_file file = {.width = d.width, .height = d.height, .channels = a.channels, .channel_count = a.count,
                              .attributes = p->attributes, .attribute_count = p->attribute_count,
                              .chromaticities = kiln_color_chromaticities(p->color, xy) ? xy : NULL};
        memcpy(file.crop, d.crop, sizeof file.crop);
        done = image_write_exr(path, &file, report);
    }
    for (int i = 0; i < KILN_AOV_COUNT; i++) free(a.aovs[i]);
    free(a.beauty);
    return done;
}
