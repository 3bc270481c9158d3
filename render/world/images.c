#include "render/world/images.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/threads.h"
#include "image/image.h"
#include "render/world/mips.h"
#include "scene/transfer.h"

/* Grey spreads to RGB and a missing alpha is 1 (glTF 2.0, 3.9.2). */
#define EXPAND(type, one)                                                                                              \
    static void expand_##type(const type *from, uint32_t channels, size_t count, type *to) {                           \
        for (size_t i = 0; i < count; i++, from += channels, to += 4) {                                                \
            bool grey = channels < 3;                                                                                  \
            to[0] = from[0];                                                                                           \
            to[1] = from[grey ? 0 : 1];                                                                                \
            to[2] = from[grey ? 0 : 2];                                                                                \
            to[3] = channels == 2 ? from[1] : channels == 4 ? from[3] : (type)(one);                                   \
        }                                                                                                              \
    }
EXPAND(uint8_t, 255)
EXPAND(uint16_t, 65535)
EXPAND(float, 1.0f)

static void *expand(const kiln_image *image) {
    size_t count = (size_t)image->width * image->height;
    void *rgba = aligned_array(count, texel_bytes(image->format));
    if (!rgba) return NULL;
    if (image->format == KILN_PIXELS_U8) expand_uint8_t(image->pixels, image->channels, count, rgba);
    else if (image->format == KILN_PIXELS_U16) expand_uint16_t(image->pixels, image->channels, count, rgba);
    else expand_float(image->pixels, image->channels, count, rgba);
    return rgba;
}

/* Pixels of a description, decoded if they are a file. *owned says whether image_free is due. */
static bool pixels_of(const kiln_image_desc *desc, kiln_image *image, bool *owned, kiln_report *report) {
    *owned = desc->encoded != NULL;
    if (!desc->encoded) {
        *image = (kiln_image){desc->width, desc->height, desc->channels, desc->format, (void *)desc->pixels};
        return true;
    }
    kiln_where where = where_root(scene_image_place(desc));
    return image_decode(desc->encoded, desc->encoded_size, 0, image, &where, report);
}

/* Which of an image's arrays serves a use. */
static uint32_t place_of(kiln_pixel_format format, kiln_transfer transfer, texel_domain domain) {
    bool curved = transfer == KILN_TRANSFER_SRGB;
    if (format == KILN_PIXELS_U8 || (format == KILN_PIXELS_U16 && !curved)) return 0;
    if (format == KILN_PIXELS_U16) domain = TEXELS_UNIT; /* it cannot leave that */
    return 1 + 2 * (uint32_t)domain + curved;
}

const void *image_texels(const world_image *image, kiln_transfer transfer, texel_domain domain,
                         kiln_pixel_format *format) {
    uint32_t place = place_of(image->format, transfer, domain);
    *format = place ? KILN_PIXELS_F32 : image->format;
    return image->texels[place];
}

static uint32_t levels_of(const world_image *image, kiln_transfer transfer, texel_domain domain) {
    uint32_t place = place_of(image->format, transfer, domain);
    return image->format == KILN_PIXELS_U8 ? (uint32_t)transfer : place ? KILN_TRANSFER_COUNT - 1 + place : 0;
}

const void *image_levels(const world_image *image, kiln_transfer transfer, texel_domain domain) {
    return image->filtered & image_use(transfer, domain) ? image->levels[levels_of(image, transfer, domain)] : NULL;
}

/* The pyramid for a use, unless it is there already. */
static bool make_levels(world_image *image, kiln_transfer transfer, texel_domain domain, const float *curve,
                        kiln_report *report) {
    uint32_t at = levels_of(image, transfer, domain);
    void **levels = &image->levels[at];
    texture_grid grid = {.width = (int32_t)image->width, .height = (int32_t)image->height, .curve = curve};
    grid.texels = image_texels(image, transfer, domain, &grid.format);
    if (*levels || (grid.format == KILN_PIXELS_U8 && !mips_take(curve))) return true;
    *levels = mips_make(&grid, &image->level_bytes[at]);
    image->bytes += image->level_bytes[at];
    return *levels || report_no_memory(report, "filtering textures");
}

static bool into_domain(float *value, float high) {
    bool inside = *value >= 0 && *value <= high;
    if (!inside) *value = *value > high && *value < INFINITY ? high : 0.0f;
    return inside;
}

/* Linear floats of U16 and F32; *outside counts the texels that were clamped. */
static float *to_floats(const kiln_image *image, kiln_transfer transfer, texel_domain domain, size_t *outside) {
    size_t count = (size_t)image->width * image->height;
    float high = domain == TEXELS_UNIT ? 1.0f : RADIANCE_LIMIT;
    void *codes = expand(image);
    float *rgba = image->format == KILN_PIXELS_F32 ? codes : codes ? aligned_array(4 * count, sizeof *rgba) : NULL;
    for (size_t i = 0; rgba && i < count; i++) {
        bool inside = true;
        for (size_t k = 4 * i; k < 4 * i + 4; k++) {
            float code = image->format == KILN_PIXELS_F32 ? rgba[k] : (float)((uint16_t *)codes)[k] / 65535.0f;
            rgba[k] = k % 4 == 3 ? code : transfer_decode(transfer, code);
            inside &= into_domain(&rgba[k], high);
        }
        *outside += !inside;
    }
    if (codes != rgba) free(codes);
    return rgba;
}

/* The size of an array of texels. */
static size_t texels_bytes(const world_image *image, uint32_t place) {
    return (size_t)image->width * image->height * texel_bytes(place ? KILN_PIXELS_F32 : image->format);
}

/* Texels for a use, unless they are there already. */
static bool make_texels(world_image *image, const kiln_image *pixels, kiln_transfer transfer, texel_domain domain,
                        const kiln_where *where, kiln_report *report) {
    uint32_t place = place_of(pixels->format, transfer, domain);
    size_t texels = (size_t)pixels->width * pixels->height, outside = 0;
    if (image->texels[place]) return true;
    image->texels[place] = place ? (void *)to_floats(pixels, transfer, domain, &outside) : expand(pixels);
    image->bytes += texels_bytes(image, place);
    if (outside)
        report_warning(report, KILN_CODE_RANGE, where, "clean the picture",
                       "%zu of %zu texels lie outside %s: they are clamped", outside, texels,
                       domain == TEXELS_UNIT ? "[0, 1]" : "[0, 1e30]");
    return image->texels[place] || report_no_memory(report, "decoding textures");
}

/* Extremes of n values, which come in turns of a divisor of SPAN channels: SPAN at once, for compilers vectorise that. */
enum { SPAN = 48 };
#define EXTREMES(type, largest)                                                                                        \
    static void extremes_##type(const type *values, size_t n, uint32_t channels, float low[4], float high[4]) {        \
        type least[SPAN], most[SPAN] = {0};                                                                            \
        for (uint32_t k = 0; k < SPAN; k++) least[k] = largest;                                                        \
        for (; n >= SPAN; n -= SPAN, values += SPAN)                                                                   \
            for (uint32_t k = 0; k < SPAN; k++) {                                                                      \
                least[k] = values[k] < least[k] ? values[k] : least[k];                                                \
                most[k] = values[k] > most[k] ? values[k] : most[k];                                                   \
            }                                                                                                          \
        for (uint32_t k = 0; k < n; k++) {                                                                             \
            least[k] = values[k] < least[k] ? values[k] : least[k];                                                    \
            most[k] = values[k] > most[k] ? values[k] : most[k];                                                       \
        }                                                                                                              \
        for (uint32_t k = 0; k < SPAN; k++) {                                                                          \
            low[k % channels] = fminf(low[k % channels], (float)least[k]);                                             \
            high[k % channels] = fmaxf(high[k % channels], (float)most[k]);                                            \
        }                                                                                                              \
    }
EXTREMES(uint8_t, UINT8_MAX)
EXTREMES(uint16_t, UINT16_MAX)
EXTREMES(float, INFINITY)

/* What is not a number counts as 0, as decoding has it: the picture may hold both. */
static void heed_nans(const kiln_image *pixels, float low[4], float high[4]) {
    const float *values = pixels->pixels;
    for (size_t i = 0; i < (size_t)pixels->width * pixels->height * pixels->channels; i++) {
        uint32_t k = (uint32_t)(i % pixels->channels);
        if (isfinite(values[i])) continue;
        low[k] = 0;
        if (values[i] > 0) high[k] = INFINITY;
    }
}

/* The least and the largest of each channel. */
static void look_at(world_image *image, const kiln_image *pixels) {
    size_t n = (size_t)pixels->width * pixels->height * pixels->channels;
    float low[4] = {INFINITY, INFINITY, INFINITY, INFINITY}, high[4] = {0}, most = 1;
    if (pixels->format == KILN_PIXELS_U8) extremes_uint8_t(pixels->pixels, n, pixels->channels, low, high), most = 255;
    else if (pixels->format == KILN_PIXELS_U16)
        extremes_uint16_t(pixels->pixels, n, pixels->channels, low, high), most = 65535;
    else {
        extremes_float(pixels->pixels, n, pixels->channels, low, high);
        heed_nans(pixels, low, high);
    }
    bool grey = pixels->channels < 3, alpha = pixels->channels == 2 || pixels->channels == 4;
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t from = k < 3 ? grey ? 0 : k : pixels->channels - 1;
        image->low[k] = k == 3 && !alpha ? 1 : fmaxf(low[from], 0) / most;
        image->high[k] = k == 3 && !alpha ? 1 : fmaxf(high[from], 0) / most;
    }
    image->width = pixels->width;
    image->height = pixels->height;
    image->format = pixels->format;
    image->looked_at = true;
}

static bool make_all_texels(world_image *image, const kiln_image *pixels, float curves[KILN_TRANSFER_COUNT][256],
                            const kiln_where *where, kiln_report *report) {
    for (int d = 0; d < TEXEL_DOMAINS; d++)
        for (int t = 0; t < KILN_TRANSFER_COUNT; t++) {
            uint32_t use = image_use((kiln_transfer)t, (texel_domain)d);
            if (image->wanted & use && !make_texels(image, pixels, (kiln_transfer)t, (texel_domain)d, where, report))
                return false;
            if (image->filtered & use && !make_levels(image, (kiln_transfer)t, (texel_domain)d, curves[t], report))
                return false;
        }
    return true;
}

typedef struct decode_job {
    world_image *images;
    const kiln_scene *scene;
    float (*curves)[256]; /* NULL: no pixel is kept */
    kiln_report *report;
    atomic_bool failed;
} decode_job;

static void decode_one(void *context, size_t index, uint32_t thread) {
    (void)thread;
    decode_job *job = context;
    world_image *image = &job->images[index];
    if (!image->wanted || (job->curves && atomic_load(&job->failed))) return;
    kiln_image pixels;
    bool owned;
    if (!pixels_of(&job->scene->images[index], &pixels, &owned, job->report)) {
        atomic_store(&job->failed, true);
        return;
    }
    kiln_where where = where_root(scene_image_place(&job->scene->images[index]));
    look_at(image, &pixels);
    if (job->curves && !make_all_texels(image, &pixels, job->curves, &where, job->report))
        atomic_store(&job->failed, true);
    if (owned) image_free(&pixels);
}

static bool decode(decode_job *job, uint32_t threads) {
    threads_for(threads, job->scene->image_count, decode_one, job);
    return !job->failed;
}

bool images_decode(world_image *images, const kiln_scene *scene, float curves[KILN_TRANSFER_COUNT][256],
                   uint32_t threads, kiln_report *report) {
    return decode(&(decode_job){images, scene, curves, report, false}, threads);
}

bool images_look(world_image *images, const kiln_scene *scene, uint32_t threads, kiln_report *report) {
    return decode(&(decode_job){images, scene, NULL, report, false}, threads);
}

void images_drop(world_image *images, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        world_image *image = &images[i];
        bool texels[1 + 2 * TEXEL_DOMAINS] = {0}, levels[KILN_TRANSFER_COUNT + 2 * TEXEL_DOMAINS] = {0};
        for (int d = 0; d < TEXEL_DOMAINS; d++)
            for (int t = 0; t < KILN_TRANSFER_COUNT; t++) {
                uint32_t use = image_use((kiln_transfer)t, (texel_domain)d);
                texels[place_of(image->format, (kiln_transfer)t, (texel_domain)d)] |= (image->wanted & use) != 0;
                levels[levels_of(image, (kiln_transfer)t, (texel_domain)d)] |= (image->filtered & use) != 0;
            }
        for (uint32_t k = 0; k < 1 + 2 * TEXEL_DOMAINS; k++) {
            if (texels[k] || !image->texels[k]) continue;
            image->bytes -= texels_bytes(image, k);
            free(image->texels[k]);
            image->texels[k] = NULL;
        }
        for (uint32_t k = 0; k < KILN_TRANSFER_COUNT + 2 * TEXEL_DOMAINS; k++) {
            if (levels[k] || !image->levels[k]) continue;
            image->bytes -= image->level_bytes[k];
            free(image->levels[k]);
            image->levels[k] = NULL;
        }
    }
}

void images_free(world_image *images, uint32_t count) {
    for (uint32_t i = 0; images && i < count; i++) {
        for (int k = 0; k < 1 + 2 * TEXEL_DOMAINS; k++) free(images[i].texels[k]);
        for (int k = 0; k < KILN_TRANSFER_COUNT + 2 * TEXEL_DOMAINS; k++) free(images[i].levels[k]);
    }
    free(images);
}

bool image_load_linear(const kiln_image_desc *desc, kiln_transfer transfer, const kiln_decoding *decoding,
                       uint32_t *width, uint32_t *height, float **rgb, kiln_report *report) {
    kiln_image pixels;
    bool owned;
    if (!pixels_of(desc, &pixels, &owned, report)) return false;
    size_t count = (size_t)pixels.width * pixels.height;
    float scale = pixels.format == KILN_PIXELS_U8 ? 1.0f / 255.0f : pixels.format == KILN_PIXELS_U16 ? 1.0f / 65535.0f : 1.0f;
    *rgb = aligned_array(3 * count, sizeof **rgb);
    for (size_t i = 0; *rgb && i < count; i++) {
        float c[3];
        for (uint32_t k = 0; k < 3; k++) {
            size_t at = i * pixels.channels + (pixels.channels < 3 ? 0 : k);
            float code = pixels.format == KILN_PIXELS_U8 ? (float)((uint8_t *)pixels.pixels)[at]
                         : pixels.format == KILN_PIXELS_U16 ? (float)((uint16_t *)pixels.pixels)[at]
                                                            : ((float *)pixels.pixels)[at];
            c[k] = transfer_decode(transfer, code * scale);
        }
        v3_store(*rgb + 3 * i, decoding_apply(decoding, transfer, c));
    }
    *width = pixels.width;
    *height = pixels.height;
    if (owned) image_free(&pixels);
    return *rgb ? true : report_no_memory(report, "decoding the environment");
}
